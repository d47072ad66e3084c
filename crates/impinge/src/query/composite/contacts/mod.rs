//! Contacts of composites: those of the parts, as the whole has them.
//!
//! For every two parts within reach [`facts`] finds their separation and asks the surfaces, if there
//! are any, whether the normal is one that the whole has there ([`judge`]): if it is that of a seam,
//! only contacts with the face of the part count. [`resolve`] drops those that another contact
//! explains, and makes sure that solids that overlap have a contact. What is left is merged into flat
//! patches.
//!
//! The classes of normals at a seam are those of Catto's chain shapes (Box2D, 2023), whose edges know
//! their neighbours.

mod candidates;
mod facts;
mod judge;
mod resolve;
mod scene;
mod view;

use self::facts::{Finding, Reference, Standing};
use self::scene::Scene;
use crate::bounding_volume::Ray;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Space, Vector, max};
use crate::query::manifold_build::{Merging, Patch, merge};
use crate::query::pair::{Placed, canonical};
use crate::query::{ManifoldRequest, Pair, PairIds};
use crate::shape::Geometry;

/// So many points of two parts are kept before they are merged with those of others: all that two
/// facets of usual solids have.
const PART_POINTS: usize = 16;

/// The contacts of two shapes of which one at least is a composite, kept from update to update; in
/// the frame of the first.
#[derive(Clone, Debug, Default)]
pub(crate) struct CompositeContacts<N: Real, const D: usize> {
    patches: Vec<Patch<N, D>>,
    ids: PairIds,
    /// In the frame of the second shape, where the middle of the first was when it was last seen on
    /// the side of the surface that it came from: a solid that was pushed halfway through a surface
    /// with two sides, or jumped there, is still on its old side.
    reference: Reference<N, D>,
}

impl<N: Real, const D: usize> CompositeContacts<N, D> {
    /// How many contact points there are.
    pub(crate) fn len(&self) -> usize {
        self.patches.iter().map(|patch| patch.points.len()).sum()
    }

    /// The two shapes change places.
    pub(crate) fn flip_names(&mut self) {
        self.reference = None;
        for point in self.patches.iter_mut().flat_map(|patch| &mut patch.points) {
            point.parts.reverse();
            core::mem::swap(&mut point.raw.feature1, &mut point.raw.feature2);
        }
    }
}

impl<N: Space<D>, const D: usize> CompositeContacts<N, D> {
    /// Computes the contacts for a new pose, of two shapes or of one with itself; points whose parts
    /// and features stay keep their numbers.
    pub(crate) fn update(
        &mut self,
        pair: &Pair<'_, N, D>,
        is_self: bool,
        request: &ManifoldRequest<N>,
    ) {
        let center = middle_of_first(pair);
        let reference = center.map(|center| advanced(pair, self.reference, center));
        let query = Query { pair, is_self, reference: &reference, request };
        let findings = query.findings();
        let overlaps = findings.iter().any(|finding| finding.distance <= N::ZERO);
        self.reference = if overlaps { reference } else { center };
        let tolerance = findings.iter().fold(N::ZERO, |most, found| max(most, found.tolerance));
        let pieces = findings.into_iter().filter(|found| found.standing != Standing::Left);
        let pieces = pieces.map(|finding| finding.patch).collect();
        let merging = Merging { request, tolerance, old: &self.patches };
        self.patches = merge(pieces, &merging, &mut self.ids);
    }
}

/// The middle of a convex first shape, in the frame of the second.
fn middle_of_first<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> Option<Point<N, D>> {
    let map = Geometry(pair.first).as_support_map()?;
    Some(pair.pose12.inverse_point(&map.center()))
}

/// Where the middle of the first shape counts as being: where it is, unless the straight way there
/// from where it was leads through the surface and is no longer than the shape is.
fn advanced<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    old: Reference<N, D>,
    center: Point<N, D>,
) -> Point<N, D> {
    let composite = Geometry(pair.second).as_composite();
    let composite = composite.filter(|composite| composite.surface().is_some());
    let map = Geometry(pair.first).as_support_map();
    let (Some(old), Some(composite), Some(map)) = (old, composite, map) else { return center };
    let way = center - old;
    if way == Vector::<N, D>::zeros() || way.norm() > N::TWO * (map.reach() + map.rounding()) {
        return center;
    }
    let hit = super::first_hit(composite, &Ray::new(old, way), false);
    if hit.is_some_and(|hit| hit.toi <= N::ONE) { old } else { center }
}

/// What is asked of a pair.
struct Query<'a, N: Real, const D: usize> {
    pair: &'a Pair<'a, N, D>,
    is_self: bool,
    reference: &'a Reference<N, D>,
    request: &'a ManifoldRequest<N>,
}

impl<N: Space<D>, const D: usize> Query<'_, N, D> {
    /// What the parts say, in the frame of the first shape; which of it holds is settled.
    fn findings(&self) -> Vec<Finding<N, D>> {
        let request = self.of_parts();
        let reach = request.prediction;
        let candidates = candidates::candidates(self.pair, self.is_self, reach);
        let scene = Scene::new(self.pair, &candidates::middle(self.pair, &candidates));
        let one = |&parts| facts::finding(&scene, parts, self.reference, &request);
        let mut findings: Vec<_> = candidates.iter().filter_map(one).collect();
        resolve::resolve(&scene, &mut findings);
        for point in findings.iter_mut().flat_map(|finding| &mut finding.patch.points) {
            point.raw.point1 += scene.first.origin;
        }
        findings
    }

    /// What is asked of two parts: of points that turning brings near, the nearest point may lie on
    /// another part, so that is looked at when all are known.
    fn of_parts(&self) -> ManifoldRequest<N> {
        let map = Geometry(self.pair.first).as_support_map();
        let size = map.map_or(N::ZERO, |map| N::TWO * (map.reach() + map.rounding()));
        let ManifoldRequest { prediction, sine, .. } = *self.request;
        let prediction = prediction + sine * size;
        ManifoldRequest { prediction, sine: N::ZERO, max_points: PART_POINTS }
    }
}

/// The contact of two placed shapes in the world frame, `None` beyond `limit`: the deepest of what
/// manifolds are made of.
pub(crate) fn contact_in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let is_composite = |placed: &Placed<'_, N, D>| placed.shape.as_composite().is_some();
    if !is_composite(placed1) && !is_composite(placed2) {
        return (N::tables().separation_in_world)(placed1, placed2, limit);
    }
    let (pair, is_swapped) = canonical(&placed1.pose, placed1.shape, &placed2.pose, placed2.shape);
    if !pair.pose12.is_finite() {
        return None;
    }
    let found = deepest(&pair, limit)?;
    let first = if is_swapped { &placed2.pose } else { &placed1.pose };
    Some(in_world(&found, first, is_swapped))
}

fn in_world<N: Real, const D: usize>(
    found: &Separation<N, D>,
    first: &Pose<N, D>,
    is_swapped: bool,
) -> Separation<N, D> {
    let distance = found.distance;
    let (normal, point1, point2) =
        (first.vector(&found.normal), first.point(&found.point1), first.point(&found.point2));
    if is_swapped {
        return Separation { distance, normal: -normal, point1: point2, point2: point1 };
    }
    Separation { distance, normal, point1, point2 }
}

/// The deepest contact of a pair. Of shapes that are apart only the parts as near as the nearest
/// are looked at, unless that is one that cannot be touched.
fn deepest<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let nearest = (N::tables().separation)(pair, limit)?;
    let reach = max(nearest.distance, N::ZERO);
    let reach = reach + N::lit(64.0) * N::EPSILON * reach;
    let found = deepest_within(pair, reach).or_else(|| deepest_within(pair, max(limit, N::ZERO)));
    found.filter(|found| found.distance <= limit)
}

fn deepest_within<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    reach: N,
) -> Option<Separation<N, D>> {
    let request = ManifoldRequest { prediction: reach, sine: N::ZERO, max_points: PART_POINTS };
    let reference = middle_of_first(pair);
    let query = Query { pair, is_self: false, reference: &reference, request: &request };
    let findings = query.findings();
    let kept = findings.iter().filter(|finding| finding.standing != Standing::Left);
    let points = kept.flat_map(|finding| {
        let normal = finding.patch.normal;
        finding.patch.points.iter().map(move |point| (normal, point.raw))
    });
    let deepest = points.reduce(|a, b| if b.1.distance < a.1.distance { b } else { a });
    deepest.map(|(normal, point)| {
        let (distance, point1) = (point.distance, point.point1);
        Separation { distance, normal, point1, point2: point1 + normal * distance }
    })
}

/// How far two shapes are apart, or the parts of one that do not hang together; negative where they
/// overlap, `None` beyond `limit`.
pub(crate) fn distance_within<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    is_self: bool,
    limit: N,
) -> Option<N> {
    if !is_self {
        return (N::tables().separation)(pair, limit).map(|found| found.distance);
    }
    let candidates = candidates::candidates(pair, true, max(limit, N::ZERO));
    let scene = Scene::new(pair, &candidates::middle(pair, &candidates));
    let one = |&parts| (N::tables().separation)(&scene.pair(parts).pair(), limit);
    let distances = candidates.iter().filter_map(one).map(|found| found.distance);
    distances.reduce(crate::math::min)
}
