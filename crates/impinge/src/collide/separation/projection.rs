//! Projection of a point onto a solid. The separation of a ball follows from the projection of its
//! centre.
//!
//! ```text
//!         point  *        distance > 0: outside; < 0: inside, minus the depth
//!                |        outward: unit, along which the distance is measured
//!      .---------+-----.  `point` of the projection: on the surface
//!      |  solid        |  projected point = projection.point + outward * distance
//! ```

use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Vector, unit};

pub(super) use crate::math::perpendicular_to;

/// The projection of a point onto a solid, in the frame of the solid: nearest point of the surface,
/// signed distance and direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Projection<N: Real, const D: usize> {
    /// Signed distance of the point from the surface: positive outside, negative inside.
    pub(crate) distance: N,
    /// Unit vector out of the solid along which `distance` is measured.
    pub(crate) outward: Vector<N, D>,
    /// Point of the surface nearest to the projected point.
    pub(crate) point: Point<N, D>,
}

impl<N: Real, const D: usize> Projection<N, D> {
    /// Returns the separation of a ball from the solid; `None` if the distance exceeds `limit`.
    /// `self` must be the projection of the ball's centre, which is the origin of the first frame;
    /// the pose of the solid in that frame is `pose12`.
    pub(super) fn of_ball(
        &self,
        radius: N,
        pose12: &Pose<N, D>,
        limit: N,
    ) -> Option<Separation<N, D>> {
        let distance = self.distance - radius;
        let normal = -pose12.vector(&self.outward);
        let point1 = Point::from(normal * radius);
        let point2 = pose12.point(&self.point);
        (distance <= limit).then_some(Separation { distance, normal, point1, point2 })
    }
}

/// Returns the length that counts as rounding error for points at most `reach` from the origin.
pub(super) fn rounding_error<N: Real>(reach: N) -> N {
    N::lit(8.0) * N::EPSILON * reach
}

/// Returns the origin of the first frame, which is the centre of a ball, in the frame of the second
/// solid.
pub(super) fn center_in_second<N: Real, const D: usize>(pose12: &Pose<N, D>) -> Point<N, D> {
    pose12.inverse_point(&Point::origin())
}

/// Returns the first coordinate axis, which serves as normal in degenerate cases.
pub(super) fn first_axis<N: Real, const D: usize>() -> Vector<N, D> {
    let mut axis = Vector::<N, D>::zeros();
    axis[0] = N::ONE;
    axis
}

/// Returns the unit vector along the part of `v` perpendicular to the unit vector `d`; `None` if
/// `v` is zero, or if that part is at most 16 epsilons of the length of `v`.
///
/// It subtracts the component along `d` twice: the first remainder may be small and so inexact
/// (Kahan: twice is enough).
pub(super) fn made_perpendicular<N: Real, const D: usize>(
    v: &Vector<N, D>,
    d: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let (v, _) = unit(v)?;
    let (once, remainder) = unit(&(v - d * v.dot(d)))?;
    let (twice, _) = unit(&(once - d * once.dot(d)))?;
    (remainder > N::lit(16.0) * N::EPSILON).then_some(twice)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perpendicular_vectors() {
        let d = Vector::<f64, 3>::new(0.6, 0.0, 0.8);
        assert_eq!(perpendicular_to(&d), Vector::<f64, 3>::new(0.0, 1.0, 0.0), "the idle axis");
        let flat = Vector::<f64, 2>::new(0.0, -1.0);
        assert_eq!(perpendicular_to(&flat), Vector::<f64, 2>::new(1.0, 0.0), "in 2D");
        let v = made_perpendicular(&Vector::<f64, 3>::new(5.0, 1e-6, 0.0), &first_axis());
        assert_eq!(v, Some(Vector::<f64, 3>::new(0.0, 1.0, 0.0)), "the small part survives");
        assert_eq!(made_perpendicular(&first_axis::<f64, 3>(), &first_axis()), None, "parallel");
    }
}
