//! One update: from boxes that wait to events in canonical order.

use super::PairFinder;
use super::finder::{AGAIN, CHANGED, Home};
use crate::math::Real;
use crate::pairs::{pack, unpack};

/// One object in so many changed: beyond that, all pairs are looked at for those that ended.
const SWEEP_FROM: usize = 4;

/// Pairs per chunk of that look.
const SWEEP_CHUNK: usize = 4096;

/// What becomes of pairs in an update.
#[derive(Debug, Default)]
struct Verdict {
    /// Indices of the pairs that end.
    ending: Vec<usize>,
    /// The pairs that begin, packed, ascending.
    starting: Vec<u64>,
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Applies what is pending; see `BroadPhase::update`. The numbers handed out are ids, the
    /// smaller one first.
    pub fn update(
        &mut self,
        filter: &mut dyn FnMut(u32, u32) -> bool,
        callback: &mut dyn FnMut(u32, u32, bool),
    ) {
        self.clock = self.clock.wrapping_add(1);
        if self.is_idle() {
            return self.keep_order();
        }
        self.apply_waiting();
        self.apply_again();
        self.moving.refit();
        self.still.refit();
        let verdict = self.judge(filter);
        // From here on no foreign code runs until everything is consistent.
        let events = self.commit(verdict);
        self.settle();
        self.keep_order();
        for (key, started) in events {
            let (a, b) = unpack(key);
            callback(a, b, started);
        }
    }

    /// Decides about all pairs that the changes concern; alters nothing.
    fn judge(&mut self, filter: &mut dyn FnMut(u32, u32) -> bool) -> Verdict {
        let mut verdict = Verdict { ending: self.parted(), starting: Vec::new() };
        let mut met = self.met();
        met.sort_unstable();
        debug_assert!(met.is_sorted_by(|a, b| a < b), "every pair begins once");
        for key in met {
            let (a, b) = unpack(key);
            let is_again = (self.marks[a as usize] | self.marks[b as usize]) & AGAIN != 0;
            let present = if is_again { self.pairs.index_of(a, b) } else { None };
            match (present, filter(a, b)) {
                (None, true) => verdict.starting.push(key),
                (Some(index), false) => verdict.ending.push(index),
                _ => {}
            }
        }
        verdict
    }

    /// Indices of the pairs whose boxes do not overlap any more.
    fn parted(&self) -> Vec<usize> {
        if self.changes.len() * SWEEP_FROM < self.homes.len() {
            return self.parted_from_changed();
        }
        let pairs = self.pairs.pairs();
        let sweep = |chunk: usize| -> Vec<usize> {
            let first = chunk * SWEEP_CHUNK;
            let last = pairs.len().min(first + SWEEP_CHUNK);
            let has_parted =
                |&(a, b): &(u32, u32)| !self.loose[a as usize].overlaps(&self.loose[b as usize]);
            (first..last).filter(|&index| has_parted(&pairs[index])).collect()
        };
        let chunks = pairs.len().div_ceil(SWEEP_CHUNK);
        #[cfg(feature = "parallel")]
        if pairs.len() >= crate::bvh::PARALLEL_FROM && rayon::current_num_threads() > 1 {
            use rayon::prelude::*;
            let lists: Vec<Vec<usize>> = (0..chunks).into_par_iter().map(sweep).collect();
            return lists.concat();
        }
        (0..chunks).flat_map(sweep).collect()
    }

    /// The same, by way of the objects that changed.
    fn parted_from_changed(&self) -> Vec<usize> {
        let mut parted = Vec::new();
        for &a in &self.changes {
            for (b, index) in self.pairs.partners(a) {
                // Where both changed, the smaller one speaks for the pair.
                let is_other = self.marks[b as usize] & CHANGED != 0 && b < a;
                if !is_other && !self.loose[a as usize].overlaps(&self.loose[b as usize]) {
                    parted.push(index);
                }
            }
        }
        parted
    }

    /// The pairs whose boxes overlap and did not before, packed.
    fn met(&mut self) -> Vec<u64> {
        let mut met = Vec::new();
        self.joiner.self_join(&self.moving, &mut met);
        self.joiner.self_join(&self.still, &mut met);
        self.joiner.cross_join(&self.moving, &self.still, &mut met);
        for &u in &self.unbounded {
            self.met_by_unbounded(u, &mut met);
        }
        met
    }

    /// The pairs of one unbounded object that began: with all objects if it changed itself, else
    /// with those that changed.
    fn met_by_unbounded(&self, u: u32, met: &mut Vec<u64>) {
        let is_changed = self.marks[u as usize] & CHANGED != 0;
        let mut test = |other: u32| {
            // Of two unbounded objects, the one that changed speaks, of two that did the smaller.
            let is_told_by_other = self.homes[other as usize] == Home::Unbounded
                && self.marks[other as usize] & CHANGED != 0
                && (!is_changed || other < u);
            if other != u && !is_told_by_other && self.began(u, other) {
                met.push(pack(u, other));
            }
        };
        if is_changed {
            let ids = (0..).zip(&self.homes).filter(|&(_, &home)| home != Home::Nowhere);
            ids.for_each(|(other, _)| test(other));
        } else {
            self.changes.iter().for_each(|&other| test(other));
        }
    }

    /// The boxes overlap and did not before.
    fn began(&self, a: u32, b: u32) -> bool {
        let old = |id: u32| {
            let is_changed = self.marks[id as usize] & CHANGED != 0;
            if is_changed { &self.previous[id as usize] } else { &self.loose[id as usize] }
        };
        self.loose[a as usize].overlaps(&self.loose[b as usize]) && !old(a).overlaps(old(b))
    }

    /// Alters the table of pairs; the events, in canonical order.
    fn commit(&mut self, mut verdict: Verdict) -> Vec<(u64, bool)> {
        // From the back: what a removal moves has been dealt with already.
        verdict.ending.sort_unstable_by(|a, b| b.cmp(a));
        let mut stopped = Vec::with_capacity(verdict.ending.len());
        for index in verdict.ending {
            let (a, b) = self.pairs.pairs()[index];
            stopped.push(pack(a, b));
            self.pairs.remove_at(index);
        }
        stopped.sort_unstable();
        for &key in &verdict.starting {
            let (a, b) = unpack(key);
            self.pairs.insert_new(a, b);
        }
        merge(&stopped, &verdict.starting)
    }

    /// Declares the present boxes those of before.
    fn settle(&mut self) {
        for &id in &self.changes {
            self.marks[id as usize] = 0;
        }
        self.changes.clear();
        self.moving.settle();
        self.still.settle();
    }
}

/// Two ascending lists as one: stopped pairs with `false`, started ones with `true`.
fn merge(stopped: &[u64], started: &[u64]) -> Vec<(u64, bool)> {
    let mut events = Vec::with_capacity(stopped.len() + started.len());
    let mut rest = started.iter().peekable();
    for &stop in stopped {
        while let Some(&start) = rest.next_if(|&&start| start < stop) {
            events.push((start, true));
        }
        events.push((stop, false));
    }
    events.extend(rest.map(|&start| (start, true)));
    events
}
