//! The update of a [`PairFinder`]: applies the waiting boxes, and reports in canonical order the
//! pairs that start or stop.

use super::PairFinder;
use super::finder::{CHANGED, Container, REFILTER};
use crate::bvh::{Changes, PARALLEL_FROM};
use crate::math::Real;
use crate::memory::{Look, clone_empty};
use crate::pairs::{PairTable, pack, unpack};

/// Number of pairs whose entries in the pair table are prefetched together.
const BATCH: usize = 16;

/// The pairs that start or stop in an update, packed ([`pack`]). Each list is ascending.
#[derive(Debug, Default)]
pub(super) struct PairEvents {
    /// Pairs that start.
    starting: Vec<u64>,
    /// Pairs that stop.
    stopped: Vec<u64>,
    /// Both lists merged, ascending; the flag is `true` for a pair that starts.
    events: Vec<(u64, bool)>,
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Applies the waiting changes; see `BroadPhase::update`. Both callbacks receive ids, the
    /// smaller one first.
    pub fn update(
        &mut self,
        filter: &mut dyn FnMut(u32, u32) -> bool,
        callback: &mut dyn FnMut(u32, u32, bool),
    ) {
        self.clock = self.clock.wrapping_add(1);
        if let Some(look) = self.recent.end_update(self.containers.len()) {
            self.give_back(look);
        }
        if self.is_idle() {
            return self.keep_order(0);
        }
        self.recent.note(self.num_waiting());
        self.apply_waiting();
        self.apply_refilters();
        self.moving.refit_from(&self.loose);
        self.still.refit();
        let mut found = core::mem::take(&mut self.found);
        self.find_changes(&mut found);
        self.filter(&mut found, filter);
        // No user code runs from here until the state is consistent.
        self.commit_pairs_and_boxes(&found.ended);
        self.recent.note(found.began.len().max(found.ended.len()));
        self.found = found;
        let events = core::mem::take(&mut self.pair_events.events);
        for &(key, started) in &events {
            let (a, b) = unpack(key);
            callback(a, b, started);
        }
        self.pair_events.events = events;
    }

    /// Calls the filter for each pair that began, and lists the accepted new pairs as starting. A
    /// pair in the table that is filtered again and refused is added to `found.ended`. The table
    /// itself is not changed.
    fn filter(&mut self, found: &mut Changes, filter: &mut dyn FnMut(u32, u32) -> bool) {
        self.pair_events.starting.clear();
        found.began.sort_unstable();
        debug_assert!(found.began.is_sorted_by(|a, b| a < b), "every pair begins once");
        for &key in &found.began {
            let (a, b) = unpack(key);
            let is_refiltered = (self.marks[a as usize] | self.marks[b as usize]) & REFILTER != 0;
            let is_present = is_refiltered && self.pairs.index_of(a, b).is_some();
            match (is_present, filter(a, b)) {
                (false, true) => self.pair_events.starting.push(key),
                (true, false) => found.ended.push(key),
                _ => {}
            }
        }
        found.ended.sort_unstable();
        found.ended.dedup();
    }

    /// Lists the pairs whose loosened boxes began or ceased to overlap since the last update. For
    /// an object that is filtered again, all pairs that overlap now count as begun.
    fn find_changes(&mut self, found: &mut Changes) {
        found.clear();
        self.joiner.self_join(&self.moving, found);
        self.joiner.self_join(&self.still, found);
        self.joiner.cross_join(&self.moving, &self.still, found);
        for &u in &self.unbounded {
            self.changes_of_unbounded(u, found);
        }
        let escaped = self.moving.escaped().chain(self.still.escaped());
        for a in escaped.chain(self.searched.iter().copied()) {
            self.push_ended_pairs(a, &mut found.ended);
        }
    }

    /// Appends to `ended` the pairs of object `a` in the pair table whose loosened boxes no longer
    /// overlap.
    fn push_ended_pairs(&self, a: u32, ended: &mut Vec<u64>) {
        for (b, _) in self.pairs.partners(a) {
            if !self.loose[a as usize].overlaps(&self.loose[b as usize]) {
                ended.push(pack(a, b));
            }
        }
    }

    /// Lists the pairs of the unbounded object `u` that began or ended. Tests all objects if `u`
    /// changed, else only the objects that changed.
    fn changes_of_unbounded(&self, u: u32, found: &mut Changes) {
        let is_changed = self.marks[u as usize] & CHANGED != 0;
        let mut test = |other: u32| {
            // A pair of two unbounded objects is reported once: by the object that changed, or by
            // the object with the smaller id if both changed.
            let is_reported_by_other = self.containers[other as usize] == Container::Unbounded
                && self.marks[other as usize] & CHANGED != 0
                && (!is_changed || other < u);
            if other == u || is_reported_by_other {
                return;
            }
            match self.overlap_before_and_now(u, other) {
                (false, true) => found.began.push(pack(u, other)),
                (true, false) => found.ended.push(pack(u, other)),
                _ => {}
            }
        };
        if is_changed {
            let ids = (0..)
                .zip(&self.containers)
                .filter(|&(_, &container)| container != Container::Nowhere);
            ids.for_each(|(other, _)| test(other));
        } else {
            self.changes.iter().for_each(|&other| test(other));
        }
    }

    fn overlap_before_and_now(&self, a: u32, b: u32) -> (bool, bool) {
        let before = self.before(a).overlaps(&self.before(b));
        (before, self.loose[a as usize].overlaps(&self.loose[b as usize]))
    }

    /// Updates the pair table, and prepares the trees for the next update. The two tasks are
    /// independent, so they may run in parallel if there are at least [`PARALLEL_FROM`] objects.
    fn commit_pairs_and_boxes(&mut self, ended: &[u64]) {
        let mut pairs = core::mem::take(&mut self.pairs);
        let mut pair_events = core::mem::take(&mut self.pair_events);
        let is_large = self.containers.len() >= PARALLEL_FROM;
        let mut commit_pairs = || pair_events.commit(&mut pairs, ended);
        let mut commit_boxes = || {
            let changed = self.changes.len();
            self.commit_changes();
            self.keep_order(changed);
        };
        if is_large {
            join(commit_pairs, commit_boxes);
        } else {
            commit_pairs();
            commit_boxes();
        }
        (self.pairs, self.pair_events) = (pairs, pair_events);
    }

    /// Makes the present boxes the old boxes of the next update, and clears all marks.
    fn commit_changes(&mut self) {
        for &id in &self.changes {
            self.marks[id as usize] = 0;
        }
        self.changes.clear();
        self.searched.clear();
        self.moving.commit_boxes();
        self.still.commit_boxes();
    }
}

/// Runs both closures; with the feature `parallel`, possibly on two threads.
fn join(one: impl FnOnce() + Send, other: impl FnOnce() + Send) {
    #[cfg(feature = "parallel")]
    rayon::join(one, other);
    #[cfg(not(feature = "parallel"))]
    {
        one();
        other();
    }
}

clone_empty!([] PairEvents);

impl PairEvents {
    /// Releases the memory of lists that have been short for some time.
    pub(super) fn give_back(&mut self, look: Look) {
        look.trim(&mut self.starting);
        look.trim(&mut self.stopped);
        look.trim(&mut self.events);
    }

    /// Updates the pair table, and lists the events in canonical order. As long as there are pairs
    /// of both kinds, a pair that starts takes the index of a pair that stops. So no other pair
    /// moves in the table.
    fn commit(&mut self, pairs: &mut PairTable, ended: &[u64]) {
        let Self { starting, stopped, events } = self;
        let mut started = 0;
        stopped.clear();
        for chunk in ended.chunks(BATCH) {
            pairs.prefetch(chunk);
            pairs.prefetch(&starting[started..starting.len().min(started + BATCH)]);
            for &key in chunk {
                let (a, b) = unpack(key);
                // A pair that the filter refused when it began is not in the table.
                let was_there = match starting.get(started) {
                    Some(&start) => pairs.replace((a, b), unpack(start)).is_some(),
                    None => pairs.remove(a, b).is_some(),
                };
                if was_there {
                    stopped.push(key);
                    started = starting.len().min(started + 1);
                }
            }
        }
        for chunk in starting[started..].chunks(BATCH) {
            pairs.prefetch(chunk);
            for (a, b) in chunk.iter().copied().map(unpack) {
                pairs.insert_new(a, b);
            }
        }
        merge(stopped, starting, events);
    }
}

/// Merges two ascending lists of pairs into one ascending list. The flag is `false` for a stopped
/// pair and `true` for a started pair.
fn merge(stopped: &[u64], started: &[u64], events: &mut Vec<(u64, bool)>) {
    events.clear();
    let mut rest = started.iter().peekable();
    for &stop in stopped {
        while let Some(&start) = rest.next_if(|&&start| start < stop) {
            events.push((start, true));
        }
        events.push((stop, false));
    }
    events.extend(rest.map(|&start| (start, true)));
}
