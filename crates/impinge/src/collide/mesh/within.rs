//! Computes the contacts of two shapes, and the distance of a composite's own parts, for a single
//! configuration, without cached data.

use super::part_cache::PartCache;
use super::part_contact::{Arena, PartContact, PartStatus};
use super::scene::Scene;
use super::{
    CompositeContacts, PART_POINTS, PartContacts, Query, gather, has_own_path, middle_of_first,
};
use crate::collide::parts::between::Between;
use crate::collide::{ManifoldRequest, Pair, RawPoint};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector, max, min};
use crate::tables::ByDimension;

/// A contact point of two shapes, in the frame of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FoundContact<N: Real, const D: usize> {
    pub(crate) separation: Separation<N, D>,
    /// Index of the part of the first shape, and of the second; 0 for a convex solid.
    pub(crate) parts: [u32; 2],
}

/// Callback that receives each contact point.
type Visit<'a, N, const D: usize> = dyn FnMut(&FoundContact<N, D>) + 'a;

/// Calls `visit` with each contact point of the parts within `max_distance`, before points are
/// merged into patches: each has the normal of its own parts. Uses the specialised path if
/// [`has_own_path`] returns `true` and the path supports the pair; else the generic path.
pub(crate) fn each_contact_within<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    max_distance: N,
    visit: &mut Visit<'_, N, D>,
) {
    let request =
        ManifoldRequest { prediction: max_distance, sine: N::ZERO, max_points: PART_POINTS };
    if has_own_path(between) {
        let mut cache = CompositeContacts { around: PartCache::for_once(), ..Default::default() };
        let (mut contacts, mut arena) = (PartContacts::new(), Arena::default());
        let out = (&mut contacts, &mut arena);
        if <N::Algorithms>::quick_contacts(&mut cache, between, &request, out).is_some() {
            return each_point(&contacts, &arena, visit);
        }
    }
    each_in_general(between, &request, visit);
}

/// Calls `visit` with each contact point that the generic path finds.
fn each_in_general<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    request: &ManifoldRequest<N>,
    visit: &mut Visit<'_, N, D>,
) {
    let (reference, mut around) = (middle_of_first(between), PartCache::for_once());
    let culled = gather::culled(between, false, request.prediction, &mut around);
    let (around, reference) = (&around, &reference);
    let query = Query { between, is_self: false, around, reference, request };
    let mut arena = Arena::default();
    let contacts = query.part_contacts(request.prediction, &culled, &mut arena);
    each_point(&contacts, &arena, visit);
}

/// Calls `visit` with each point of the contacts that hold.
fn each_point<N: Space<D>, const D: usize>(
    contacts: &[PartContact<N, D>],
    arena: &Arena<N, D>,
    visit: &mut Visit<'_, N, D>,
) {
    for contact in contacts.iter().filter(|contact| contact.status != PartStatus::Left) {
        for point in &arena.points[contact.piece.points.clone()] {
            visit(&FoundContact::new(&contact.piece.normal, point, contact.parts()));
        }
    }
}

impl<N: Real, const D: usize> FoundContact<N, D> {
    /// Converts a contact point into a separation; the second point is `point1 + normal *
    /// distance`.
    fn new(normal: &Vector<N, D>, point: &RawPoint<N, D>, parts: [u32; 2]) -> Self {
        let (normal, RawPoint { distance, point1, .. }) = (*normal, *point);
        let point2 = point1 + normal * distance;
        Self { separation: Separation { distance, normal, point1, point2 }, parts }
    }
}

/// Returns the deepest contact of the parts within `max_distance`, the first in a tie; `None`
/// without a contact.
pub(super) fn deepest_within<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    max_distance: N,
) -> Option<Separation<N, D>> {
    deepest_of(|visit| each_contact_within(between, max_distance, visit))
}

/// Returns the least signed distance of two parts of one composite that are not adjacent; `None` if
/// no such pair is within `limit`. `pair` is the pair of the composite with itself.
pub(crate) fn own_distance<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<N> {
    let between = Between::of_pair(pair);
    let candidates = gather::candidates(&between, true, max(limit, N::ZERO));
    let around = PartCache::for_once();
    let scene = Scene::new(&between, &around);
    let one = |&parts| <N::Algorithms>::separation(&scene.pair(parts).pair(), limit);
    let distances = candidates.iter().filter_map(one).map(|found| found.distance);
    distances.reduce(min)
}

/// Returns the deepest contact by the generic path alone; `None` without a contact.
#[cfg(test)]
pub(super) fn deepest_in_general<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    request: &ManifoldRequest<N>,
) -> Option<Separation<N, D>> {
    deepest_of(|visit| each_in_general(between, request, visit))
}

/// Returns the deepest of the contacts that `each` visits, the first in a tie; `None` without a
/// contact.
fn deepest_of<N: Real, const D: usize>(
    each: impl FnOnce(&mut Visit<'_, N, D>),
) -> Option<Separation<N, D>> {
    let mut deepest: Option<Separation<N, D>> = None;
    each(&mut |FoundContact { separation, .. }| {
        if deepest.is_none_or(|deepest| separation.distance < deepest.distance) {
            deepest = Some(*separation);
        }
    });
    deepest
}
