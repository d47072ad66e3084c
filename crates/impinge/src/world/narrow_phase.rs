//! The interface of a narrow phase to its world: it receives pairs, and returns contacts and
//! proximities.

use super::objects::{Slot, handle_at};
use super::{CollisionObjects, entries};
use crate::math::Space;
use crate::narrow_phase::{
    CollisionObjectHandle, ContactPair, ContactStream, DefaultNarrowPhase, Events, IdAllocator,
    Interaction, ObjectTable, ProximityPair, Views,
};
use crate::query::{ContactManifold, ManifoldView};

/// Pairs with their contacts, in canonical order.
pub type ContactPairs<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ContactPair<'a, N, D>)> + 'a,
>;

/// Pairs with their proximities, in canonical order.
pub type ProximityPairs<'a> =
    Box<dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ProximityPair)> + 'a>;

/// Manifolds with at least one contact, in the canonical order of their pairs.
pub type ContactManifolds<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, &'a ContactManifold<N, D>)>
        + 'a,
>;

/// Manifolds with at least one contact, read in place if possible, in unspecified order.
pub type ContactViews<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ManifoldView<'a, N, D>)>
        + 'a,
>;

/// A part of [`ContactViews`] that one thread reads.
pub type ContactViewPiece<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ManifoldView<'a, N, D>)>
        + Send
        + 'a,
>;

/// Computes contacts and proximities for the pairs that the broad phase proposes.
///
/// In each update a world calls [`Self::handle_interactions`] for objects whose pair with
/// themselves starts or stops, then [`Self::handle_change`] for each object whose shape, query type
/// or skin changed. Then it calls [`Self::handle_interactions`] with the pairs of two objects that
/// started or stopped, and [`Self::update`]. In all calls `handle1 < handle2`, or both are equal
/// for an object that is tested against itself. During a call [`CollisionObjects::table`] has the
/// poses, shapes and query types of the objects in the call, and of all objects with pairs.
///
/// ```
/// use impinge::dim2::narrow_phase::{DefaultNarrowPhase, NarrowPhase};
/// use impinge::dim2::world::CollisionWorld;
///
/// fn exchange(world: &mut CollisionWorld<f32, ()>, narrow_phase: impl NarrowPhase<f32, 2, ()> + Clone + 'static) {
///     world.set_narrow_phase(Box::new(narrow_phase));
/// }
///
/// let mut world = CollisionWorld::new(0.02);
/// exchange(&mut world, DefaultNarrowPhase::new());
/// world.update();
/// ```
pub trait NarrowPhase<N: Space<D>, const D: usize, T>: Send + Sync {
    /// Computes the contacts and proximities of all pairs, and appends the resulting events to
    /// `events`.
    fn update(&mut self, objects: &CollisionObjects<N, D, T>, events: &mut Events);

    /// Computes the contacts or the proximity of a pair between two updates. During this call
    /// [`CollisionObjects::table`] has the present poses of the pair's objects instead of those of
    /// the last update. Appends the resulting events; returns `false` if there is no such pair.
    ///
    /// The default does not support this and returns `false`.
    fn update_pair(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> bool {
        let _ = (events, objects, handle1, handle2);
        false
    }

    /// Starts or stops a pair, without a geometric query. A started pair gets its algorithm;
    /// nothing changes if the pair already exists. A stopped pair is removed, with a final event if
    /// it was touching or near.
    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        started: bool,
    );

    /// Starts (`true`) or stops (`false`) several distinct pairs, in any order; see
    /// [`Self::handle_interaction`].
    fn handle_interactions(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        interactions: &[Interaction],
    ) {
        for &((handle1, handle2), started) in interactions {
            self.handle_interaction(events, objects, handle1, handle2, started);
        }
    }

    /// Stops a pair because one of its objects is being removed. Appends at most one event: the end
    /// of the contact or of the proximity that the pair had at its last computation.
    fn handle_removal(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    );

    /// Chooses the algorithms of an object's pairs again, because the object's shape, query type or
    /// skin has changed.
    fn handle_change(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle: CollisionObjectHandle,
    );

    /// Returns `true` if the narrow phase has a pair of the object. When it returns `false`, the
    /// world releases the object's row in [`CollisionObjects::table`]. A narrow phase that does not
    /// read the table can keep the default, which returns `true`.
    fn has_pairs_of(&self, handle: CollisionObjectHandle) -> bool {
        let _ = handle;
        true
    }

    /// Returns the objects that have a pair with this object, sorted by handle. Includes the object
    /// itself if it is tested against itself.
    ///
    /// The default searches all pairs.
    fn partners_of(
        &self,
        objects: &CollisionObjects<N, D, T>,
        handle: CollisionObjectHandle,
    ) -> Vec<CollisionObjectHandle> {
        let contacts = self.contact_pairs(objects).map(|(first, second, _)| [first, second]);
        let proximities = self.proximity_pairs(objects).map(|(first, second, _)| [first, second]);
        let own = contacts.chain(proximities).filter(|pair| pair.contains(&handle));
        let mut partners: Vec<_> =
            own.map(|[first, second]| if first == handle { second } else { first }).collect();
        partners.sort_unstable();
        partners
    }

    /// Returns the allocator of contact ids. If this narrow phase is replaced, its allocator passes
    /// to the new narrow phase, so that no id is issued twice. `None` (the default) if this narrow
    /// phase has no allocator.
    fn ids(&mut self) -> Option<&mut IdAllocator> {
        None
    }

    /// Returns the contacts of a pair as of the last update; `None` if there is no such pair or its
    /// query is for proximity.
    fn contact_pair<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'a, N, D>>;

    /// Returns the proximity of a pair as of the last update; `None` if there is no such pair or
    /// its query is for contacts.
    fn proximity_pair(
        &self,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair>;

    /// Returns all pairs whose query is for contacts.
    fn contact_pairs<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactPairs<'a, N, D>;

    /// Returns all manifolds with at least one contact, in the canonical order of their pairs.
    fn contact_manifolds<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactManifolds<'a, N, D> {
        Box::new(self.contact_pairs(objects).flat_map(|(handle1, handle2, pair)| {
            pair.manifolds().map(move |manifold| (handle1, handle2, manifold))
        }))
    }

    /// Returns all manifolds with at least one contact, in the order that is fastest to read. This
    /// order is equal on every machine.
    fn contact_views<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactViews<'a, N, D> {
        let manifolds = self.contact_manifolds(objects);
        Box::new(manifolds.filter_map(|(handle1, handle2, manifold)| {
            Some((handle1, handle2, ManifoldView::of_manifold(manifold)?))
        }))
    }

    /// Splits the sequence of [`Self::contact_views`] into consecutive parts: at least one, and at
    /// most `pieces`.
    fn contact_view_pieces<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
        pieces: usize,
    ) -> Vec<ContactViewPiece<'a, N, D>>
    where
        T: Sync,
    {
        let _ = pieces;
        let views: Vec<_> = self.contact_views(objects).collect();
        vec![Box::new(views.into_iter())]
    }

    /// Fills `stream` with the manifolds of [`Self::contact_views`], in their order, without
    /// manifolds of removed objects.
    fn read_contacts(&self, objects: &CollisionObjects<N, D, T>, stream: &mut ContactStream<N, D>) {
        let are_here =
            |first, second| objects.get(first).is_some() && objects.get(second).is_some();
        let views = self.contact_views(objects);
        stream.fill(views.filter(|(first, second, _)| are_here(*first, *second)));
    }

    /// Returns all pairs whose query is for proximity.
    fn proximity_pairs<'a>(&'a self, objects: &'a CollisionObjects<N, D, T>) -> ProximityPairs<'a>;
}

impl<N: Space<D>, const D: usize, T> NarrowPhase<N, D, T> for DefaultNarrowPhase<N, D> {
    fn update(&mut self, objects: &CollisionObjects<N, D, T>, events: &mut Events) {
        self.step(objects.table(), events);
    }

    fn update_pair(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> bool {
        let key = [handle1.index(), handle2.index()];
        entries::update_pair(self, objects.table(), key, events)
    }

    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        started: bool,
    ) {
        let (index1, index2) = (handle1.index(), handle2.index());
        if started {
            entries::pair_started(self, objects.table(), index1, index2);
        } else {
            entries::pair_stopped(self, objects.table(), index1, index2, events);
        }
    }

    fn handle_interactions(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        interactions: &[Interaction],
    ) {
        entries::begin_and_end_pairs(self, objects.table(), interactions, events);
    }

    fn handle_removal(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) {
        let (index1, index2) = (handle1.index(), handle2.index());
        entries::pair_stopped(self, objects.table(), index1, index2, events);
    }

    fn handle_change(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle: CollisionObjectHandle,
    ) {
        entries::object_changed(self, objects.table(), handle.index(), events);
    }

    fn has_pairs_of(&self, handle: CollisionObjectHandle) -> bool {
        self.has_pairs(handle.index())
    }

    fn partners_of(
        &self,
        objects: &CollisionObjects<N, D, T>,
        handle: CollisionObjectHandle,
    ) -> Vec<CollisionObjectHandle> {
        let partners = self.partners(handle.index());
        partners.into_iter().map(|index| handle_at(objects.slots(), index)).collect()
    }

    fn ids(&mut self) -> Option<&mut IdAllocator> {
        Some(&mut self.ids)
    }

    fn contact_pair<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'a, N, D>> {
        Self::contact_pair(self, objects.table(), handle1.index(), handle2.index())
    }

    fn proximity_pair(
        &self,
        _: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair> {
        Self::proximity_pair(self, handle1.index(), handle2.index())
    }

    fn contact_pairs<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactPairs<'a, N, D> {
        let pairs = Self::contact_pairs(self, objects.table());
        Box::new(pairs.map(with_handles(objects.slots())))
    }

    fn contact_manifolds<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactManifolds<'a, N, D> {
        let manifolds = Self::contact_manifolds(self, objects.table());
        Box::new(manifolds.map(with_handles(objects.slots())))
    }

    fn contact_views<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactViews<'a, N, D> {
        entries::contact_views(self, objects.table(), objects.slots())
    }

    fn contact_view_pieces<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
        pieces: usize,
    ) -> Vec<ContactViewPiece<'a, N, D>>
    where
        T: Sync,
    {
        entries::contact_view_pieces(self, objects.table(), objects.slots(), pieces)
    }

    fn read_contacts(&self, objects: &CollisionObjects<N, D, T>, stream: &mut ContactStream<N, D>) {
        entries::read_contacts(self, objects.table(), objects.slots(), stream);
    }

    fn proximity_pairs<'a>(&'a self, objects: &'a CollisionObjects<N, D, T>) -> ProximityPairs<'a> {
        Box::new(Self::proximity_pairs(self).map(with_handles(objects.slots())))
    }
}

/// Implements [`NarrowPhase::contact_views`].
pub(super) fn views_of<'a, N: Space<D>, const D: usize>(
    narrow_phase: &'a DefaultNarrowPhase<N, D>,
    table: &'a ObjectTable<N, D>,
    slots: &'a [Slot],
) -> ContactViews<'a, N, D> {
    views_with_handles(narrow_phase.contact_views(table), slots)
}

/// Implements [`NarrowPhase::contact_view_pieces`].
pub(super) fn view_pieces_of<'a, N: Space<D>, const D: usize>(
    narrow_phase: &'a DefaultNarrowPhase<N, D>,
    table: &'a ObjectTable<N, D>,
    slots: &'a [Slot],
    pieces: usize,
) -> Vec<ContactViewPiece<'a, N, D>> {
    let pieces = narrow_phase.contact_view_pieces(table, pieces);
    pieces.map(|views| views_with_handles(views, slots)).collect()
}

/// Implements [`NarrowPhase::read_contacts`].
pub(super) fn read_all<N: Space<D>, const D: usize>(
    narrow_phase: &DefaultNarrowPhase<N, D>,
    table: &ObjectTable<N, D>,
    slots: &[Slot],
    stream: &mut ContactStream<N, D>,
) {
    let views = narrow_phase.contact_views(table);
    if views.reads_in_place {
        stream.fill(views.in_place(with_handles(slots)));
    } else {
        stream.fill(views.with_built(with_handles(slots)));
    }
}

/// Returns views with the handles of their objects. If all pairs are read in place, the iterator
/// has no branch for built manifolds, because that would slow down reading.
fn views_with_handles<'a, N: Space<D>, const D: usize>(
    views: Views<'a, N, D>,
    slots: &'a [Slot],
) -> ContactViewPiece<'a, N, D> {
    if views.reads_in_place {
        Box::new(views.in_place(with_handles(slots)))
    } else {
        Box::new(views.with_built(with_handles(slots)))
    }
}

/// Returns a function that replaces the handle indices of two present objects by their handles.
fn with_handles<F>(
    slots: &[Slot],
) -> impl Fn((u32, u32, F)) -> (CollisionObjectHandle, CollisionObjectHandle, F) + Copy {
    |(first, second, found)| (handle_at(slots, first), handle_at(slots, second), found)
}
