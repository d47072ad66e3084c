//! The interface between a sample and the code that runs it.

use core::fmt;

use impinge::debug_render::{Color, DebugDrawing, DebugRender, Drawn};
use impinge::math::{Point, Space};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge_record::{Recordable, Recorder, Registry};
use serde::Serialize;

use crate::{Panel, SampleError};

/// The recorded world of a sample. The data of an object is its label.
pub type World<const D: usize> = Recorder<f32, D, String>;

/// The duration of a step in seconds.
pub const TIME_STEP: f32 = 1.0 / 60.0;

/// The position type of a world.
pub type Isometry<const D: usize> = <f32 as Space<D>>::Isometry;

/// A scene with controls, about one subject of the library.
///
/// [`Running`](crate::Running) calls these methods. It updates the world after each method that may
/// move, add or remove objects, and then calls [`Self::updated`]. A step takes [`TIME_STEP`]. The
/// same calls give the same bits on every machine.
pub trait Sample<const D: usize>: Send
where
    f32: Recordable<D>,
{
    /// Returns the controls with their initial values.
    fn panel(&self) -> Panel {
        Panel::new()
    }

    /// Returns the margin of the fat AABBs in the broad phase.
    fn margin(&self) -> f32 {
        0.02
    }

    /// Returns the registry with the named shapes and pair filters of this sample.
    fn registry(&self) -> Registry<f32, D, String> {
        Registry::new()
    }

    /// Adds the objects to an empty world, and resets the state of the sample.
    ///
    /// # Errors
    /// If the world rejects an object.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError>;

    /// Removes all objects and adds them again, for a restart or another number of objects.
    ///
    /// # Errors
    /// As [`Self::build`].
    fn rebuild(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        world.clear();
        self.build(world, panel)
    }

    /// Applies the changed value of a control as far as this needs no step. It is called after a
    /// control was set, except after a press of a button.
    ///
    /// # Errors
    /// If the world rejects a change.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let _ = (world, panel);
        Ok(())
    }

    /// Moves the objects by one step.
    ///
    /// # Errors
    /// If the world rejects a change.
    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError>;

    /// Evaluates the world after an update, for instance by counting events or by queries. It is
    /// called after each update of the world; the default does nothing.
    ///
    /// # Errors
    /// If the world rejects a query.
    fn updated(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let _ = (world, panel);
        Ok(())
    }

    /// Moves an object to the position to which the user drags it.
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

    /// Draws the elements that the sample adds to its objects, such as rays, paths and distances.
    fn draw(&self, world: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        let _ = (world, panel, canvas);
    }

    /// Returns the values that are displayed beside the picture.
    fn readouts(&self, world: &World<D>, panel: &Panel) -> Vec<Readout> {
        let _ = (world, panel);
        Vec::new()
    }
}

/// The interface with which samples draw.
pub struct Canvas<'a, const D: usize>
where
    f32: Space<D>,
{
    /// Draws results of queries, and whole worlds.
    pub drawing: &'a mut DebugDrawing<f32, D>,
    /// Receives the lines, points and texts.
    pub renderer: &'a mut dyn DebugRender<f32, D>,
}

impl<const D: usize> Canvas<'_, D>
where
    f32: Space<D>,
{
    /// Draws a line that belongs to a query.
    pub fn line(&mut self, ends: [Point<f32, D>; 2], color: Color) {
        self.renderer.line(ends, color, Drawn::Query);
    }

    /// Draws a line from each point to the next.
    pub fn path(&mut self, points: &[Point<f32, D>], color: Color) {
        for ends in points.windows(2) {
            self.line([ends[0], ends[1]], color);
        }
    }

    /// Draws a point that a query found.
    pub fn point(&mut self, at: &Point<f32, D>, size: f32, color: Color) {
        self.renderer.point(at, size, color, Drawn::QueryHit);
    }

    /// Draws a text beside a point.
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

/// A labelled number or word that is displayed beside the picture.
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
    /// The text before the value.
    pub label: &'static str,
    /// The value as text.
    pub value: String,
}

impl Readout {
    /// Creates a readout with any value that can be formatted.
    #[must_use]
    pub fn new(label: &'static str, value: impl fmt::Display) -> Self {
        Self { label, value: value.to_string() }
    }

    /// Creates a readout of a number with four digits after the point. Magnitudes below 0.001 or
    /// from 1e5 on, except 0, have four significant digits and an exponent.
    #[must_use]
    pub fn number(label: &'static str, value: f32) -> Self {
        let is_hidden = value != 0.0 && !(0.001..1.0e5).contains(&value.abs());
        Self::new(label, if is_hidden { format!("{value:.3e}") } else { format!("{value:.4}") })
    }

    /// Creates a readout of a number; `none` if there is no number.
    #[must_use]
    pub fn optional(label: &'static str, value: Option<f32>) -> Self {
        value.map_or_else(|| Self::new(label, "none"), |value| Self::number(label, value))
    }
}
