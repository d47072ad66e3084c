//! Ball against convex polygon in 2D.

use crate::collide::Pair;
use crate::collide::separation::balls::ball_segment;
use crate::collide::separation::projection::{Projection, center_in_second, rounding_error};
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real};
use crate::shape::{Kind, Polytope, PolytopeFace, SupportMap};

/// Returns the separation of a ball from a convex polygon; `None` above `limit`.
///
/// If the centre is inside the polygon, the ball is pushed out through the nearest side. If it is
/// outside, the nearest point lies on a side that has the centre in front of it. Cost: linear in
/// the number of sides.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 2>,
    limit: N,
) -> Option<Separation<N, 2>> {
    let (Kind::Ball(ball), Kind::Polytope(polygon)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center = center_in_second(&pair.pose12);
    project(polygon, &center).of_ball(ball.radius(), &pair.pose12, limit)
}

/// Projects a point onto a polygon.
pub(in crate::collide::separation) fn project<N: Real>(
    polygon: &Polytope<N, 2>,
    center: &Point<N, 2>,
) -> Projection<N, 2> {
    let (index, distance) = polygon.highest_face(center);
    let highest = &polygon.faces()[index as usize];
    let outward = highest.normal;
    // A NaN distance takes the branch for points inside.
    if distance > N::ZERO {
        return project_from_outside(polygon, center, highest);
    }
    Projection { distance, outward, point: center - outward * distance }
}

/// Projects a point that is outside the polygon; `highest` is the side with the largest height of
/// the point. In most cases the nearest point lies on that side, and the supporting line there
/// proves it.
fn project_from_outside<N: Real>(
    polygon: &Polytope<N, 2>,
    center: &Point<N, 2>,
    highest: &PolytopeFace<N, 2>,
) -> Projection<N, 2> {
    let rounding_error = rounding_error(polygon.reach() + center.coords.norm());
    let certain = |projected: &Projection<N, 2>| {
        projected.outward.dot(&(center - polygon.core_support(&projected.outward)))
    };
    let mut best = project_on_side(polygon, highest, center);
    let is_over_side = best.outward == highest.normal;
    if is_over_side || certain(&best) + rounding_error / N::lit(4.0) >= best.distance {
        return best;
    }
    for side in polygon.faces().iter().filter(|side| side.height_of(center) > N::ZERO) {
        let projected = project_on_side(polygon, side, center);
        if projected.distance < best.distance {
            best = projected;
        }
    }
    // Close to a corner the offset is mostly rounding error. The normal of the highest side
    // replaces it if the height along this normal is larger by more than rounding.
    if certain(&best) + rounding_error < highest.height_of(center) {
        best.outward = highest.normal;
    }
    best
}

/// Projects a point that is in front of a side onto this side.
fn project_on_side<N: Real>(
    polygon: &Polytope<N, 2>,
    side: &PolytopeFace<N, 2>,
    center: &Point<N, 2>,
) -> Projection<N, 2> {
    let around = polygon.face_vertices(side);
    let ends = [around[0], around[1]].map(|vertex| polygon.vertices()[vertex as usize]);
    let along = ends[1] - ends[0];
    if (center - ends[0]).dot(&along) <= N::ZERO || (ends[1] - center).dot(&along) <= N::ZERO {
        return ball_segment::project(&ends, center);
    }
    let distance = side.height_of(center);
    Projection { distance, outward: side.normal, point: center - side.normal * distance }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::ConvexPolygon;

    #[test]
    fn over_a_side_a_corner_and_inside() {
        let p = Point::<f64, 2>::new;
        let corners = [p(0.0, 0.0), p(4.0, 0.0), p(4.0, 2.0), p(0.0, 2.0)];
        let polygon = ConvexPolygon::new(&corners);
        let below = project(&polygon, &p(1.0, -3.0));
        assert_eq!((below.distance, below.point), (3.0, p(1.0, 0.0)), "below the base");
        let corner = project(&polygon, &p(7.0, 6.0));
        assert_eq!((corner.distance, corner.point), (5.0, p(4.0, 2.0)), "beyond a corner");
        assert_eq!((corner.outward.x, corner.outward.y), (0.6, 0.8), "away from the corner");
        let inside = project(&polygon, &p(3.5, 1.0));
        assert_eq!((inside.distance, inside.point), (-0.5, p(4.0, 1.0)), "out to the right");
    }

    #[test]
    fn a_corner_that_the_highest_side_does_not_end_at() {
        let p = Point::<f64, 2>::new;
        // For some of the points the long slope is the side with the largest height, but neither of
        // its ends is the nearest corner.
        let corners = [p(0.0, 0.0), p(10.0, 0.0), p(0.5, 1.0), p(0.0, 1.0)];
        let polygon = ConvexPolygon::new(&corners);
        for step in -20_i32..60 {
            for rise in [1.0, 1.5, 4.0] {
                let center = p(f64::from(step) / 4.0, rise);
                let found = project(&polygon, &center);
                let by_hand = (0..4)
                    .map(|at| ball_segment::project(&[corners[at], corners[(at + 1) % 4]], &center))
                    .fold(f64::INFINITY, |least, projected| least.min(projected.distance));
                assert!((found.distance.abs() - by_hand).abs() < 1e-14, "from {center}");
            }
        }
    }
}
