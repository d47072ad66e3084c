//! Scenes whose objects move, recorded.

use crate::args::{KeyFrames, Stepping};
use crate::error::CliError;
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};
use crate::summary::touches;

/// A recording of a scene.
pub(crate) struct Recorded {
    pub(crate) bytes: Vec<u8>,
    pub(crate) objects: usize,
    /// After how many steps something touched.
    pub(crate) touched: usize,
}

/// Moves the objects of a scene and records every update.
pub(crate) fn record(
    loaded: &Loaded,
    stepping: Stepping,
    key_frames: KeyFrames,
) -> Result<Recorded, CliError> {
    run_in(loaded.kind, Record { loaded, stepping, key_frames })
}

/// Records a scene; see [`record`].
struct Record<'a> {
    loaded: &'a Loaded,
    stepping: Stepping,
    key_frames: KeyFrames,
}

impl Task for Record<'_> {
    type Answer = Recorded;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Recorded, CliError> {
        let Stepping { steps, time_step } = self.stepping;
        let mut world = self.loaded.moving::<N, D>(self.key_frames)?;
        let mut progress = Progress::new(steps as usize, "recording");
        let (objects, mut touched) = (world.len(), 0);
        for _ in 0..steps {
            self.loaded.step(&mut world, time_step.seconds.0)?;
            touched += usize::from(touches(&world));
            progress.step();
        }
        Ok(Recorded { bytes: world.finish().bytes, objects, touched })
    }
}
