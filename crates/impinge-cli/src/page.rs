//! The parts of the page, and recordings for it.

use impinge_html::Assets;

use crate::args::{PageArgs, Positive};
use crate::error::CliError;
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// The parts in a folder that the user names, or else those of the command.
pub(crate) fn assets(args: &PageArgs) -> Result<Assets, CliError> {
    match &args.folder {
        Some(folder) => Ok(Assets::from_folder(folder)?),
        None => embedded().ok_or(CliError::NoPage),
    }
}

#[cfg(feature = "page")]
#[expect(clippy::unnecessary_wraps, reason = "a command without the feature has none")]
fn embedded() -> Option<Assets> {
    Some(Assets::embedded())
}

#[cfg(not(feature = "page"))]
const fn embedded() -> Option<Assets> {
    None
}

/// The bytes of a recording of a scene whose objects move.
pub(crate) fn record(loaded: &Loaded, steps: u32, dt: Positive) -> Result<Vec<u8>, CliError> {
    run_in(loaded.kind, Steps { loaded, steps, dt })
}

struct Steps<'a> {
    loaded: &'a Loaded,
    steps: u32,
    dt: Positive,
}

impl Task for Steps<'_> {
    type Answer = Vec<u8>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<u8>, CliError> {
        let mut world = self.loaded.moving::<N, D>()?;
        let mut progress = Progress::new(self.steps as usize, "recording");
        for _ in 0..self.steps {
            world.step(self.dt.0)?;
            progress.step();
        }
        Ok(world.finish().bytes)
    }
}
