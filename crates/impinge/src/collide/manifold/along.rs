//! Contacts of two solids along a given normal. They are used for a face of a surface: its contacts
//! are along the face's normal even where the nearest points have another normal.
//!
//! The supporting features along the normal are clipped as for a separation, but the nearest points
//! need not be among the contacts. If the features do not overlap in projection, there is no
//! contact.

use super::clip;
use super::frame::{Candidates, ContactFrame};
use super::{SegmentPair, tangents3};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, min};
use crate::shape::{Geometry, Kind};
use crate::tables::ByDimension;

/// Request for a manifold along a normal.
#[derive(Clone, Copy)]
pub(crate) struct Along<N, const D: usize>
where
    N: Space<D>,
{
    /// Unit vector from the first solid to the second, in the frame of the first.
    pub(crate) normal: Vector<N, D>,
    /// Lower bound of the signed distance of the solids. A candidate that is nearer by more than
    /// rounding lies below the plane of the face and beside the face, and is dropped.
    pub(crate) least: N,
    /// Largest length that counts as a rounding error for the pair.
    pub(crate) tolerance: N,
}

/// Request for the contacts of two solids along the normal of a face; one of the solids is the
/// face.
pub(crate) struct OnFace<N: Real, const D: usize> {
    /// Normal of the face: unit vector from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// Least distance of a contact point. Points that are nearer by more than rounding are dropped;
    /// the distances of the others are raised to at least `least`.
    pub(crate) least: N,
    /// Signed distance of the solids if `normal` is also the normal of their separation; else
    /// `None`.
    pub(crate) nearest: Option<N>,
    /// Largest distance of a contact point; farther points are dropped.
    pub(crate) prediction: N,
    /// Largest length that counts as a rounding error for the pair.
    pub(crate) tolerance: N,
}

/// Builds the manifold of two convex solids along a normal. It is empty if the supporting features
/// do not overlap in projection, if all points are beyond the prediction or nearer than `least`, if
/// one of the solids is a half-space, or if a supporting feature in 2D is neither a side nor a
/// corner.
pub(crate) fn build_along<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    along: &Along<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) {
    let (Along { normal, least, tolerance }, prediction) = (*along, request.prediction);
    let on_face = OnFace { normal, least, nearest: None, prediction, tolerance };
    <N::Algorithms>::on_face(pair, &on_face, out);
}

/// Builds the manifold of a pair whose separation has the normal of a face of a surface, up to
/// rounding, and the signed distance `distance`. Returns `false` if the caller has to use
/// [`build_between`] instead: in 2D, for a `distance` that is NaN or beyond the prediction, and in
/// the cases that [`on_face3`] lists.
pub(crate) fn build_on_face<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    normal: &Vector<N, D>,
    distance: N,
    tolerance: N,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) -> bool {
    let (normal, nearest, prediction) = (*normal, Some(distance), request.prediction);
    let on_face = OnFace { normal, least: -N::INFINITY, nearest, prediction, tolerance };
    distance <= prediction && <N::Algorithms>::on_face(pair, &on_face, out)
}

/// Builds the manifold of a pair with a known separation, with up to `request.max_points` points.
pub(crate) fn build_between<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) {
    <N::Algorithms>::between(pair, separation, request, out);
}

/// Computes the contacts of two solids in 2D along a normal. Returns `false` if `nearest` is known,
/// because [`build_between`] then gives the contacts. Also returns `false`, without contacts, for
/// half-spaces and if a supporting feature is neither a side nor a corner.
pub(crate) fn on_face2<N: Real>(
    pair: &Pair<'_, N, 2>,
    query: &OnFace<N, 2>,
    out: &mut RawManifold<N, 2>,
) -> bool {
    let OnFace { normal, least, nearest, prediction, tolerance } = *query;
    if nearest.is_some() {
        return false;
    }
    out.points.clear();
    out.normal = normal;
    let sides = SegmentPair { pair: *pair, tolerance, prediction };
    let along = Along { normal, least, tolerance };
    sides.along(&along, |point| out.points.push(point)).is_some()
}

/// Computes the contacts of two solids in 3D along the normal of a face of one of them. Returns
/// `false` for half-spaces. If `nearest` is known, also returns `false` for pairs of kinds that
/// `is_served` excludes, and if no contact is as near as `nearest`, up to the tolerance: then
/// [`build_between`] gives the contacts.
pub(crate) fn on_face3<N: Real>(
    pair: &Pair<'_, N, 3>,
    query: &OnFace<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let OnFace { normal, least, nearest, prediction, tolerance } = *query;
    let is_served = matches!(
        (&pair.first, &pair.second),
        (Kind::Triangle(_), Kind::Cuboid(_) | Kind::Polytope(_))
            | (Kind::Segment(_) | Kind::Capsule(_), Kind::Triangle(_))
    );
    out.points.clear();
    out.normal = normal;
    if nearest.is_some() && !is_served {
        return false;
    }
    let Some(planes) = extremes(pair, &normal, nearest) else { return false };
    let frame = ContactFrame::known(&planes, tangents3(&normal), tolerance, prediction);
    let (mut candidates, mut lowest) = (Candidates::new(), N::INFINITY);
    clip::candidates(pair, &frame, &mut candidates);
    // Candidates nearer than `least` by more than rounding lie beside the face, below its plane.
    candidates.retain(|candidate| candidate.distance >= least - tolerance);
    for candidate in &mut candidates {
        candidate.distance = max(candidate.distance, least);
        lowest = min(candidate.distance, lowest);
    }
    if let Some(nearest) = nearest {
        // `lowest` is infinite without candidates; a NaN is not near.
        let is_reached = lowest <= nearest + tolerance;
        if !is_reached {
            return false;
        }
        if let Some(deepest) = candidates.iter_mut().find(|found| found.distance == lowest) {
            deepest.distance = nearest;
        }
    }
    out.points.extend(candidates.iter().map(|candidate| candidate.with_id(0)));
    true
}

/// Returns the supporting planes of both solids along a normal, as a separation. `point1` is an
/// extreme point of the first solid, and `point2` is opposite to it on the plane of the second
/// solid; it need not be on the second solid. The distance is `nearest` if it is known. `None` with
/// a half-space.
pub(in crate::collide) fn extremes<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    normal: &Vector<N, D>,
    nearest: Option<N>,
) -> Option<Separation<N, D>> {
    let map1 = Geometry(pair.first).as_support_map()?;
    let map2 = Geometry(pair.second).as_support_map()?;
    let point1 = map1.core_support(normal) + normal * map1.rounding();
    let distance = nearest.unwrap_or_else(|| {
        let toward_first = pair.pose12.inverse_vector(&-normal);
        let core2 = pair.pose12.point(&map2.core_support(&toward_first));
        normal.dot(&(core2 - point1)) - map2.rounding()
    });
    Some(Separation { distance, normal: *normal, point1, point2: point1 + normal * distance })
}
