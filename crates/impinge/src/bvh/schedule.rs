//! The schedule of renewals: when the order of slots is renewed, and how much of that work one step
//! does.
//!
//! Moving objects spoil the order: the leaf blocks grow. When their surface for each object is a
//! fifth above that after the last renewal (or many objects came or went), a snapshot of all
//! centres is sorted over several steps and then applied: work proportional to the number of
//! objects, which move anyway. A sparing tree is renewed in a copy ([`super::renewal`]), with a
//! constant amount of work in each step. No step depends on measured time, so results are equal on
//! every machine.

use super::order::{Item, sort, split};
use super::renewal::Renewal;
use super::{LANES, Tree};

/// Growth of the leaf surface per object at which a renewal starts.
const WORN: f64 = 1.2;
/// Period, in calls, of the check whether the order is worn.
const LOOK_EVERY: u32 = 4;
/// Size up to which a part of the snapshot is sorted at once.
const SORTED_AT_ONCE: usize = 1024;
/// Least number of items that a step handles, so that small trees renew in few steps.
const MIN_BUDGET: usize = 2048;
/// If more than one object in `LATE` came or moved far while the snapshot was sorted, the snapshot
/// is discarded.
const LATE: usize = 4;
/// Number of objects that may always come or go before the order is renewed.
const SLACK: usize = 64;
/// A sparing tree of at most `SMALL` objects is sorted at once; newcomers are sorted in runs of at
/// most as many.
const SMALL: usize = 1024;

/// The state of the renewal.
#[derive(Clone, Debug)]
pub(super) struct Schedule<const D: usize> {
    /// Leaf surface per object after the last renewal; `None` if it must be measured.
    base: Option<f64>,
    /// First slot that came since the last renewal.
    ordered: usize,
    /// First slot that came since the last [`Tree::refit`].
    fresh: usize,
    /// First slots of the runs sorted since the last renewal, ascending: each run is longer than
    /// twice the next.
    runs: Vec<usize>,
    /// The centres being sorted, and the parts not yet sorted.
    snapshot: Vec<Item<D>>,
    parts: Vec<(usize, usize)>,
    /// Calls since the last renewal; wraps.
    calls: u32,
    /// Blocks were written since the last check of the surface.
    is_used: bool,
    /// Objects that came or moved far since the snapshot was taken, whose positions in it are
    /// wrong. May have repeats and removed objects.
    late: Vec<u32>,
    /// Scratch: new objects.
    newcomers: Vec<Item<D>>,
    /// Scratch: a new order, and by id whether an object has a position in it.
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
    /// Returns `true` if objects came since the last refit.
    pub(super) const fn has_new(&self) -> bool {
        self.end > self.schedule.fresh
    }

    /// Sorts the objects that came since the last refit among themselves, or all objects if the new
    /// ones are a third. Earlier runs are merged in if they are not much longer, so that there are
    /// few runs and each object is sorted again only a few times (the logarithmic method of Bentley
    /// and Saxe 1980).
    pub(super) fn sort_new(&mut self) {
        let new = self.end - self.schedule.fresh.min(self.end);
        if new * 3 > self.live {
            self.rebuild();
        } else if self.is_sparing && (new <= LANES || self.renewal.is_some()) {
            // These wait for more objects, since a few single ones are not neighbours, or for the
            // renewal.
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

    /// Notes that boxes changed, so that the surface must be checked.
    pub(super) fn note_use(&mut self) {
        self.schedule.is_used = true;
    }

    /// Sorts all objects at once.
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

    /// Notes a new object that a snapshot or a renewal under way does not contain.
    #[inline]
    pub(super) fn note_late(&mut self, id: u32) {
        if !self.schedule.snapshot.is_empty() {
            self.schedule.late.push(id);
        }
        if let Some(renewal) = &mut self.renewal {
            renewal.insert(id);
        }
    }

    /// Notes the changed objects of escaped blocks, whose positions in a snapshot are wrong.
    pub(super) fn note_strayed(&mut self) {
        if !self.schedule.snapshot.is_empty() {
            let mut late = core::mem::take(&mut self.schedule.late);
            late.extend(self.escaped());
            self.schedule.late = late;
        }
    }

    /// Declares the objects in the slots before `end` sorted; later ones count as new.
    pub(super) fn declare_ordered(&mut self, end: usize) {
        self.schedule.begin(end, end);
    }

    /// Does this step's share of keeping the order; must be called after [`Self::settle`].
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

    /// Continues a renewal in a copy, or begins one if the order is worn.
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

    /// Sorts all objects, and settles the tree again.
    fn rebuild_at_once(&mut self) {
        self.rebuild();
        self.refit_layers(&[]);
        self.settle();
    }

    /// Takes a snapshot of all objects, to be sorted in steps, if the order should be renewed.
    fn start_if_worn(&mut self) {
        if self.wants_order() {
            let mut snapshot = core::mem::take(&mut self.schedule.snapshot);
            self.list_items(0, &mut snapshot);
            self.schedule.snapshot = snapshot;
            self.schedule.parts.push((0, self.live));
        }
    }

    /// Returns `true` if the order should be renewed. Checks the surface in some calls only,
    /// because the sum over all blocks would dominate an otherwise idle step.
    fn wants_order(&mut self) -> bool {
        self.schedule.calls = self.schedule.calls.wrapping_add(1);
        let is_due = self.schedule.base.is_none() || self.schedule.calls.is_multiple_of(LOOK_EVERY);
        let looks = is_due && core::mem::take(&mut self.schedule.is_used);
        self.is_spoilt() || (looks && self.is_worn())
    }

    /// Returns `true` if the surface of leaf blocks for each object exceeds [`WORN`] times that of
    /// the first check since the renewal.
    #[expect(clippy::cast_precision_loss, reason = "a count that weighs a heuristic")]
    fn is_worn(&mut self) -> bool {
        let surface = self.leaf_surface() / self.live as f64;
        let base = *self.schedule.base.get_or_insert(surface);
        surface > WORN * base
    }

    /// Returns `true` if too many objects came or went since the last renewal.
    fn is_spoilt(&self) -> bool {
        let (came, holes) = (self.end - self.schedule.ordered.min(self.end), self.end - self.live);
        came > self.live / 16 + SLACK || holes > self.live / 4 + SLACK
    }

    /// Moves the objects to their sorted positions. Objects removed since are skipped; those
    /// missing in the snapshot follow at the end, sorted among themselves.
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
    /// Releases the scratch memory of a sparing tree.
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
    /// Begins a new period after the order was renewed; keeps the memory.
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

    /// Notes that there are no slots from `end` on.
    pub(super) fn forget_slots_from(&mut self, end: usize) {
        (self.ordered, self.fresh) = (self.ordered.min(end), self.fresh.min(end));
    }

    /// Returns the first slot of the run to be sorted up to `end`: the newcomers, merged with
    /// earlier runs while these are short and the total is at most `most`.
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

    /// Sorts parts of the snapshot until `budget` items have been handled; always at least one
    /// part.
    fn sort_some(&mut self, budget: usize) {
        let mut done = 0;
        while done < budget {
            let Some((start, end)) = self.parts.pop() else { return };
            let items = &mut self.snapshot[start..end];
            if items.len() <= SORTED_AT_ONCE {
                sort(items);
                // The number of levels is that of halvings down to one block.
                let levels = items.len().div_ceil(LANES).next_power_of_two().trailing_zeros();
                done += items.len() * (levels.max(1) as usize);
            } else if let Some(left) = split(items) {
                self.parts.extend([(start + left, end), (start, start + left)]);
                done += end - start;
            }
        }
    }
}
