//! Finds the features that the nearest points of two convex solids lie on.

use super::frame::{ContactFrame, Which, rounding};
use super::interval::FeatureInterval;
use super::ring::part_of;
use super::{ManifoldRequest, Pair, clip, tangents2, tangents3};
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::{FeatureId, Kind};

/// Returns the features of two solids in 2D that the points of their separation lie on.
pub(crate) fn features2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
) -> [FeatureId; 2] {
    features(pair, separation, supporting_part2)
}

/// Returns the features of two solids in 3D that the points of their separation lie on.
pub(crate) fn features3<N: Real>(
    pair: &Pair<'_, N, 3>,
    separation: &Separation<N, 3>,
) -> [FeatureId; 2] {
    features(pair, separation, supporting_part3)
}

/// Returns the feature of one solid in 2D that its point of the separation lies on: of the second
/// solid if `is_second`, else of the first. The result equals the entry of that solid in
/// [`features2`], except within rounding of another feature.
pub(crate) fn feature2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    tolerance: N,
    is_second: bool,
) -> FeatureId {
    feature(pair, separation, tolerance, supporting_part2, is_second)
}

/// Returns the feature of one solid in 3D that its point of the separation lies on: of the second
/// solid if `is_second`, else of the first. The result equals the entry of that solid in
/// [`features3`], except within rounding of another feature.
pub(crate) fn feature3<N: Real>(
    pair: &Pair<'_, N, 3>,
    separation: &Separation<N, 3>,
    tolerance: N,
    is_second: bool,
) -> FeatureId {
    feature(pair, separation, tolerance, supporting_part3, is_second)
}

/// Function that returns the smallest part of one solid's supporting feature that contains the
/// solid's point of the separation. The flag selects the second solid.
type SupportingPartFn<N, const D: usize> =
    fn(&Pair<'_, N, D>, &Separation<N, D>, bool) -> FeatureId;

/// Creates a frame for finding features; its prediction is the distance of the pair.
fn frame<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tangents: [Vector<N, D>; 2],
) -> ContactFrame<N, D> {
    let request = ManifoldRequest::new(separation.distance, N::ZERO, 1);
    ContactFrame::new(pair, separation, &request, tangents)
}

/// Returns the features of both solids: each from the position of its point if that decides, else
/// from the supporting feature.
fn features<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    supporting_part: SupportingPartFn<N, D>,
) -> [FeatureId; 2] {
    if let Some(touched) = of_ball(pair, separation) {
        return [FeatureId::Face(0), touched];
    }
    let (tolerance, normal) = (rounding(pair), separation.normal);
    let first = by_position(pair.first, &separation.point1, &normal, tolerance);
    // The position on the second solid is computed in the frame of that solid.
    let second = || {
        let point = pair.pose12.inverse_point(&separation.point2);
        by_position(pair.second, &point, &-pair.pose12.inverse_vector(&normal), tolerance)
    };
    [
        first.unwrap_or_else(|| supporting_part(pair, separation, false)),
        second().unwrap_or_else(|| supporting_part(pair, separation, true)),
    ]
}

/// Returns the part of a solid that contains a surface point with the outward normal `outward`,
/// from the position alone, without the supporting feature. Supports flat-faced solids,
/// half-spaces, segments, capsules and rounded solids of these kinds; returns `None` for other
/// kinds, and where the position does not decide within `tolerance`.
fn by_position<N: Real, const D: usize>(
    kind: Kind<'_, N, D>,
    point: &Point<N, D>,
    outward: &Vector<N, D>,
    tolerance: N,
) -> Option<FeatureId> {
    match kind {
        Kind::Plane(_) => Some(FeatureId::Face(0)),
        Kind::Cuboid(cuboid) => cuboid.part_at(point, tolerance),
        Kind::Triangle(triangle) => triangle.part_at(point, outward, tolerance),
        Kind::Polytope(solid) => Some(solid.part_at(point, outward, tolerance)),
        Kind::Segment(segment) => part_of(segment, point, N::TWO * tolerance),
        Kind::Capsule(capsule) => {
            let core = point - outward * capsule.radius();
            part_of(capsule.segment(), &core, N::TWO * tolerance)
        }
        Kind::Rounded(solid) => {
            let core = point - outward * solid.radius();
            by_position(solid.inner().0, &core, outward, tolerance)
        }
        _ => None,
    }
}

/// Returns one feature: from the position of the point if [`of_ball`] or [`on_seam`] decides, else
/// from the supporting feature.
fn feature<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tolerance: N,
    supporting_part: SupportingPartFn<N, D>,
    is_second: bool,
) -> FeatureId {
    match of_ball(pair, separation) {
        Some(touched) if is_second => return touched,
        Some(_) => return FeatureId::Face(0),
        None => {}
    }
    let seam = on_seam(pair, separation, tolerance, is_second);
    seam.unwrap_or_else(|| supporting_part(pair, separation, is_second))
}

/// Returns the side or corner of a triangle that a box, a hull, a segment or a capsule touches;
/// `is_second` must select the triangle. The nearest points of these pairs are accurate to
/// rounding, so the position decides. `None` for other pairs, for the other solid of a pair, and if
/// the point is inside the triangle.
fn on_seam<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tolerance: N,
    is_second: bool,
) -> Option<FeatureId> {
    let (triangle, point, toward) = match (&pair.first, &pair.second) {
        (Kind::Triangle(triangle), Kind::Cuboid(_) | Kind::Polytope(_)) if !is_second => {
            (triangle, separation.point1, separation.normal)
        }
        (Kind::Segment(_) | Kind::Capsule(_), Kind::Triangle(triangle)) if is_second => {
            let point = pair.pose12.inverse_point(&separation.point2);
            (triangle, point, pair.pose12.inverse_vector(&-separation.normal))
        }
        _ => return None,
    };
    let part = triangle.part_at(&point, &toward, tolerance);
    part.filter(|part| !matches!(part, FeatureId::Face(_)))
}

/// Returns the feature of the second solid if the first is a ball and the position of the point
/// decides ([`beside_ball`]); else `None`.
fn of_ball<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
) -> Option<FeatureId> {
    match pair.first {
        Kind::Ball(_) => beside_ball(pair, separation),
        _ => None,
    }
}

/// Returns the feature of the second solid that a ball, the first solid, touches; `None` if the
/// position of the point does not decide for the kind of the second solid. The result equals the
/// part that the supporting feature gives, except within rounding of another part.
#[inline]
pub(in crate::collide) fn beside_ball<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    found: &Separation<N, D>,
) -> Option<FeatureId> {
    if let Kind::Ball(_) | Kind::Ellipsoid(_) = pair.second {
        return Some(FeatureId::Face(0));
    }
    let (point, tolerance) = (pair.pose12.inverse_point(&found.point2), rounding(pair));
    match pair.second {
        Kind::Cylinder(cylinder, _) => cylinder.part_at(&point, tolerance),
        Kind::Cone(cone, _) => cone.part_at(&point, tolerance),
        other => by_position(other, &point, &-pair.pose12.inverse_vector(&found.normal), tolerance),
    }
}

/// Returns one of the two solids, and its pose in the frame of the first; the pose is `None` for
/// the first solid.
fn solid<'a, N: Real, const D: usize>(
    pair: &'a Pair<'_, N, D>,
    is_second: bool,
) -> (Which, Kind<'a, N, D>, Option<&'a Pose<N, D>>) {
    if is_second {
        (Which::Second, pair.second, Some(&pair.pose12))
    } else {
        (Which::First, pair.first, None)
    }
}

fn supporting_part2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    is_second: bool,
) -> FeatureId {
    let frame = frame(pair, separation, tangents2(&separation.normal));
    let (which, kind, pose) = solid(pair, is_second);
    let side = FeatureInterval::of(which, kind, pose, &frame);
    side.map_or(FeatureId::Face(0), |side| side.at_witness(&frame))
}

fn supporting_part3<N: Real>(
    pair: &Pair<'_, N, 3>,
    separation: &Separation<N, 3>,
    is_second: bool,
) -> FeatureId {
    let frame = frame(pair, separation, tangents3(&separation.normal));
    let (which, kind, pose) = solid(pair, is_second);
    // Balls and half-spaces have only this feature; composites have no supporting feature.
    if let Kind::Ball(_) | Kind::Plane(_) | Kind::Composite(_) = kind {
        return FeatureId::Face(0);
    }
    clip::part_at_witness(kind, which, pose, &frame)
}
