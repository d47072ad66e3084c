//! Sets the distance to exactly zero if a corner of one solid coincides with a corner of the other
//! solid or lies on a side of the other solid, where rounding would leave a small distance.
//!
//! Users build from shared corners: triangles of a mesh, polygons of a map, tetrahedra. The height
//! of a corner over a side that ends there is computed from the other end of the side, so it may be
//! a rounding error above zero. If the distance is no more than such an error, the corners are
//! compared bit for bit, in the frame of the first solid. The exact sign of an area decides whether
//! a corner lies on a side.

use smallvec::SmallVec;

use crate::collide::Pair;
use crate::convex::Separation;
use crate::math::{Mapped, Point, Real, exact, filled, max, max_component, min};
use crate::shape::{Geometry, Kind, SupportMap};

/// Distances up to this may be rounding errors, in epsilons of the sum of both sizes and the
/// distance of the origins.
const ROUNDING: f64 = 64.0;

/// Returns `found`, but with distance zero if its distance is positive, may be a rounding error,
/// and a corner of one solid coincides with a corner of the other solid or lies on the segment
/// between two of them. For two boxes it returns `found` unchanged, because their distance is a
/// difference of their dimensions.
#[inline]
pub(in crate::collide::separation) fn with_shared_corner<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    found: Separation<N, D>,
) -> Separation<N, D> {
    let are_boxes = matches!((pair.first, pair.second), (Kind::Cuboid(_), Kind::Cuboid(_)));
    let is_apart = found.distance > N::ZERO && !are_boxes;
    if is_apart && found.distance <= rounding(pair) { at_corner(pair, found) } else { found }
}

/// Returns the largest distance of a pair that may be a rounding error: [`ROUNDING`] in units of
/// length.
pub(super) fn rounding<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> N {
    let [reach1, reach2] = [pair.first, pair.second]
        .mapped(|kind| Geometry(kind).as_support_map().map_or(N::ZERO, SupportMap::reach));
    let size = reach1 + reach2 + max_component(&pair.pose12.translation);
    N::lit(ROUNDING) * N::EPSILON * size
}

/// Compares the corners of both solids that are extreme along the normal, up to rounding. If such a
/// corner of one solid coincides with such a corner of the other solid, or lies on the segment
/// between two of these, returns `found` with distance zero and both points at this corner.
/// Otherwise returns `found` unchanged.
#[cold]
fn at_corner<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    found: Separation<N, D>,
) -> Separation<N, D> {
    let tolerance = rounding(pair);
    let facing = |kind: &Kind<'_, N, D>, is_second: bool| {
        let in_first_frame = |corner: &Point<N, D>| {
            if is_second { pair.pose12.point(corner) } else { *corner }
        };
        let height = |corner: &Point<N, D>| {
            let along = found.normal.dot(&corner.coords);
            if is_second { -along } else { along }
        };
        let mut highest = -N::INFINITY;
        each_corner(kind, &mut |corner| highest = max(highest, height(&in_first_frame(corner))));
        let mut corners = SmallVec::<[Point<N, D>; 8]>::new();
        each_corner(kind, &mut |corner| {
            let corner = in_first_frame(corner);
            if height(&corner) >= highest - tolerance {
                corners.push(corner);
            }
        });
        corners
    };
    let (corners1, corners2) = (facing(&pair.first, false), facing(&pair.second, true));
    let touching1 = corners1.iter().find(|corner| lies_among(corner, &corners2));
    match touching1.or_else(|| corners2.iter().find(|corner| lies_among(corner, &corners1))) {
        Some(&corner) => {
            Separation { distance: N::ZERO, normal: found.normal, point1: corner, point2: corner }
        }
        None => found,
    }
}

/// Returns whether a point is one of `corners`, or lies exactly between two of them.
fn lies_among<N: Real, const D: usize>(point: &Point<N, D>, corners: &[Point<N, D>]) -> bool {
    let mut pairs = corners
        .iter()
        .enumerate()
        .flat_map(|(at, a)| corners[at + 1..].iter().map(move |b| (a, b)));
    corners.contains(point) || pairs.any(|(a, b)| is_between(point, a, b))
}

/// Returns whether a point lies exactly on the segment from `a` to `b`: it is in the segment's box,
/// and the triangle of the three points has no area in any projection along an axis.
fn is_between<N: Real, const D: usize>(
    point: &Point<N, D>,
    a: &Point<N, D>,
    b: &Point<N, D>,
) -> bool {
    let is_within = |axis: usize| {
        let (low, high) = (min(a[axis], b[axis]), max(a[axis], b[axis]));
        low <= point[axis] && point[axis] <= high
    };
    let is_collinear = |one: usize, other: usize| {
        let project = |p: &Point<N, D>| Point::<f64, 2>::new(p[one].as_f64(), p[other].as_f64());
        exact::area(&project(a), &project(b), &project(point)) == 0.0
    };
    (0..D).all(is_within) && (0..D).all(|one| (one + 1..D).all(|other| is_collinear(one, other)))
}

/// Calls `visit` with each corner of a flat-sided solid, in its own frame; does nothing for other
/// solids.
fn each_corner<N: Real, const D: usize>(
    kind: &Kind<'_, N, D>,
    visit: &mut dyn FnMut(&Point<N, D>),
) {
    match kind {
        Kind::Segment(segment) => [segment.a(), segment.b()].into_iter().for_each(visit),
        Kind::Triangle(triangle) => triangle.corners().iter().for_each(visit),
        Kind::Polytope(polytope) => polytope.vertices().iter().for_each(visit),
        Kind::Cuboid(cuboid) => {
            let half = cuboid.half_extents();
            for signs in 0..1_u32 << D {
                let corner =
                    filled(|axis| if signs >> axis & 1 == 0 { -half[axis] } else { half[axis] });
                visit(&Point::<N, D>::from(corner));
            }
        }
        _ => (),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_lie_on_segments_exactly() {
        let p = |x: f64, y: f64, z: f64| Point::<f64, 3>::new(x, y, z);
        let (a, b) = (p(0.0, 0.0, 0.0), p(6.0, 9.0, 3.0));
        assert!(is_between(&p(2.0, 3.0, 1.0), &a, &b) && is_between(&p(4.0, 6.0, 2.0), &b, &a));
        assert!(!is_between(&p(2.0, 3.0, 1.0 + f64::EPSILON), &a, &b), "beside it by one bit");
        assert!(!is_between(&p(8.0, 12.0, 4.0), &a, &b), "beyond its end");
        assert!(is_between(&a, &a, &a) && !is_between(&b, &a, &a), "a segment without length");
        assert!(lies_among(&b, &[b]) && !lies_among(&p(2.0, 3.0, 1.0), &[b]), "one corner");
    }
}
