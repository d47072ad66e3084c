//! The schedule of renewals: when the order of slots is renewed, and how much of that work one step
//! does.
//!
//! Moving objects spoil the order: the leaf blocks grow. A renewal starts when the leaf surface per
//! object is a fifth above its value after the last renewal, or when many objects were inserted or
//! removed. Then a snapshot of all centres is sorted over several steps and applied; the work of
//! one step is proportional to the number of objects. A sparing tree, whose objects seldom change,
//! is instead renewed in a copy ([`super::renewal`]), with a bounded amount of work in each step.
//! No step depends on measured time, so results are equal on every machine.

use super::order::{Item, sort, split};
use super::renewal::Renewal;
use super::{LANES, Tree};
use crate::memory::clone_fields;

/// A renewal starts when the leaf surface per object exceeds this multiple of its value after the
/// last renewal.
const WORN: f64 = 1.2;
/// Calls of `wants_order` between two measurements of the leaf surface.
const LOOK_EVERY: u32 = 4;
/// Greatest number of items of the snapshot that are sorted at once.
const SORTED_AT_ONCE: usize = 1024;
/// Least budget of one step for sorting the snapshot, in items times levels of the sort, so that
/// small trees are renewed in few steps.
const MIN_BUDGET: usize = 2048;
/// If more than one object in `LATE` was inserted or moved far since the snapshot was taken, the
/// snapshot is discarded and all objects are sorted at once.
const LATE: usize = 4;
/// Number of objects that may be inserted or removed in a tree of any size before the order is
/// renewed.
const SLACK: usize = 64;
/// A sparing tree ([`Tree::is_sparing`]) of at most `SMALL` objects is sorted at once. In a larger
/// sparing tree, new objects are sorted in runs of at most about `SMALL` slots.
const SMALL: usize = 1024;

/// The state of the renewal.
#[derive(Debug)]
pub(super) struct Schedule<const D: usize> {
    /// Leaf surface per object, first measured after the last renewal; `None` until then.
    base: Option<f64>,
    /// First slot that was not in use at the last renewal; the objects in earlier slots were sorted
    /// then.
    ordered: usize,
    /// First slot whose object has not been sorted yet.
    fresh: usize,
    /// First slots of the runs sorted since the last renewal, ascending. Each run is more than
    /// twice as long as the next, except that runs of a sparing tree are not merged beyond
    /// [`SMALL`] slots.
    runs: Vec<usize>,
    /// The centres being sorted, and the parts not yet sorted.
    snapshot: Vec<Item<D>>,
    parts: Vec<(usize, usize)>,
    /// Calls of `wants_order` since the last renewal; wraps.
    calls: u32,
    /// Whether blocks were written since the last measurement of the surface.
    is_used: bool,
    /// Objects that were inserted or moved far since the snapshot was taken: the snapshot lacks
    /// them or has them at wrong positions. May have repeats and removed objects.
    late: Vec<u32>,
    /// Scratch: new objects.
    newcomers: Vec<Item<D>>,
    /// Scratch: a new order of ids, and by id whether the object has a position in that order.
    order: Vec<u32>,
    is_placed: Vec<bool>,
}

clone_fields!([const D: usize] Schedule<D> {
    base, ordered, fresh, runs, snapshot, parts, calls, is_used, late, newcomers, order, is_placed,
});

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
    /// Returns `true` if there are slots at the end whose objects have not been sorted yet.
    pub(super) const fn has_new(&self) -> bool {
        self.end > self.schedule.fresh
    }

    /// Sorts the objects inserted since the last sort among themselves, or all objects if more than
    /// a third are new. Earlier runs are merged in while they are short, so that there are few runs
    /// and each object is sorted again only a few times (the logarithmic method of Bentley and Saxe
    /// 1980). Up to 16 new objects are not sorted; in a sparing tree they wait for more.
    pub(super) fn sort_new(&mut self) {
        let new = self.end - self.schedule.fresh.min(self.end);
        if new * 3 > self.live {
            self.rebuild();
        } else if self.is_sparing && (new <= LANES || self.renewal.is_some()) {
            // In a sparing tree new objects stay unsorted while there are at most 16 of them: few
            // objects are rarely close together, and sorting them gains little. They also stay
            // unsorted during a renewal, because the renewal puts them in their places.
            return;
        } else if new > LANES {
            let most = if self.is_sparing { SMALL } else { usize::MAX };
            let start = self.schedule.next_run(self.end, most);
            self.sort_from(start);
        }
        self.schedule.fresh = self.end;
    }

    /// Sorts the objects in the slots from `start`, a multiple of 16, to the end.
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

    /// Records that boxes changed. The surface must then be measured again.
    pub(super) fn note_use(&mut self) {
        self.schedule.is_used = true;
    }

    /// Sorts all objects at once, and drops a renewal or snapshot in progress. A refit must follow.
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

    /// Records a new object, which a snapshot or a renewal in progress lacks.
    #[inline]
    pub(super) fn note_late(&mut self, id: u32) {
        if !self.schedule.snapshot.is_empty() {
            self.schedule.late.push(id);
        }
        if let Some(renewal) = &mut self.renewal {
            renewal.insert(id);
        }
    }

    /// Adds the changed objects of escaped blocks to the late objects, because a snapshot in
    /// progress has them at wrong positions.
    pub(super) fn note_strayed(&mut self) {
        if !self.schedule.snapshot.is_empty() {
            let mut late = core::mem::take(&mut self.schedule.late);
            late.extend(self.escaped());
            self.schedule.late = late;
        }
    }

    /// Declares the slots before `end` sorted; objects in later slots are new.
    pub(super) fn declare_ordered(&mut self, end: usize) {
        self.schedule.begin(end, end);
    }

    /// Performs this step's share of the renewal of the order. Must be called after
    /// [`Self::commit_boxes`].
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

    /// Continues the renewal of a sparing tree. If no renewal is in progress and
    /// [`Self::wants_order`] returns `true`, begins one, or sorts a tree of at most [`SMALL`]
    /// objects at once.
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

    /// Sorts all objects, then refits and commits the tree.
    fn rebuild_at_once(&mut self) {
        self.rebuild();
        self.refit_layers(&[]);
        self.commit_boxes();
    }

    /// If [`Self::wants_order`] returns `true`, takes a snapshot of all objects, to be sorted over
    /// several steps.
    fn start_if_worn(&mut self) {
        if self.wants_order() {
            let mut snapshot = core::mem::take(&mut self.schedule.snapshot);
            self.list_items(0, &mut snapshot);
            self.schedule.snapshot = snapshot;
            self.schedule.parts.push((0, self.live));
        }
    }

    /// Counts the call, and returns `true` if the order should be renewed. Measures the surface at
    /// the first call after a renewal and then in one of [`LOOK_EVERY`] calls, and only if boxes
    /// changed since the last measurement: the sum over all blocks would dominate an otherwise idle
    /// step.
    fn wants_order(&mut self) -> bool {
        self.schedule.calls = self.schedule.calls.wrapping_add(1);
        let is_due = self.schedule.base.is_none() || self.schedule.calls.is_multiple_of(LOOK_EVERY);
        let looks = is_due && core::mem::take(&mut self.schedule.is_used);
        self.is_spoilt() || (looks && self.is_worn())
    }

    /// Returns `true` if the leaf surface per object exceeds [`WORN`] times its first measurement
    /// since the renewal. The first call stores that measurement.
    #[expect(clippy::cast_precision_loss, reason = "a count that weighs a heuristic")]
    fn is_worn(&mut self) -> bool {
        let surface = self.leaf_surface() / self.live as f64;
        let base = *self.schedule.base.get_or_insert(surface);
        surface > WORN * base
    }

    /// Returns `true` if more than a sixteenth of the objects, plus [`SLACK`], occupy slots added
    /// since the last renewal, or if the free slots before `end` exceed a quarter of the objects,
    /// plus [`SLACK`].
    fn is_spoilt(&self) -> bool {
        let (came, holes) = (self.end - self.schedule.ordered.min(self.end), self.end - self.live);
        came > self.live / 16 + SLACK || holes > self.live / 4 + SLACK
    }

    /// Moves the objects to their sorted positions, then refits and commits the tree. Skips objects
    /// that were removed since the snapshot. Objects that the snapshot lacks, and late objects,
    /// follow at the end, sorted among themselves.
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
        self.commit_boxes();
    }
}

impl<const D: usize> Tree<D> {
    /// Releases the scratch memory of a sparing tree; does nothing for another tree.
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
    /// Resets the schedule after the order was renewed; keeps the memory. Slots before `ordered`
    /// are sorted as a whole, and slots from `ordered` to `fresh` as a run.
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

    /// Clamps the slot indices to `end`, after the slots from `end` on were dropped.
    pub(super) fn forget_slots_from(&mut self, end: usize) {
        (self.ordered, self.fresh) = (self.ordered.min(end), self.fresh.min(end));
    }

    /// Records a new run that ends at `end`, and returns its first slot. The run has the new
    /// objects. While the last earlier run is at most twice as long as the new run, and both
    /// together have at most `most` slots, it becomes a part of the new run.
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

    /// Sorts parts of the snapshot until the items sorted, each counted once for each level of the
    /// sort, reach `budget`. Sorts or splits at least one part.
    fn sort_some(&mut self, budget: usize) {
        let mut done = 0;
        while done < budget {
            let Some((start, end)) = self.parts.pop() else { return };
            let items = &mut self.snapshot[start..end];
            if items.len() <= SORTED_AT_ONCE {
                sort(items);
                // Sorting halves the items this many times, down to one block.
                let levels = items.len().div_ceil(LANES).next_power_of_two().trailing_zeros();
                done += items.len() * (levels.max(1) as usize);
            } else if let Some(left) = split(items) {
                self.parts.extend([(start + left, end), (start, start + left)]);
                done += end - start;
            }
        }
    }
}
