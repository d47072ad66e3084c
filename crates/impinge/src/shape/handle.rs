//! Shapes shared by many objects.

use std::ops::Deref;
use std::sync::Arc;

use super::Shape;
use crate::math::Real;

/// A counted reference to an immutable shape; cloning it is cheap and shares the shape.
#[derive(Clone, Debug)]
pub struct ShapeHandle<N: Real, const D: usize>(Arc<dyn Shape<N, D>>);

impl<N: Real, const D: usize> ShapeHandle<N, D> {
    /// Takes a shape into shared ownership.
    pub fn new<S: Shape<N, D>>(shape: S) -> Self {
        Self(Arc::new(shape))
    }

    /// Shares a shape that is already counted.
    pub fn from_arc(shape: Arc<dyn Shape<N, D>>) -> Self {
        Self(shape)
    }

    /// The two handles share one shape.
    #[must_use]
    pub fn is_same(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl<N: Real, const D: usize> Deref for ShapeHandle<N, D> {
    type Target = dyn Shape<N, D>;

    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl<N: Real, const D: usize> AsRef<dyn Shape<N, D>> for ShapeHandle<N, D> {
    fn as_ref(&self) -> &dyn Shape<N, D> {
        &*self.0
    }
}
