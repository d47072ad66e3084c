//! Half-lines.

use crate::math::{Point, Pose, Real, Vector};

/// A half-line: the points `origin + t · dir` for `t ≥ 0`.
///
/// `dir` need not be a unit vector; times are in units of its length. A zero `dir` makes the ray a
/// point.
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
    /// Creates the ray from `origin` along `dir`.
    pub const fn new(origin: Point<N, D>, dir: Vector<N, D>) -> Self {
        Self { origin, dir }
    }

    /// Returns the point at time `t`.
    pub fn point_at(&self, t: N) -> Point<N, D> {
        self.origin + self.dir * t
    }

    /// Returns the ray in the local frame of a solid at `pose`; times stay equal.
    #[must_use]
    pub fn inverse_transformed_by(&self, pose: &Pose<N, D>) -> Self {
        Self::new(pose.inverse_point(&self.origin), pose.inverse_vector(&self.dir))
    }

    /// Returns the ray, given in the local frame of a solid at `pose`, in the outer frame; times
    /// stay equal.
    #[must_use]
    pub fn transformed_by(&self, pose: &Pose<N, D>) -> Self {
        Self::new(pose.point(&self.origin), pose.vector(&self.dir))
    }
}
