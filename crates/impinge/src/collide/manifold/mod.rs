//! Builds the manifold of a pair from its separation: points that span the contact area.
//!
//! ```text
//!   separation   `frame`           supporting features           candidates      points and ids
//!   (witness) -> ContactFrame  ->  3D: `ring`, `clip`        ->  corners of  ->  `reduce`
//!                                  2D: `interval`                the common      `ids`, `matching`
//!                                  half-space: `half_space`      area
//! ```
//!
//! The separation provides the normal and the witness, its nearest pair of points. The supporting
//! features of both solids, projected along the normal, are points, segments and convex polygons
//! ([`ring`]); the corners of their intersection ([`clip`]) are the candidates. In 2D the
//! intersection is an interval ([`interval`]). Against a half-space ([`half_space`]), the
//! candidates are all corners of the solid near the boundary. [`reduce`] chooses a few candidates,
//! and [`ids`] gives them ids.
//!
//! If the solids are within the prediction, a manifold built from their separation has at least one
//! point, and its smallest distance is exactly that of the witness. If the first solid is a ball,
//! the witness is the only point. A manifold along a given normal ([`along`]) may be empty, and
//! need not contain the witness.

mod along;
mod chain;
mod clip;
pub(in crate::collide) mod face_lanes;
pub(in crate::collide) mod frame;
mod half_space;
pub(in crate::collide) mod ids;
mod interval;
pub(in crate::collide) mod matching;
pub(in crate::collide) mod raised;
pub(in crate::collide) mod reduce;
mod ring;
mod supporting;
#[cfg(test)]
pub(crate) mod tests;
mod witness;

pub(super) use self::along::{Along, build_along, build_between, build_on_face};
pub(crate) use self::along::{OnFace, on_face2, on_face3};
pub(super) use self::chain::SegmentPair;
pub(in crate::collide) use self::frame::Candidate;
use self::frame::{Candidates, ContactFrame};
use self::ids::PairPose;
pub(crate) use self::witness::{
    feature2 as witness_feature2, feature3 as witness_feature3, features2 as witness_features2,
    features3 as witness_features3,
};
use super::separation::{separation_2d, separation_3d};
use super::size::smaller_size;
use super::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, orthonormal_basis, perp};
use crate::shape::{FeatureId, Kind};
use crate::tables::ByDimension;

/// Builds the manifold of two solids in 2D: at most two points.
///
/// `out` holds the previous manifold of the pair, from which the new points inherit their ids. On
/// return `out` is empty if and only if the solids are farther apart than the prediction or the
/// distance of the separation is NaN or infinite.
pub(crate) fn build2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    build_2d(pair, separation, request, request.max_points.min(2), out);
}

/// Builds the manifold of two solids in 2D with up to `request.max_points` points; `out` follows
/// the contract of [`build2`].
pub(crate) fn between2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    build_2d(pair, separation, request, request.max_points, out);
}

/// Builds the manifold in 2D with at most `limit` points.
fn build_2d<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    request: &ManifoldRequest<N>,
    limit: usize,
    out: &mut RawManifold<N, 2>,
) {
    if build_one_sided(pair, separation, request, limit, out) {
        return;
    }
    let frame = ContactFrame::new(pair, separation, request, tangents2(&separation.normal));
    if !interval::build(pair, &frame, limit, out) {
        // One solid is user-defined and has a supporting feature that is neither a corner nor a
        // side.
        build_witness_manifold(pair, separation, out);
    }
}

/// Builds the manifold of two solids in 3D: at most `request.max_points` points.
///
/// `out` holds the previous manifold and receives the new one, with the contract of [`build2`].
pub(crate) fn build3<N: Real>(
    pair: &Pair<'_, N, 3>,
    separation: &Separation<N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    if !build_one_sided(pair, separation, request, request.max_points, out) {
        let frame = ContactFrame::new(pair, separation, request, tangents3(&separation.normal));
        clip::build(pair, &frame, request.max_points, out);
    }
}

/// Builds the manifold of three kinds of pairs: an empty one for a pair beyond the prediction or
/// with a distance that is NaN or infinite, one point for a ball as the first solid, and the near
/// corners for a half-space as the second. Returns `false`, with nothing changed, for other pairs.
fn build_one_sided<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    request: &ManifoldRequest<N>,
    limit: usize,
    out: &mut RawManifold<N, D>,
) -> bool {
    let distance = separation.distance;
    // Written so that NaN counts as beyond the prediction.
    let is_near = distance <= request.prediction && distance.is_finite_number();
    if !is_near {
        out.points.clear();
    } else if let Kind::Ball(_) = pair.first {
        build_witness_manifold(pair, separation, out);
    } else if let Kind::Plane(_) = pair.second {
        let tangents = <N::Algorithms>::tangents(&separation.normal);
        half_space::build(
            pair,
            &ContactFrame::new(pair, separation, request, tangents),
            limit,
            out,
        );
    } else {
        return false;
    }
    true
}

/// Builds the manifold whose only contact is at the nearest points.
fn build_witness_manifold<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    out: &mut RawManifold<N, D>,
) {
    let parts = <N::Algorithms>::witness_features(pair, separation);
    let choice = PointChoice {
        pose: PairPose { pose12: None, normal: &separation.normal },
        size: &|| smaller_size([pair.first, pair.second]),
        distance: separation.distance,
        tolerance: N::ZERO,
        limit: 1,
    };
    choose(&mut [Candidate::alone(separation, parts)], &choice, out);
    out.pose12 = None;
}

/// Returns two unit vectors that complete the normal to a right-handed basis.
pub(crate) fn tangents3<N: Real>(normal: &Vector<N, 3>) -> [Vector<N, 3>; 2] {
    let (u, v) = orthonormal_basis(normal);
    [u, v]
}

/// Returns the normal rotated clockwise by 90° as the only tangent in 2D; the second is zero.
#[inline]
pub(crate) fn tangents2<N: Real>(normal: &Vector<N, 2>) -> [Vector<N, 2>; 2] {
    [-perp(normal), Vector::<N, 2>::zeros()]
}

/// Computes the separation of a pair in 3D, and builds its manifold from it as [`build3`] does.
/// Clears the points if the solids are beyond the prediction.
pub(crate) fn contacts_of_separation3<N: Real>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    match separation_3d(pair, request.prediction) {
        Some(separation) => build3(pair, &separation, request, out),
        None => out.points.clear(),
    }
}

/// Computes the separation of a pair in 2D, and builds its manifold from it as [`build2`] does.
/// Clears the points if the solids are beyond the prediction.
pub(crate) fn contacts_of_separation2<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    match separation_2d(pair, request.prediction) {
        Some(separation) => build2(pair, &separation, request, out),
        None => out.points.clear(),
    }
}

/// Slack of the deepest point, as a fraction of the pair's size (`collide/size.rs`). A candidate
/// that continues a point of the previous manifold may stand for the deepest point if its distance
/// exceeds the smallest one by at most the slack. It then gets the distance of the pair. So a solid
/// that vibrates at rest keeps its points although its deepest corner changes in each step.
const SLACK: f64 = 1.0 / 512.0;

/// Up to this number of candidates, all are kept if the limit on the number of points allows. More
/// candidates are reduced ([`reduce`]) even if the limit allows all of them, because some may
/// coincide up to rounding, such as corners of two equal boxes.
pub(in crate::collide) const ALL: usize = 4;

/// Inputs of [`choose`].
pub(in crate::collide) struct PointChoice<'a, N: Real, const D: usize> {
    /// Pose of the second solid relative to the first (see [`PairPose`]), and the normal.
    pub(in crate::collide) pose: PairPose<'a, N, D>,
    /// Computes the size of the pair (`collide/size.rs`); called only when a length is compared
    /// with it.
    pub(in crate::collide) size: &'a dyn Fn() -> N,
    /// Signed distance of the pair; one of the deepest points gets exactly this distance.
    pub(in crate::collide) distance: N,
    /// Largest length that counts as a rounding error.
    pub(in crate::collide) tolerance: N,
    /// Largest number of points; at least one is kept.
    pub(in crate::collide) limit: usize,
}

/// Returns the largest distance with which an old point may stand for the deepest point: `distance`
/// of the pair plus the larger of `tolerance` and `SLACK` times the pair's `size`.
pub(in crate::collide) fn slack_level<N: Real>(distance: N, size: N, tolerance: N) -> N {
    distance + max(size * N::lit(SLACK), tolerance)
}

/// Replaces the manifold of a pair by at most `limit` of the candidates, which were computed in
/// `frame`.
fn choose_in_frame<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &ContactFrame<N, D>,
    candidates: &mut [Candidate<N, D>],
    limit: usize,
    out: &mut RawManifold<N, D>,
) {
    let (pose12, normal) = (&pair.pose12, &frame.normal());
    let choice = PointChoice {
        pose: PairPose { pose12: Some(pose12).filter(|_| keeps_pose(pair)), normal },
        size: &|| smaller_size([pair.first, pair.second]),
        distance: frame.witness.distance,
        tolerance: frame.tolerance,
        limit,
    };
    choose(candidates, &choice, out);
    out.pose12 = Some(*pose12).filter(|_| keeps_pose(pair));
}

/// Returns whether the manifold stores the pose, so that points are also matched by their positions
/// on the second solid. `false` for pairs that the kernels of `batch` may compute, because these
/// store no pose.
fn keeps_pose<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> bool {
    let has_lanes = |kind: &Kind<'_, N, D>| {
        matches!(kind, Kind::Ball(_) | Kind::Cuboid(_) | Kind::Segment(_) | Kind::Capsule(_))
    };
    !(has_lanes(&pair.first) && has_lanes(&pair.second))
}

/// Replaces the points of a manifold by at least one and at most `limit` candidates, and sets its
/// normal. One of the deepest points gets exactly the distance of the pair. The distance computed
/// for that point differs from it by rounding, or by up to `SLACK` times the size of the pair.
pub(in crate::collide) fn choose<N: Real, const D: usize>(
    candidates: &mut [Candidate<N, D>],
    choice: &PointChoice<'_, N, D>,
    out: &mut RawManifold<N, D>,
) {
    let PointChoice { distance, tolerance, .. } = *choice;
    let limit = choice.limit.max(1);
    if !(candidates.len() <= limit.min(ALL) && ids::renew(candidates, choice, out)) {
        let is_over = candidates.len() > limit.min(ALL) && !out.points.is_empty();
        if !out.points.is_empty() {
            ids::inherit_by_features(out, candidates);
            let all: reduce::Indices = (0..candidates.len()).collect();
            ids::inherit_by_position(out, &choice.pose, choice.size, candidates, &all);
        }
        let size = if is_over { (choice.size)() } else { N::ZERO };
        let levels = [distance + tolerance, slack_level(distance, size, tolerance)];
        let chosen = chosen(candidates, levels, tolerance, limit);
        if is_over {
            // Passes the ids of candidates that were not chosen to chosen candidates near them.
            ids::inherit_by_position(out, &choice.pose, choice.size, candidates, &chosen);
        }
        let deepest = deepest_of(chosen.len(), levels[0], |at| {
            let candidate = &candidates[chosen[at]];
            (candidate.is_old(), candidate.distance)
        });
        candidates[chosen[deepest]].distance = distance;
        ids::replace_points(candidates, &chosen, out);
    }
    out.normal = *choice.pose.normal;
}

/// Returns the indices of all candidates if these are no more than `limit` and [`ALL`], else of at
/// most `limit` candidates that span a large area ([`reduce`]). At least one is deepest: its
/// distance is the smallest or at most `levels[0]`, or it continues an old point and has at most
/// the distance `levels[1]`.
#[inline]
fn chosen<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    levels: [N; 2],
    tolerance: N,
    limit: usize,
) -> reduce::Indices {
    if candidates.len() <= limit.min(ALL) {
        return (0..candidates.len()).collect();
    }
    let flattened = candidates.iter().map(|c| (c.flat, c.distance, c.is_old()));
    reduce::chosen(&mut reduce::projected(flattened, levels), limit, tolerance)
}

/// Adds the nearest points, which lie on `features`, as a candidate. If exactly one candidate has
/// the same features, and at least one of them is not a face, the new candidate replaces it.
/// Several candidates with the same features lie on round rims at different positions, so they all
/// stay.
fn add_witness<N: Real, const D: usize>(
    witness: &Separation<N, D>,
    features: [FeatureId; 2],
    out: &mut Candidates<N, D>,
) {
    let is_face = |id: &FeatureId| matches!(id, FeatureId::Face(_));
    let is_twin = |candidate: &Candidate<N, D>| candidate.features == features;
    if !features.iter().all(is_face) && out.iter().filter(|twin| is_twin(twin)).count() == 1 {
        out.retain(|candidate| !is_twin(candidate));
    }
    out.push(Candidate::alone(witness, features));
}

/// Returns the index of the candidate that gets the distance of the pair, by [`deepest_of`] with
/// `limit`.
fn deepest<N: Real, const D: usize>(candidates: &[Candidate<N, D>], limit: N) -> usize {
    deepest_of(candidates.len(), limit, |index| {
        let candidate = &candidates[index];
        (candidate.is_old(), candidate.distance)
    })
}

/// Returns the index of the candidate that gets the distance of the pair: the one with the smallest
/// distance among those that continue an old point and have a distance of at most `limit`, or among
/// all if there are none. The first wins a tie. `what` returns, for each candidate, whether it
/// continues an old point, and its distance.
#[inline]
pub(in crate::collide) fn deepest_of<N: Real>(
    count: usize,
    limit: N,
    what: impl Fn(usize) -> (bool, N),
) -> usize {
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
