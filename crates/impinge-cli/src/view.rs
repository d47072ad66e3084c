//! `impinge view`: a scene that runs, or a recording, in a browser.

use std::thread;
use std::time::{Duration, Instant};

use impinge_html::Live;

use crate::args::ViewArgs;
use crate::error::CliError;
use crate::input::Input;
use crate::output::{self, NAME, Outcome};
use crate::page::assets;
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &ViewArgs) -> Result<Outcome, CliError> {
    let assets = assets(&args.page)?;
    let input = Input::open(&args.scene)?;
    let title = args.scene.scene.display().to_string();
    let live = Live::start(&assets, &title, args.port)?;
    output::print(&format!("{NAME}{}{NAME:#}\n", live.url()))?;
    match input {
        Input::Recording(log) => {
            live.send(&log.bytes);
            wait_for_interrupt()
        }
        Input::Scene(loaded) => {
            run_in(loaded.kind, Show { loaded: &loaded, args, live: &live })?;
            Ok(Outcome::Clear)
        }
    }
}

/// Serves until the user interrupts the command.
fn wait_for_interrupt() -> ! {
    loop {
        thread::park();
    }
}

/// Moves the objects of a scene by the clock.
struct Show<'a> {
    loaded: &'a Loaded,
    args: &'a ViewArgs,
    live: &'a Live,
}

impl Task for Show<'_> {
    type Answer = ();

    fn run<N: Stage<D>, const D: usize>(self) -> Result<(), CliError> {
        let Self { loaded, args, live } = self;
        let mut world = loaded.moving::<N, D>()?;
        let pause = Duration::try_from_secs_f64(args.dt.0)
            .map_err(|error| CliError::argument("--dt", args.dt.0, error))?;
        let mut due = Instant::now();
        for _ in 0..args.steps.unwrap_or(u64::MAX) {
            world.step(args.dt.0)?;
            live.send(&world.recorder_mut().take_bytes());
            // A step that takes longer than it shows delays the next ones, which do not catch up.
            due = (due + pause).max(Instant::now());
            thread::sleep(due.saturating_duration_since(Instant::now()));
        }
        live.send(&world.finish().bytes);
        Ok(())
    }
}
