//! Computes the distance of two solids for callers that do not need the depth of an overlap.
//!
//! If the solids are apart, this distance is bit-identical to the distance of their separation.

use super::balls::{
    ball_ball, ball_cone, ball_cuboid, ball_cylinder, ball_polygon, ball_polytope, ball_segment,
    ball_triangle, ball_triangle2,
};
use super::flat_core::FlatCore;
use super::inner_ball::inner_balls_meet;
use super::projection::center_in_second;
use super::segments::segment_segment;
use super::{apart, general, plane_any, revolved};
use crate::collide::Pair;
use crate::convex::{self, Simplicial};
use crate::math::{Point, Real, Space};
use crate::shape::{Geometry, Kind};

/// Smallest depth along the line of the centres, in units of the pair, at which pairs of
/// [`DistanceMethod::Axes`] are searched for a proof of overlap. For smaller depths, separating
/// axes are as fast.
const DEEP: f64 = 1.0 / 8.0;

/// Method by which the distance of a pair is computed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum DistanceMethod {
    /// By a closed form, which costs no more if it includes the depth.
    Formula,
    /// By closed forms for pairs of features, as for two cylinders; proving an overlap first is
    /// faster than computing the depth.
    Features,
    /// By separating axes; proving an overlap first is faster only for depths of at least [`DEEP`].
    Axes,
    /// By the formulas of `revolved`, with a fallback that computes no depths.
    Revolved,
    /// By the general algorithm.
    Search,
}

/// Returns the signed distance of two solids in 3D; `None` above `limit`.
///
/// If the solids overlap and `limit` is zero or more, the result may be any number that is not
/// positive, so that clear overlaps need not be measured. Otherwise it is bit-identical to the
/// distance of the separation. A pair whose kinds are not in canonical order gets the distance of
/// its separation, unless a closed form exists for it or balls inside the solids prove an overlap.
pub(crate) fn distance_3d<N: Simplicial<3>>(pair: &Pair<'_, N, 3>, limit: N) -> Option<N> {
    if let Some(known) = known_3d(pair) {
        return (known <= limit).then_some(known);
    }
    if limit >= N::ZERO && inner_balls_meet(pair) {
        return Some(N::ZERO);
    }
    if is_distance_only(pair, limit) && are_faceted(pair) {
        return apart::distance(pair, limit);
    }
    let method = method_3d(pair);
    if method == DistanceMethod::Revolved && is_distance_only(pair, limit) && are_bare(pair) {
        return revolved::distance(pair, limit);
    }
    distance(pair, limit, method)
}

/// Returns the signed distance of two solids in 2D; `None` above `limit`. Overlaps are handled as
/// by [`distance_3d`].
pub(crate) fn distance_2d<N: Simplicial<2>>(pair: &Pair<'_, N, 2>, limit: N) -> Option<N> {
    if let Some(known) = known(pair, beside_ball_2d) {
        return (known <= limit).then_some(known);
    }
    if limit >= N::ZERO && inner_balls_meet(pair) {
        return Some(N::ZERO);
    }
    distance(pair, limit, method_2d(pair))
}

/// Returns the signed distance, without a limit, of pairs for which a closed form can compute it
/// without the normal and the points of the separation; `None` for other pairs.
fn known_3d<N: Real>(pair: &Pair<'_, N, 3>) -> Option<N> {
    use Kind::{Capsule, Segment};
    match (pair.first, pair.second) {
        (Segment(_), Segment(_) | Capsule(_)) | (Capsule(_), Capsule(_)) => {
            Some(segment_segment::distance(pair))
        }
        _ => known(pair, beside_ball_3d),
    }
}

/// Returns the signed distance of two balls, of any solid (first) and a half-space (second), or of
/// a ball (first) and another solid (second), for which it calls `beside_ball`. `None` for other
/// pairs, and if `beside_ball` or [`plane_any::distance`] returns `None`.
#[inline(always)]
fn known<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    beside_ball: fn(N, Kind<'_, N, D>, &Point<N, D>) -> Option<N>,
) -> Option<N> {
    match (pair.first, pair.second) {
        (Kind::Ball(ball1), Kind::Ball(ball2)) => {
            let radii = [ball1.radius(), ball2.radius()];
            Some(ball_ball::distance(&pair.pose12.translation, radii))
        }
        (solid, Kind::Plane(plane)) => plane_any::distance(solid, plane, &pair.pose12),
        (Kind::Ball(ball), other) => {
            beside_ball(ball.radius(), other, &center_in_second(&pair.pose12))
        }
        _ => None,
    }
}

/// Returns the signed distance of a ball from a solid in 3D; `center` is in the frame of the solid.
/// Subtracts the radii in the same order as the separation, for identical bits. For triangles and
/// segments it computes no direction, unlike the separation. `None` for kinds without a closed
/// form.
fn beside_ball_3d<N: Real>(radius: N, kind: Kind<'_, N, 3>, center: &Point<N, 3>) -> Option<N> {
    let apart = match kind {
        Kind::Triangle(triangle) => ball_triangle::distance_from(triangle.corners(), center),
        Kind::Polytope(hull) => ball_polytope::project(hull, center).distance,
        Kind::Cylinder(cylinder, _) => ball_cylinder::project(cylinder, center).distance,
        Kind::Cone(cone, _) => ball_cone::project(cone, center).distance,
        Kind::Rounded(solid) => {
            let core = beside_ball_3d(radius, solid.inner().0, center)?;
            return Some(core - solid.radius());
        }
        other => return beside_ball(radius, other, center),
    };
    Some(apart - radius)
}

/// Returns the signed distance of a ball from a solid in 2D, as [`beside_ball_3d`] does in 3D. Also
/// `None` for triangles without area.
fn beside_ball_2d<N: Real>(radius: N, kind: Kind<'_, N, 2>, center: &Point<N, 2>) -> Option<N> {
    let apart = match kind {
        Kind::Triangle(triangle) => ball_triangle2::project(triangle.corners(), center)?.distance,
        Kind::Polytope(polygon) => ball_polygon::project(polygon, center).distance,
        Kind::Rounded(solid) => {
            let core = beside_ball_2d(radius, solid.inner().0, center)?;
            return Some(core - solid.radius());
        }
        other => return beside_ball(radius, other, center),
    };
    Some(apart - radius)
}

/// Returns the signed distance of a ball from a segment, capsule or box, whose formulas do not
/// depend on the dimension; `None` for other kinds.
#[inline]
fn beside_ball<N: Real, const D: usize>(
    radius: N,
    kind: Kind<'_, N, D>,
    center: &Point<N, D>,
) -> Option<N> {
    let apart = match kind {
        Kind::Segment(segment) => ball_segment::distance_from(segment, center),
        Kind::Capsule(capsule) => {
            ball_segment::distance_from(capsule.segment(), center) - capsule.radius()
        }
        Kind::Cuboid(cuboid) => ball_cuboid::project(cuboid.half_extents(), center).distance,
        _ => return None,
    };
    Some(apart - radius)
}

/// Returns the signed distance, computed by `method`; `None` above `limit`. If [`is_distance_only`]
/// returns `true`, all methods but [`DistanceMethod::Formula`] first try to prove an overlap; the
/// result is then zero.
fn distance<N: Simplicial<D> + Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
    method: DistanceMethod,
) -> Option<N> {
    if is_distance_only(pair, limit) {
        if method == DistanceMethod::Search && are_bare(pair) {
            return general::distance(pair, limit);
        }
        if method != DistanceMethod::Formula && certainly_overlap(pair, method) {
            return Some(N::ZERO);
        }
    }
    super::separation(pair, limit).map(|found| found.distance)
}

/// Returns whether the functions that compute no depth may be called: `limit` is zero or more, so
/// that depths are not needed, and the solids are in canonical order.
fn is_distance_only<N: Real, const D: usize>(pair: &Pair<'_, N, D>, limit: N) -> bool {
    limit >= N::ZERO && Geometry(pair.first).kind() <= Geometry(pair.second).kind()
}

/// Returns whether both solids are triangles, boxes or hulls.
const fn are_faceted<N: Real>(pair: &Pair<'_, N, 3>) -> bool {
    apart::is_faceted(&pair.first) && apart::is_faceted(&pair.second)
}

/// Returns whether neither solid is rounded.
fn are_bare<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> bool {
    let is_rounded = |kind| matches!(kind, Kind::Rounded(_));
    !is_rounded(pair.first) && !is_rounded(pair.second)
}

/// Tries to prove that two solids overlap by more than rounding, and returns whether it succeeds.
/// `false` proves nothing; with [`DistanceMethod::Axes`] it is also returned for depths below
/// [`DEEP`]. The radii of capsules and rounded solids count: their cores need not overlap.
///
/// Cost: a few support points of each solid.
fn certainly_overlap<N: Simplicial<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    method: DistanceMethod,
) -> bool {
    let least = if method == DistanceMethod::Axes { N::lit(DEEP) } else { N::ZERO };
    if let (Some(map1), Some(map2)) = (FlatCore::of(pair.first), FlatCore::of(pair.second)) {
        return convex::overlap(&map1, &map2, &pair.pose12, least);
    }
    let (first, second) = (Geometry(pair.first), Geometry(pair.second));
    match (first.as_support_map(), second.as_support_map()) {
        (Some(map1), Some(map2)) => convex::overlap(map1, map2, &pair.pose12, least),
        _ => false,
    }
}

/// Returns the innermost solid of a rounded solid; other solids unchanged.
fn inner<N: Real, const D: usize>(kind: Kind<'_, N, D>) -> Kind<'_, N, D> {
    if let Kind::Rounded(solid) = kind { inner(solid.inner().0) } else { kind }
}

/// Returns the method for two kinds in canonical order in 3D. A rounded solid counts as its
/// innermost solid.
fn method_3d<N: Real>(pair: &Pair<'_, N, 3>) -> DistanceMethod {
    use Kind::{
        Ball, Capsule, Composite, Cone, Cuboid, Cylinder, Plane, Polytope, Segment, Triangle,
    };
    match (inner(pair.first), inner(pair.second)) {
        (Ball(_), _) | (_, Ball(_) | Plane(_) | Composite(_)) | (Plane(_) | Composite(_), _) => {
            DistanceMethod::Formula
        }
        (
            Segment(_) | Capsule(_),
            Segment(_) | Capsule(_) | Triangle(_) | Cuboid(_) | Polytope(_),
        ) => DistanceMethod::Formula,
        (Cuboid(_), Cuboid(_)) => DistanceMethod::Formula,
        (Triangle(_) | Cuboid(_) | Polytope(_), Triangle(_) | Cuboid(_) | Polytope(_)) => {
            DistanceMethod::Axes
        }
        (Cylinder(..), Cylinder(..)) => DistanceMethod::Features,
        (
            Segment(_) | Capsule(_) | Triangle(_) | Cuboid(_) | Polytope(_),
            Cylinder(..) | Cone(..),
        )
        | (Cylinder(..) | Cone(..), Cone(..)) => DistanceMethod::Revolved,
        _ => DistanceMethod::Search,
    }
}

/// Returns the method for two kinds in canonical order in 2D. A rounded solid counts as its
/// innermost solid.
fn method_2d<N: Real>(pair: &Pair<'_, N, 2>) -> DistanceMethod {
    use Kind::{Ball, Composite, Plane};
    let (first, second) = (inner(pair.first), inner(pair.second));
    match (first, second) {
        (Ball(_), _) | (_, Ball(_) | Plane(_) | Composite(_)) | (Plane(_) | Composite(_), _) => {
            DistanceMethod::Formula
        }
        _ if FlatCore::of(first).is_some() && FlatCore::of(second).is_some() => {
            DistanceMethod::Formula
        }
        _ => DistanceMethod::Search,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::separation::hulls::tests::Random;
    use crate::collide::separation::separation;
    use crate::math::na::{Quaternion, UnitQuaternion};
    use crate::math::{Point, Pose, Space, Vector};
    use crate::shape::{
        Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, Plane,
        Rounded, Segment, Shape, Triangle,
    };

    /// Returns the number of cases in which [`certainly_overlap`] proves an overlap, and the number
    /// of all cases with an overlap. A case is a pair of solids at a pose; pairs with
    /// [`DistanceMethod::Formula`] are not counted. Asserts in each case that an overlap is proved
    /// only if there is one, and that `distance` returns the distance of the separation if the
    /// solids are apart, and no positive number otherwise.
    fn found<N: Simplicial<D> + Space<D>, const D: usize>(
        solids: &[Box<dyn Shape<N, D>>],
        poses: &[Pose<N, D>],
        method: fn(&Pair<'_, N, D>) -> DistanceMethod,
    ) -> (usize, usize) {
        let (mut found, mut overlapping) = (0, 0);
        for (first, second) in solids.iter().flat_map(|a| solids.iter().map(move |b| (a, b))) {
            for &pose12 in poses {
                let pair = Pair { first: first.geometry().0, second: second.geometry().0, pose12 };
                let depth = separation(&pair, N::INFINITY).expect("finite").distance;
                let is_deep = depth < N::ZERO;
                let is_searched = method(&pair) != DistanceMethod::Formula;
                let is_found = is_searched && certainly_overlap(&pair, DistanceMethod::Features);
                assert!(is_deep || !is_found, "they are apart at {pose12:?}");
                let known = distance(&pair, N::INFINITY, method(&pair)).expect("finite");
                if depth > N::ZERO {
                    assert_eq!(known, depth, "the same where they are apart at {pose12:?}");
                } else {
                    assert!(known <= N::ZERO, "they touch at {pose12:?}");
                }
                overlapping += usize::from(is_deep && is_searched);
                found += usize::from(is_found);
            }
        }
        (found, overlapping)
    }

    /// Returns 24 multiples of `direction`, from zero in steps of a tenth of `size`.
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
        let (found, overlapping) = found(&solids, &poses, method_3d);
        assert!(found * 2 > overlapping, "{found} of {overlapping} in 3D");
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
        let (found, overlapping) = found(&solids, &poses, method_2d);
        assert!(found * 2 > overlapping, "{found} of {overlapping} in 2D");
    }

    type Solids<N, const D: usize> = [Box<dyn Shape<N, D>>];

    /// Asserts that the distances that `known` returns are bit-identical to the distances of the
    /// separation.
    fn are_parts<N: Space<D>, const D: usize>(
        firsts: &Solids<N, D>,
        seconds: &Solids<N, D>,
        pose_of: impl Fn(&mut Random) -> Pose<N, D>,
        known: impl Fn(&Pair<'_, N, D>) -> Option<N>,
    ) {
        let random = &mut Random(5);
        for _ in 0..400 {
            let pose12 = pose_of(random);
            for (first, second) in firsts.iter().flat_map(|a| seconds.iter().map(move |b| (a, b))) {
                let pair = Pair { first: first.geometry().0, second: second.geometry().0, pose12 };
                let expected = separation(&pair, N::INFINITY).expect("finite").distance;
                let found = known(&pair).expect("a formula");
                assert_eq!(found, expected, "{first:?} and {second:?} at {pose12:?}");
            }
        }
    }

    #[test]
    fn distances_from_balls_and_half_spaces_are_those_of_the_separation() {
        let p = |x: f32, y: f32, z: f32| Point::<f32, 3>::new(x, y, z);
        let corners = [p(0.0, -1.0, 0.2), p(1.0, 0.0, 0.1), p(0.0, 1.0, -0.3), p(0.2, 0.1, 1.0)];
        let half = Vector::<f32, 3>::new(1.0, 0.5, 0.75);
        let solids = || -> Vec<Box<dyn Shape<f32, 3>>> {
            vec![
                Box::new(Segment::new(corners[0], corners[1])),
                Box::new(Capsule::new(0.5, 0.25)),
                Box::new(Triangle::new(corners[0], corners[1], corners[3])),
                Box::new(Cuboid::new(half)),
                Box::new(ConvexHull::from_points(&corners)),
                Box::new(Cylinder::new(0.5, 0.75)),
                Box::new(Cone::new(0.75, 0.5)),
                Box::new(Rounded::new(Rounded::new(Cuboid::new(half), 0.125), 0.3)),
                Box::new(Rounded::new(Capsule::new(0.5, 0.3), 0.1)),
                Box::new(Plane::new(Vector::<f32, 3>::y_axis())),
            ]
        };
        let ball: [Box<dyn Shape<f32, 3>>; 1] = [Box::new(Ball::new(0.3))];
        let pose_of = |random: &mut Random| random.turn::<f32>();
        are_parts(&ball, &solids(), pose_of, known_3d);
        let plane: [Box<dyn Shape<f32, 3>>; 1] =
            [Box::new(Plane::new(-Vector::<f32, 3>::x_axis()))];
        are_parts(&solids()[..9], &plane, pose_of, known_3d);
        let flat: [Box<dyn Shape<f32, 2>>; 4] = [
            Box::new(Triangle::new(corners[0].xy(), corners[1].xy(), corners[3].xy())),
            Box::new(ConvexPolygon::from_points(&corners.map(|corner| corner.xy()))),
            Box::new(Rounded::new(Cuboid::new(half.xy()), 0.1)),
            Box::new(Plane::new(Vector::<f32, 2>::y_axis())),
        ];
        let ball: [Box<dyn Shape<f32, 2>>; 1] = [Box::new(Ball::new(0.3))];
        let pose_of = |random: &mut Random| Pose::from_translation(random.vector::<f32>().xy());
        are_parts(&ball, &flat, pose_of, |pair| known(pair, beside_ball_2d));
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
        let pair = Pair { first, second, pose12 };
        assert!(!certainly_overlap(&pair, DistanceMethod::Features), "not a number");
        assert_eq!(distance_3d(&pair, f32::INFINITY), None, "not a number");
    }
}
