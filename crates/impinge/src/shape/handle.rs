//! Shapes shared by many objects.

use std::ops::Deref;
use std::sync::Arc;

use crate::math::{Real, Vector};
use crate::shape::{ScaleError, Shape};

/// A reference-counted handle of an immutable shape; a clone is cheap and shares the shape.
///
/// ```
/// use impinge::dim2::shape::{Ball, Cuboid, Shape, ShapeHandle};
///
/// let handle: ShapeHandle<f32> = ShapeHandle::new(Ball::new(1.0));
/// assert!(handle.is_same(&handle.clone()), "shared, not copied");
/// assert_eq!(handle.as_shape::<Ball<f32>>().map(Ball::radius), Some(1.0));
/// assert!(handle.as_shape::<Cuboid<f32>>().is_none());
/// assert_eq!(handle.local_aabb().maxs().x, 1.0, "all that a shape can do");
/// ```
#[derive(Debug)]
pub struct ShapeHandle<N: Real, const D: usize>(Arc<dyn Shape<N, D>>);

impl<N: Real, const D: usize> Clone for ShapeHandle<N, D> {
    fn clone(&self) -> Self {
        Self(Arc::clone(&self.0))
    }

    /// Leaves the reference count unchanged if both handles already share the shape.
    fn clone_from(&mut self, source: &Self) {
        if !self.is_same(source) {
            *self = source.clone();
        }
    }
}

impl<N: Real, const D: usize> ShapeHandle<N, D> {
    /// Moves a shape into a new handle.
    pub fn new<S: Shape<N, D>>(shape: S) -> Self {
        Self(Arc::new(shape))
    }

    /// Returns a handle of a shape that is already in an [`Arc`].
    pub fn from_arc(shape: Arc<dyn Shape<N, D>>) -> Self {
        Self(shape)
    }

    /// Returns the shape scaled along the axes of its frame, about its origin; see
    /// [`Shape::scaled`].
    ///
    /// ```
    /// use impinge::dim2::math::{Vector, Point};
    /// use impinge::dim2::shape::{Capsule, ScaleError, Segment, ShapeHandle};
    ///
    /// let (mirror, wide) = (Vector::new(-1.0_f32, 1.0), Vector::new(2.0, 1.0));
    /// let segment = ShapeHandle::new(Segment::new(Point::origin(), Point::new(3.0, 4.0)));
    /// let mirrored = segment.scaled(&mirror).expect("a segment takes every scale");
    /// assert_eq!(mirrored.local_aabb().mins(), &Point::new(-3.0, 0.0));
    ///
    /// let capsule = ShapeHandle::new(Capsule::new(1.0_f32, 0.5));
    /// assert!(capsule.scaled(&mirror).is_ok());
    /// assert!(matches!(capsule.scaled(&wide), Err(ScaleError::NotSuch { .. })));
    /// ```
    ///
    /// # Errors
    /// If a factor is zero or not finite, if no shape of the library can represent the scaled
    /// solid, or if scaled coordinates are out of range.
    pub fn scaled(&self, scale: &Vector<N, D>) -> Result<Self, ScaleError> {
        self.0.scaled(scale)
    }

    /// Returns whether this is the only handle of the shape.
    #[cfg(feature = "debug_render")]
    pub(crate) fn is_sole(&self) -> bool {
        Arc::strong_count(&self.0) == 1
    }

    /// Returns whether both handles share one shape.
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
