//! Samples on the stage.

use impinge::debug_render::{DebugDrawing, DebugRender};
use impinge::math::Space;
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_samples::{Control, ControlKind, ControlValue, Entry, Running, Sample};

use crate::answer::{Info, ShownControl, ShownKind, ShownReadout, Status};
use crate::describe::status;
use crate::stage::Source;
use crate::{EngineError, Viewed};

/// A sample that runs. What it records is dropped after each step.
#[derive(Debug)]
pub struct Sampled<const D: usize>
where
    f32: Viewed<D>,
{
    running: Running<D>,
    entry: Entry,
    /// The controls that the page knows.
    known: Vec<ShownControl>,
}

impl<const D: usize> Sampled<D>
where
    f32: Viewed<D>,
{
    /// A sample at step 0.
    ///
    /// # Errors
    /// If its world refuses its objects.
    pub fn new(entry: &Entry, sample: Box<dyn Sample<D>>) -> Result<Self, EngineError> {
        let mut running = Running::new(sample)?;
        drop(running.take_bytes());
        let known = shown_controls(running.controls());
        Ok(Self { running, entry: *entry, known })
    }

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

    fn info(&self, bounds: [[f64; 3]; 2]) -> Info {
        let Entry { name, title, about, .. } = self.entry;
        Info {
            kind: "sample",
            step: step_of(&self.running),
            notes: Vec::new(),
            dimension: D,
            scalar: "f32".to_owned(),
            name: name.to_owned(),
            title: title.to_owned(),
            about: about.to_owned(),
            written_by: String::new(),
            steps: None,
            complete: false,
            time_step: 1.0 / 60.0,
            bounds,
            up: [0.0, 1.0, 0.0],
            marks: Vec::new(),
            controls: shown_controls(self.running.controls()),
        }
    }

    fn status(&mut self) -> Status {
        let now = shown_controls(self.running.controls());
        let changed = now != self.known;
        let controls = if changed { now.clone() } else { Vec::new() };
        self.known = now;
        let readouts = self.running.readouts().into_iter();
        let readouts =
            readouts.map(|readout| ShownReadout { label: readout.label, value: readout.value });
        let of_world = status(self.world(), step_of(&self.running));
        Status { controls, readouts: readouts.collect(), ..of_world }
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

    /// The page knows the value that it has set.
    fn control(&mut self, name: &str, value: &ControlValue) -> Result<(), EngineError> {
        self.running.set_control(name, value)?;
        self.drop_recording();
        let now = shown_controls(self.running.controls());
        for (known, now) in self.known.iter_mut().zip(now) {
            if known.name == name {
                *known = now;
            }
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

fn step_of<const D: usize>(running: &Running<D>) -> usize
where
    f32: Viewed<D>,
{
    usize::try_from(running.step()).unwrap_or(usize::MAX)
}

fn shown_controls(controls: &[Control]) -> Vec<ShownControl> {
    controls.iter().map(shown_control).collect()
}

const fn shown_control(control: &Control) -> ShownControl {
    let kind = match control.kind {
        ControlKind::Number { value, min, max, step } => {
            ShownKind::Number { value, min, max, step }
        }
        ControlKind::Choice { value, choices } => ShownKind::Choice { value, choices },
        ControlKind::Flag { value } => ShownKind::Flag { value },
        ControlKind::Button { .. } => ShownKind::Button,
    };
    ShownControl { name: control.name, label: control.label, kind }
}
