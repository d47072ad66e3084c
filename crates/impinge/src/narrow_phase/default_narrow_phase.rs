//! The narrow phase of a world: its pairs, each with its algorithm and its state.

use core::fmt;
use std::sync::{Arc, OnceLock};

use super::detector::DefaultProximityDispatcher;
use super::entry::{
    Change, ContactEntry, CustomContactEntry, CustomProximityEntry, ProximityEntry,
};
use super::generator::DefaultContactDispatcher;
use super::group::PairKey;
use super::pair_groups::{Carried, GroupId, Location, PairGroups, contact_group, kind_pair};
use super::reuse::{ReuseError, usable_tolerance};
use super::rewind::NarrowHead;
use super::state::ContactState;
use super::traits::{ContactDispatcher, ContactPrediction, ProximityDispatcher};
use super::update::PairChanges;
use super::{ContactEvent, Events, IdAllocator, ObjectTable, PairQuery, ProximityEvent};
use crate::collide::ManifoldRequest;
use crate::journal::Journal;
use crate::math::{Mapped, Space};
use crate::memory::{Recent, clone_fields};
use crate::pairs::PairTable;
use crate::shape::Shape;

/// The narrow phase of a new world: computes the contacts and proximities of its pairs, and keeps
/// them from update to update.
///
/// Pairs of the library's own algorithms are stored in dense arrays: one for each query and each
/// pair of shape kinds, and one for the contacts of all pairs with composites. They are updated in
/// batches, without a virtual call or an allocation for each pair. Pairs of a custom dispatcher are
/// updated one by one. A pair is updated only if one of its objects changed, or if the pair is
/// marked as dirty, as each new pair is.
///
/// ```
/// use impinge::dim3::narrow_phase::DefaultNarrowPhase;
/// use impinge::dim3::world::CollisionWorld;
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// // This is what a new world uses.
/// world.set_narrow_phase(Box::new(DefaultNarrowPhase::new()));
/// world.update();
/// ```
pub struct DefaultNarrowPhase<N: Space<D>, const D: usize> {
    /// Dispatchers, shared with clones.
    pub(super) contact_dispatcher: Arc<dyn ContactDispatcher<N, D>>,
    pub(super) proximity_dispatcher: Arc<dyn ProximityDispatcher<N, D>>,
    /// All pairs. An object is identified by its handle index.
    pub(super) pairs: PairTable,
    /// Location of the state of each pair; parallel to `pairs`.
    pub(super) locations: Vec<Location>,
    pub(super) groups: PairGroups<N, D>,
    /// Maximum relative motion, as a distance, with which a pair reuses its contacts. Unused
    /// without contact reuse.
    pub(super) tolerance: N,
    pub(crate) ids: IdAllocator,
    /// Keys of pairs that were marked dirty since the last update; some of the pairs may be gone.
    pub(super) dirty_pairs: Vec<PairKey>,
    /// Scratch: changes of contact and proximity statuses in one update.
    pub(super) changes: PairChanges,
    pub(super) picked: Vec<Location>,
    /// Indices in `pairs`, sorted by pair; computed on first use after the pairs changed.
    pub(super) order: OnceLock<Vec<u32>>,
    /// Recent lengths of the lists of an update, which decide when memory is released.
    recent: Recent,
    /// Indices in `pairs` of the touching pairs, sorted by pair; computed on first use after the
    /// pairs or their contacts changed.
    pub(super) touching: OnceLock<Vec<u32>>,
    pub(super) journal: Journal<(), NarrowHead>,
}

clone_fields!([N: Space<D>, const D: usize] DefaultNarrowPhase<N, D> {
    contact_dispatcher, proximity_dispatcher, pairs, locations, groups, tolerance, ids, dirty_pairs, changes, picked,
    order, recent, touching, journal,
});

impl<N: Space<D>, const D: usize> Default for DefaultNarrowPhase<N, D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Space<D>, const D: usize> fmt::Debug for DefaultNarrowPhase<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DefaultNarrowPhase")
            .field("pairs", &self.pairs.len())
            .finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Creates a narrow phase without pairs, with the library's own algorithms.
    #[must_use]
    pub fn new() -> Self {
        Self::with_dispatchers(
            Box::new(DefaultContactDispatcher::<D>::new()),
            Box::new(DefaultProximityDispatcher::<D>::new()),
        )
    }

    /// Creates a narrow phase without pairs that gets its algorithms from these dispatchers.
    #[must_use]
    pub fn with_dispatchers(
        contacts: Box<dyn ContactDispatcher<N, D>>,
        proximity: Box<dyn ProximityDispatcher<N, D>>,
    ) -> Self {
        Self {
            contact_dispatcher: contacts.into(),
            proximity_dispatcher: proximity.into(),
            pairs: PairTable::new(),
            locations: Vec::new(),
            groups: PairGroups::default(),
            tolerance: N::ZERO,
            ids: IdAllocator::new(),
            dirty_pairs: Vec::new(),
            changes: PairChanges::new(),
            picked: Vec::new(),
            recent: Recent::default(),
            order: OnceLock::new(),
            touching: OnceLock::new(),
            journal: Journal::default(),
        }
    }

    /// Enables contact reuse with this tolerance; see [`Self::try_reusing`].
    ///
    /// # Panics
    /// If the tolerance is negative or not finite; [`Self::try_reusing`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn reusing(self, tolerance: N) -> Self {
        match self.try_reusing(tolerance) {
            Ok(narrow_phase) => narrow_phase,
            Err(error) => panic!("{error}"),
        }
    }

    /// Returns a narrow phase without pairs and with contact reuse: pairs of the library's own
    /// algorithms keep their contacts while they hardly move.
    ///
    /// As long as no point of the smaller solid has moved farther than `tolerance` relative to the
    /// other solid since the contacts of a pair were last computed, the contact points stay fixed
    /// to the solids. Only their depths are measured again, along the old normal; a pair without
    /// contacts stays without contacts.
    ///
    /// A reused depth differs by at most twice the tolerance from the depth of a query, and
    /// contacts may begin and end late by up to that distance. A manifold may keep points up to
    /// twice the tolerance beyond the prediction, as long as at least one contact of the pair is
    /// within the prediction, or is no farther apart than when the contacts were last computed.
    /// Overlapping solids are never missed, since the motion is also limited by the prediction of
    /// the pair. Ids, features and the order of contacts stay the same.
    ///
    /// A ball against a ball, box, segment or capsule is always computed, since its closed form is
    /// as fast. The results are equal on every machine and for any number of threads, but depend on
    /// earlier positions of the objects.
    ///
    /// Reuse pays off where most pairs move by less than a tenth of the tolerance in a step: a pair
    /// of hulls or cylinders then costs as little as a pair of boxes, and an object on a mesh as
    /// little as an object on a box. It costs 80 bytes for each pair (`f32`, 3D). A good tolerance
    /// is a tenth of the prediction, and a thousandth of the size of an object. This is the contact
    /// recycling of Box2D and Box3D.
    ///
    /// ```
    /// use impinge::dim3::narrow_phase::DefaultNarrowPhase;
    /// use impinge::dim3::world::CollisionWorld;
    ///
    /// let mut world = CollisionWorld::<f32, ()>::new(0.02);
    /// world.set_narrow_phase(Box::new(DefaultNarrowPhase::new().reusing(0.001)));
    /// assert!(DefaultNarrowPhase::<f32>::new().try_reusing(-1.0).is_err());
    /// ```
    ///
    /// # Errors
    /// If the tolerance is negative or not finite.
    pub fn try_reusing(self, tolerance: N) -> Result<Self, ReuseError> {
        let tolerance = usable_tolerance(tolerance)?;
        let Self { contact_dispatcher, proximity_dispatcher, .. } = self;
        let groups = PairGroups::with_references();
        Ok(Self { contact_dispatcher, proximity_dispatcher, groups, tolerance, ..Self::new() })
    }

    /// Updates all pairs, and occasionally releases memory.
    pub(crate) fn step(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        self.recent.note(self.dirty_pairs.len());
        self.update_pairs(table, events);
        if let Some(look) = self.recent.end_update(self.pairs.len()) {
            look.trim(&mut self.dirty_pairs);
            look.trim(&mut self.changes);
            look.trim(&mut self.picked);
            look.fit(&mut self.locations);
            self.pairs.fit(look);
            self.groups.fit(look);
        }
    }

    /// Adds a pair and chooses its algorithm, without a geometric query. Does nothing if the pair
    /// exists.
    pub(crate) fn pair_started(&mut self, table: &ObjectTable<N, D>, first: u32, second: u32) {
        if !self.pairs.insert(first, second).is_new {
            return;
        }
        self.forget_order();
        let (location, _) = self.add_to_group(table, [first, second], Carried::Nothing);
        self.locations.push(location);
    }

    /// Removes a pair, with a final event if it was touching or near. Does nothing if there is no
    /// such pair.
    pub(crate) fn pair_stopped(
        &mut self,
        table: &ObjectTable<N, D>,
        first: u32,
        second: u32,
        events: &mut Events,
    ) {
        let Some(index) = self.pairs.index_of(first, second) else { return };
        let carried = self.remove_from_group(index);
        push_change(table, [first, second], carried.end(), events);
        let removed = self.pairs.remove_at(index);
        self.locations.swap_remove(removed.index);
        self.forget_order();
    }

    /// Returns `true` if the object has at least one pair.
    pub(crate) fn has_pairs(&self, object: u32) -> bool {
        self.pairs.count(object) > 0
    }

    /// Drops the sorted lists, because pairs or their indices have changed.
    pub(super) fn forget_order(&mut self) {
        self.order.take();
        self.touching.take();
    }

    /// Chooses the algorithms of an object's pairs again, after its shape, query type or skin
    /// changed. Contacts keep their ids if the kind of query and the features stay the same.
    pub(crate) fn object_changed(
        &mut self,
        table: &ObjectTable<N, D>,
        object: u32,
        events: &mut Events,
    ) {
        let mut partners: Vec<(u32, usize)> = self.pairs.partners(object).collect();
        // Sorted, because a rewind restores the pairs, but not the order of partners in the table.
        partners.sort_unstable();
        for (_, index) in partners {
            let key = PairKey::from(self.pairs.pairs()[index]);
            if !self.adjust(table, key, index, object) {
                let carried = self.remove_from_group(index);
                let (location, change) = self.add_to_group(table, key, carried);
                self.locations[index] = location;
                push_change(table, key, change, events);
            }
        }
    }

    /// Returns the group of a pair and the maximum number of points of its manifold (0 for a
    /// proximity) if the library's own algorithm serves the pair; else `None`.
    pub(super) fn built_in_group(
        &self,
        table: &ObjectTable<N, D>,
        key: PairKey,
    ) -> Option<(GroupId, usize)> {
        let (a, b) = (table.shape(key[0]).as_ref(), table.shape(key[1]).as_ref());
        match table.query(key[0]).pair(table.query(key[1])) {
            PairQuery::Contacts { .. } => {
                let max_points = self.contact_dispatcher.built_in(a, b)?;
                Some((contact_group(a, b), max_points))
            }
            PairQuery::Proximity { .. } => {
                let built_in = self.proximity_dispatcher.is_built_in(a, b);
                built_in.then(|| (GroupId::Proximity(kind_pair(a, b)), 0))
            }
        }
    }

    /// Keeps the state of a pair if its old and its new algorithm are built in and serve the same
    /// kind of query and, for contacts, either both serve convex solids or both serve composites.
    /// Then updates the request, and moves the state to the group of the new shape kinds. Otherwise
    /// changes nothing and returns `false`.
    fn adjust(
        &mut self,
        table: &ObjectTable<N, D>,
        key: PairKey,
        index: usize,
        object: u32,
    ) -> bool {
        let Some((new_group, max_points)) = self.built_in_group(table, key) else { return false };
        let Location { group, row } = self.locations[index];
        let query = table.query(key[0]).pair(table.query(key[1]));
        match (group, new_group, query) {
            (
                GroupId::Contacts(old),
                GroupId::Contacts(new),
                PairQuery::Contacts { linear, angular },
            ) => {
                let removed = self.groups.contacts.of_mut(old).swap_remove(row);
                self.note_move(removed.moved, row);
                let mut entry = removed.state;
                let linear = table.beyond_skins(key, linear);
                entry.request = ManifoldRequest::new(linear, angular, max_points);
                entry.state.set_solids(shapes(table, key));
                let group = self.groups.contacts.made(new);
                let row = group.push(key, entry, removed.is_touching);
                self.locations[index] = Location { group: new_group, row };
            }
            (GroupId::Composites, GroupId::Composites, PairQuery::Contacts { linear, angular }) => {
                let entry = self.groups.composites.state_mut(row);
                let is_composite = table.shape(object).as_ref().geometry().as_composite().is_some();
                entry.state.forget_shapes(is_composite);
                let linear = table.beyond_skins(key, linear);
                entry.request = ManifoldRequest::new(linear, angular, max_points);
            }
            (GroupId::Proximity(old), GroupId::Proximity(new), PairQuery::Proximity { margin }) => {
                let removed = self.groups.proximity.of_mut(old).swap_remove(row);
                self.note_move(removed.moved, row);
                let entry = ProximityEntry { margin, ..removed.state };
                let row = self.groups.proximity.made(new).push(key, entry, false);
                self.locations[index] = Location { group: new_group, row };
            }
            _ => return false,
        }
        self.groups.mark_dirty(self.locations[index]);
        self.dirty_pairs.push(key);
        true
    }

    /// Chooses an algorithm for a pair, and adds the pair's state to the group of the algorithm.
    /// The status of the pair continues from `carried`. Returns the location of the state, and the
    /// change of the status if there is one.
    fn add_to_group(
        &mut self,
        table: &ObjectTable<N, D>,
        key: PairKey,
        carried: Carried,
    ) -> (Location, Option<Change>) {
        self.dirty_pairs.push(key);
        self.touching.take();
        match table.query(key[0]).pair(table.query(key[1])) {
            PairQuery::Contacts { linear, angular } => {
                self.add_contacts(table, key, carried, linear, angular)
            }
            PairQuery::Proximity { margin } => self.add_proximity(table, key, carried, margin),
        }
    }

    fn add_contacts(
        &mut self,
        table: &ObjectTable<N, D>,
        key: PairKey,
        carried: Carried,
        linear: N,
        angular: N,
    ) -> (Location, Option<Change>) {
        if let Some((group, max_points)) = self.built_in_group(table, key) {
            let (is_touching, change) = carried.into_touching();
            let number = self.ids.allocate();
            let linear = table.beyond_skins(key, linear);
            let request = ManifoldRequest::new(linear, angular, max_points);
            let row = match group {
                GroupId::Contacts(kinds) => {
                    let entry = new_entry(table, key, request, number);
                    self.groups.contacts.made(kinds).push(key, entry, is_touching)
                }
                GroupId::Composites => self.groups.composites.push(
                    key,
                    ContactEntry::new(request, number),
                    is_touching,
                ),
                _ => unreachable!("the query asks for contacts"),
            };
            return (Location { group, row }, change);
        }
        let (a, b) = (table.shape(key[0]).as_ref(), table.shape(key[1]).as_ref());
        let Some(algorithm) = self.contact_dispatcher.get_contact_algorithm(a, b) else {
            return (NOWHERE, carried.end());
        };
        let (is_touching, change) = carried.into_touching();
        let half = angular * N::HALF;
        let prediction = ContactPrediction::new(linear, half, half);
        let entry = CustomContactEntry { algorithm, prediction };
        let row = self.groups.custom_contacts.push(key, entry, is_touching);
        (Location { group: GroupId::CustomContacts, row }, change)
    }

    fn add_proximity(
        &mut self,
        table: &ObjectTable<N, D>,
        key: PairKey,
        carried: Carried,
        margin: N,
    ) -> (Location, Option<Change>) {
        if let Some((group, _)) = self.built_in_group(table, key) {
            let GroupId::Proximity(kinds) = group else {
                unreachable!("the query asks for proximity")
            };
            let (status, change) = carried.into_status();
            let entry = ProximityEntry { margin, status };
            let row = self.groups.proximity.made(kinds).push(key, entry, false);
            return (Location { group, row }, change);
        }
        let (a, b) = (table.shape(key[0]).as_ref(), table.shape(key[1]).as_ref());
        let Some(algorithm) = self.proximity_dispatcher.get_proximity_algorithm(a, b) else {
            return (NOWHERE, carried.end());
        };
        let (status, change) = carried.into_status();
        let entry = CustomProximityEntry { algorithm, margin, status };
        let row = self.groups.custom_proximity.push(key, entry, false);
        (Location { group: GroupId::CustomProximity, row }, change)
    }

    /// Removes the state of the pair at `index` in `pairs` from its group, and returns its status.
    fn remove_from_group(&mut self, index: usize) -> Carried {
        let location = self.locations[index];
        let (carried, moved) = self.groups.take(location);
        self.note_move(moved, location.row);
        carried
    }

    /// Updates the location of the pair that moved to row `row` when another pair was removed from
    /// its group; does nothing if no pair moved.
    fn note_move(&mut self, moved: Option<PairKey>, row: u32) {
        let Some([first, second]) = moved else { return };
        let index = self.pairs.index_of(first, second).expect("every state belongs to a pair");
        self.locations[index].row = row;
    }
}

/// Creates the entry of a new pair of convex solids, with the identifier `number`.
pub(super) fn new_entry<N: Space<D>, const D: usize>(
    table: &ObjectTable<N, D>,
    key: PairKey,
    request: ManifoldRequest<N>,
    number: u64,
) -> ContactEntry<N, ContactState<N, D>> {
    let mut entry = ContactEntry::<N, ContactState<N, D>>::new(request, number);
    entry.state.set_solids(shapes(table, key));
    entry
}

/// Returns the shapes of a pair, in the order of its key.
fn shapes<N: Space<D>, const D: usize>(
    table: &ObjectTable<N, D>,
    key: PairKey,
) -> [&dyn Shape<N, D>; 2] {
    key.mapped(|object| table.shape(object).as_ref())
}

/// The location of a pair without an algorithm.
pub(super) const NOWHERE: Location = Location { group: GroupId::Nothing, row: 0 };

/// Pushes the event of a pair's change, if there is one.
pub(super) fn push_change<N: Space<D>, const D: usize>(
    table: &ObjectTable<N, D>,
    [first, second]: PairKey,
    change: Option<Change>,
    events: &mut Events,
) {
    let (collider1, collider2) = (table.handle(first), table.handle(second));
    match change {
        Some(Change::Contact { touching: true }) => {
            events.push_contact(ContactEvent::Started(collider1, collider2));
        }
        Some(Change::Contact { touching: false }) => {
            events.push_contact(ContactEvent::Stopped(collider1, collider2));
        }
        Some(Change::Proximity(prev_status, new_status)) => {
            let event = ProximityEvent { collider1, collider2, prev_status, new_status };
            events.push_proximity(event);
        }
        None => {}
    }
}
