//! From the one fact about a pair to a manifold: the points that delimit the area of contact.
//!
//! The separation gives the normal and the witness, the nearest pair of points. Both solids answer
//! with the part of their core that faces the other; seen along the normal these are points, segments
//! and convex polygons of the plane (module [`mod@facet`]), and the corners of what they have in common
//! ([`overlap`]) are the candidates. [`half_space`] is the case of a face without end. The witness is
//! always represented, so the smallest distance of a manifold is that of the separation exactly; with
//! a ball it is all there is.
//! At last [`reduce`] chooses a few candidates and [`names`] numbers them.
//!
//! Sutherland and Hodgman ("Reentrant polygon clipping", 1974) clip one polygon against the sides of
//! the other, which makes one solid the reference; here both are treated alike, see [`overlap`].

mod along;
mod ball;
mod box_lanes;
mod capsule_face;
mod chain;
mod clip;
mod closed_lanes;
mod facet;
mod fences;
mod frame;
mod half_space;
mod level_corners;
mod names;
mod overlap;
mod patch;
mod patch_line;
mod patch_outline;
mod patch_shelves;
mod reduce;
mod ring;
mod stretch;
#[cfg(test)]
pub(super) mod tests;
mod triangle_face;
#[cfg(test)]
mod triangle_face_tests;
mod witness;

pub(super) use self::along::{Along, build_along, build_between, build_on_face};
pub(crate) use self::box_lanes::{BoxJob, update_box_pairs2, update_box_pairs3};
pub(super) use self::chain::SegmentPair;
pub(crate) use self::closed_lanes::{KeptPairs, PairQuestion, Solid, update_pairs2, update_pairs3};
use self::facet::{Facet, Which};
use self::frame::{Candidate, Frame};
use self::overlap::{Candidates, Overlap};
pub(super) use self::patch::{Merging, Patch, PatchPoint, Piece, Points, merge};
pub(super) use self::patch_line::merge_in_plane;
pub(crate) use self::triangle_face::{OnFace, on_face2, on_face3};
pub(crate) use self::witness::{
    feature2 as witness_feature2, feature3 as witness_feature3, features2 as witness_features2,
    features3 as witness_features3,
};
use super::separation::{separation_in_plane, separation_in_space};
use super::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Pose, Real, Vector, orthonormal_basis, perp};
use crate::shape::{FeatureId, Geometry, Kind};

/// Builds the manifold of two solids in the plane: at most two points.
///
/// `out` holds the previous manifold of the pair, whose points hand on their ids; it is empty
/// afterwards if and only if the solids are farther apart than the prediction or overlap without
/// bound. A separation that is not a number gives an empty manifold.
pub(crate) fn build2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    let frame = Frame::new(pair, separation, request, tangents2(&separation.normal));
    let limits = (request, request.max_points.min(2));
    if !stretch::build(pair, &frame, limits, out) {
        build(pair, &frame, limits, out);
    }
}

/// As [`build2`], with as many points as are asked for.
pub(crate) fn between2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    let frame = Frame::new(pair, separation, request, tangents2(&separation.normal));
    build(pair, &frame, (request, request.max_points), out);
}

/// Builds the manifold of two solids in space: at most `request.max_points` points.
///
/// As [`build2`].
pub(crate) fn build3<N: Real>(
    pair: &Pair<'_, N, 3>,
    separation: &Separation<N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    let frame = Frame::new(pair, separation, request, tangents3(&separation.normal));
    let limits = (request, request.max_points);
    let distance = separation.distance;
    let is_near = distance <= request.prediction && distance.is_finite_number();
    let is_ball = matches!(pair.first, Kind::Ball(_));
    if is_ball || !is_near || !clip::build(pair, &frame, request.max_points, out) {
        build(pair, &frame, limits, out);
    }
}

/// Two directions that complete a normal of space to a right-handed basis.
pub(crate) fn tangents3<N: Real>(normal: &Vector<N, 3>) -> [Vector<N, 3>; 2] {
    let (u, v) = orthonormal_basis(normal);
    [u, v]
}

/// The direction along the line of contact in the plane, and zero for the second that there is not.
#[inline]
pub(crate) fn tangents2<N: Real>(normal: &Vector<N, 2>) -> [Vector<N, 2>; 2] {
    [-perp(normal), Vector::<N, 2>::zeros()]
}

/// The manifold of a pair in space: by the fused algorithm of its kinds where there is one and it does not
/// decline, else from the separation.
pub(crate) fn contacts3<N: Real>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    if let Kind::Ball(_) = pair.first {
        return ball::build(pair, separation_in_space(pair, request.prediction), out);
    }
    if let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (pair.first, pair.second) {
        return box_lanes::build3([cuboid1, cuboid2], &pair.pose12, request, out);
    }
    if level_corners::build(pair, request, out) {
        return;
    }
    contacts_of_separation3(pair, request, out);
}

/// The manifold of a pair in space from its separation.
fn contacts_of_separation3<N: Real>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    match separation_in_space(pair, request.prediction) {
        Some(separation) => build3(pair, &separation, request, out),
        None => out.points.clear(),
    }
}

/// The manifold of a pair in the plane; as [`contacts3`].
pub(crate) fn contacts2<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    if let Kind::Ball(_) = pair.first {
        return ball::build(pair, separation_in_plane(pair, request.prediction), out);
    }
    if let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (pair.first, pair.second) {
        return box_lanes::build2([cuboid1, cuboid2], &pair.pose12, request, out);
    }
    contacts_of_separation2(pair, request, out);
}

/// The manifold of a pair in the plane from its separation.
fn contacts_of_separation2<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    match separation_in_plane(pair, request.prediction) {
        Some(separation) => build2(pair, &separation, request, out),
        None => out.points.clear(),
    }
}

/// The manifold by facets.
fn build<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &Frame<N, D>,
    (request, limit): (&ManifoldRequest<N>, usize),
    out: &mut RawManifold<N, D>,
) {
    let distance = frame.witness.distance;
    if !(distance <= request.prediction && distance.is_finite_number()) {
        out.points.clear();
        return;
    }
    out.normal = frame.normal();
    if let Kind::Ball(_) = pair.first {
        let touched = ball::known_part(pair, &frame.witness)
            .unwrap_or_else(|| ball::shown_at_witness(pair, frame));
        let parts = [FeatureId::Face(0), touched];
        return names::settle_alone(&Candidate::alone(&frame.witness, parts), out);
    }
    let mut candidates = Candidates::new();
    fill(pair, frame, &mut candidates);
    choose(&mut candidates, (distance, frame.tolerance), limit, out);
}

/// Replaces the points of a manifold by at most `limit` of the candidates, and at least one. The
/// nearest stands for the witness and takes the separation's `distance`, which it has but for
/// rounding.
fn choose<N: Real, const D: usize>(
    candidates: &mut [Candidate<N, D>],
    (distance, tolerance): (N, N),
    limit: usize,
    out: &mut RawManifold<N, D>,
) {
    if candidates.len() <= limit && names::renew(candidates, distance, out) {
        return;
    }
    names::inherit(&out.points, candidates);
    let level = distance + tolerance;
    let chosen = chosen(candidates, (level, tolerance), limit.max(1));
    let deepest = deepest_of(chosen.len(), level, |at| {
        let candidate = &candidates[chosen[at]];
        (candidate.kept_id.is_some(), candidate.distance)
    });
    candidates[chosen[deepest]].distance = distance;
    names::settle(candidates, &chosen, out);
}

/// The indices of at most `limit` candidates, one with a distance of at most `level` or the smallest among them.
#[inline]
fn chosen<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    (level, tolerance): (N, N),
    limit: usize,
) -> reduce::Indices {
    if candidates.len() <= limit {
        return (0..candidates.len()).collect();
    }
    let seen = candidates.iter().map(|c| (c.flat, c.distance, c.kept_id.is_some()));
    reduce::chosen(&mut reduce::projected(seen, level), limit, tolerance)
}

/// The corners of the common area, and the witness if it is none of them.
fn fill<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &Frame<N, D>,
    out: &mut Candidates<N, D>,
) {
    let mut first = Facet::boundary(Which::First);
    let mut second = Facet::boundary(Which::Second);
    face(&mut first, pair.first, None, frame);
    face(&mut second, pair.second, Some(&pair.pose12), frame);
    if let Kind::Plane(_) = pair.second {
        half_space::candidates(pair.first, &first, frame, out);
    } else {
        Overlap { frame, first: &first, second: &second }.candidates(out);
    }
    let limit = frame.witness.distance + frame.tolerance;
    if !out.iter().any(|candidate| candidate.distance <= limit) {
        let features = [at_witness(&first, frame), at_witness(&second, frame)];
        add_witness(frame, features, out);
    }
}

/// Makes a facet what a solid shows of itself; that of a half-space stays its boundary.
#[inline]
fn face<N: Real, const D: usize>(
    facet: &mut Facet<N, D>,
    kind: Kind<'_, N, D>,
    pose: Option<&Pose<N, D>>,
    frame: &Frame<N, D>,
) {
    if let Some(map) = Geometry(kind).as_support_map() {
        facet.face(map, pose, frame);
    }
}

/// The part of a solid that the witness lies on.
fn at_witness<N: Real, const D: usize>(facet: &Facet<N, D>, frame: &Frame<N, D>) -> FeatureId {
    facet.locate(&Vector::<N, 2>::zeros(), frame.tolerance).unwrap_or(facet.id)
}

/// Adds the witness, in place of any candidate with the same name unless the name is that of two
/// faces, which many points may share.
fn add_witness<N: Real, const D: usize>(
    frame: &Frame<N, D>,
    features: [FeatureId; 2],
    out: &mut Candidates<N, D>,
) {
    let is_shared = features.iter().all(|id| matches!(id, FeatureId::Face(_)));
    out.retain(|candidate| is_shared || candidate.features != features);
    out.push(Candidate::alone(&frame.witness, features));
}

/// The candidate that stands for the witness; see [`deepest_of`].
fn deepest<N: Real, const D: usize>(candidates: &[Candidate<N, D>], limit: N) -> usize {
    deepest_of(candidates.len(), limit, |index| {
        let candidate = &candidates[index];
        (candidate.kept_id.is_some(), candidate.distance)
    })
}

/// Of candidates whose distance is the smallest but for rounding, at most `limit`, one that the previous
/// manifold held, then the deepest: its index. `what` tells of each whether it was held, and its distance.
#[inline]
fn deepest_of<N: Real>(count: usize, limit: N, what: impl Fn(usize) -> (bool, N)) -> usize {
    let rank = |index: usize| {
        let (is_kept, distance) = what(index);
        (!(distance <= limit && is_kept), distance)
    };
    (1..count).fold(0, |best, index| {
        let (new, old) = (rank(index), rank(best));
        if (new.0, old.0) == (false, true) || new.0 == old.0 && new.1 < old.1 {
            index
        } else {
            best
        }
    })
}
