//! Samples as stages.

use impinge::debug_render::{DebugDrawing, DebugRender};
use impinge::math::Space;
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_samples::{Control, ControlValue, Entry, Running, Sample};

use crate::answer::{Info, Status};
use crate::describe::status;
use crate::stage::Source;
use crate::{EngineError, Viewed};

/// A running sample. Its recording is dropped after each step.
#[derive(Debug)]
pub struct Sampled<const D: usize>
where
    f32: Viewed<D>,
{
    running: Running<D>,
    entry: Entry,
    /// The controls with the values that the page has: the values that it received last, or that it
    /// has set since.
    known: Vec<Control>,
}

impl<const D: usize> Sampled<D>
where
    f32: Viewed<D>,
{
    /// Creates the stage with the sample at step 0.
    ///
    /// # Errors
    /// If the world rejects an object of the sample.
    pub fn new(entry: &Entry, sample: Box<dyn Sample<D>>) -> Result<Self, EngineError> {
        let mut running = Running::new(sample)?;
        drop(running.take_bytes());
        let known = running.controls().to_vec();
        Ok(Self { running, entry: *entry, known })
    }

    /// Drops the recorded bytes, which the page does not use.
    fn drop_recording(&mut self) {
        drop(self.running.take_bytes());
    }
}

impl<const D: usize> Source<f32, D> for Sampled<D>
where
    f32: Viewed<D>,
{
    type Data = String;

    fn world(&self) -> &CollisionWorld<f32, D, String> {
        self.running.world()
    }

    fn info(&self) -> Info {
        let Entry { name, title, about, .. } = self.entry;
        Info {
            kind: "sample",
            step: self.running.step(),
            name: name.to_owned(),
            title: title.to_owned(),
            about: about.to_owned(),
            controls: self.running.controls().to_vec(),
            ..Info::default()
        }
    }

    fn status(&mut self) -> Status {
        let now = self.running.controls();
        let controls = if now == self.known { Vec::new() } else { now.to_vec() };
        self.known = now.to_vec();
        let readouts = self.running.readouts();
        Status { controls, readouts, ..status(self.world(), self.running.step()) }
    }

    fn push(&mut self, _: &[u8]) -> Result<(), EngineError> {
        Err(EngineError::OfRecordings("bytes to come"))
    }

    fn seek(&mut self, _: usize) -> Result<(), EngineError> {
        Err(EngineError::OfRecordings("recorded steps"))
    }

    fn advance(&mut self, steps: u64) -> Result<(), EngineError> {
        for _ in 0..steps {
            self.running.advance()?;
            self.drop_recording();
        }
        Ok(())
    }

    fn reset(&mut self) -> Result<(), EngineError> {
        self.running.restart()?;
        self.drop_recording();
        Ok(())
    }

    /// Sets a control. The page already has the value, so the next status lists the controls only
    /// if the sample has changed another control.
    fn control(&mut self, name: &str, value: &ControlValue) -> Result<(), EngineError> {
        self.running.set_control(name, value)?;
        self.drop_recording();
        let controls = self.known.iter_mut().zip(self.running.controls());
        for (known, now) in controls.filter(|(known, _)| known.name == name) {
            *known = *now;
        }
        Ok(())
    }

    fn drag(
        &mut self,
        object: CollisionObjectHandle,
        to: &<f32 as Space<D>>::Isometry,
    ) -> Result<(), EngineError> {
        self.running.drag(object, to)?;
        self.drop_recording();
        Ok(())
    }

    fn draw(&self, drawing: &mut DebugDrawing<f32, D>, renderer: &mut dyn DebugRender<f32, D>) {
        self.running.draw(drawing, renderer);
    }

    fn stand_ins(&self) -> &[String] {
        &[]
    }
}
