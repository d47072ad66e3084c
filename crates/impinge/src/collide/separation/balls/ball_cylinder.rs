//! Ball against cylinder. In the half-plane through the axis and the ball's centre, the cylinder is
//! a rectangle.

use crate::collide::Pair;
use crate::collide::separation::projection::{Projection, center_in_second};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, max, min, unit};
use crate::shape::{Cylinder, Kind};

/// Returns the separation of a ball from a cylinder; `None` above `limit`.
///
/// If the centre is inside the cylinder, the ball is pushed out through the side or a cap,
/// whichever is nearest. In a tie, caps come before the side, and the upper cap before the lower. A
/// centre on the axis that is nearest to the side is pushed towards positive x.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let (Kind::Ball(ball), Kind::Cylinder(cylinder, _)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(cylinder, &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// A point in cylindrical coordinates: distance from the y axis, height, and the unit vector away
/// from the axis, which is the x axis for points on the y axis.
pub(in crate::collide::separation) struct HalfPlane<N: Real> {
    /// `x` is the distance from the axis, `y` the height.
    pub(in crate::collide::separation) point: Vector<N, 2>,
    /// Unit vector away from the axis, as (x, z).
    away: Vector<N, 2>,
}

impl<N: Real> HalfPlane<N> {
    pub(in crate::collide::separation) fn of(point: &Point<N, 3>) -> Self {
        let fallback = (Vector::<N, 2>::x(), N::ZERO);
        let (away, radial) = unit(&Vector::<N, 2>::new(point.x, point.z)).unwrap_or(fallback);
        Self { point: Vector::<N, 2>::new(radial, point.y), away }
    }

    /// Maps a vector of the half-plane to 3D.
    pub(in crate::collide::separation) fn lift(&self, v: &Vector<N, 2>) -> Vector<N, 3> {
        Vector::<N, 3>::new(self.away.x * v.x, v.y, self.away.y * v.x)
    }

    /// Maps a projection found in the half-plane to 3D.
    pub(in crate::collide::separation) fn projection(
        &self,
        distance: N,
        outward: &Vector<N, 2>,
        point: &Vector<N, 2>,
    ) -> Projection<N, 3> {
        let point = Point::from(self.lift(point));
        Projection { distance, outward: self.lift(outward), point }
    }
}

/// Projects a point onto a cylinder.
#[inline]
pub(in crate::collide::separation) fn project<N: Real>(
    cylinder: &Cylinder<N>,
    center: &Point<N, 3>,
) -> Projection<N, 3> {
    let (h, r) = (cylinder.half_height(), cylinder.radius());
    let plane = HalfPlane::of(center);
    let p = plane.point;
    let clamped = Vector::<N, 2>::new(min(p.x, r), max(min(p.y, h), -h));
    if let Some((outward, distance)) = unit(&(p - clamped)) {
        return plane.projection(distance, &outward, &clamped);
    }
    let (beyond_side, beyond_cap) = (p.x - r, p.y.abs() - h);
    if beyond_side > beyond_cap {
        let rim = Vector::<N, 2>::new(r, p.y);
        return plane.projection(beyond_side, &Vector::<N, 2>::x(), &rim);
    }
    let sign = if p.y < N::ZERO { -N::ONE } else { N::ONE };
    let outward = Vector::<N, 2>::new(N::ZERO, sign);
    plane.projection(beyond_cap, &outward, &Vector::<N, 2>::new(p.x, sign * h))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cap_side_rim_and_axis() {
        let cylinder = Cylinder::new(2.0_f64, 3.0);
        let p = Point::<f64, 3>::new;
        let cap = project(&cylinder, &p(1.0, -5.0, 0.0));
        assert_eq!((cap.distance, cap.outward.y), (3.0, -1.0), "below the lower cap");
        let rim = project(&cylinder, &p(0.0, 6.0, -6.0));
        assert_eq!((rim.distance, rim.point), (5.0, p(0.0, 2.0, -3.0)), "3 out and 4 up");
        let side = project(&cylinder, &p(0.0, 0.0, 2.5));
        assert_eq!((side.distance, side.outward.z), (-0.5, 1.0), "inside, near the side");
        let thin = project(&Cylinder::new(2.0_f64, 0.5), &p(0.0, 0.0, 0.0));
        assert_eq!((thin.distance, thin.outward.x), (-0.5, 1.0), "from the axis to positive x");
        let disk = project(&Cylinder::new(0.0_f64, 3.0), &p(1.0, 0.0, 0.0));
        assert_eq!((disk.distance, disk.outward.y), (0.0, 1.0), "a disk has two caps");
    }
}
