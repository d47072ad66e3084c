//! The pairs that begin and end in an update, processed in batches with prefetching.
//!
//! A pair that begins may get the index of one that ends, so the order of pairs is unspecified.

use smallvec::SmallVec;

use super::default_narrow_phase::{new_entry, push_change};
use super::entry::Change;
use super::group::PairKey;
use super::pair_groups::{GroupId, Location};
use super::{DefaultNarrowPhase, Events, Interaction, ObjectTable, PairQuery};
use crate::collide::ManifoldRequest;
use crate::math::Space;
use crate::pairs::pack;

/// Maximum number of started pairs, and of stopped pairs, in one batch.
const BATCH: usize = 16;

/// The keys of the started or the stopped pairs of one batch.
type BatchKeys = SmallVec<[PairKey; BATCH]>;

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Adds the pairs that began and removes those that ended, as
    /// [`pair_started`](Self::pair_started) and [`pair_stopped`](Self::pair_stopped) do.
    ///
    /// Pairs are scattered in memory, so several are prefetched at once. If a pair that begins and
    /// a pair that ends are in the same group, the first takes the index of the second, and no
    /// other pair moves.
    pub(crate) fn begin_and_end_pairs(
        &mut self,
        table: &ObjectTable<N, D>,
        interactions: &[Interaction],
        events: &mut Events,
    ) {
        let all = |wanted: bool| {
            let those = interactions.iter().filter(move |(_, has_started)| *has_started == wanted);
            those.map(|((first, second), _)| [first.index(), second.index()])
        };
        let (mut starting, mut stopping) = (all(true), all(false));
        loop {
            let started: BatchKeys = starting.by_ref().take(BATCH).collect();
            let stopped: BatchKeys = stopping.by_ref().take(BATCH).collect();
            if started.is_empty() && stopped.is_empty() {
                return;
            }
            self.prefetch(table, &started, &stopped);
            self.begin_and_end_some_pairs(table, [&started, &stopped], events);
        }
    }

    /// Adds the pairs `started` and removes the pairs `stopped`; where possible, an added pair
    /// replaces a removed one.
    fn begin_and_end_some_pairs(
        &mut self,
        table: &ObjectTable<N, D>,
        [started, stopped]: [&[PairKey]; 2],
        events: &mut Events,
    ) {
        let both = started.len().min(stopped.len());
        for (&new, &old) in started.iter().zip(stopped) {
            self.exchange(table, old, new, events);
        }
        for &[first, second] in &started[both..] {
            self.pair_started(table, first, second);
        }
        for &[first, second] in &stopped[both..] {
            self.pair_stopped(table, first, second, events);
        }
    }

    /// Loads the data of some pairs. These loads are independent of each other, so the cache misses
    /// overlap. Changes nothing.
    fn prefetch(&self, table: &ObjectTable<N, D>, started: &[PairKey], stopped: &[PairKey]) {
        let packed = |&[first, second]: &PairKey| pack(first, second);
        let keys: SmallVec<[u64; 2 * BATCH]> = started.iter().chain(stopped).map(packed).collect();
        self.pairs.prefetch(&keys);
        let kind = |object: u32| table.shape(object).geometry().kind() as u32;
        let kinds = |sum: u32, &[first, second]: &PairKey| sum ^ kind(first) ^ kind(second);
        let mut loaded = u64::from(started.iter().fold(0, kinds));
        for &[first, second] in stopped {
            let index = self.pairs.index_of(first, second);
            let location = index.map(|index| self.locations[index]);
            if let Some(Location { group: GroupId::Contacts(kinds), row }) = location {
                let entry = self.groups.contacts.of(kinds).state(row);
                loaded ^= entry.number ^ u64::from(entry.state.prefetch());
            }
        }
        core::hint::black_box(loaded);
    }

    /// Removes the pair `old` and adds the pair `new`.
    fn exchange(
        &mut self,
        table: &ObjectTable<N, D>,
        old: PairKey,
        new: PairKey,
        events: &mut Events,
    ) {
        if self.replace(table, old, new, events).is_none() {
            self.pair_stopped(table, old[0], old[1], events);
            self.pair_started(table, new[0], new[1]);
        }
    }

    /// Writes the pair `new` at the index and row of the pair `old`, and pushes the final event of
    /// `old` if `old` was touching. `None`, without a change, if `old` does not exist, if `new`
    /// exists, or if they do not belong to the same group of built-in contacts of convex solids.
    fn replace(
        &mut self,
        table: &ObjectTable<N, D>,
        old: PairKey,
        new: PairKey,
        events: &mut Events,
    ) -> Option<()> {
        let index = self.pairs.index_of(old[0], old[1])?;
        let Location { group, row } = self.locations[index];
        let (GroupId::Contacts(kinds), PairQuery::Contacts { linear, angular }) =
            (group, table.query(new[0]).pair(table.query(new[1])))
        else {
            return None;
        };
        let (_, max_points) =
            self.built_in_group(table, new).filter(|built_in| built_in.0 == group)?;
        if self.pairs.index_of(new[0], new[1]).is_some() {
            return None;
        }
        let linear = table.beyond_skins(new, linear);
        let request = ManifoldRequest::new(linear, angular, max_points);
        let entry = new_entry(table, new, request, self.ids.allocate());
        let was_touching = self.groups.contacts.of_mut(kinds).replace(row, new, entry);
        let end = was_touching.then_some(Change::Contact { touching: false });
        push_change(table, old, end, events);
        self.pairs.replace(old.into(), new.into());
        self.dirty_pairs.push(new);
        self.forget_order();
        Some(())
    }
}
