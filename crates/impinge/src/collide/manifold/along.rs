//! The manifold of two solids along a normal that is given, not found: contacts with a face of a
//! surface, whose own edges say nothing.
//!
//! The supporting features along the normal are clipped as ever, but there is no witness that must be among the
//! points: where the features do not lie above each other, there is no point at all.

use super::clip;
use super::frame::{Candidates, ContactFrame};
use super::{SegmentPair, tangents3};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, min};
use crate::shape::{Geometry, Kind};
use crate::tables::ByDimension;

/// What a manifold along a given normal is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Along<N, const D: usize>
where
    N: Space<D>,
{
    /// Unit, from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// No two points of the solids are nearer than this: what seems to be by more than rounding is
    /// below the surface of the face and beside it.
    pub(crate) least: N,
    /// Lengths below this are rounding errors of the pair.
    pub(crate) tolerance: N,
}

/// What is asked of two solids, one of which is a face of a surface.
pub(crate) struct OnFace<N: Real, const D: usize> {
    /// That of the face, unit, from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// Points nearer than this by more than rounding are left out, others are as near as this.
    pub(crate) least: N,
    /// How near the nearest is, if that is known.
    pub(crate) nearest: Option<N>,
    /// Points farther than this are left out.
    pub(crate) prediction: N,
    /// Lengths below this are rounding errors of the pair.
    pub(crate) tolerance: N,
}

/// Builds the manifold of two convex solids along a normal; empty if no points face each other along
/// it, or if one of the solids is a half-space.
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

/// Builds the manifold of a pair that is a distance apart along the normal of a face of a surface that is one
/// of the solids, or nearly so; returns false where that is left to [`build_between`].
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

/// The manifold of a pair whose separation is known, with as many points as are asked for.
pub(crate) fn build_between<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) {
    <N::Algorithms>::between(pair, separation, request, out);
}

/// The contacts of two solids of the plane along a normal. Where the distance is known the nearest points are,
/// too, and this returns false.
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

/// The contacts of two solids along the normal of a face of one of them. Where the distance is known one has to
/// be that near, else this returns false, as it does of solids whose nearest points are known besides.
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
    candidates.retain(|candidate| candidate.distance >= least - tolerance);
    for candidate in &mut candidates {
        candidate.distance = max(candidate.distance, least);
        lowest = min(candidate.distance, lowest);
    }
    if let Some(nearest) = nearest {
        // Infinite where there is none; NaN is not near.
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

/// The supporting planes of the two solids along a normal, as a witness: its points are the farthest
/// of each solid, and need not face each other. `None` if there is a half-space.
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
