//! The narrow phase as a world sees it: given pairs, asked for contacts and proximities.

use super::objects::{Slot, handle_at};
use super::{CollisionObjects, entries};
use crate::math::Space;
use crate::narrow_phase::{
    CollisionObjectHandle, ContactPair, DefaultNarrowPhase, Events, IdAllocator, Interaction,
    ObjectTable, ProximityPair, Views,
};
use crate::query::{ContactManifold, ManifoldView};

/// Pairs with their contacts, in canonical order.
pub type ContactPairs<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ContactPair<'a, N, D>)> + 'a,
>;

/// Pairs with their proximities, in canonical order.
pub type ProximityPairs<'a> =
    Box<dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ProximityPair)> + 'a>;

/// Manifolds that hold a contact, in the canonical order of their pairs.
pub type ContactManifolds<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, &'a ContactManifold<N, D>)>
        + 'a,
>;

/// Manifolds that hold a contact, read in place, in no particular order.
pub type ContactViews<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ManifoldView<'a, N, D>)>
        + 'a,
>;

/// The same for one thread of several.
pub type ContactViewPiece<'a, N, const D: usize> = Box<
    dyn Iterator<Item = (CollisionObjectHandle, CollisionObjectHandle, ManifoldView<'a, N, D>)>
        + Send
        + 'a,
>;

/// Exact answers for the pairs that the broad phase proposes.
///
/// A world calls, in each update: [`Self::handle_change`] for each object with another shape or
/// query type, [`Self::handle_interactions`] with the pairs that started or stopped, then
/// [`Self::update`]. In all calls `handle1 < handle2`, except that both are the same for an object that
/// is tested against itself, and [`CollisionObjects::table`] has the poses,
/// shapes and query types that the call is about, and those of all objects with pairs.
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
    /// Computes all contacts and proximities, with the events of what changed.
    fn update(&mut self, objects: &CollisionObjects<N, D, T>, events: &mut Events);

    /// Computes one pair anew between two updates: [`CollisionObjects::table`] has other poses of its two
    /// objects during this call than at the last update. Puts what changed into `events`, and answers whether
    /// there is such a pair.
    ///
    /// The default cannot do it: it answers that there is no pair.
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

    /// A pair started (its algorithm is picked; nothing happens if the pair is known) or stopped (its
    /// algorithm is freed, with the event that the pair is over if it had begun). No geometric query.
    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        started: bool,
    );

    /// Several pairs, each of them once, started (`true`) or stopped: as [`Self::handle_interaction`] of
    /// each, in any order.
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

    /// The pair ends because one of its objects is being removed. What it did at the last update is
    /// over: one event at most.
    fn handle_removal(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    );

    /// The shape or the query type of an object is another one: the algorithms of its pairs are
    /// picked anew.
    fn handle_change(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle: CollisionObjectHandle,
    );

    /// Whether a pair of the object is kept. Once there is none, the world takes back what it lends to the
    /// narrow phase of the object; one that does not use [`CollisionObjects::table`] need not say.
    fn has_pairs_of(&self, handle: CollisionObjectHandle) -> bool {
        let _ = handle;
        true
    }

    /// The objects that have a pair with this one, sorted; itself, if it is tested against itself.
    ///
    /// The default looks at all pairs.
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

    /// Where the names of contacts come from: handed on when another narrow phase takes over, so that
    /// no name is given twice.
    fn ids(&mut self) -> Option<&mut IdAllocator> {
        None
    }

    /// The contacts of a pair, as of the last update; `None` if there is no such pair or it is asked
    /// for proximity only.
    fn contact_pair<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'a, N, D>>;

    /// The proximity of a pair, as of the last update; `None` if there is no such pair or it is asked
    /// for contacts.
    fn proximity_pair(
        &self,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair>;

    /// All pairs that are asked for contacts.
    fn contact_pairs<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactPairs<'a, N, D>;

    /// All manifolds that hold a contact.
    fn contact_manifolds<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactManifolds<'a, N, D> {
        Box::new(self.contact_pairs(objects).flat_map(|(handle1, handle2, pair)| {
            pair.manifolds().map(move |manifold| (handle1, handle2, manifold))
        }))
    }

    /// All manifolds that hold a contact, in whatever order is quickest; the same on every machine.
    fn contact_views<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactViews<'a, N, D> {
        let manifolds = self.contact_manifolds(objects);
        Box::new(manifolds.filter_map(|(handle1, handle2, manifold)| {
            Some((handle1, handle2, ManifoldView::of_manifold(manifold)?))
        }))
    }

    /// What [`Self::contact_views`] gives, in its order, cut into at most so many pieces, at least one.
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

    /// All pairs that are asked for proximity.
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
        Box::new(pairs.map(named(objects.slots())))
    }

    fn contact_manifolds<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactManifolds<'a, N, D> {
        let manifolds = Self::contact_manifolds(self, objects.table());
        Box::new(manifolds.map(named(objects.slots())))
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

    fn proximity_pairs<'a>(&'a self, objects: &'a CollisionObjects<N, D, T>) -> ProximityPairs<'a> {
        Box::new(Self::proximity_pairs(self).map(named(objects.slots())))
    }
}

/// See [`NarrowPhase::contact_views`].
pub(super) fn views_of<'a, N: Space<D>, const D: usize>(
    narrow_phase: &'a DefaultNarrowPhase<N, D>,
    table: &'a ObjectTable<N, D>,
    slots: &'a [Slot],
) -> ContactViews<'a, N, D> {
    named_views(narrow_phase.contact_views(table), slots)
}

/// See [`NarrowPhase::contact_view_pieces`].
pub(super) fn view_pieces_of<'a, N: Space<D>, const D: usize>(
    narrow_phase: &'a DefaultNarrowPhase<N, D>,
    table: &'a ObjectTable<N, D>,
    slots: &'a [Slot],
    pieces: usize,
) -> Vec<ContactViewPiece<'a, N, D>> {
    let pieces = narrow_phase.contact_view_pieces(table, pieces);
    pieces.map(|views| named_views(views, slots)).collect()
}

/// Views with the handles of their objects. Each kind by itself: a chain of both is slower to read.
fn named_views<'a, N: Space<D>, const D: usize>(
    views: Views<'a, N, D>,
    slots: &'a [Slot],
) -> ContactViewPiece<'a, N, D> {
    if views.is_plain {
        Box::new(views.plain(named(slots)))
    } else {
        Box::new(views.particular(named(slots)))
    }
}

/// Turns indices of living objects, and what goes with them, into their handles.
fn named<F>(
    slots: &[Slot],
) -> impl Fn((u32, u32, F)) -> (CollisionObjectHandle, CollisionObjectHandle, F) + Copy {
    |(first, second, found)| (handle_at(slots, first), handle_at(slots, second), found)
}
