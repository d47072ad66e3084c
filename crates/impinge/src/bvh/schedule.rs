//! When the order of slots is renewed, and how much of that work one step does.
//!
//! Moving objects spoil the order: the leaf blocks grow. When their surface is a fifth above what
//! it was after the last renewal (or many objects came or went), a snapshot of all centres is
//! sorted over several steps, a bounded amount of work in each, and applied when it is done. No
//! step depends on the time taken, so results are the same on every machine.

use super::order::{Item, sort, split};
use super::{LANES, NONE, Tree};

/// Growth of the leaf surface per object that starts a renewal.
const WORN: f64 = 1.2;
/// One call in so many looks whether the order is worn.
const LOOK_EVERY: u32 = 4;
/// A part of the snapshot this small is sorted at once.
const SORTED_AT_ONCE: usize = 1024;
/// The least number of items that a step handles, so that small trees renew in few steps.
const LEAST_BUDGET: usize = 2048;
/// Objects that may come or go in any case before the order is renewed.
const SLACK: usize = 64;

/// The state of the renewal.
#[derive(Clone, Debug)]
pub(super) struct Schedule<const D: usize> {
    /// Leaf surface per object after the last renewal; `None` if it is to be taken.
    base: Option<f64>,
    /// Slots from here on have come since the last renewal.
    ordered: usize,
    /// Slots from here on have come since the last [`Tree::refit`].
    fresh: usize,
    /// The centres being sorted, and the parts of them still to be.
    snapshot: Vec<Item<D>>,
    parts: Vec<(usize, usize)>,
    /// Calls without a renewal; wraps.
    calls: u32,
}

impl<const D: usize> Default for Schedule<D> {
    fn default() -> Self {
        Self { base: None, ordered: 0, fresh: 0, snapshot: Vec::new(), parts: Vec::new(), calls: 0 }
    }
}

impl<const D: usize> Tree<D> {
    /// Sorts the objects that came since the last refit among themselves, or everything if they
    /// are a third of all.
    pub(super) fn sort_new(&mut self) {
        let new = self.end - self.schedule.fresh.min(self.end);
        if new * 3 > self.live {
            self.rebuild();
        } else if new > LANES {
            let start = self.schedule.fresh / LANES * LANES;
            let mut items = self.items_from(start);
            sort(&mut items);
            self.rearrange(start, items.iter().map(|item| item.id));
        }
        self.schedule.fresh = self.end;
    }

    /// Sorts everything at once.
    pub fn rebuild(&mut self) {
        let mut items = self.items_from(0);
        sort(&mut items);
        self.rearrange(0, items.iter().map(|item| item.id));
        self.declare_ordered();
    }

    /// All objects are in order; those that come are new.
    pub(super) fn declare_ordered(&mut self) {
        self.schedule = Schedule { ordered: self.end, fresh: self.end, ..Schedule::default() };
    }

    /// Does this step's share of keeping the order; call it after [`Self::settle`].
    pub fn maintain(&mut self) {
        debug_assert_eq!(self.changed, 0, "maintenance comes after settling");
        if self.live == 0 {
            if self.end > 0 {
                self.clear();
            }
            return;
        }
        if self.schedule.snapshot.is_empty() {
            self.start_if_worn();
        } else if self.schedule.parts.is_empty() {
            self.apply_snapshot();
        } else {
            self.schedule.sort_some(self.live.max(LEAST_BUDGET));
        }
    }

    /// Looks at the surface in some calls only: the sum over all blocks is what an otherwise idle
    /// step would spend its time on.
    fn start_if_worn(&mut self) {
        self.schedule.calls = self.schedule.calls.wrapping_add(1);
        let looks = self.schedule.base.is_none() || self.schedule.calls.is_multiple_of(LOOK_EVERY);
        if self.is_spoilt() || (looks && self.is_worn()) {
            self.schedule.snapshot = self.items_from(0);
            self.schedule.parts = vec![(0, self.live)];
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "a count that weighs a heuristic")]
    fn is_worn(&mut self) -> bool {
        let surface = self.leaf_surface() / self.live as f64;
        let base = *self.schedule.base.get_or_insert(surface);
        surface > WORN * base
    }

    /// Too many objects came or went since the last renewal.
    fn is_spoilt(&self) -> bool {
        let (came, holes) = (self.end - self.schedule.ordered.min(self.end), self.end - self.live);
        came > self.live / 16 + SLACK || holes > self.live / 4 + SLACK
    }

    /// Moves the objects to the sorted places: those removed since are skipped, those added since
    /// follow at the end.
    fn apply_snapshot(&mut self) {
        let mut listed = vec![false; self.slots.len()];
        let mut ids = Vec::with_capacity(self.live);
        let sorted = core::mem::take(&mut self.schedule.snapshot);
        for item in &sorted {
            if self.contains(item.id) {
                listed[item.id as usize] = true;
                ids.push(item.id);
            }
        }
        let ordered = ids.len();
        let others = self.ids[..self.end].iter();
        ids.extend(others.filter(|&&id| id != NONE && !listed[id as usize]));
        self.rearrange(0, ids.into_iter());
        self.refit_layers();
        self.settle();
        self.schedule = Schedule { ordered, fresh: self.end, ..Schedule::default() };
    }
}

impl<const D: usize> Schedule<D> {
    /// Sorts parts of the snapshot until `budget` items have been handled; always at least one.
    fn sort_some(&mut self, budget: usize) {
        let mut done = 0;
        while done < budget {
            let Some((start, end)) = self.parts.pop() else { return };
            let items = &mut self.snapshot[start..end];
            if items.len() <= SORTED_AT_ONCE {
                sort(items);
                // As many levels as there are halvings down to one block.
                let levels = items.len().div_ceil(LANES).next_power_of_two().trailing_zeros();
                done += items.len() * (levels.max(1) as usize);
            } else if let Some(left) = split(items) {
                self.parts.extend([(start + left, end), (start, start + left)]);
                done += end - start;
            }
        }
    }
}
