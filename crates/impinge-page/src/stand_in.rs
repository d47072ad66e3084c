//! Stand-ins for code of the recorded program: its pair filters and its own shape types.

use impinge::math::Space;
use impinge::shape::{Ball, ShapeHandle};
use impinge_record::{Problem, ReadError, Registry};

use crate::space::Viewed;

/// The maximum number of stand-ins of a recording; the recording is read again for each of them.
const MAX_STAND_INS: usize = 64;

/// A registry, and the names of its filters and shapes that are stand-ins.
#[derive(Clone, Debug)]
pub(crate) struct StandIns<N: Space<D>, const D: usize> {
    pub(crate) registry: Registry<N, D, Vec<u8>>,
    pub(crate) filters: Vec<String>,
    pub(crate) shapes: Vec<String>,
}

impl<N: Viewed<D>, const D: usize> StandIns<N, D> {
    pub(crate) const fn of(registry: Registry<N, D, Vec<u8>>) -> Self {
        Self { registry, filters: Vec::new(), shapes: Vec::new() }
    }

    /// Adds a stand-in for the missing name in an error. Returns `false` if the error is not about
    /// a missing name, or if there are too many stand-ins.
    pub(crate) fn add_for(&mut self, error: &ReadError) -> bool {
        if self.filters.len() + self.shapes.len() >= MAX_STAND_INS {
            return false;
        }
        let registry = self.registry.clone();
        match &error.problem {
            Problem::UnknownFilter(name) => {
                self.registry = N::with_open_filter(registry, name);
                self.filters.push(name.clone());
            }
            Problem::UnknownShape(name) => {
                let ball = ShapeHandle::new(Ball::new(N::HALF));
                self.registry = registry.with_shape(name, ball);
                self.shapes.push(name.clone());
            }
            _ => return false,
        }
        true
    }

    /// Returns a sentence about each stand-in, to be shown on the page.
    pub(crate) fn notes(&self) -> impl Iterator<Item = String> {
        let filters = self.filters.iter().map(|name| {
            format!("The pair filter {name} is code of the program that was recorded; here it lets all pairs through.")
        });
        let shapes = self.shapes.iter().map(|name| {
            format!("The shape {name} is code of the program that was recorded; here it is a ball of radius 0.5.")
        });
        filters.chain(shapes)
    }
}
