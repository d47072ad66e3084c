//! Bounding volumes of placed shapes, under the names that users type.

use super::Shape;
use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{AbstractRotation, Isometry, Pose, Real};

/// The smallest axis-aligned box around a shape placed at `m`, up to rounding; unbounded for a
/// half-space, but on the side on which an axis-aligned one ends.
///
/// ```
/// use impinge::dim2::bounding_volume::aabb;
/// use impinge::dim2::na::{Isometry2, Point2};
/// use impinge::dim2::shape::Ball;
///
/// let volume = aabb(&Ball::new(0.5), &Isometry2::translation(3.0, 0.0));
/// assert_eq!((*volume.mins(), *volume.maxs()), (Point2::new(2.5, -0.5), Point2::new(3.5, 0.5)));
/// ```
#[must_use]
pub fn aabb<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    m: &Isometry<N, R, D>,
) -> Aabb<N, D> {
    shape.aabb(&Pose::from_isometry(m))
}

/// A sphere around a shape placed at `m`: the same at every turn of the shape, so not always the
/// smallest; unbounded for a half-space.
#[must_use]
pub fn bounding_sphere<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    m: &Isometry<N, R, D>,
) -> BoundingSphere<N, D> {
    shape.local_bounding_sphere().transformed_by(&Pose::from_isometry(m))
}
