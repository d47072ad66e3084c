//! The update of all pairs: selects the pairs that need a new query, and computes them in batches.

use crate::tables::ByDimension;
use crate::tables::entries;
use smallvec::SmallVec;

use super::ahead::update_due;
use super::default_narrow_phase::push_change;
use super::due::{ContactRows, DueContacts};
use super::entry::{Change, ContactEntry, ContactView, ProximityEntry, posed};
use super::group::{CHUNK, Group, PairKey, Rows};
use super::lanes::{ContactGroup, Lane, Location};
use super::reuse::{Reference, Reuse};
use super::rewind::Parts;
use super::state::KeptContacts;
use super::{DefaultNarrowPhase, Events, ObjectTable};
use crate::collide::Solid;
use crate::math::Space;

/// If fewer than one in `SPARSE` pairs must be updated, they are found by their changed objects
/// instead of by a scan of all pairs.
const SPARSE: usize = 8;

/// Indices of pairs within a chunk.
type LanePlaces = SmallVec<[usize; CHUNK]>;

/// Changes of an update, with their pairs.
pub(super) type PairChanges = Vec<(PairKey, Change)>;

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Updates all pairs to the rows of the table, and pushes the events.
    pub(crate) fn update_pairs(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        entries::update_pairs(self, table, events);
    }

    /// [`Self::update_pairs`], compiled in this crate.
    pub(crate) fn update_pairs_here(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        let due = core::mem::take(&mut self.due);
        let mut changes = core::mem::take(&mut self.changes);
        if self.is_sparse(table, due.len()) {
            self.update_some(table, &due, &mut changes);
        } else {
            self.update_all(table, &mut changes);
        }
        self.report(table, changes, events);
        self.due = due;
        self.due.clear();
    }

    /// Updates one pair to the rows of the table, and pushes its event. Returns `false` if there is
    /// no such pair.
    pub(crate) fn update_pair(
        &mut self,
        table: &ObjectTable<N, D>,
        [first, second]: PairKey,
        events: &mut Events,
    ) -> bool {
        let Some(index) = self.pairs.index_of(first, second) else { return false };
        let mut changes = core::mem::take(&mut self.changes);
        self.update_picked(table, &[self.locations[index]], &mut changes);
        self.report(table, changes, events);
        true
    }

    /// Pushes the events of `changes`, and keeps the memory of the list.
    fn report(&mut self, table: &ObjectTable<N, D>, mut changes: PairChanges, events: &mut Events) {
        if changes.iter().any(|(_, change)| matches!(change, Change::Contact { .. })) {
            self.touching.take();
        }
        for (key, change) in changes.drain(..) {
            push_change(table, key, Some(change), events);
        }
        self.changes = changes;
    }

    /// Returns `true` if few pairs need an update: the pairs of changed objects, and `more` others.
    fn is_sparse(&self, table: &ObjectTable<N, D>, more: usize) -> bool {
        let mut affected = more;
        table.changed().iter().all(|&row| {
            affected += self.pairs.count(row);
            affected * SPARSE < self.pairs.len()
        }) && affected * SPARSE < self.pairs.len()
    }

    /// Updates all pairs by scanning group after group.
    fn update_all(&mut self, table: &ObjectTable<N, D>, changes: &mut PairChanges) {
        if self.journal.is_on() {
            self.lanes.note_due(table);
        }
        let reuse = Reuse { table, tolerance: self.tolerance };
        let is_used = |group: &&mut ContactGroup<N, D>| !group.is_empty();
        for group in self.lanes.contacts.all_mut().iter_mut().filter(is_used) {
            let solids = group.state(0).state.solids().copied();
            update_group(group, changes, |rows, changes| {
                update_convex(rows, reuse, changes, solids.as_ref());
            });
        }
        update_group(&mut self.lanes.composites, changes, |mut rows, changes| {
            let mut due = rows.take_all_due(table);
            if !rows.references.is_empty() {
                due.retain(|place| !reuse.keeps(&mut rows, place));
            }
            update_due(&mut rows, table, due, |rows, place| {
                compute_contact(rows, table, place, changes);
                reuse.note(rows, place);
            });
        });
        for group in self.lanes.proximity.all_mut() {
            update_group(group, changes, |rows, changes| {
                update_each(rows, table, changes, update_status);
            });
        }
        self.update_all_custom(table, changes);
    }

    /// Updates pairs with custom algorithms one by one, since they share one allocator of ids.
    fn update_all_custom(&mut self, table: &ObjectTable<N, D>, changes: &mut PairChanges) {
        for place in 0..self.lanes.custom_contacts.keys().len() {
            if self.lanes.custom_contacts.rows().take_due(place, table) {
                self.update_custom_contact(table, place, changes);
            }
        }
        for place in 0..self.lanes.custom_proximity.keys().len() {
            if self.lanes.custom_proximity.rows().take_due(place, table) {
                self.update_custom_proximity(table, place, changes);
            }
        }
    }

    fn update_custom_contact(
        &mut self,
        table: &ObjectTable<N, D>,
        place: usize,
        changes: &mut PairChanges,
    ) {
        let mut rows = self.lanes.custom_contacts.rows();
        let (key, entry, _) = rows.row(place);
        let is_touching = entry.update(&*self.contact_dispatcher, table, key, &mut self.ids);
        note_touching(&mut rows, place, is_touching, changes);
    }

    fn update_custom_proximity(
        &mut self,
        table: &ObjectTable<N, D>,
        place: usize,
        changes: &mut PairChanges,
    ) {
        let mut rows = self.lanes.custom_proximity.rows();
        let (key, entry, _) = rows.row(place);
        let change = entry.update(&*self.proximity_dispatcher, table, key);
        changes.extend(change.map(|change| (key, change)));
    }

    /// Updates the pairs of changed objects, and the pairs marked as due.
    fn update_some(
        &mut self,
        table: &ObjectTable<N, D>,
        due: &[PairKey],
        changes: &mut PairChanges,
    ) {
        let mut picked = core::mem::take(&mut self.picked);
        self.pick(table, due, &mut picked);
        for picked in picked.chunk_by(|one, other| one.lane == other.lane) {
            self.update_picked(table, picked, changes);
        }
        picked.clear();
        self.picked = picked;
    }

    /// Lists the locations of the pairs of changed objects and of pairs marked as due, each once,
    /// sorted by group and index.
    fn pick(&self, table: &ObjectTable<N, D>, due: &[PairKey], picked: &mut Vec<Location>) {
        for &row in table.changed() {
            // A pair of two changed objects is listed for the smaller index only.
            let mine = |partner: u32| !(table.has_changed(partner) && partner < row);
            let partners = self.pairs.partners(row).filter(|(partner, _)| mine(*partner));
            picked.extend(partners.map(|(_, index)| self.locations[index]));
        }
        let still = |&&[a, b]: &&PairKey| !table.has_changed(a) && !table.has_changed(b);
        let due = due.iter().filter(still).filter_map(|&[a, b]| self.pairs.index_of(a, b));
        picked.extend(due.map(|index| self.locations[index]));
        picked.sort_unstable();
        picked.dedup();
    }

    /// Updates some pairs, which are all in the same group.
    fn update_picked(
        &mut self,
        table: &ObjectTable<N, D>,
        picked: &[Location],
        changes: &mut PairChanges,
    ) {
        if self.journal.is_on() {
            self.lanes.note(picked);
        }
        let reuse = Reuse { table, tolerance: self.tolerance };
        match picked[0].lane {
            Lane::Contacts(group) => {
                let rows = self.lanes.contacts.of_mut(group).rows();
                update_picked_convex(rows, reuse, picked, changes);
            }
            Lane::Composites => {
                let rows = &mut self.lanes.composites.rows();
                update_places(rows, picked, |rows, place| {
                    update_contact(rows, reuse, place, changes);
                });
            }
            Lane::Proximity(group) => {
                let rows = &mut self.lanes.proximity.of_mut(group).rows();
                update_places(rows, picked, |rows, place| {
                    update_status(rows, table, place, changes);
                });
            }
            Lane::CustomContacts => {
                for place in picked.iter().map(|at| at.place as usize) {
                    self.lanes.custom_contacts.rows().take_mark(place);
                    self.update_custom_contact(table, place, changes);
                }
            }
            Lane::CustomProximity => {
                for place in picked.iter().map(|at| at.place as usize) {
                    self.lanes.custom_proximity.rows().take_mark(place);
                    self.update_custom_proximity(table, place, changes);
                }
            }
            Lane::Nothing => {}
        }
    }
}

/// Sets whether a pair touches, and lists the change if there is one.
#[inline]
pub(super) fn note_touching<S, V, R>(
    rows: &mut Rows<'_, S, V, R>,
    index: usize,
    is_touching: bool,
    changes: &mut PairChanges,
) {
    if rows.set_touching(index, is_touching) {
        changes.push((rows.keys[index], Change::Contact { touching: is_touching }));
    }
}

/// Updates the contacts of a chunk of pairs of convex solids, in SIMD lanes if their kinds have a
/// kernel. `solids` are the copies in one of the pairs; if one pair of a group has copies, all
/// have.
fn update_convex<N: Space<D>, const D: usize>(
    mut rows: ContactRows<'_, N, D>,
    reuse: Reuse<'_, N, D>,
    changes: &mut PairChanges,
    solids: Option<&[Solid<N, D>; 2]>,
) {
    let mut due = rows.take_all_due(reuse.table);
    let may_keep = !(rows.references.is_empty() || has_ball(solids));
    if may_keep {
        due.retain(|place| !reuse.keeps(&mut rows, place));
    }
    let places: LanePlaces = due.indices().collect();
    compute_convex(&mut rows, reuse.table, &places, solids, changes);
    if may_keep {
        places.iter().for_each(|&place| reuse.note(&mut rows, place));
    }
}

/// Returns `true` if a solid is a ball. Pairs with a ball do not reuse contacts, because their
/// closed forms are as fast.
fn has_ball<N: Space<D>, const D: usize>(solids: Option<&[Solid<N, D>; 2]>) -> bool {
    solids.is_some_and(|solids| solids.iter().any(|solid| matches!(solid, Solid::Ball(_))))
}

/// Computes the contacts of the pairs at the given indices of a chunk.
fn compute_convex<N: Space<D>, const D: usize>(
    rows: &mut ContactRows<'_, N, D>,
    table: &ObjectTable<N, D>,
    places: &[usize],
    solids: Option<&[Solid<N, D>; 2]>,
    changes: &mut PairChanges,
) {
    let is_done = solids.is_some_and(|[solid1, solid2]| {
        let changes = &mut *changes;
        let mut due = DueContacts { rows: rows.reborrow(), places, table, changes };
        <N::Algorithms>::update_lanes([solid1, solid2], &mut due)
    });
    if !is_done {
        places.iter().for_each(|&place| compute_contact(rows, table, place, changes));
    }
}

/// Updates the contacts of the picked pairs of convex solids.
fn update_picked_convex<N: Space<D>, const D: usize>(
    mut rows: ContactRows<'_, N, D>,
    reuse: Reuse<'_, N, D>,
    picked: &[Location],
    changes: &mut PairChanges,
) {
    let first = picked[0].place as usize;
    let solids = rows.states[first].state.solids().copied();
    let may_keep = !has_ball(solids.as_ref());
    for picked in picked.chunks(CHUNK) {
        let mut places: LanePlaces = picked.iter().map(|at| at.place as usize).collect();
        for &place in &places {
            rows.take_mark(place);
        }
        places.retain(|place| !(may_keep && reuse.keeps(&mut rows, *place)));
        compute_convex(&mut rows, reuse.table, &places, solids.as_ref(), changes);
        if may_keep {
            places.iter().for_each(|&place| reuse.note(&mut rows, place));
        }
    }
}

/// Updates the picked pairs of any other group, one by one.
fn update_places<S, V, R>(
    rows: &mut Rows<'_, S, V, R>,
    picked: &[Location],
    mut update: impl FnMut(&mut Rows<'_, S, V, R>, usize),
) {
    for at in picked {
        rows.take_mark(at.place as usize);
        update(rows, at.place as usize);
    }
}

/// Updates the contacts of one pair.
fn update_contact<N: Space<D>, S: KeptContacts<N, D>, const D: usize>(
    rows: &mut Rows<'_, ContactEntry<N, S>, ContactView<S::Manifolds>, Reference<N, D>>,
    reuse: Reuse<'_, N, D>,
    place: usize,
    changes: &mut PairChanges,
) {
    if !reuse.keeps(rows, place) {
        compute_contact(rows, reuse.table, place, changes);
        reuse.note(rows, place);
    }
}

/// Computes the contacts of one pair.
fn compute_contact<N: Space<D>, S: KeptContacts<N, D>, const D: usize>(
    rows: &mut Rows<'_, ContactEntry<N, S>, ContactView<S::Manifolds>, Reference<N, D>>,
    table: &ObjectTable<N, D>,
    place: usize,
    changes: &mut PairChanges,
) {
    let (key, entry, view) = rows.row(place);
    let is_touching = entry.update(view, &posed(table, key));
    note_touching(rows, place, is_touching, changes);
}

/// Updates the proximity of one pair.
fn update_status<N: Space<D>, const D: usize>(
    rows: &mut Rows<'_, ProximityEntry<N>, ()>,
    table: &ObjectTable<N, D>,
    place: usize,
    changes: &mut PairChanges,
) {
    let (key, entry, _) = rows.row(place);
    let change = entry.update(&posed(table, key));
    changes.extend(change.map(|change| (key, change)));
}

/// Updates the pairs of a group chunk by chunk; with the feature `parallel` on several threads. In
/// either case changes are listed in the order of the group.
fn update_group<
    S: Parts + Send + Sync,
    V: Default + Send + Sync,
    R: Clone + Default + Send + Sync,
>(
    group: &mut Group<S, V, R>,
    changes: &mut PairChanges,
    update: impl Fn(Rows<'_, S, V, R>, &mut PairChanges) + Sync,
) {
    let rows = group.rows();
    #[cfg(feature = "parallel")]
    if rows.len() >= 2 * CHUNK {
        use rayon::prelude::*;
        let chunks: Vec<_> = rows.chunks().collect();
        let chunk = |rows| {
            let mut changes = PairChanges::new();
            update(rows, &mut changes);
            changes
        };
        let results: Vec<PairChanges> = chunks.into_par_iter().map(chunk).collect();
        changes.extend(results.into_iter().flatten());
        return;
    }
    for rows in rows.chunks() {
        update(rows, changes);
    }
}

/// Updates the pairs of a chunk that need a new query, one by one.
fn update_each<N: Space<D>, S, V, R, const D: usize>(
    mut rows: Rows<'_, S, V, R>,
    table: &ObjectTable<N, D>,
    changes: &mut PairChanges,
    update: impl Fn(&mut Rows<'_, S, V, R>, &ObjectTable<N, D>, usize, &mut PairChanges),
) {
    for place in 0..rows.len() {
        if rows.take_due(place, table) {
            update(&mut rows, table, place, changes);
        }
    }
}
