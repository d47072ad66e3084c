//! Rays, along which ray casts search for the first hit.

use crate::math::{Point, Pose, Real, Vector};

/// A ray: the points `origin + t · dir` for times `t ≥ 0`.
///
/// `dir` need not be a unit vector: it is the displacement per unit of time. If `dir` is zero, the
/// ray is the point `origin`.
///
/// ```
/// use impinge::dim2::math::{Point, Vector};
/// use impinge::dim2::query::Ray;
///
/// let ray = Ray::new(Point::new(1.0_f32, 0.0), Vector::new(0.0, 2.0));
/// assert_eq!(ray.point_at(1.5), Point::new(1.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Ray<N: Real, const D: usize> {
    /// The start of the ray.
    pub origin: Point<N, D>,
    /// The displacement in one unit of time.
    pub dir: Vector<N, D>,
}

impl<N: Real, const D: usize> Ray<N, D> {
    /// Creates the ray that starts at `origin` and moves by `dir` per unit of time.
    pub const fn new(origin: Point<N, D>, dir: Vector<N, D>) -> Self {
        Self { origin, dir }
    }

    /// Returns the point at time `t`.
    pub fn point_at(&self, t: N) -> Point<N, D> {
        self.origin + self.dir * t
    }

    /// Transforms the ray from the outer frame to the local frame of a solid at `pose`. Times do
    /// not change.
    #[must_use]
    pub fn inverse_transformed_by(&self, pose: &Pose<N, D>) -> Self {
        Self::new(pose.inverse_point(&self.origin), pose.inverse_vector(&self.dir))
    }

    /// Transforms the ray from the local frame of a solid at `pose` to the outer frame. Times do
    /// not change.
    #[must_use]
    pub fn transformed_by(&self, pose: &Pose<N, D>) -> Self {
        Self::new(pose.point(&self.origin), pose.vector(&self.dir))
    }
}
