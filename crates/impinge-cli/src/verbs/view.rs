//! `impinge view`: shows a running scene, or a recording, in a browser.

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
    // The address is printed only after the input was read.
    match Input::open(&args.scene)? {
        Input::Recording(log) => {
            let bytes = log.into_page_bytes()?;
            let live = start(args)?;
            live.send(&bytes);
            wait_for_interrupt()
        }
        Input::Scene(loaded) => {
            let live = start(args)?;
            run_in(loaded.kind, Show { loaded: &loaded, args, live: &live })?;
            Ok(Outcome::Clear)
        }
    }
}

/// Starts the server and prints its address.
fn start(args: &ViewArgs) -> Result<Live, CliError> {
    let title = args.scene.scene.display().to_string();
    let live = Live::start(&assets(&args.page)?, &title, args.port)?;
    output::print(&format!("{NAME}{}{NAME:#}\n", live.url()))?;
    Ok(live)
}

/// Waits until the user interrupts the command, while other threads serve the page.
fn wait_for_interrupt() -> ! {
    loop {
        thread::park();
    }
}

/// The task that moves the objects of a scene in real time, and sends the recording to the page.
struct Show<'a> {
    loaded: &'a Loaded,
    args: &'a ViewArgs,
    live: &'a Live,
}

impl Task for Show<'_> {
    type Answer = ();

    fn run<N: Stage<D>, const D: usize>(self) -> Result<(), CliError> {
        let Self { loaded, args, live } = self;
        let mut world = loaded.moving::<N, D>(args.key_frames)?;
        let seconds = args.time_step.seconds.0;
        let pause = Duration::try_from_secs_f64(seconds)
            .map_err(|error| CliError::argument("--dt", seconds, error))?;
        let mut due = Instant::now();
        for _ in 0..args.steps.unwrap_or(u64::MAX) {
            loaded.step(&mut world, seconds)?;
            live.send(&world.recorder_mut().take_bytes());
            // If a step takes longer than `pause`, the steps after it are delayed and do not catch
            // up.
            due = (due + pause).max(Instant::now());
            thread::sleep(due.saturating_duration_since(Instant::now()));
        }
        live.send(&world.finish().bytes);
        Ok(())
    }
}
