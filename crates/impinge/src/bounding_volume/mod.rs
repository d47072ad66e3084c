//! Simple volumes that enclose shapes: what the broad phase works on.

mod aabb;
mod placed;
mod ray;
mod sphere;

pub use aabb::{Aabb, AabbError};
pub use ray::Ray;
pub use sphere::{BoundingSphere, BoundingSphereError};

use crate::math::Real;

/// A volume that a broad phase can keep in place of an object.
///
/// What is computed from volumes is rounded outwards: [`merged`](Self::merged) holds both to the last bit,
/// [`loosened`](Self::loosened) and [`swept`](Self::swept) hold what they are around. Boxes whose exact corners are
/// numbers of the scalar are exact, but for [`swept`](Self::swept) by a product that is not; spheres are larger by
/// some units in the last place.
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
    /// The points of the space that the volume lies in.
    type Point;
    /// The rays of the space that the volume lies in.
    type Ray;
    /// The velocities of the space that the volume lies in.
    type Vector;

    /// The two volumes have a point in common.
    fn intersects(&self, other: &Self) -> bool;
    /// Every point of `other` is a point of this volume.
    fn contains(&self, other: &Self) -> bool;
    /// The smallest volume of this kind around both.
    #[must_use]
    fn merged(&self, other: &Self) -> Self;
    /// The volume grown by `margin` (zero or more) on every side.
    #[must_use]
    fn loosened(&self, margin: N) -> Self;
    /// The smallest volume of this kind around all places of this one as it moves with `velocity`
    /// (finite) from time zero to `max_time` (zero or more, perhaps infinite).
    #[must_use]
    fn swept(&self, velocity: &Self::Vector, max_time: N) -> Self;
    /// The point lies in the volume.
    fn contains_point(&self, point: &Self::Point) -> bool;
    /// The ray, with times from zero on, meets the volume.
    fn intersects_ray(&self, ray: &Self::Ray) -> bool;
}
