//! The pairs that begin and end in an update, processed in batches.
//!
//! A pair that begins may get the index of one that ends, so the order of pairs is unspecified.

use smallvec::SmallVec;

use super::default_narrow_phase::{new_entry, push_change};
use super::entry::Change;
use super::group::PairKey;
use super::lanes::{Lane, Location};
use super::{DefaultNarrowPhase, Events, Interaction, ObjectTable, PairQuery};
use crate::collide::ManifoldRequest;
use crate::math::Space;
use crate::pairs::pack;

/// Number of started and of stopped pairs that are prefetched at once.
const AT_ONCE: usize = 16;

/// Keys of some pairs.
type BatchKeys = SmallVec<[PairKey; AT_ONCE]>;

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Adds the pairs that began and removes those that ended, as [`pair_started`](Self::pair_started) and
    /// [`pair_stopped`](Self::pair_stopped) do.
    ///
    /// Pairs are scattered in memory, so several are prefetched at once. A pair that begins takes
    /// the index of a pair that ends, if both are in the same group, so that no other pair moves.
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
            let started: BatchKeys = starting.by_ref().take(AT_ONCE).collect();
            let stopped: BatchKeys = stopping.by_ref().take(AT_ONCE).collect();
            if started.is_empty() && stopped.is_empty() {
                return;
            }
            self.fetch(table, &started, &stopped);
            self.begin_and_end_some_pairs(table, [&started, &stopped], events);
        }
    }

    /// Adds some pairs and removes others; where possible, an added pair replaces a removed one.
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

    /// Prefetches the data of some pairs, whose loads would otherwise wait for each other. Changes nothing.
    fn fetch(&self, table: &ObjectTable<N, D>, started: &[PairKey], stopped: &[PairKey]) {
        let packed = |&[first, second]: &PairKey| pack(first, second);
        let keys: SmallVec<[u64; 2 * AT_ONCE]> =
            started.iter().chain(stopped).map(packed).collect();
        self.pairs.fetch(&keys);
        let kind = |object: u32| table.shape(object).geometry().kind() as u32;
        let kinds = |sum: u32, &[first, second]: &PairKey| sum ^ kind(first) ^ kind(second);
        let mut seen = u64::from(started.iter().fold(0, kinds));
        for &[first, second] in stopped {
            let index = self.pairs.index_of(first, second);
            let location = index.map(|index| self.locations[index]);
            if let Some(Location { lane: Lane::Contacts(group), place }) = location {
                let entry = self.lanes.contacts.of(group).state(place);
                seen ^= entry.number ^ u64::from(entry.state.fetch());
            }
        }
        core::hint::black_box(seen);
    }

    /// Removes one pair and adds another.
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

    /// Writes a new pair at the index of an old one; `None`, without a change, unless both belong
    /// to the same group of built-in contacts.
    fn replace(
        &mut self,
        table: &ObjectTable<N, D>,
        old: PairKey,
        new: PairKey,
        events: &mut Events,
    ) -> Option<()> {
        let index = self.pairs.index_of(old[0], old[1])?;
        let Location { lane, place } = self.locations[index];
        let (Lane::Contacts(group), PairQuery::Contacts { linear, angular }) =
            (lane, table.query(new[0]).pair(table.query(new[1])))
        else {
            return None;
        };
        let (_, max_points) =
            self.built_in_lane(table, new).filter(|built_in| built_in.0 == lane)?;
        if self.pairs.index_of(new[0], new[1]).is_some() {
            return None;
        }
        let linear = table.beyond_skins(new, linear);
        let request = ManifoldRequest::new(linear, angular, max_points);
        let entry = new_entry(table, new, request, self.ids.allocate());
        let was_touching = self.lanes.contacts.of_mut(group).replace(place, new, entry);
        let end = was_touching.then_some(Change::Contact { touching: false });
        push_change(table, old, end, events);
        self.pairs.replace(old.into(), new.into());
        self.due.push(new);
        self.forget_order();
        Some(())
    }
}
