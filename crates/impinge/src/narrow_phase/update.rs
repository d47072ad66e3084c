//! The step: which pairs need a new query, and the batches that give it to them.

use smallvec::SmallVec;

use super::default_narrow_phase::push_change;
use super::due::{ContactRows, DueContacts};
use super::entry::{Change, ContactEntry, ContactView, ProximityEntry, posed};
use super::group::{Group, Rows};
use super::lanes::{Lane, Location, needs_update};
use super::state::{KeptContacts, Posed};
use super::{DefaultNarrowPhase, Events, ObjectTable};
use crate::math::Space;
use crate::query::{BoxJob, Solid};

/// Pairs per task: large enough to hide the cost of a task, small enough to spread the load. A
/// constant, so that the order of results never depends on the number of threads.
const CHUNK: usize = 128;

/// Below one pair to update in this many, the pairs are found from the objects that changed rather
/// than by going through all of them.
const SPARSE: usize = 8;

/// What changed, pair by pair.
pub(super) type Changes = Vec<((u32, u32), Change)>;

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Brings all pairs up to date with the rows of the table and reports what changed.
    pub(crate) fn update_pairs(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        (N::tables().update_pairs)(self, table, events);
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
        for (key, change) in changes.drain(..) {
            self.note_change(key, change);
            push_change(table, key, Some(change), events);
        }
        self.changes = changes;
        self.due = due;
        self.due.clear();
    }

    /// Few of the pairs are to be updated: those of objects that changed and some more.
    fn is_sparse(&self, table: &ObjectTable<N, D>, more: usize) -> bool {
        let mut affected = more;
        table.changed().iter().all(|&row| {
            affected += self.pairs.count(row);
            affected * SPARSE < self.pairs.len()
        }) && affected * SPARSE < self.pairs.len()
    }

    /// Keeps what readers go by in step with the states.
    fn note_change(&mut self, (first, second): (u32, u32), change: Change) {
        if let Change::Contact { touching } = change {
            let index = self.pairs.index_of(first, second).expect("a state belongs to a pair");
            self.locations[index].is_touching = touching;
            self.touching.take();
        }
    }

    /// Goes through all pairs, lane by lane.
    fn update_all(&mut self, table: &ObjectTable<N, D>, changes: &mut Changes) {
        // Of the hundreds of groups most are empty.
        for group in self.lanes.contacts.iter_mut().filter(|group| !group.is_empty()) {
            let solids = group.state(0).state.solids().copied();
            update_group(group, changes, |rows, changes| {
                update_convex(rows, table, changes, solids.as_ref());
            });
        }
        update_group(&mut self.lanes.composites, changes, |rows, changes| {
            update_contacts(rows, table, changes);
        });
        for group in self.lanes.proximity.iter_mut().filter(|group| !group.is_empty()) {
            update_group(group, changes, |rows, changes| update_proximity(rows, table, changes));
        }
        self.update_all_custom(table, changes);
    }

    /// One by one: algorithms of the user's share one source of names.
    fn update_all_custom(&mut self, table: &ObjectTable<N, D>, changes: &mut Changes) {
        for (key, entry, _) in self.lanes.custom_contacts.rows().each() {
            if needs_update(entry.due, table, key) {
                let dispatcher = &*self.contact_dispatcher;
                let change = entry.update(dispatcher, table, key, &mut self.ids);
                changes.extend(change.map(|change| (key, change)));
            }
        }
        for (key, entry, _) in self.lanes.custom_proximity.rows().each() {
            if needs_update(entry.due, table, key) {
                let change = entry.update(&*self.proximity_dispatcher, table, key);
                changes.extend(change.map(|change| (key, change)));
            }
        }
    }

    /// Updates the pairs of the objects that changed, and those that are due.
    fn update_some(
        &mut self,
        table: &ObjectTable<N, D>,
        due: &[(u32, u32)],
        changes: &mut Changes,
    ) {
        let mut indices = core::mem::take(&mut self.indices);
        for &row in table.changed() {
            // A pair of two changed objects is taken from the end with the smaller index.
            let mine = |partner: u32| !(table.has_changed(partner) && partner < row);
            let partners = self.pairs.partners(row).filter(|(partner, _)| mine(*partner));
            indices.extend(partners.map(|(_, index)| index));
        }
        let still = |&&(a, b): &&(u32, u32)| !table.has_changed(a) && !table.has_changed(b);
        let due = due.iter().filter(still).filter_map(|&(a, b)| self.pairs.index_of(a, b));
        indices.extend(due);
        indices.sort_unstable();
        indices.dedup();
        for index in indices.drain(..) {
            let key = self.pairs.pairs()[index];
            let change = self.update_one(table, key, self.locations[index]);
            changes.extend(change.map(|change| (key, change)));
        }
        self.indices = indices;
    }

    fn update_one(
        &mut self,
        table: &ObjectTable<N, D>,
        key: (u32, u32),
        Location { lane, place, .. }: Location,
    ) -> Option<Change> {
        match lane {
            Lane::Contacts(group) => {
                let (entry, view) = self.lanes.contacts[usize::from(group)].parts_mut(place);
                entry.update(view, &posed(table, key))
            }
            Lane::Composites => {
                let (entry, view) = self.lanes.composites.parts_mut(place);
                entry.update(view, &posed(table, key))
            }
            Lane::Proximity(group) => {
                let entry = self.lanes.proximity[usize::from(group)].state_mut(place);
                entry.update(&posed(table, key))
            }
            Lane::CustomContacts => {
                let entry = self.lanes.custom_contacts.state_mut(place);
                entry.update(&*self.contact_dispatcher, table, key, &mut self.ids)
            }
            Lane::CustomProximity => {
                let entry = self.lanes.custom_proximity.state_mut(place);
                entry.update(&*self.proximity_dispatcher, table, key)
            }
            Lane::Nothing => None,
        }
    }
}

/// Brings the contacts of some pairs of convex solids up to date, several at a time where that can be
/// done for their kinds. `solids` are those of one of them: all have copies if one has.
fn update_convex<N: Space<D>, const D: usize>(
    mut rows: ContactRows<'_, N, D>,
    table: &ObjectTable<N, D>,
    changes: &mut Changes,
    solids: Option<&[Solid<N, D>; 2]>,
) {
    if let Some([Solid::Cuboid(_), Solid::Cuboid(_)]) = solids {
        return update_boxes(rows, table, changes);
    }
    let is_done = solids.is_some_and(|[solid1, solid2]| {
        let mut due = DueContacts { rows: rows.reborrow(), table, changes: &mut *changes };
        (N::tables().update_lanes)([solid1, solid2], &mut due)
    });
    if !is_done {
        update_contacts(rows, table, changes);
    }
}

/// Brings the contacts of some pairs of boxes up to date, several at a time.
fn update_boxes<N: Space<D>, const D: usize>(
    mut rows: ContactRows<'_, N, D>,
    table: &ObjectTable<N, D>,
    changes: &mut Changes,
) {
    let mut jobs = SmallVec::<[BoxJob<'_, N, D>; CHUNK]>::new();
    for (key, entry, view) in rows.reborrow().each() {
        if needs_update(entry.due, table, key) {
            let poses = [table.pose(key.0), table.pose(key.1)];
            if let Some(job) = entry.begin_boxes(view, poses) {
                jobs.push(job);
            }
        }
    }
    (N::tables().box_contacts)(&mut jobs);
    drop(jobs);
    for (&key, entry) in rows.keys.iter().zip(rows.states) {
        if let Some(change) = entry.note() {
            changes.push((key, change));
        }
    }
}

/// Brings the contacts of some pairs up to date.
fn update_contacts<N: Space<D>, S: KeptContacts<N, D>, const D: usize>(
    rows: Rows<'_, ContactEntry<N, S>, ContactView<S::Manifolds>>,
    table: &ObjectTable<N, D>,
    changes: &mut Changes,
) {
    update_each(rows, changes, (table, |entry| entry.due), |entry, view, posed| {
        entry.update(view, posed)
    });
}

/// Brings the proximity of some pairs up to date.
fn update_proximity<N: Space<D>, const D: usize>(
    rows: Rows<'_, ProximityEntry<N>, ()>,
    table: &ObjectTable<N, D>,
    changes: &mut Changes,
) {
    update_each(rows, changes, (table, |entry| entry.due), |entry, _, posed| entry.update(posed));
}

/// Updates the pairs of a group chunk by chunk, on several threads where the feature says so; what
/// changed comes in the order of the group either way.
fn update_group<S: Send + Sync, V: Default + Send + Sync>(
    group: &mut Group<S, V>,
    changes: &mut Changes,
    update: impl Fn(Rows<'_, S, V>, &mut Changes) + Sync,
) {
    let rows = group.rows();
    #[cfg(feature = "parallel")]
    if rows.len() >= 2 * CHUNK {
        use rayon::prelude::*;
        let chunks: Vec<_> = rows.chunks(CHUNK).collect();
        let chunk = |rows| {
            let mut changes = Changes::new();
            update(rows, &mut changes);
            changes
        };
        let results: Vec<Changes> = chunks.into_par_iter().map(chunk).collect();
        changes.extend(results.into_iter().flatten());
        return;
    }
    for rows in rows.chunks(CHUNK) {
        update(rows, changes);
    }
}

/// Updates the pairs of a chunk that need it, one by one.
fn update_each<N: Space<D>, S, V, const D: usize>(
    rows: Rows<'_, S, V>,
    changes: &mut Changes,
    (table, is_due): (&ObjectTable<N, D>, fn(&S) -> bool),
    update: impl Fn(&mut S, Option<&mut V>, &Posed<'_, N, D>) -> Option<Change>,
) {
    for (key, state, view) in rows.each() {
        if needs_update(is_due(state), table, key) {
            let change = update(state, view, &posed(table, key));
            changes.extend(change.map(|change| (key, change)));
        }
    }
}
