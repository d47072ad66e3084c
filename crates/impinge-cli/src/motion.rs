//! Records scenes with moving objects.

use crate::args::{KeyFrames, Stepping};
use crate::error::CliError;
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};
use crate::summary::touches;

/// The counts of a recorded scene.
pub(crate) struct Recorded {
    /// The number of bytes of the recording, unpacked.
    pub(crate) bytes: usize,
    pub(crate) objects: usize,
    /// The number of steps after which at least one pair touched.
    pub(crate) touched: usize,
}

/// Moves the objects of a scene and records every update. `take` gets the bytes of the recording in
/// pieces, the first piece after the first step.
pub(crate) fn record(
    loaded: &Loaded,
    stepping: Stepping,
    key_frames: KeyFrames,
    take: &mut dyn FnMut(&[u8]) -> Result<(), CliError>,
) -> Result<Recorded, CliError> {
    run_in(loaded.kind, Record { loaded, stepping, key_frames, take })
}

/// The task that records a scene; see [`record`].
struct Record<'a> {
    loaded: &'a Loaded,
    stepping: Stepping,
    key_frames: KeyFrames,
    take: &'a mut dyn FnMut(&[u8]) -> Result<(), CliError>,
}

impl Task for Record<'_> {
    type Answer = Recorded;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Recorded, CliError> {
        let Stepping { steps, time_step } = self.stepping;
        let mut world = self.loaded.moving::<N, D>(self.key_frames)?;
        let mut progress = Progress::new(steps as usize, "recording");
        let (objects, mut touched, mut bytes) = (world.len(), 0, 0);
        let mut take = |piece: &[u8]| {
            bytes += piece.len();
            (self.take)(piece)
        };
        for _ in 0..steps {
            self.loaded.step(&mut world, time_step.seconds.0)?;
            touched += usize::from(touches(&world));
            take(&world.recorder_mut().take_bytes())?;
            progress.step();
        }
        take(&world.finish().bytes)?;
        Ok(Recorded { bytes, objects, touched })
    }
}
