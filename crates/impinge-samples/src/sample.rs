//! What a sample is.

use core::fmt;

use impinge::debug_render::{Color, DebugDrawing, DebugRender, Drawn};
use impinge::math::{Point, Space};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge_record::{Recordable, Recorder, Registry};
use serde::Serialize;

use crate::{Panel, SampleError};

/// The world of a sample, which is recorded; the data of an object is its label.
pub type World<const D: usize> = Recorder<f32, D, String>;

/// Seconds of a step.
pub const TIME_STEP: f32 = 1.0 / 60.0;

/// The positions of a world.
pub type Isometry<const D: usize> = <f32 as Space<D>>::Isometry;

/// A scene with controls, that shows one thing about the library.
///
/// [`Running`](crate::Running) calls these methods, and updates the world after each that may change it. A step
/// is [`TIME_STEP`] long. The same calls lead to the same bits on every machine.
pub trait Sample<const D: usize>: Send
where
    f32: Recordable<D>,
{
    /// The controls, with their values at first.
    fn panel(&self) -> Panel {
        Panel::new()
    }

    /// By how much the boxes of the broad phase are loosened.
    fn margin(&self) -> f32 {
        0.02
    }

    /// Names for the shapes and the pair filters of the sample's own.
    fn registry(&self) -> Registry<f32, D, String> {
        Registry::new()
    }

    /// Adds the objects to a world without any, and forgets what was before.
    ///
    /// # Errors
    /// Where the world refuses an object.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError>;

    /// Removes all objects and adds them again: what a sample of another size, or one that restarts, does.
    ///
    /// # Errors
    /// As [`Self::build`].
    fn rebuild(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        world.clear();
        self.build(world, panel)
    }

    /// A control was set, not a button: what can be seen at once, without a step, is changed.
    ///
    /// # Errors
    /// Where the world refuses a change.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let _ = (world, panel);
        Ok(())
    }

    /// Moves the objects by one step.
    ///
    /// # Errors
    /// Where the world refuses a change.
    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError>;

    /// The world was updated: its events are counted here, and its queries asked.
    ///
    /// # Errors
    /// Where the world refuses a query.
    fn updated(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let _ = (world, panel);
        Ok(())
    }

    /// A person moved an object.
    ///
    /// # Errors
    /// If the handle is stale or the position is not finite.
    fn dragged(
        &mut self,
        world: &mut World<D>,
        object: CollisionObjectHandle,
        to: &Isometry<D>,
    ) -> Result<(), SampleError> {
        Ok(world.set_position(object, *to)?)
    }

    /// Draws what is to be seen beside the objects: rays, paths, distances.
    fn draw(&self, world: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        let _ = (world, panel, canvas);
    }

    /// Numbers to be shown.
    fn readouts(&self, world: &World<D>, panel: &Panel) -> Vec<Readout> {
        let _ = (world, panel);
        Vec::new()
    }
}

/// What samples draw with.
pub struct Canvas<'a, const D: usize>
where
    f32: Space<D>,
{
    /// Draws queries, and whole worlds.
    pub drawing: &'a mut DebugDrawing<f32, D>,
    /// Takes lines and points.
    pub renderer: &'a mut dyn DebugRender<f32, D>,
}

impl<const D: usize> Canvas<'_, D>
where
    f32: Space<D>,
{
    /// A line that belongs to a query.
    pub fn line(&mut self, ends: [Point<f32, D>; 2], color: Color) {
        self.renderer.line(ends, color, Drawn::Query);
    }

    /// Lines from each point to the next.
    pub fn path(&mut self, points: &[Point<f32, D>], color: Color) {
        for ends in points.windows(2) {
            self.line([ends[0], ends[1]], color);
        }
    }

    /// A point that a query found.
    pub fn point(&mut self, at: &Point<f32, D>, size: f32, color: Color) {
        self.renderer.point(at, size, color, Drawn::QueryHit);
    }

    /// A text beside a point.
    pub fn text(&mut self, at: &Point<f32, D>, text: &str, color: Color) {
        self.renderer.text(at, text, color, Drawn::QueryHit);
    }
}

impl<const D: usize> fmt::Debug for Canvas<'_, D>
where
    f32: Space<D>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Canvas").field("drawing", &self.drawing).finish_non_exhaustive()
    }
}

/// A number or a word to be shown beside the picture.
///
/// ```
/// use impinge_samples::Readout;
///
/// assert_eq!(Readout::number("Distance", 0.125_f32).value, "0.1250");
/// assert_eq!(Readout::optional("Time of impact", None).value, "none");
/// assert_eq!(Readout::new("Hits", 3).value, "3");
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Readout {
    /// What it is.
    pub label: &'static str,
    /// Its value.
    pub value: String,
}

impl Readout {
    /// Anything that can be written.
    #[must_use]
    pub fn new(label: &'static str, value: impl fmt::Display) -> Self {
        Self { label, value: value.to_string() }
    }

    /// A number with four digits after the point, or in scientific notation where that would hide it.
    #[must_use]
    pub fn number(label: &'static str, value: f32) -> Self {
        let is_hidden = value != 0.0 && !(0.001..1.0e5).contains(&value.abs());
        Self::new(label, if is_hidden { format!("{value:.3e}") } else { format!("{value:.4}") })
    }

    /// A number, or the word `none` where there is none.
    #[must_use]
    pub fn optional(label: &'static str, value: Option<f32>) -> Self {
        value.map_or_else(|| Self::new(label, "none"), |value| Self::number(label, value))
    }
}
