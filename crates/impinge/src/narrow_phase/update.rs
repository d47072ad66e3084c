//! The step: which pairs need a new query, and the batches that give it to them.

use super::default_narrow_phase::push_change;
use super::entry::{Change, posed};
use super::group::Group;
use super::lanes::{Lane, Location, needs_update};
use super::{DefaultNarrowPhase, Events, ObjectTable};
use crate::math::Space;

/// Pairs per task: large enough to hide the cost of a task, small enough to spread the load. A
/// constant, so that the order of results never depends on the number of threads.
const CHUNK: usize = 128;

/// Below one pair to update in this many, the pairs are found from the objects that changed rather
/// than by going through all of them.
const SPARSE: usize = 8;

/// Some pairs of a group side by side: keys and states, and views.
type Chunk<'a, S, V> = ((&'a [(u32, u32)], &'a mut [S]), &'a mut [V]);

/// What changed, pair by pair.
type Changes = Vec<((u32, u32), Change)>;

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Brings all pairs up to date with the rows of the table and reports what changed.
    pub(crate) fn update_pairs(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        (N::tables().update_pairs)(self, table, events);
    }

    /// [`Self::update_pairs`], compiled in this crate.
    pub(crate) fn update_pairs_here(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        let due = core::mem::take(&mut self.due);
        let mut changes = Changes::new();
        let affected: usize = table.changed().iter().map(|&row| self.pairs.count(row)).sum();
        if (affected + due.len()) * SPARSE < self.pairs.len() {
            self.update_some(table, &due, &mut changes);
        } else {
            self.update_all(table, &mut changes);
        }
        for (key, change) in changes {
            self.note_change(key, change);
            push_change(table, key, Some(change), events);
        }
        self.due = due;
        self.due.clear();
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
        for group in &mut self.lanes.contacts {
            update_group(group, changes, |key, entry, view| {
                let needed = needs_update(entry.due, table, key);
                if needed { entry.update(view, &posed(table, key)) } else { None }
            });
        }
        update_group(&mut self.lanes.composites, changes, |key, entry, view| {
            let needed = needs_update(entry.due, table, key);
            if needed { entry.update(view, &posed(table, key)) } else { None }
        });
        for group in &mut self.lanes.proximity {
            update_group(group, changes, |key, entry, ()| {
                let needed = needs_update(entry.due, table, key);
                if needed { entry.update(&posed(table, key)) } else { None }
            });
        }
        self.update_all_custom(table, changes);
    }

    /// One by one: algorithms of the user's share one source of names.
    fn update_all_custom(&mut self, table: &ObjectTable<N, D>, changes: &mut Changes) {
        let (keys, entries, _) = self.lanes.custom_contacts.split_mut();
        for (&key, entry) in keys.iter().zip(entries) {
            if needs_update(entry.due, table, key) {
                let dispatcher = &*self.contact_dispatcher;
                let change = entry.update(dispatcher, table, key, &mut self.ids);
                changes.extend(change.map(|change| (key, change)));
            }
        }
        let (keys, entries, _) = self.lanes.custom_proximity.split_mut();
        for (&key, entry) in keys.iter().zip(entries) {
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
        let mut indices = Vec::new();
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
        for index in indices {
            let key = self.pairs.pairs()[index];
            let change = self.update_one(table, key, self.locations[index]);
            changes.extend(change.map(|change| (key, change)));
        }
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

/// Updates the pairs of a group chunk by chunk, on several threads where the feature says so; what
/// changed comes in the order of the group either way.
fn update_group<S: Send + Sync, V: Default + Send + Sync>(
    group: &mut Group<S, V>,
    changes: &mut Changes,
    update: impl Fn((u32, u32), &mut S, &mut V) -> Option<Change> + Sync,
) {
    let (keys, states, views) = group.split_mut();
    let chunk = |((keys, states), views): Chunk<'_, S, V>| -> Changes {
        let one = |((&key, state), view)| update(key, state, view).map(|change| (key, change));
        keys.iter().zip(states).zip(views).filter_map(one).collect()
    };
    #[cfg(feature = "parallel")]
    if keys.len() >= 2 * CHUNK {
        use rayon::prelude::*;
        let chunks = keys.par_chunks(CHUNK).zip(states.par_chunks_mut(CHUNK));
        let chunks = chunks.zip(views.par_chunks_mut(CHUNK));
        let results: Vec<Changes> = chunks.map(chunk).collect();
        changes.extend(results.into_iter().flatten());
        return;
    }
    let chunks = keys.chunks(CHUNK).zip(states.chunks_mut(CHUNK));
    for one in chunks.zip(views.chunks_mut(CHUNK)) {
        changes.extend(chunk(one));
    }
}
