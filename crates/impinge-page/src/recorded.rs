//! Recordings as stages.

use impinge::debug_render::{DebugDrawing, DebugRender};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_record::{
    Difference, Divergence, Header, Loss, ObjectField, ReadError, Registry, Replay,
};
use impinge_samples::ControlValue;

use crate::answer::{Info, Status};
use crate::describe::status;
use crate::frame::queries::QueryPen;
use crate::stage::Source;
use crate::stand_in::StandIns;
use crate::time_line::marks;
use crate::{EngineError, Viewed};

/// A replayed recording, complete or still growing. The data of its objects may be any bytes.
///
/// Pair filters and shapes that the registry lacks get stand-ins: filters that accept all pairs,
/// and balls. A stand-in can make the replay differ from the recording. If the end of the recording
/// is missing or damaged, the records before that part are replayed. [`Info::notes`] lists the
/// stand-ins and the lost part. A step that needs another stand-in adds it; [`Status::notes`]
/// lists them again then.
#[derive(Debug)]
pub struct Recorded<N: Viewed<D>, const D: usize> {
    replay: Replay<N, D, Vec<u8>>,
    stand_ins: StandIns<N, D>,
    is_stream: bool,
    /// The part of the recording that could not be read when it was opened. The replay keeps only
    /// the bytes before it, so it does not report the loss again.
    loss: Option<Loss>,
    /// The number of notes that the page has. Notes are never removed.
    known_notes: usize,
}

impl<N: Viewed<D>, const D: usize> Recorded<N, D> {
    /// Opens a recording that does not grow, at step 1, the state after its first update; at step 0
    /// if it has no updates.
    ///
    /// Takes time in proportion to the number of bytes, again for each stand-in, and copies the
    /// bytes.
    ///
    /// # Errors
    /// As [`Replay::salvage`] and [`Replay::seek`], except for names that the registry lacks.
    pub fn open(bytes: &[u8], registry: Registry<N, D, Vec<u8>>) -> Result<Self, EngineError> {
        let mut recorded = Self { is_stream: false, ..Self::growing(registry) };
        recorded.read(bytes)?;
        recorded.loss = recorded.replay.loss().cloned();
        recorded.seek(1)?;
        recorded.known_notes = recorded.notes().len();
        Ok(recorded)
    }

    /// Creates a growing recording without bytes.
    #[must_use]
    pub fn growing(registry: Registry<N, D, Vec<u8>>) -> Self {
        let stand_ins = StandIns::of(registry);
        let replay = Replay::growing(&stand_ins.registry);
        Self { replay, stand_ins, is_stream: true, loss: None, known_notes: 0 }
    }

    /// Reads the bytes of a recording from its beginning, and once more for each missing name that
    /// gets a stand-in.
    fn read(&mut self, bytes: &[u8]) -> Result<(), ReadError> {
        loop {
            let error = if self.is_stream {
                // In a stream, damage is an error, since the bytes after the damage could never be
                // read.
                self.replay = Replay::growing(&self.stand_ins.registry);
                self.replay.push(bytes).err()
            } else {
                self.replay = Replay::salvage(bytes, &self.stand_ins.registry)?;
                self.replay.loss().map(|loss| loss.error.clone())
            };
            match error {
                Some(error) if self.stand_ins.add_for(&error) => {}
                Some(error) if self.is_stream => return Err(error),
                _ => return Ok(()),
            }
        }
    }

    /// Adds a stand-in for the missing name in an error, and reads all bytes again.
    ///
    /// # Errors
    /// Returns `error` itself if it is not about a missing name, or if there are too many
    /// stand-ins.
    fn reread(&mut self, error: ReadError) -> Result<(), ReadError> {
        if !self.stand_ins.add_for(&error) {
            return Err(error);
        }
        let bytes = self.replay.bytes().to_vec();
        self.read(&bytes)
    }

    /// Goes to a step, or to the last step if there are fewer steps. Missing pair filters are
    /// detected here, when the calls that register them are replayed.
    fn go(&mut self, step: usize) -> Result<(), ReadError> {
        while let Err(error) = self.replay.seek(step) {
            self.reread(error)?;
        }
        Ok(())
    }

    fn notes(&self) -> Vec<String> {
        self.loss.iter().map(loss_text).chain(self.stand_ins.notes()).collect()
    }
}

impl<N: Viewed<D>, const D: usize> Source<N, D> for Recorded<N, D> {
    type Data = Vec<u8>;

    fn world(&self) -> &CollisionWorld<N, D, Vec<u8>> {
        self.replay.world()
    }

    fn info(&self) -> Info {
        let header = Header::read(self.replay.bytes());
        Info {
            kind: if self.is_stream { "stream" } else { "recording" },
            step: self.replay.step(),
            notes: self.notes(),
            written_by: header.map_or_else(|_| String::new(), |header| header.writer),
            steps: Some(self.replay.len()),
            complete: self.replay.is_complete(),
            marks: marks(self.replay.marks()),
            ..Info::default()
        }
    }

    fn status(&mut self) -> Status {
        let diverged = self.replay.divergence().map(|found| divergence_text(&found));
        let mut notes = self.notes();
        if notes.len() == self.known_notes {
            notes.clear();
        } else {
            self.known_notes = notes.len();
        }
        Status { diverged, notes, ..status(self.world(), self.replay.step()) }
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
        // Like an opened recording, a stream goes to its first update as soon as it has one.
        if step == 0 {
            self.go(1)?;
        }
        // The response to a push is the description of the stage, which has all notes.
        self.known_notes = self.notes().len();
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

    /// Moves an object in the replayed world. The next seek or advance restores the recorded
    /// position.
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

/// Returns a sentence, to be shown on the page, that says that the recording has no end and how
/// many of its last bytes cannot be read.
fn loss_text(loss: &Loss) -> String {
    match loss.bytes {
        0 => "The recording has no end: its program did not finish it.".to_owned(),
        bytes => {
            format!(
                "The recording has no end: its last {bytes} bytes cannot be read, {}.",
                loss.error
            )
        }
    }
}

/// Returns a sentence, to be shown on the page, about the first difference of a replay from its
/// recording.
fn divergence_text(found: &Divergence) -> String {
    // `found.step` counts the updates before the difference. The difference is in the next update,
    // or in a query before that update.
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
