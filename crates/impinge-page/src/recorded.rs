//! Recordings on the stage.

use impinge::debug_render::{DebugDrawing, DebugRender};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_record::{Difference, Divergence, Header, ObjectField, ReadError, Registry, Replay};
use impinge_samples::ControlValue;

use crate::answer::{Info, Status};
use crate::describe::status;
use crate::queries::QueryPen;
use crate::stage::Source;
use crate::stand_in::StandIns;
use crate::time_line::marks;
use crate::{EngineError, Viewed};

/// A recording that is replayed, whole or growing. The data of objects may be any bytes.
///
/// What the recording names and the registry lacks is stood in for: pair filters let all pairs through, shapes become
/// balls. [`Info::notes`] says so, and the replay then differs from the recording where that matters.
#[derive(Debug)]
pub struct Recorded<N: Viewed<D>, const D: usize> {
    replay: Replay<N, D, Vec<u8>>,
    stand_ins: StandIns<N, D>,
    is_stream: bool,
}

impl<N: Viewed<D>, const D: usize> Recorded<N, D> {
    /// A whole recording, at its first update.
    ///
    /// # Errors
    /// As [`Replay::open`] and [`Replay::seek`], but for names that the registry lacks.
    pub fn open(bytes: Vec<u8>, registry: Registry<N, D, Vec<u8>>) -> Result<Self, EngineError> {
        let mut stand_ins = StandIns::of(registry);
        let replay = loop {
            match Replay::open(bytes.clone(), &stand_ins.registry) {
                Ok(replay) => break replay,
                Err(error) => stand_ins.resolve(error)?,
            }
        };
        let mut recorded = Self { replay, stand_ins, is_stream: false };
        recorded.seek(1)?;
        Ok(recorded)
    }

    /// A recording without bytes, which grows.
    #[must_use]
    pub fn growing(registry: Registry<N, D, Vec<u8>>) -> Self {
        let stand_ins = StandIns::of(registry);
        let replay = Replay::growing(&stand_ins.registry);
        Self { replay, stand_ins, is_stream: true }
    }

    /// Lets something stand in for a name that was found missing, and reads all bytes again.
    fn reread(&mut self, error: ReadError) -> Result<(), ReadError> {
        self.stand_ins.resolve(error)?;
        let bytes = self.replay.bytes().to_vec();
        self.replay = Replay::growing(&self.stand_ins.registry);
        while let Err(error) = self.replay.push(&bytes) {
            self.stand_ins.resolve(error)?;
            self.replay = Replay::growing(&self.stand_ins.registry);
        }
        Ok(())
    }

    /// Goes to a step; `at_most` the last.
    fn go(&mut self, step: usize) -> Result<(), ReadError> {
        while let Err(error) = self.replay.seek(step) {
            self.reread(error)?;
        }
        Ok(())
    }
}

impl<N: Viewed<D>, const D: usize> Source<N, D> for Recorded<N, D> {
    type Data = Vec<u8>;

    fn world(&self) -> &CollisionWorld<N, D, Vec<u8>> {
        self.replay.world()
    }

    fn info(&self, bounds: [[f64; 3]; 2]) -> Info {
        let header = Header::read(self.replay.bytes());
        Info {
            kind: if self.is_stream { "stream" } else { "recording" },
            step: self.replay.step(),
            notes: self.stand_ins.notes(),
            dimension: D,
            scalar: format!("f{}", 8 * N::BYTES),
            name: String::new(),
            title: String::new(),
            about: String::new(),
            written_by: header.map_or_else(|_| String::new(), |header| header.writer),
            steps: Some(self.replay.len()),
            complete: self.replay.is_complete(),
            time_step: 1.0 / 60.0,
            bounds,
            up: [0.0, 1.0, 0.0],
            marks: marks(self.replay.marks()),
            controls: Vec::new(),
        }
    }

    fn status(&mut self) -> Status {
        let diverged = self.replay.divergence().map(|found| divergence_text(&found));
        Status { diverged, ..status(self.world(), self.replay.step()) }
    }

    fn push(&mut self, bytes: &[u8]) -> Result<(), EngineError> {
        if !self.is_stream {
            return Err(EngineError::OfSamples("bytes to come: it is whole"));
        }
        let step = self.replay.step();
        if let Err(error) = self.replay.push(bytes) {
            self.reread(error)?;
            self.go(step)?;
        }
        // What was empty stands at its first update, as what is opened whole.
        if step == 0 {
            self.go(1)?;
        }
        Ok(())
    }

    fn seek(&mut self, step: usize) -> Result<(), EngineError> {
        Ok(self.go(step)?)
    }

    fn advance(&mut self, steps: u64) -> Result<(), EngineError> {
        let steps = usize::try_from(steps).unwrap_or(usize::MAX);
        Ok(self.go(self.replay.step().saturating_add(steps))?)
    }

    fn reset(&mut self) -> Result<(), EngineError> {
        Ok(self.go(1)?)
    }

    fn control(&mut self, _: &str, _: &ControlValue) -> Result<(), EngineError> {
        Err(EngineError::OfSamples("controls"))
    }

    /// The next seek undoes it.
    fn drag(&mut self, object: CollisionObjectHandle, to: &N::Isometry) -> Result<(), EngineError> {
        let world = self.replay.world_mut();
        world.try_set_position(object, *to)?;
        world.update();
        Ok(())
    }

    fn draw(&self, drawing: &mut DebugDrawing<N, D>, renderer: &mut dyn DebugRender<N, D>) {
        let mut pen = QueryPen { drawing, renderer };
        self.replay.queries().iter().for_each(|asked| pen.draw(asked));
    }

    fn stand_ins(&self) -> &[String] {
        &self.stand_ins.filters
    }
}

/// In what a replay differs, for people.
fn divergence_text(found: &Divergence) -> String {
    // The record of an update makes the next step.
    let step = found.step + 1;
    match found.difference {
        Difference::Object { index, field: ObjectField::Description } => {
            format!("step {step}: object {index} is at another place or has other groups")
        }
        Difference::Object { index, field: ObjectField::Pairs } => {
            format!("step {step}: object {index} has other contacts")
        }
        Difference::State => format!("step {step}: the state of the world differs"),
        Difference::Events => format!("step {step}: the events differ"),
        _ => format!("step {step}: the answer of a query differs"),
    }
}
