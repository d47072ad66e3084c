//! The manifold of two solids along a normal that is given, not found: contacts with a face of a
//! surface, whose own edges say nothing.
//!
//! The parts of the solids that face each other along the normal are clipped as ever, but there is
//! no witness that must be among the points: where the parts do not lie above each other, there is
//! no point at all.

use super::facet::{Facet, Which};
use super::frame::Frame;
use super::overlap::{Candidates, Overlap};
use super::triangle_face::OnFace;
use super::{choose, face};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, min};
use crate::query::{ManifoldRequest, Pair, RawManifold};
use crate::shape::Geometry;

/// What a manifold along a given normal is asked for.
#[derive(Clone, Copy)]
pub(in crate::query) struct Along<N, const D: usize>
where
    N: Space<D>,
{
    /// Unit, from the first solid to the second.
    pub(in crate::query) normal: Vector<N, D>,
    /// No two points of the solids are nearer than this: what seems to be by more than rounding is
    /// below the surface of the face and beside it.
    pub(in crate::query) least: N,
    /// Lengths below this are rounding errors of the pair.
    pub(in crate::query) tolerance: N,
}

/// Builds the manifold of two convex solids along a normal; empty if no points face each other along
/// it, or if one of the solids is a half-space.
pub(in crate::query) fn build_along<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    along: &Along<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) {
    let (Along { normal, least, tolerance }, prediction) = (*along, request.prediction);
    let on_face = OnFace { normal, least, nearest: None, prediction, tolerance };
    if request.sine <= N::ZERO && (N::tables().on_face)(pair, &on_face, out) {
        return;
    }
    build_in_general(pair, along, request, out);
}

/// [`build_along`] by facets and their overlap, for all solids.
pub(super) fn build_in_general<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    along: &Along<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) {
    out.normal = along.normal;
    let mut candidates = Candidates::new();
    let tolerance = fill(pair, along, request, &mut candidates);
    candidates.retain(|candidate| candidate.distance >= along.least - tolerance);
    for candidate in &mut candidates {
        candidate.distance = max(candidate.distance, along.least);
    }
    let lowest = candidates.iter().fold(N::INFINITY, |low, c| min(c.distance, low));
    if candidates.is_empty() {
        return out.points.clear();
    }
    choose(&mut candidates, (lowest, tolerance), request.max_points, out);
}

/// The candidates along a normal; answers what counts as rounding.
fn fill<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    along: &Along<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut Candidates<N, D>,
) -> N {
    let Some(witness) = extremes(pair, &along.normal) else { return N::ZERO };
    let frame = frame(pair, &witness, request);
    let (first, second) = facets(pair, &frame);
    let overlap = Overlap { frame: &frame, first: &first, second: &second };
    overlap.candidates(out);
    overlap.candidates_of_points(out);
    frame.tolerance
}

/// The supporting planes of the two solids along a normal, as a witness: its points are the farthest
/// of each solid, and need not face each other. `None` if there is a half-space.
pub(super) fn extremes<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    normal: &Vector<N, D>,
) -> Option<Separation<N, D>> {
    let map1 = Geometry(pair.first).as_support_map()?;
    let map2 = Geometry(pair.second).as_support_map()?;
    let toward_first = pair.pose12.inverse_vector(&-normal);
    let point1 = map1.core_support(normal) + normal * map1.rounding();
    let core2 = pair.pose12.point(&map2.core_support(&toward_first));
    let distance = normal.dot(&(core2 - point1)) - map2.rounding();
    Some(Separation { distance, normal: *normal, point1, point2: point1 + normal * distance })
}

/// Builds the manifold of a pair that is a distance apart along the normal of a face of a surface that is the
/// first solid, or nearly so; answers false where that is left to [`build_between`].
pub(in crate::query) fn build_on_face<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    normal: &Vector<N, D>,
    distance: N,
    tolerance: N,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) -> bool {
    let (normal, nearest, prediction) = (*normal, Some(distance), request.prediction);
    let on_face = OnFace { normal, least: -N::INFINITY, nearest, prediction, tolerance };
    let is_asked = request.sine <= N::ZERO && distance <= prediction;
    is_asked && (N::tables().on_face)(pair, &on_face, out)
}

/// The manifold of a pair whose separation is known, with as many points as are asked for.
pub(in crate::query) fn build_between<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, D>,
) {
    (N::tables().between)(pair, separation, request, out);
}

pub(super) fn frame<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    witness: &Separation<N, D>,
    request: &ManifoldRequest<N>,
) -> Frame<N, D> {
    Frame::new(pair, witness, request, (N::tables().tangents)(&witness.normal))
}

/// What the two solids show of themselves along the normal of a frame.
pub(super) fn facets<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &Frame<N, D>,
) -> (Facet<N, D>, Facet<N, D>) {
    let mut first = Facet::boundary(Which::First);
    let mut second = Facet::boundary(Which::Second);
    face(&mut first, pair.first, None, frame);
    face(&mut second, pair.second, Some(&pair.pose12), frame);
    (first, second)
}
