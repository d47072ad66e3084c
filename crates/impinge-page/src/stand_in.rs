//! What stands for code of the program that was recorded: its pair filters and its own shapes.

use impinge::math::Space;
use impinge::shape::{Ball, ShapeHandle};
use impinge_record::{Problem, ReadError, Registry};

use crate::space::Viewed;

/// So many names of a recording are stood in for; each costs opening it again.
const MAX_STAND_INS: usize = 64;

/// A registry, and the names for which something stands in.
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

    /// Lets something stand in for a name that the registry lacks.
    ///
    /// # Errors
    /// The error itself, if it is another one or there are too many names.
    pub(crate) fn resolve(&mut self, error: ReadError) -> Result<(), ReadError> {
        if self.filters.len() + self.shapes.len() >= MAX_STAND_INS {
            return Err(error);
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
            _ => return Err(error),
        }
        Ok(())
    }

    /// What people should know of it.
    pub(crate) fn notes(&self) -> Vec<String> {
        let filters = self.filters.iter().map(|name| {
            format!("The pair filter {name} is code of the program that was recorded; here it lets all pairs through.")
        });
        let shapes = self.shapes.iter().map(|name| {
            format!("The shape {name} is code of the program that was recorded; here it is a ball of radius 0.5.")
        });
        filters.chain(shapes).collect()
    }
}
