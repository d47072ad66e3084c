//! Ball against cone. In the half-plane through the axis and the ball's centre, the cone is a
//! triangle.
//!
//! ```text
//!    y |\ apex (0, h)             one half of the axial section: `x` from the axis, `y` up
//!      | \     slant: unit normal of the side
//!      |__\ rim (r, -h)
//! ```

use super::ball_cylinder::HalfPlane;
use crate::collide::Pair;
use crate::collide::separation::projection::{Projection, center_in_second, rounding_error};
use crate::collide::separation::segments::nearest::nearest_on_segment;
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, max, unit};
use crate::shape::{Cone, Kind};

/// Returns the separation of a ball from a cone; `None` above `limit`.
///
/// If the centre is inside the cone, the ball is pushed out through the nearer of base and side; in
/// a tie, through the base. A centre on the axis that is nearer to the side is pushed towards
/// positive x.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let (Kind::Ball(ball), Kind::Cone(cone, _)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(cone, &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// Half of the cone's axial section: `x` is the distance from the axis, `y` the height.
struct Section<N: Real> {
    /// Corners of the section: the apex and the rim.
    apex: Vector<N, 2>,
    rim: Vector<N, 2>,
    /// Unit normal of the slanted side; the x axis for a cone of no size.
    slant: Vector<N, 2>,
}

impl<N: Real> Section<N> {
    fn of(cone: &Cone<N>) -> Self {
        let (h, r) = (cone.half_height(), cone.radius());
        let slant = unit(&Vector::<N, 2>::new(N::TWO * h, r));
        Self {
            apex: Vector::<N, 2>::new(N::ZERO, h),
            rim: Vector::<N, 2>::new(r, -h),
            slant: slant.map_or_else(Vector::<N, 2>::x, |(slant, _)| slant),
        }
    }

    /// Returns the height of `p` above the section along `outward`, which must not point towards
    /// the axis.
    fn height(&self, outward: &Vector<N, 2>, p: &Vector<N, 2>) -> N {
        outward.dot(p) - max(outward.dot(&self.apex), outward.dot(&self.rim))
    }

    /// Returns the largest height of `p` above a side, and the normal of that side.
    ///
    /// The directions +x and +y are also tried, after the sides. They are needed for a cone without
    /// height (a disk) or without radius (a segment): there, no normal of a side points from the
    /// rim or the apex to the points beyond it.
    fn highest(&self, p: &Vector<N, 2>) -> (N, Vector<N, 2>) {
        let (x, y) = (Vector::<N, 2>::x(), Vector::<N, 2>::y());
        let mut best = (self.height(&-y, p), -y);
        for outward in [self.slant, x, y] {
            let height = self.height(&outward, p);
            if height > best.0 {
                best = (height, outward);
            }
        }
        best
    }

    /// Returns the point of the base or the slanted side nearest to `p`; the base wins a tie.
    fn nearest(&self, p: &Vector<N, 2>) -> Vector<N, 2> {
        let p = Point::from(*p);
        let (rim, apex) = (Point::from(self.rim), Point::from(self.apex));
        let middle = Point::<N, 2>::new(N::ZERO, self.rim.y);
        let base = nearest_on_segment(&[middle, rim], &p).0;
        let side = nearest_on_segment(&[rim, apex], &p).0;
        let base_wins = (p - base).norm_squared() <= (p - side).norm_squared();
        if base_wins { base.coords } else { side.coords }
    }
}

/// Projects a point onto a cone.
pub(in crate::collide::separation) fn project<N: Real>(
    cone: &Cone<N>,
    center: &Point<N, 3>,
) -> Projection<N, 3> {
    let (section, plane) = (Section::of(cone), HalfPlane::of(center));
    let p = plane.point;
    let (flat, outward) = section.highest(&p);
    if flat > N::ZERO {
        let point = section.nearest(&p);
        let (offset, distance) = unit(&(p - point)).unwrap_or((outward, flat));
        // Close to the surface the offset is mostly rounding error. It is used only if the height
        // along it is at least that along the best side normal, up to rounding.
        let rounding_error = rounding_error(section.rim.norm() + p.norm());
        let certain = offset.x >= N::ZERO && section.height(&offset, &p) + rounding_error >= flat;
        let outward = if certain { offset } else { outward };
        return plane.projection(distance, &outward, &point);
    }
    plane.projection(flat, &outward, &(p - outward * flat))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn apex_side_base_and_inside() {
        // The normal of the side is (4, 3) / 5.
        let cone = Cone::new(2.0_f64, 3.0);
        let p = Point::<f64, 3>::new;
        let apex = project(&cone, &p(0.0, 7.0, 0.0));
        assert_eq!((apex.distance, apex.outward.y), (5.0, 1.0), "above the apex");
        let base = project(&cone, &p(0.0, -3.0, 1.0));
        assert_eq!((base.distance, base.outward.y), (1.0, -1.0), "below the base");
        let rim = project(&cone, &p(0.0, -6.0, -6.0));
        assert_eq!((rim.distance, rim.point), (5.0, p(0.0, -2.0, -3.0)), "3 out and 4 down");
        let side = project(&cone, &p(1.5 + 4.0, 3.0, 0.0));
        assert!((side.distance - 5.0).abs() < 1e-14, "5 away from the middle of the slant");
        assert!((side.outward - Vector::<f64, 3>::new(0.8, 0.6, 0.0)).norm() < 1e-15, "its normal");
        let inside = project(&cone, &p(0.0, -1.5, 0.0));
        assert_eq!((inside.distance, inside.outward.y), (-0.5, -1.0), "out through the base");
    }
}
