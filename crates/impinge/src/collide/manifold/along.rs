//! Manifold of two solids along a normal that is given, not computed: contacts with a face of a
//! surface, whose own edges do not count.
//!
//! The supporting features along the normal are clipped as usual, but no witness has to be among
//! the points. If the features do not overlap in projection, there is no point at all.

use super::clip;
use super::frame::{Candidates, ContactFrame};
use super::{SegmentPair, tangents3};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, min};
use crate::shape::{Geometry, Kind};
use crate::tables::ByDimension;

/// Request for a manifold along a given normal.
#[derive(Clone, Copy)]
pub(crate) struct Along<N, const D: usize>
where
    N: Space<D>,
{
    /// Unit vector from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// No two points of the solids are nearer than this. A candidate that is nearer by more than
    /// rounding is below the surface of the face and beside it.
    pub(crate) least: N,
    /// Lengths below this are rounding errors of the pair.
    pub(crate) tolerance: N,
}

/// Request for the contacts of two solids, one of which is a face of a surface.
pub(crate) struct OnFace<N: Real, const D: usize> {
    /// Normal of the face: unit, from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// Points nearer than this by more than rounding are dropped; others are at least as far as
    /// this.
    pub(crate) least: N,
    /// The least distance, if it is known.
    pub(crate) nearest: Option<N>,
    /// Points farther than this are dropped.
    pub(crate) prediction: N,
    /// Lengths below this are rounding errors of the pair.
    pub(crate) tolerance: N,
}

/// Builds the manifold of two convex solids along a normal; empty if no points lie across from each
/// other along it, or if one of the solids is a half-space.
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

/// Builds the manifold of a pair that is at `distance` along the normal of a face of a surface, up
/// to rounding; returns `false` if [`build_between`] has to build it.
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

/// Computes the contacts of two solids in 2D along a normal. Returns `false` if the distance is
/// known: then the nearest points are known, too.
pub(crate) fn on_face2<N: Real>(
    pair: &Pair<'_, N, 2>,
    asked: &OnFace<N, 2>,
    out: &mut RawManifold<N, 2>,
) -> bool {
    let OnFace { normal, least, nearest, prediction, tolerance } = *asked;
    if nearest.is_some() {
        return false;
    }
    out.points.clear();
    out.normal = normal;
    let sides = SegmentPair { pair: *pair, tolerance, prediction };
    let along = Along { normal, least, tolerance };
    sides.along(&along, |point| out.points.push(point)).is_some()
}

/// Computes the contacts of two solids along the normal of a face of one of them. If the distance
/// is known, a contact must have it; else this returns `false`, as for solids with known nearest
/// points.
pub(crate) fn on_face3<N: Real>(
    pair: &Pair<'_, N, 3>,
    asked: &OnFace<N, 3>,
    out: &mut RawManifold<N, 3>,
) -> bool {
    let OnFace { normal, least, nearest, prediction, tolerance } = *asked;
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
    // Below the surface of the face and beside it.
    candidates.retain(|candidate| candidate.distance >= least - tolerance);
    for candidate in &mut candidates {
        candidate.distance = max(candidate.distance, least);
        lowest = min(candidate.distance, lowest);
    }
    if let Some(nearest) = nearest {
        // Infinite if there is none; NaN is not near.
        let is_reached = lowest <= nearest + tolerance;
        if !is_reached {
            return false;
        }
        if let Some(deepest) = candidates.iter_mut().find(|found| found.distance == lowest) {
            deepest.distance = nearest;
        }
    }
    out.points.extend(candidates.iter().map(|candidate| candidate.named(0)));
    true
}

/// Returns the supporting planes of both solids along a normal, as a witness: its points are the
/// farthest of each solid and need not lie across from each other. `None` with a half-space.
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
