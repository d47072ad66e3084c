//! The contacts of two shapes at one time, without a cache.

use super::part_cache::PartCache;
use super::part_contact::{Arena, PartStatus};
use super::{CompositeContacts, PART_POINTS, Query, gather, has_own_way, middle_of_first};
use crate::collide::parts::between::Between;
use crate::collide::{ManifoldRequest, RawPoint};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector};
use crate::tables::ByDimension;

/// A contact of two shapes in the frame of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FoundContact<N: Real, const D: usize> {
    pub(crate) separation: Separation<N, D>,
    /// The part of the first shape and of the second; 0 for a convex solid.
    pub(crate) parts: [u32; 2],
}

/// Receives each contact.
type Visit<'a, N, const D: usize> = dyn FnMut(&FoundContact<N, D>) + 'a;

/// Calls `visit` with each contact of the parts within `reach`, by the kernel of the pair if there
/// is one.
pub(crate) fn each_contact_within<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    reach: N,
    visit: &mut Visit<'_, N, D>,
) {
    let request = ManifoldRequest { prediction: reach, sine: N::ZERO, max_points: PART_POINTS };
    if has_own_way(between) {
        let mut contacts =
            CompositeContacts { around: PartCache::for_once(), ..Default::default() };
        if <N::Algorithms>::update_quickly(&mut contacts, between, &request) {
            for patch in contacts.patches() {
                for point in &patch.points {
                    visit(&FoundContact::new(&patch.normal, &point.raw, point.parts));
                }
            }
            return;
        }
    }
    each_in_general(between, &request, visit);
}

/// [`each_contact_within`] by the generic path.
fn each_in_general<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    request: &ManifoldRequest<N>,
    visit: &mut Visit<'_, N, D>,
) {
    let (reference, mut around) = (middle_of_first(between), PartCache::for_once());
    let nearby = gather::nearby(between, false, request.prediction, &mut around);
    let (around, reference) = (&around, &reference);
    let query = Query { between, is_self: false, around, reference, request };
    let mut arena = Arena::default();
    let contacts = query.part_contacts(request.prediction, &nearby, &mut arena);
    for contact in contacts.iter().filter(|contact| contact.status != PartStatus::Left) {
        for point in &arena.points[contact.piece.points.clone()] {
            visit(&FoundContact::new(&contact.piece.normal, point, contact.parts()));
        }
    }
}

impl<N: Real, const D: usize> FoundContact<N, D> {
    /// Makes a separation of a contact point; the second point follows from the first by `normal *
    /// distance`.
    fn new(normal: &Vector<N, D>, point: &RawPoint<N, D>, parts: [u32; 2]) -> Self {
        let (normal, RawPoint { distance, point1, .. }) = (*normal, *point);
        let point2 = point1 + normal * distance;
        Self { separation: Separation { distance, normal, point1, point2 }, parts }
    }
}

/// Returns the deepest contact of the parts within `reach`, the first in a tie.
pub(super) fn deepest_within<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    reach: N,
) -> Option<Separation<N, D>> {
    deepest_of(|visit| each_contact_within(between, reach, visit))
}

/// [`deepest_within`] by the generic path alone.
#[cfg(test)]
pub(super) fn deepest_in_general<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    request: &ManifoldRequest<N>,
) -> Option<Separation<N, D>> {
    deepest_of(|visit| each_in_general(between, request, visit))
}

/// Returns the deepest of the contacts that `each` visits, the first in a tie.
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
