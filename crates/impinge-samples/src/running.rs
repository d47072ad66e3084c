//! Runs a sample.

use core::fmt;

use impinge::debug_render::{DebugDrawing, DebugRender};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge_record::{Recordable, Recorder, Registry};

use crate::{Canvas, Control, ControlValue, Isometry, Panel, Readout, Sample, SampleError, World};

/// A running sample with its controls and its world.
///
/// The world is updated after each method that changes it. A method that fails may have changed a
/// part of the world; [`restart`](Self::restart) then starts the sample again.
///
/// ```
/// use impinge_samples::{ControlValue, Make, Running, entries};
///
/// let entry = entries().iter().find(|entry| entry.name == "stack2").expect("the stack");
/// let Make::Plane(make) = entry.make else { panic!("it is a sample in 2D") };
/// let mut stack = Running::new(make())?;
/// stack.set_control("count", &ControlValue::Number(3.0))?;
/// stack.advance()?;
/// assert_eq!(stack.world().len(), 4, "three boxes and the floor");
/// assert!(stack.world().contact_views().count() >= 3, "each lies on something");
/// # Ok::<(), impinge_samples::SampleError>(())
/// ```
pub struct Running<const D: usize>
where
    f32: Recordable<D>,
{
    sample: Box<dyn Sample<D>>,
    panel: Panel,
    world: World<D>,
    step: usize,
}

impl<const D: usize> Running<D>
where
    f32: Recordable<D>,
{
    /// Starts a sample at step 0 with its objects. The world is updated once.
    ///
    /// # Errors
    /// If the world rejects the objects.
    pub fn new(sample: Box<dyn Sample<D>>) -> Result<Self, SampleError> {
        let world = Recorder::new(sample.margin(), sample.registry())?;
        let panel = sample.panel();
        let mut running = Self { sample, panel, world, step: 0 };
        running.restart()?;
        Ok(running)
    }

    /// Starts the sample again at step 0, with the current values of the controls. The same
    /// recording continues: all objects are removed and added again.
    ///
    /// # Errors
    /// If the world rejects the objects.
    pub fn restart(&mut self) -> Result<(), SampleError> {
        self.sample.rebuild(&mut self.world, &self.panel)?;
        self.step = 0;
        self.update()
    }

    /// Advances the sample by a step of [`TIME_STEP`](crate::TIME_STEP).
    ///
    /// # Errors
    /// If the world rejects a change.
    pub fn advance(&mut self) -> Result<(), SampleError> {
        self.sample.advance(&mut self.world, &mut self.panel)?;
        self.step += 1;
        self.update()
    }

    /// Sets a control. Changes that need no step are applied immediately. A button takes effect at
    /// the next step.
    ///
    /// # Errors
    /// If the control or the value is invalid, see [`Panel::set`], or if the world rejects a
    /// change.
    pub fn set_control(&mut self, name: &str, value: &ControlValue) -> Result<(), SampleError> {
        self.panel.set(name, value)?;
        if *value == ControlValue::Pressed {
            return Ok(());
        }
        self.sample.changed(&mut self.world, &self.panel)?;
        self.update()
    }

    /// Moves an object to the position to which the user drags it.
    ///
    /// # Errors
    /// If the handle is stale or the position is not finite.
    pub fn drag(
        &mut self,
        object: CollisionObjectHandle,
        to: &Isometry<D>,
    ) -> Result<(), SampleError> {
        self.sample.dragged(&mut self.world, object, to)?;
        self.update()
    }

    fn update(&mut self) -> Result<(), SampleError> {
        self.world.update();
        self.sample.updated(&mut self.world, &self.panel)
    }

    /// Draws the lines, points and texts that the sample adds to its objects.
    /// [`DebugDrawing::world`] draws the objects.
    pub fn draw(&self, drawing: &mut DebugDrawing<f32, D>, renderer: &mut dyn DebugRender<f32, D>) {
        self.sample.draw(&self.world, &self.panel, &mut Canvas { drawing, renderer });
    }

    /// Returns the values that the sample displays.
    #[must_use]
    pub fn readouts(&self) -> Vec<Readout> {
        self.sample.readouts(&self.world, &self.panel)
    }

    /// Returns the controls with their current values.
    #[must_use]
    pub fn controls(&self) -> &[Control] {
        self.panel.controls()
    }

    /// Returns the world, for queries and drawings.
    #[must_use]
    pub const fn world(&self) -> &World<D> {
        &self.world
    }

    /// Returns the number of steps since the start or the last restart.
    #[must_use]
    pub const fn step(&self) -> usize {
        self.step
    }

    /// Returns the registry of the shapes and filters that the recording refers to by name.
    #[must_use]
    pub fn registry(&self) -> Registry<f32, D, String> {
        self.sample.registry()
    }

    /// Returns the bytes of the recording since the last call. They are kept in memory until then,
    /// so callers that do not use the recording should discard the bytes after each step.
    #[must_use]
    pub fn take_bytes(&mut self) -> Vec<u8> {
        self.world.take_bytes()
    }

    /// Ends the recording and returns the bytes since the last [`take_bytes`](Self::take_bytes).
    #[must_use]
    pub fn finish(self) -> Vec<u8> {
        self.world.finish().bytes
    }
}

impl<const D: usize> fmt::Debug for Running<D>
where
    f32: Recordable<D>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Running")
            .field("panel", &self.panel)
            .field("step", &self.step)
            .finish_non_exhaustive()
    }
}
