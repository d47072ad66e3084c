//! When the order of slots is renewed, and how much of that work one step does.
//!
//! Moving objects spoil the order: the leaf blocks grow. When their surface is a fifth above what
//! it was after the last renewal (or many objects came or went), a snapshot of all centres is
//! sorted over several steps, and applied when it is done: work in proportion to the objects, which move. A tree of
//! objects that seldom change is renewed aside ([`super::renewal`]), a constant amount of work in each step. No
//! step depends on the time taken, so results are the same on every machine.

use super::order::{Item, sort, split};
use super::renewal::Renewal;
use super::{LANES, Tree};

/// Growth of the leaf surface per object that starts a renewal.
const WORN: f64 = 1.2;
/// One call in so many looks whether the order is worn.
const LOOK_EVERY: u32 = 4;
/// A part of the snapshot this small is sorted at once.
const SORTED_AT_ONCE: usize = 1024;
/// The least number of items that a step handles, so that small trees renew in few steps.
const MIN_BUDGET: usize = 2048;
/// One object in so many came or went elsewhere while the snapshot was sorted: it is worth nothing.
const LATE: usize = 4;
/// Objects that may come or go in any case before the order is renewed.
const SLACK: usize = 64;
/// A tree of objects that seldom change is sorted at once up to so many, and newcomers with no more others.
const SMALL: usize = 1024;

/// The state of the renewal.
#[derive(Clone, Debug)]
pub(super) struct Schedule<const D: usize> {
    /// Leaf surface per object after the last renewal; `None` if it is to be taken.
    base: Option<f64>,
    /// Slots from here on have come since the last renewal.
    ordered: usize,
    /// Slots from here on have come since the last [`Tree::refit`].
    fresh: usize,
    /// Where the slots begin that were sorted together since the last renewal, ascending: each run is
    /// longer than twice the next.
    runs: Vec<usize>,
    /// The centres being sorted, and the parts of them still to be.
    snapshot: Vec<Item<D>>,
    parts: Vec<(usize, usize)>,
    /// Calls without a renewal; wraps.
    calls: u32,
    /// Blocks were written to since the surface was looked at.
    is_used: bool,
    /// Objects that came, or went elsewhere, since the snapshot was taken: it knows nothing of where
    /// they are. Some may be listed twice or have gone.
    late: Vec<u32>,
    /// Memory for those that came.
    newcomers: Vec<Item<D>>,
    /// Memory for a new order, and by id whether an object has its place in it.
    order: Vec<u32>,
    is_placed: Vec<bool>,
}

impl<const D: usize> Default for Schedule<D> {
    fn default() -> Self {
        Self {
            base: None,
            ordered: 0,
            fresh: 0,
            runs: Vec::new(),
            newcomers: Vec::new(),
            snapshot: Vec::new(),
            parts: Vec::new(),
            calls: 0,
            is_used: true,
            late: Vec::new(),
            order: Vec::new(),
            is_placed: Vec::new(),
        }
    }
}

impl<const D: usize> Tree<D> {
    /// Objects came since the last refit.
    pub(super) const fn has_new(&self) -> bool {
        self.end > self.schedule.fresh
    }

    /// Sorts the objects that came since the last refit among themselves, or everything if they
    /// are a third of all. Those that came before them are sorted with them if they are not many more: so
    /// that there are few runs, and each object is sorted anew but a few times (the logarithmic method of
    /// Bentley and Saxe 1980).
    pub(super) fn sort_new(&mut self) {
        let new = self.end - self.schedule.fresh.min(self.end);
        if new * 3 > self.live {
            self.rebuild();
        } else if self.is_sparing && (new <= LANES || self.renewal.is_some()) {
            // They wait for others, since objects that come one by one have nothing in common, or for the renewal.
            return;
        } else if new > LANES {
            let most = if self.is_sparing { SMALL } else { usize::MAX };
            let start = self.schedule.next_run(self.end, most);
            self.sort_from(start);
        }
        self.schedule.fresh = self.end;
    }

    /// Sorts the objects in the slots from `start` (a block boundary) on.
    fn sort_from(&mut self, start: usize) {
        let mut items = core::mem::take(&mut self.schedule.newcomers);
        let mut ids = core::mem::take(&mut self.schedule.order);
        self.list_items(start, &mut items);
        sort(&mut items);
        ids.clear();
        ids.extend(items.iter().map(|item| item.id));
        self.rearrange(start, &ids);
        if !self.is_sparing {
            (self.schedule.newcomers, self.schedule.order) = (items, ids);
        }
    }

    /// Notes that boxes changed, so that the surface is worth a look.
    pub(super) fn note_use(&mut self) {
        self.schedule.is_used = true;
    }

    /// Sorts everything at once.
    pub(crate) fn rebuild(&mut self) {
        let mut items = core::mem::take(&mut self.schedule.snapshot);
        self.list_items(0, &mut items);
        sort(&mut items);
        let mut ids = core::mem::take(&mut self.schedule.order);
        ids.clear();
        ids.extend(items.iter().map(|item| item.id));
        self.rearrange(0, &ids);
        (self.schedule.snapshot, self.schedule.order) = (items, ids);
        self.schedule.begin(self.end, self.end);
        self.renewal = None;
        self.give_back();
    }

    /// Notes that an object has come, where a snapshot or a renewal does not know it.
    #[inline]
    pub(super) fn note_late(&mut self, id: u32) {
        if !self.schedule.snapshot.is_empty() {
            self.schedule.late.push(id);
        }
        if let Some(renewal) = &mut self.renewal {
            renewal.insert(id);
        }
    }

    /// Notes the same of all changed objects of blocks that were escaped.
    pub(super) fn note_strayed(&mut self) {
        if !self.schedule.snapshot.is_empty() {
            let mut late = core::mem::take(&mut self.schedule.late);
            late.extend(self.escaped());
            self.schedule.late = late;
        }
    }

    /// The objects in the slots before `end` are in order; the others, and those that come, are new.
    pub(super) fn declare_ordered(&mut self, end: usize) {
        self.schedule.begin(end, end);
    }

    /// Does this step's share of keeping the order; call it after [`Self::settle`].
    pub(crate) fn maintain(&mut self) {
        debug_assert_eq!(self.changed, 0, "maintenance comes after settling");
        if self.live == 0 {
            if self.end > 0 {
                self.clear();
            }
            return;
        }
        if self.is_sparing {
            self.renew_aside();
        } else if self.schedule.snapshot.is_empty() {
            self.start_if_worn();
        } else if self.schedule.late.len() * LATE > self.live {
            self.rebuild_at_once();
        } else if self.schedule.parts.is_empty() {
            self.apply_snapshot();
        } else {
            self.schedule.sort_some(self.live.max(MIN_BUDGET));
        }
    }

    /// Does the next steps of a renewal aside, or begins one where the order asks for it.
    fn renew_aside(&mut self) {
        if let Some(mut renewal) = self.renewal.take() {
            if renewal.proceed(self) {
                *self = renewal.into_tree();
            } else {
                self.renewal = Some(renewal);
            }
        } else if self.wants_order() {
            if self.live <= SMALL {
                self.rebuild_at_once();
            } else {
                self.renewal = Some(Box::new(Renewal::begin(self)));
            }
        }
    }

    /// Sorts everything, and leaves the tree settled as it was.
    fn rebuild_at_once(&mut self) {
        self.rebuild();
        self.refit_layers(&[]);
        self.settle();
    }

    fn start_if_worn(&mut self) {
        if self.wants_order() {
            let mut snapshot = core::mem::take(&mut self.schedule.snapshot);
            self.list_items(0, &mut snapshot);
            self.schedule.snapshot = snapshot;
            self.schedule.parts.push((0, self.live));
        }
    }

    /// Looks at the surface in some calls only: the sum over all blocks is what an otherwise idle
    /// step would spend its time on.
    fn wants_order(&mut self) -> bool {
        self.schedule.calls = self.schedule.calls.wrapping_add(1);
        let is_due = self.schedule.base.is_none() || self.schedule.calls.is_multiple_of(LOOK_EVERY);
        let looks = is_due && core::mem::take(&mut self.schedule.is_used);
        self.is_spoilt() || (looks && self.is_worn())
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

    /// Moves the objects to the sorted places: those removed since are skipped, and those that the
    /// snapshot does not know follow at the end, sorted among themselves.
    fn apply_snapshot(&mut self) {
        let mut ids = core::mem::take(&mut self.schedule.order);
        let mut is_placed = core::mem::take(&mut self.schedule.is_placed);
        let mut sorted = core::mem::take(&mut self.schedule.snapshot);
        is_placed.resize(self.slots.len(), false);
        ids.clear();
        ids.extend(sorted.iter().map(|item| item.id).filter(|&id| self.contains(id)));
        ids.iter().for_each(|&id| is_placed[id as usize] = true);
        self.schedule.late.iter().for_each(|&id| is_placed[id as usize] = false);
        ids.retain(|&id| is_placed[id as usize]);
        let ordered = ids.len();
        self.list_items(0, &mut sorted);
        sorted.retain(|item| !is_placed[item.id as usize]);
        sort(&mut sorted);
        ids.iter().for_each(|&id| is_placed[id as usize] = false);
        ids.extend(sorted.iter().map(|item| item.id));
        self.rearrange(0, &ids);
        self.schedule.snapshot = sorted;
        (self.schedule.order, self.schedule.is_placed) = (ids, is_placed);
        self.schedule.begin(ordered, self.end);
        self.give_back();
        self.refit_layers(&[]);
        self.settle();
    }
}

impl<const D: usize> Tree<D> {
    /// Gives back memory that a tree in which little happens would keep for nothing.
    pub(super) fn give_back(&mut self) {
        if self.is_sparing {
            let Schedule { base, ordered, fresh, calls, is_used, .. } = self.schedule;
            let runs = core::mem::take(&mut self.schedule.runs);
            let kept =
                Schedule { base, ordered, fresh, runs, calls, is_used, ..Schedule::default() };
            self.schedule = kept;
        }
    }
}

impl<const D: usize> Schedule<D> {
    /// Begins a new round after the order was renewed; keeps the memory.
    fn begin(&mut self, ordered: usize, fresh: usize) {
        (self.base, self.ordered, self.fresh) = (None, ordered, fresh);
        self.runs.clear();
        if ordered < fresh {
            self.runs.push(ordered.div_ceil(LANES) * LANES);
        }
        (self.calls, self.is_used) = (0, true);
        self.snapshot.clear();
        self.parts.clear();
        self.late.clear();
    }

    /// There are no slots from `end` on.
    pub(super) fn forget_slots_from(&mut self, end: usize) {
        (self.ordered, self.fresh) = (self.ordered.min(end), self.fresh.min(end));
    }

    /// Where the slots begin that are to be sorted together, as far as `end`: newcomers, and others if they are `most`
    /// in all.
    fn next_run(&mut self, end: usize, most: usize) -> usize {
        let mut start = self.fresh / LANES * LANES;
        self.runs.retain(|&run| run < start);
        let is_short = |run: usize, start| start - run <= 2 * (end - start) && end - run <= most;
        while let Some(&run) = self.runs.last().filter(|&&run| is_short(run, start)) {
            start = run;
            self.runs.pop();
        }
        self.runs.push(start);
        start
    }

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
