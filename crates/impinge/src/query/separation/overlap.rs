//! Whether two solids overlap, without asking how deep.

use super::flat_core::FlatCore;
use crate::convex::{self, Simplicial};
use crate::math::Real;
use crate::query::Pair;
use crate::shape::{Geometry, Kind};

/// See [`least_depth`].
const DEEP: f64 = 1.0 / 8.0;

/// Whether two solids certainly overlap, clearly more than rounding decides: then their distance is zero
/// and need not be known. `false` says nothing. Of rounded solids the cores need not overlap.
///
/// Pays where solids lie deep in one another, and the depth would have to be searched for. Costs a few
/// support points of each solid; where they are apart these are for nothing.
pub(crate) fn certainly_overlap<N: Simplicial<D>, const D: usize>(pair: &Pair<'_, N, D>) -> bool {
    if !is_searched(pair) {
        return false;
    }
    if let (Some(map1), Some(map2)) = (FlatCore::of(pair.first), FlatCore::of(pair.second)) {
        return convex::overlap(&map1, &map2, &pair.pose12, least_depth(pair));
    }
    let (first, second) = (Geometry(pair.first), Geometry(pair.second));
    match (first.as_support_map(), second.as_support_map()) {
        (Some(map1), Some(map2)) => convex::overlap(map1, map2, &pair.pose12, N::ZERO),
        _ => false,
    }
}

/// [`certainly_overlap`] in the plane, where segments, boxes and polygons have their depth sooner.
pub(crate) fn certainly_overlap_in_plane<N: Real>(pair: &Pair<'_, N, 2>) -> bool {
    let is_flat = |kind| FlatCore::of(inner(kind)).is_some();
    let are_flat = is_flat(pair.first) && is_flat(pair.second);
    !are_flat && certainly_overlap(pair)
}

/// The depth, in units of the pair, from which on the search for an overlap pays: separating axes need not
/// search for theirs, and tell as much unless it is deep.
fn least_depth<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> N {
    let has_axes = |kind| matches!(kind, Kind::Triangle(_) | Kind::Cuboid(_) | Kind::Polytope(_));
    let kinds = [pair.first, pair.second];
    if kinds.into_iter().all(has_axes) { N::lit(DEEP) } else { N::ZERO }
}

/// What is rounded; a solid that is not is itself.
fn inner<N: Real, const D: usize>(kind: Kind<'_, N, D>) -> Kind<'_, N, D> {
    if let Kind::Rounded(solid) = kind { inner(solid.inner().0) } else { kind }
}

/// Whether a depth takes longer than the search for an overlap: not where there is a formula, nor between
/// two boxes.
fn is_searched<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> bool {
    let has_formula = |kind| matches!(kind, Kind::Ball(_) | Kind::Plane(_));
    let is_line = |kind| matches!(kind, Kind::Segment(_) | Kind::Capsule(_));
    let is_cuboid = |kind| matches!(kind, Kind::Cuboid(_));
    let kinds = [inner(pair.first), inner(pair.second)];
    let is_simple = kinds.into_iter().any(has_formula)
        || kinds.into_iter().all(is_line)
        || kinds.into_iter().all(is_cuboid);
    !is_simple
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::na::{Quaternion, UnitQuaternion};
    use crate::math::{Point, Pose, Space, Vector};
    use crate::query::separation::separation;
    use crate::shape::{
        Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, Shape, Triangle,
    };

    /// How many of the poses were found to overlap, of how many that do; all of these must do.
    fn found<N: Simplicial<D> + Space<D>, const D: usize>(
        solids: &[Box<dyn Shape<N, D>>],
        poses: &[Pose<N, D>],
    ) -> (usize, usize) {
        let (mut found, mut overlapping) = (0, 0);
        for (first, second) in solids.iter().flat_map(|a| solids.iter().map(move |b| (a, b))) {
            for &pose12 in poses {
                let pair = Pair { first: first.geometry().0, second: second.geometry().0, pose12 };
                let is_deep = separation(&pair, N::INFINITY).expect("finite").distance < N::ZERO;
                let is_found = certainly_overlap(&pair);
                assert!(is_deep || !is_found, "they are apart at {pose12:?}");
                overlapping += usize::from(is_deep && is_searched(&pair));
                found += usize::from(is_found);
            }
        }
        (found, overlapping)
    }

    /// Steps away from where the first stands.
    fn steps<N: Real, const D: usize>(direction: Vector<N, D>, size: f64) -> Vec<Vector<N, D>> {
        (0..24).map(|n| direction * N::lit(size * 0.1 * f64::from(n))).collect()
    }

    fn space<N: Real>(size: f64) {
        let one = N::lit(size);
        let p = |x: f64, y: f64, z: f64| Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z)) * one;
        let corners = [
            p(0.0, -1.0, 0.2),
            p(1.0, 0.0, 0.1),
            p(0.0, 1.0, -0.3),
            p(0.2, 0.1, 1.0),
            p(-1.0, 0.1, 0.0),
        ];
        let half = Vector::<N, 3>::new(one, one * N::HALF, one);
        let solids: [Box<dyn Shape<N, 3>>; 7] = [
            Box::new(ConvexHull::from_points(&corners)),
            Box::new(Cuboid::new(half)),
            Box::new(Cylinder::new(one, one)),
            Box::new(Cone::new(one, one)),
            Box::new(Ellipsoid::new(half)),
            Box::new(Capsule::new(one, one * N::HALF)),
            Box::new(Triangle::new(corners[0], corners[1], corners[3])),
        ];
        let turn = UnitQuaternion::from_quaternion(Quaternion::new(
            N::lit(0.8),
            N::lit(0.1),
            N::lit(-0.3),
            N::lit(0.5),
        ));
        let rotation = turn.to_rotation_matrix().into_inner();
        let directions = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.4, -0.7, 0.6)];
        let poses: Vec<_> = directions
            .into_iter()
            .flat_map(|(x, y, z)| steps(Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z)), size))
            .flat_map(|at| {
                let straight = Pose::from_translation(at);
                [straight, Pose { rotation, ..straight }]
            })
            .collect();
        let (found, overlapping) = found(&solids, &poses);
        assert!(found * 2 > overlapping, "{found} of {overlapping} in space");
    }

    fn plane<N: Real>(size: f64) {
        let one = N::lit(size);
        let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x), N::lit(y)) * one;
        let corners = [p(0.0, -1.0), p(1.0, 0.0), p(0.1, 1.0), p(-0.5, 0.5)];
        let half = Vector::<N, 2>::new(one, one * N::HALF);
        let solids: [Box<dyn Shape<N, 2>>; 5] = [
            Box::new(ConvexPolygon::from_points(&corners)),
            Box::new(Cuboid::new(half)),
            Box::new(Ellipsoid::new(half)),
            Box::new(Capsule::new(one, one * N::HALF)),
            Box::new(Triangle::new(corners[0], corners[1], corners[2])),
        ];
        let poses: Vec<_> = [(1.0, 0.1), (-0.3, 0.8)]
            .into_iter()
            .flat_map(|(x, y)| steps(Vector::<N, 2>::new(N::lit(x), N::lit(y)), size))
            .map(Pose::from_translation)
            .collect();
        let (found, overlapping) = found(&solids, &poses);
        assert!(found * 2 > overlapping, "{found} of {overlapping} in the plane");
    }

    #[test]
    fn what_is_found_to_overlap_does() {
        for size in [1.0, 1e-9, 1e6] {
            space::<f32>(size);
            space::<f64>(size);
            plane::<f32>(size);
            plane::<f64>(size);
        }
    }

    #[test]
    fn nothing_is_known_of_poses_that_are_none() {
        let cone = Cone::new(1.0_f32, 1.0);
        let pose12 = Pose::from_translation(Vector::<f32, 3>::new(f32::NAN, 0.0, 0.0));
        let (first, second) = (cone.geometry().0, cone.geometry().0);
        assert!(!certainly_overlap(&Pair { first, second, pose12 }), "not a number");
    }
}
