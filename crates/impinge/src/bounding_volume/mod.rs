//! Bounding volumes of shapes: axis-aligned boxes and spheres. Also the rays that queries cast.

mod aabb;
mod placed;
mod ray;
mod sphere;

pub use aabb::{Aabb, AabbError};
pub use ray::Ray;
pub use sphere::{BoundingSphere, BoundingSphereError};

use crate::math::Real;

/// A bounding volume: a simple volume that encloses an object in a broad phase.
///
/// Computed volumes are rounded outwards: [`merged`](Self::merged) contains both volumes exactly,
/// and [`loosened`](Self::loosened) and [`swept`](Self::swept) contain the exact result. Boxes are
/// exact if the exact corners are representable, except the result of [`swept`](Self::swept) if the
/// displacement is rounded. Spheres are larger by some units in the last place.
///
/// All tests are closed: volumes that only touch intersect.
///
/// ```
/// use impinge::dim2::bounding_volume::{Aabb, BoundingVolume};
/// use impinge::dim2::math::{Point, Vector};
///
/// let volume = Aabb::new(Point::new(0.0_f32, 0.0), Point::new(1.0, 1.0));
/// assert!(volume.loosened(0.5).contains_point(&Point::new(-0.5, -0.5)));
/// assert!(volume.swept(&Vector::new(2.0, 0.0), 1.0).contains_point(&Point::new(3.0, 1.0)));
/// ```
pub trait BoundingVolume<N: Real>: Clone {
    /// The type of points in the volume's space.
    type Point;
    /// The type of rays in the volume's space.
    type Ray;
    /// The type of velocities in the volume's space.
    type Vector;

    /// Returns `true` if the two volumes have a common point.
    fn intersects(&self, other: &Self) -> bool;
    /// Returns `true` only if every point of `other` is in this volume. Boxes are compared exactly;
    /// spheres may give `false` if the outer one exceeds the inner one by rounding errors only.
    fn contains(&self, other: &Self) -> bool;
    /// Returns the smallest volume of this type that contains both volumes.
    #[must_use]
    fn merged(&self, other: &Self) -> Self;
    /// Returns the volume grown by `margin` (zero or more) on every side.
    #[must_use]
    fn loosened(&self, margin: N) -> Self;
    /// Returns the smallest volume of this type that contains this volume while it moves with
    /// `velocity` from time zero to `max_time`. The velocity must be finite; `max_time` must be
    /// zero or more, and may be infinite.
    #[must_use]
    fn swept(&self, velocity: &Self::Vector, max_time: N) -> Self;
    /// Returns `true` if the point is in the volume.
    fn contains_point(&self, point: &Self::Point) -> bool;
    /// Returns `true` if the ray meets the volume at a time of zero or more.
    fn intersects_ray(&self, ray: &Self::Ray) -> bool;
}
