//! From the separation of a pair to its manifold: the points that span the area of contact.
//!
//! The separation has the normal and the witness, the nearest pair of points. The supporting features of both
//! solids, projected along the normal, are points, segments and convex polygons ([`ring`]), and the corners of
//! their intersection ([`clip`]) are the candidates. In 2D that is an interval ([`stretch`]), and over a
//! [`half_space`] every corner counts. [`reduce`] chooses a few candidates and [`ids`] numbers them.
//!
//! The witness is always represented, so the smallest distance of a manifold is that of the separation exactly;
//! with a ball it is the only point.

mod along;
mod chain;
mod clip;
pub(in crate::collide) mod frame;
mod half_space;
pub(in crate::collide) mod ids;
pub(in crate::collide) mod reduce;
mod ring;
mod stretch;
mod supporting;
#[cfg(test)]
pub(crate) mod tests;
mod witness;

pub(super) use self::along::{Along, build_along, build_between, build_on_face};
pub(crate) use self::along::{OnFace, on_face2, on_face3};
pub(super) use self::chain::SegmentPair;
pub(in crate::collide) use self::frame::Candidate;
use self::frame::{Candidates, ContactFrame};
pub(crate) use self::witness::{
    feature2 as witness_feature2, feature3 as witness_feature3, features2 as witness_features2,
    features3 as witness_features3,
};
use super::separation::{separation_in_plane, separation_in_space};
use super::size::smaller_size;
use super::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, orthonormal_basis, perp};
use crate::shape::{FeatureId, Kind};

/// Builds the manifold of two solids in 2D: at most two points.
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
    build_in_plane(pair, separation, request, request.max_points.min(2), out);
}

/// As [`build2`], with as many points as are asked for.
pub(crate) fn between2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    build_in_plane(pair, separation, request, request.max_points, out);
}

fn build_in_plane<N: Real>(
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
    if !stretch::build(pair, &frame, limit, out) {
        // A user's solid with a supporting feature that is neither a point nor a side.
        settle_witness(pair, separation, out);
    }
}

/// Builds the manifold of two solids in 3D: at most `request.max_points` points.
///
/// As [`build2`].
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

/// Builds the manifold of a pair that is too far apart, of a ball, the first solid, or of a half-space, the
/// second; false of others.
fn build_one_sided<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    request: &ManifoldRequest<N>,
    limit: usize,
    out: &mut RawManifold<N, D>,
) -> bool {
    let distance = separation.distance;
    // Written so that NaN is too far.
    let is_near = distance <= request.prediction && distance.is_finite_number();
    if !is_near {
        out.points.clear();
    } else if let Kind::Ball(_) = pair.first {
        settle_witness(pair, separation, out);
    } else if let Kind::Plane(_) = pair.second {
        let tangents = (N::tables().tangents)(&separation.normal);
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

/// The nearest points are all there is.
fn settle_witness<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    out: &mut RawManifold<N, D>,
) {
    let parts = (N::tables().witness_features)(pair, separation);
    let (normal, distance) = (separation.normal, separation.distance);
    let nearest = PointChoice { pair, normal, distance, tolerance: N::ZERO, limit: 1 };
    choose(&mut [Candidate::alone(separation, parts)], &nearest, out);
}

/// Two directions that complete a normal of space to a right-handed basis.
pub(crate) fn tangents3<N: Real>(normal: &Vector<N, 3>) -> [Vector<N, 3>; 2] {
    let (u, v) = orthonormal_basis(normal);
    [u, v]
}

/// The direction along the line of contact in 2D, and zero for the second, which does not exist.
#[inline]
pub(crate) fn tangents2<N: Real>(normal: &Vector<N, 2>) -> [Vector<N, 2>; 2] {
    [-perp(normal), Vector::<N, 2>::zeros()]
}

/// The manifold of a pair in 3D: by the batch of its kinds where there is one and it serves the pair,
/// else from the separation.
pub(crate) fn contacts3<N: Space<3>>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    if !super::batch::build3(pair, request, out) {
        contacts_of_separation3(pair, request, out);
    }
}

/// The manifold of a pair in 3D from its separation.
pub(in crate::collide) fn contacts_of_separation3<N: Real>(
    pair: &Pair<'_, N, 3>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 3>,
) {
    match separation_in_space(pair, request.prediction) {
        Some(separation) => build3(pair, &separation, request, out),
        None => out.points.clear(),
    }
}

/// The manifold of a pair in 2D; as [`contacts3`].
pub(crate) fn contacts2<N: Space<2>>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    if !super::batch::build2(pair, request, out) {
        contacts_of_separation2(pair, request, out);
    }
}

/// The manifold of a pair in 2D from its separation.
pub(in crate::collide) fn contacts_of_separation2<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) {
    match separation_in_plane(pair, request.prediction) {
        Some(separation) => build2(pair, &separation, request, out),
        None => out.points.clear(),
    }
}

/// An old point stands for the deepest one as long as it is no farther than this part of the size of the smaller
/// solid from being as deep: half the diagonal of its box. So a solid that trembles at rest keeps its points, though
/// the deepest corner is another one at each step. The points then have the depth of the pair, and are that near to
/// the surfaces.
const SLACK: f64 = 1.0 / 512.0;

/// The nearest points of a pair, and how many points its manifold may have.
pub(in crate::collide) struct PointChoice<'a, N: Real, const D: usize> {
    pub(in crate::collide) pair: &'a Pair<'a, N, D>,
    /// Unit, from the first solid to the second.
    pub(in crate::collide) normal: Vector<N, D>,
    pub(in crate::collide) distance: N,
    /// Lengths below this are rounding errors.
    pub(in crate::collide) tolerance: N,
    pub(in crate::collide) limit: usize,
}

impl<'a, N: Real, const D: usize> PointChoice<'a, N, D> {
    fn new(pair: &'a Pair<'a, N, D>, frame: &ContactFrame<N, D>, limit: usize) -> Self {
        let (normal, distance) = (frame.normal(), frame.witness.distance);
        Self { pair, normal, distance, tolerance: frame.tolerance, limit }
    }

    /// Keeps how the solids lie.
    fn keep_pose(&self, out: &mut RawManifold<N, D>) {
        out.normal = self.normal;
        match self.pair.first {
            Kind::Ball(_) => out.forget_pose(),
            _ => out.pose12 = self.pair.pose12,
        }
    }

    /// Points up to this distance are as deep as the pair, but for rounding.
    fn level(&self) -> N {
        self.distance + self.tolerance
    }

    /// Old points up to this distance stand for the deepest one.
    fn slack(&self) -> N {
        slack_level(
            self.distance,
            smaller_size([self.pair.first, self.pair.second]),
            self.tolerance,
        )
    }
}

/// Old points up to this distance stand for the deepest one, given the distance and the size of the pair.
pub(in crate::collide) fn slack_level<N: Real>(distance: N, size: N, tolerance: N) -> N {
    distance + max(size * N::lit(SLACK), tolerance)
}

/// Replaces the points of a manifold by at most `limit` of the candidates, and at least one. One of the deepest
/// takes the distance of the pair, which it has but for rounding or the slack of an old point.
pub(in crate::collide) fn choose<N: Real, const D: usize>(
    candidates: &mut [Candidate<N, D>],
    nearest: &PointChoice<'_, N, D>,
    out: &mut RawManifold<N, D>,
) {
    let is_renewed =
        candidates.len() <= nearest.limit && ids::renew(candidates, nearest.distance, out);
    if !is_renewed {
        ids::inherit(out, nearest.pair, &nearest.normal, candidates);
        let chosen = chosen(candidates, nearest);
        let deepest = deepest_of(chosen.len(), nearest.level(), |at| {
            let candidate = &candidates[chosen[at]];
            (candidate.is_old(), candidate.distance)
        });
        candidates[chosen[deepest]].distance = nearest.distance;
        ids::settle(candidates, &chosen, out);
    }
    nearest.keep_pose(out);
}

/// The indices of at most `limit` candidates, one of the deepest among them.
#[inline]
fn chosen<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    nearest: &PointChoice<'_, N, D>,
) -> reduce::Indices {
    let limit = nearest.limit.max(1);
    if candidates.len() <= limit {
        return (0..candidates.len()).collect();
    }
    let seen = candidates.iter().map(|c| (c.flat, c.distance, c.is_old()));
    let levels = [nearest.level(), nearest.slack()];
    reduce::chosen(&mut reduce::projected(seen, levels), limit, nearest.tolerance)
}

/// Adds the nearest points, in place of the candidate with the same features if there is one: of round rims and of
/// two faces there may be more.
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

/// The candidate that stands for the witness; see [`deepest_of`].
fn deepest<N: Real, const D: usize>(candidates: &[Candidate<N, D>], limit: N) -> usize {
    deepest_of(candidates.len(), limit, |index| {
        let candidate = &candidates[index];
        (candidate.is_old(), candidate.distance)
    })
}

/// Of candidates whose distance is the smallest but for rounding, at most `limit`, one that the previous
/// manifold held, then the deepest: its index. `what` returns of each whether it was held, and its distance.
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
