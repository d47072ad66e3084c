//! The update of all pairs: selects the pairs that must be computed, and computes them in batches.

use crate::tables::ByDimension;
use crate::tables::entries;
use smallvec::SmallVec;

use super::default_narrow_phase::push_change;
use super::dirty_contacts::{ContactRows, DirtyContacts};
use super::entry::{Change, ContactEntry, ContactView, ProximityEntry, posed};
use super::group::{CHUNK, Group, PairKey, Rows};
use super::pair_groups::{ContactGroup, GroupId, Location};
use super::prefetch::update_prefetched;
use super::reuse::{Reference, Reuse};
use super::rewind::Parts;
use super::state::KeptContacts;
use super::{DefaultNarrowPhase, Events, ObjectTable};
use crate::collide::Solid;
use crate::math::Space;

/// If fewer than one in `SPARSE` pairs must be computed, they are found through their changed
/// objects instead of by a scan of all pairs.
const SPARSE: usize = 8;

/// Indices of pairs in the rows of a chunk, or in all rows of a group for picked pairs.
type RowIndices = SmallVec<[usize; CHUNK]>;

/// The changes of statuses in an update, each with its pair.
pub(super) type PairChanges = Vec<(PairKey, Change)>;

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Updates all pairs for the present rows of the table, and pushes the events.
    pub(crate) fn update_pairs(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        entries::update_pairs(self, table, events);
    }

    /// Implements [`Self::update_pairs`]; compiled in this crate.
    pub(crate) fn update_pairs_here(&mut self, table: &ObjectTable<N, D>, events: &mut Events) {
        let dirty = core::mem::take(&mut self.dirty_pairs);
        let mut changes = core::mem::take(&mut self.changes);
        if self.is_sparse(table, dirty.len()) {
            self.update_some(table, &dirty, &mut changes);
        } else {
            self.update_all(table, &mut changes);
        }
        self.report(table, changes, events);
        self.dirty_pairs = dirty;
        self.dirty_pairs.clear();
    }

    /// Updates one pair for the present rows of the table, and pushes its event. Returns `false` if
    /// there is no such pair.
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

    /// Returns `true` if fewer than one in [`SPARSE`] pairs must be computed: the pairs of changed
    /// objects, and `more` other pairs. A pair of two changed objects counts twice.
    fn is_sparse(&self, table: &ObjectTable<N, D>, more: usize) -> bool {
        let mut affected = more;
        table.changed().iter().all(|&object| {
            affected += self.pairs.count(object);
            affected * SPARSE < self.pairs.len()
        }) && affected * SPARSE < self.pairs.len()
    }

    /// Updates all pairs by scanning group after group.
    fn update_all(&mut self, table: &ObjectTable<N, D>, changes: &mut PairChanges) {
        if self.journal.is_on() {
            self.groups.note_dirty(table);
        }
        let reuse = Reuse { table, tolerance: self.tolerance };
        let is_used = |group: &&mut ContactGroup<N, D>| !group.is_empty();
        for group in self.groups.contacts.all_mut().iter_mut().filter(is_used) {
            let solids = group.state(0).state.solids().copied();
            update_group(group, changes, |rows, changes| {
                update_convex(rows, reuse, changes, solids.as_ref());
            });
        }
        update_group(&mut self.groups.composites, changes, |mut rows, changes| {
            let mut dirty = rows.take_all_dirty(table);
            if !rows.references.is_empty() {
                dirty.retain(|row| !reuse.keeps(&mut rows, row));
            }
            update_prefetched(&mut rows, table, dirty, |rows, row| {
                compute_contact(rows, table, row, changes);
                reuse.note(rows, row);
            });
        });
        for group in self.groups.proximity.all_mut() {
            update_group(group, changes, |rows, changes| {
                update_each(rows, table, changes, update_status);
            });
        }
        self.update_all_custom(table, changes);
    }

    /// Updates pairs with custom algorithms one by one, because they share one allocator of ids.
    fn update_all_custom(&mut self, table: &ObjectTable<N, D>, changes: &mut PairChanges) {
        for row in 0..self.groups.custom_contacts.keys().len() {
            if self.groups.custom_contacts.rows().take_dirty(row, table) {
                self.update_custom_contact(table, row, changes);
            }
        }
        for row in 0..self.groups.custom_proximity.keys().len() {
            if self.groups.custom_proximity.rows().take_dirty(row, table) {
                self.update_custom_proximity(table, row, changes);
            }
        }
    }

    fn update_custom_contact(
        &mut self,
        table: &ObjectTable<N, D>,
        row: usize,
        changes: &mut PairChanges,
    ) {
        let mut rows = self.groups.custom_contacts.rows();
        let (key, entry, _) = rows.row(row);
        let is_touching = entry.update(&*self.contact_dispatcher, table, key, &mut self.ids);
        note_touching(&mut rows, row, is_touching, changes);
    }

    fn update_custom_proximity(
        &mut self,
        table: &ObjectTable<N, D>,
        row: usize,
        changes: &mut PairChanges,
    ) {
        let mut rows = self.groups.custom_proximity.rows();
        let (key, entry, _) = rows.row(row);
        let change = entry.update(&*self.proximity_dispatcher, table, key);
        changes.extend(change.map(|change| (key, change)));
    }

    /// Updates the pairs of changed objects, and the pairs marked as dirty.
    fn update_some(
        &mut self,
        table: &ObjectTable<N, D>,
        dirty: &[PairKey],
        changes: &mut PairChanges,
    ) {
        let mut picked = core::mem::take(&mut self.picked);
        self.pick(table, dirty, &mut picked);
        for picked in picked.chunk_by(|one, other| one.group == other.group) {
            picked.chunks(CHUNK).for_each(|picked| self.update_picked(table, picked, changes));
        }
        picked.clear();
        self.picked = picked;
    }

    /// Lists the locations of the pairs of changed objects and of pairs marked as dirty, each once,
    /// sorted by group and row.
    fn pick(&self, table: &ObjectTable<N, D>, dirty: &[PairKey], picked: &mut Vec<Location>) {
        for &object in table.changed() {
            // A pair of two changed objects is listed for the smaller index only.
            let mine = |partner: u32| !(table.has_changed(partner) && partner < object);
            let partners = self.pairs.partners(object).filter(|(partner, _)| mine(*partner));
            picked.extend(partners.map(|(_, index)| self.locations[index]));
        }
        let still = |&&[a, b]: &&PairKey| !table.has_changed(a) && !table.has_changed(b);
        let dirty = dirty.iter().filter(still).filter_map(|&[a, b]| self.pairs.index_of(a, b));
        picked.extend(dirty.map(|index| self.locations[index]));
        picked.sort_unstable();
        picked.dedup();
    }

    /// Updates at most [`CHUNK`] pairs, which are all in the same group. If there are marks, the
    /// pairs are noted first, so the update finds them in the cache.
    fn update_picked(
        &mut self,
        table: &ObjectTable<N, D>,
        picked: &[Location],
        changes: &mut PairChanges,
    ) {
        self.groups.note(picked);
        let reuse = Reuse { table, tolerance: self.tolerance };
        match picked[0].group {
            GroupId::Contacts(kinds) => {
                let rows = self.groups.contacts.of_mut(kinds).rows();
                update_picked_convex(rows, reuse, picked, changes);
            }
            GroupId::Composites => {
                let rows = &mut self.groups.composites.rows();
                update_each_picked(rows, picked, |rows, row| {
                    update_contact(rows, reuse, row, changes);
                });
            }
            GroupId::Proximity(kinds) => {
                let rows = &mut self.groups.proximity.of_mut(kinds).rows();
                update_each_picked(rows, picked, |rows, row| {
                    update_status(rows, table, row, changes);
                });
            }
            GroupId::CustomContacts => {
                for row in picked.iter().map(|at| at.row as usize) {
                    self.groups.custom_contacts.rows().take_dirty_flag(row);
                    self.update_custom_contact(table, row, changes);
                }
            }
            GroupId::CustomProximity => {
                for row in picked.iter().map(|at| at.row as usize) {
                    self.groups.custom_proximity.rows().take_dirty_flag(row);
                    self.update_custom_proximity(table, row, changes);
                }
            }
            GroupId::Nothing => {}
        }
    }
}

/// Sets the touching flag of the pair in a row, and appends to `changes` if that changed the flag.
#[inline]
pub(super) fn note_touching<S, V, R>(
    rows: &mut Rows<'_, S, V, R>,
    row: usize,
    is_touching: bool,
    changes: &mut PairChanges,
) {
    if rows.set_touching(row, is_touching) {
        changes.push((rows.keys[row], Change::Contact { touching: is_touching }));
    }
}

/// Updates the contacts of a chunk of pairs of convex solids, in SIMD lanes if their kinds have a
/// kernel. `solids` are the copies of one pair's solids; if one pair of a group has copies, all
/// pairs have.
fn update_convex<N: Space<D>, const D: usize>(
    mut rows: ContactRows<'_, N, D>,
    reuse: Reuse<'_, N, D>,
    changes: &mut PairChanges,
    solids: Option<&[Solid<N, D>; 2]>,
) {
    let mut dirty = rows.take_all_dirty(reuse.table);
    let may_keep = !(rows.references.is_empty() || has_ball(solids));
    if may_keep {
        dirty.retain(|row| !reuse.keeps(&mut rows, row));
    }
    let indices: RowIndices = dirty.indices().collect();
    compute_convex(&mut rows, reuse.table, &indices, solids, changes);
    if may_keep {
        indices.iter().for_each(|&row| reuse.note(&mut rows, row));
    }
}

/// Returns `true` if one of the solids is a ball; `false` for pairs without copies of their solids.
/// Pairs with a ball do not reuse contacts, because their closed forms are as fast.
fn has_ball<N: Space<D>, const D: usize>(solids: Option<&[Solid<N, D>; 2]>) -> bool {
    solids.is_some_and(|solids| solids.iter().any(|solid| matches!(solid, Solid::Ball(_))))
}

/// Computes the contacts of the pairs in the rows `indices`, in SIMD lanes if there is a kernel.
fn compute_convex<N: Space<D>, const D: usize>(
    rows: &mut ContactRows<'_, N, D>,
    table: &ObjectTable<N, D>,
    indices: &[usize],
    solids: Option<&[Solid<N, D>; 2]>,
    changes: &mut PairChanges,
) {
    let is_done = solids.is_some_and(|[solid1, solid2]| {
        let changes = &mut *changes;
        let mut dirty = DirtyContacts { rows: rows.reborrow(), indices, table, changes };
        <N::Algorithms>::update_lanes([solid1, solid2], &mut dirty)
    });
    if !is_done {
        indices.iter().for_each(|&row| compute_contact(rows, table, row, changes));
    }
}

/// Updates the contacts of at most [`CHUNK`] picked pairs of convex solids.
fn update_picked_convex<N: Space<D>, const D: usize>(
    mut rows: ContactRows<'_, N, D>,
    reuse: Reuse<'_, N, D>,
    picked: &[Location],
    changes: &mut PairChanges,
) {
    let first = picked[0].row as usize;
    let solids = rows.states[first].state.solids().copied();
    let may_keep = !has_ball(solids.as_ref());
    let mut indices: RowIndices = picked.iter().map(|at| at.row as usize).collect();
    for &row in &indices {
        rows.take_dirty_flag(row);
    }
    indices.retain(|row| !(may_keep && reuse.keeps(&mut rows, *row)));
    compute_convex(&mut rows, reuse.table, &indices, solids.as_ref(), changes);
    if may_keep {
        indices.iter().for_each(|&row| reuse.note(&mut rows, row));
    }
}

/// Clears the dirty flags of the picked pairs of a group, and calls `update` for each pair.
fn update_each_picked<S, V, R>(
    rows: &mut Rows<'_, S, V, R>,
    picked: &[Location],
    mut update: impl FnMut(&mut Rows<'_, S, V, R>, usize),
) {
    for at in picked {
        rows.take_dirty_flag(at.row as usize);
        update(rows, at.row as usize);
    }
}

/// Updates the contacts of one pair: reuses them if possible, else computes them.
fn update_contact<N: Space<D>, S: KeptContacts<N, D>, const D: usize>(
    rows: &mut Rows<'_, ContactEntry<N, S>, ContactView<S::Manifolds>, Reference<N, D>>,
    reuse: Reuse<'_, N, D>,
    row: usize,
    changes: &mut PairChanges,
) {
    if !reuse.keeps(rows, row) {
        compute_contact(rows, reuse.table, row, changes);
        reuse.note(rows, row);
    }
}

/// Computes the contacts of one pair.
fn compute_contact<N: Space<D>, S: KeptContacts<N, D>, const D: usize>(
    rows: &mut Rows<'_, ContactEntry<N, S>, ContactView<S::Manifolds>, Reference<N, D>>,
    table: &ObjectTable<N, D>,
    row: usize,
    changes: &mut PairChanges,
) {
    let (key, entry, view) = rows.row(row);
    let is_touching = entry.update(view, &posed(table, key));
    note_touching(rows, row, is_touching, changes);
}

/// Updates the proximity of one pair.
fn update_status<N: Space<D>, const D: usize>(
    rows: &mut Rows<'_, ProximityEntry<N>, ()>,
    table: &ObjectTable<N, D>,
    row: usize,
    changes: &mut PairChanges,
) {
    let (key, entry, _) = rows.row(row);
    let change = entry.update(&posed(table, key));
    changes.extend(change.map(|change| (key, change)));
}

/// Calls `update` for each chunk of a group; with the feature `parallel`, on several threads if the
/// group has at least two full chunks. In both cases `changes` has the order of the group's rows.
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

/// Calls `update` for each pair of a chunk that must be computed.
fn update_each<N: Space<D>, S, V, R, const D: usize>(
    mut rows: Rows<'_, S, V, R>,
    table: &ObjectTable<N, D>,
    changes: &mut PairChanges,
    update: impl Fn(&mut Rows<'_, S, V, R>, &ObjectTable<N, D>, usize, &mut PairChanges),
) {
    for row in 0..rows.len() {
        if rows.take_dirty(row, table) {
            update(&mut rows, table, row, changes);
        }
    }
}
