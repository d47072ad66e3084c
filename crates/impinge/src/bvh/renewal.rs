//! Renewal of a sparing tree: its boxes are copied, in a new spatial order, to another tree, a
//! bounded number in each step.
//!
//! Objects inserted since the last renewal are at the end, or in lanes of removed objects, so the
//! order degrades. A renewal fills another tree with all objects of the sparing tree, and then
//! replaces the sparing tree by the other tree:
//!
//! ```text
//!   this tree        | all slots, in any order                       |
//!                        |      |      |      |      |                  1. Route: each object goes to a region
//!                        v      v      v      v      v
//!   regions of a     |  0  |  1  |  2  |  3  |  4  |  5  |  6  |  7  |  2. Copy: the objects of each region, sorted
//!   k-d tree            |     |     |     |     |     |     |     |
//!                       v     v     v     v     v     v     v     v
//!   the other tree   | sorted                              | late    |  3. Follow: objects that came in the meantime
//! ```
//!
//! The regions are the leaves of a k-d tree over a sample (a sample sort), so the new order is
//! close to the order of [`sort`]. Removals and changed boxes are applied to both trees at once.
//! The result depends only on the calls, never on measured time.

use super::order::{Cut, Item, cut_in_half, sort};
use super::tree::{Layer, small};
use super::{Bounds, LANES, NONE, Tree};

/// Slots routed in one step, and objects sorted and copied in one step.
const ROUTED: usize = 1024;
const COPIED: usize = 512;
/// Late objects added in one step: the larger of [`FOLLOWED`] and the fraction 1 / [`FOLLOWED_OF`]
/// of the late objects that are left. Inserted objects also add work units, and these add steps. So
/// this stage ends however many objects are inserted.
const FOLLOWED: usize = 128;
const FOLLOWED_OF: usize = 16;
/// Work units that a new object and a changed object add; each [`OF_STEP`] units make one
/// additional step in the next call.
const OF_INSERT: usize = 64;
const OF_SET: usize = 1;
const OF_STEP: usize = 4096;
/// Greatest depth of the k-d tree, and number of sampled objects for each region.
const MAX_DEPTH: u32 = 10;
const SAMPLES: usize = 4;

/// The state of a renewal that has begun.
#[derive(Clone, Debug)]
pub(super) struct Renewal<const D: usize> {
    stage: Stage,
    /// A binary tree of cuts: the children of cut `n` have indices `2 n + 1` and `2 n + 2`. An
    /// index `i ≥ cuts.len()` is region `i - cuts.len()`.
    cuts: Vec<Cut>,
    /// Linked lists, with entries as indices in `ids`: `last_of` has the last entry of each region,
    /// and `before` the previous entry of each entry.
    last_of: Vec<u32>,
    before: Vec<u32>,
    ids: Vec<u32>,
    /// The tree being filled.
    other: Tree<D>,
    /// Objects inserted since the renewal began. Some may have been removed.
    late: Vec<u32>,
    /// Work units added by changes since the last call of [`Self::proceed`].
    owed_units: usize,
}

/// A stage, with its progress.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Route the slots from the first value up to the second, exclusive.
    Route(usize, usize),
    /// Copy the rest of a region's list, then the regions from the second value on. The first value
    /// is the entry of the list to copy next, or [`NONE`] at the end of the list.
    Copy(u32, usize),
    /// Add the objects inserted since the renewal began.
    Follow,
}

impl<const D: usize> Renewal<D> {
    /// Begins a renewal of `tree`: chooses the regions by a sample of its objects.
    pub(super) fn begin(tree: &Tree<D>) -> Self {
        let wanted = tree.live.div_ceil(COPIED).next_power_of_two();
        let depth = wanted.trailing_zeros().min(MAX_DEPTH);
        let step = (tree.end / (SAMPLES << depth)).max(1);
        let sample = tree.ids[..tree.end].iter().step_by(step);
        let mut sample: Vec<_> = sample.filter_map(|&id| tree.item(id)).collect();
        let mut cuts = vec![Cut::default(); (1 << depth) - 1];
        fill(&mut cuts, 0, &mut sample);
        Self {
            stage: Stage::Route(0, tree.end),
            cuts,
            last_of: vec![NONE; 1 << depth],
            before: Vec::with_capacity(tree.live),
            ids: Vec::with_capacity(tree.live),
            other: tree.empty_twin(),
            late: Vec::new(),
            owed_units: 0,
        }
    }

    /// Records that an object was inserted in the old tree; the last stage adds the object to the
    /// other tree.
    pub(super) fn insert(&mut self, id: u32) {
        self.late.push(id);
        self.owed_units += OF_INSERT;
    }

    /// Records that a box of the old tree has changed; also sets the box in the other tree if the
    /// object is there already.
    pub(super) fn set(&mut self, id: u32, bounds: &Bounds<D>) {
        if self.other.contains(id) {
            self.other.set_still(id, bounds);
        }
        self.owed_units += OF_SET;
    }

    /// Removes from the other tree an object that was removed from the old one.
    pub(super) fn remove(&mut self, id: u32) {
        if self.other.contains(id) {
            self.other.remove(id);
        }
    }

    /// Performs the next step, and additional steps if many objects were inserted or changed.
    /// Returns `true` if the other tree is complete.
    pub(super) fn proceed(&mut self, tree: &Tree<D>) -> bool {
        let steps = 1 + core::mem::take(&mut self.owed_units) / OF_STEP;
        (0..steps).any(|_| self.step(tree))
    }

    /// Performs one step of the current stage, then commits the other tree. Returns `true` if the
    /// other tree is complete.
    fn step(&mut self, tree: &Tree<D>) -> bool {
        match self.stage {
            Stage::Route(slot, end) => self.route(tree, slot, end),
            Stage::Copy(object, region) => self.copy(tree, object, region),
            Stage::Follow => return self.follow(tree),
        }
        self.other.refit_layers(&[]);
        self.other.commit_boxes();
        false
    }

    /// Returns the other tree, which is refitted and committed. Call it once [`Self::proceed`] has
    /// returned `true`.
    pub(super) fn into_tree(self) -> Tree<D> {
        self.other
    }

    /// Routes the objects in the next slots, from `slot` up to `end`, to their regions.
    fn route(&mut self, tree: &Tree<D>, slot: usize, end: usize) {
        let next = end.min(slot + ROUTED);
        for item in tree.ids[slot..next].iter().filter_map(|&id| tree.item(id)) {
            let mut at = 0;
            // Descends the tree of cuts; an index beyond the cuts is a region.
            while let Some(cut) = self.cuts.get(at) {
                at = 2 * at + 1 + usize::from(cut.is_beyond(&item));
            }
            let last = &mut self.last_of[at - self.cuts.len()];
            self.before.push(core::mem::replace(last, small(self.ids.len())));
            self.ids.push(item.id);
        }
        self.stage = if next < end { Stage::Route(next, end) } else { Stage::Copy(NONE, 0) };
    }

    /// Copies the next objects of a region, up to [`COPIED`] and sorted, to the end of the other
    /// tree.
    fn copy(&mut self, tree: &Tree<D>, mut object: u32, mut region: usize) {
        if object == NONE {
            object = self.last_of[region];
            region += 1;
        }
        let mut items = Vec::with_capacity(COPIED);
        while object != NONE && items.len() < COPIED {
            items.extend(tree.item(self.ids[object as usize]));
            object = self.before[object as usize];
        }
        sort(&mut items);
        for item in &items {
            self.add(tree, item.id, true);
        }
        self.stage = if object != NONE || region < self.last_of.len() {
            Stage::Copy(object, region)
        } else {
            self.other.declare_ordered(self.other.end);
            Stage::Follow
        };
    }

    /// Adds late objects; returns `true` if none are left.
    fn follow(&mut self, tree: &Tree<D>) -> bool {
        let count = FOLLOWED.max(self.late.len() / FOLLOWED_OF);
        let rest = self.late.len().saturating_sub(count);
        for id in self.late.split_off(rest) {
            self.add(tree, id, false);
        }
        self.other.refit();
        self.other.commit_boxes();
        rest == 0
    }

    /// Adds an object to the other tree: at the end if `at_end`, else in the slot that
    /// [`Tree::find_slot`] returns. Skips an object that was removed or that the other tree already
    /// contains.
    fn add(&mut self, tree: &Tree<D>, id: u32, at_end: bool) {
        let bounds = tree.bounds(id).filter(|_| !self.other.contains(id));
        if let Some(bounds) = bounds {
            if at_end {
                self.other.append(id, &bounds);
            } else {
                self.other.insert_still(id, &bounds);
            }
        }
    }
}

/// Cuts a sample in half, and both halves recursively. The recursion ends, since each call goes one
/// level deeper in `cuts`.
fn fill<const D: usize>(cuts: &mut [Cut], at: usize, sample: &mut [Item<D>]) {
    if at >= cuts.len() {
        return;
    }
    let (cut, half) = cut_in_half(sample);
    cuts[at] = cut;
    let (near, far) = sample.split_at_mut(half);
    fill(cuts, 2 * at + 1, near);
    fill(cuts, 2 * at + 2, far);
}

impl<const D: usize> Tree<D> {
    /// Creates a sparing tree without objects, with memory for all objects of this tree.
    fn empty_twin(&self) -> Self {
        let (mut twin, blocks) = (Self::sparing(self.lanes), self.live.div_ceil(LANES) + 1);
        let Layer { blocks: leaves, bounds, swept, changed, .. } = &mut twin.layers[0];
        leaves.reserve(blocks);
        bounds.reserve(blocks);
        swept.reserve(blocks);
        changed.reserve(blocks);
        twin.is_touched.reserve(blocks);
        twin.ids.reserve(blocks * LANES);
        twin.slots.resize(self.slots.len(), NONE);
        twin
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{next, random_box, take_placed};
    use super::super::{Bounds, Lanes};
    use super::*;

    /// Expected content of a tree, by id.
    type List = Vec<Option<Bounds<3>>>;

    /// Inserts `came` objects, and removes or changes up to 20, in one step of a tree.
    fn play(state: &mut u64, tree: &mut Tree<3>, list: &mut List, came: u32) {
        for _ in 0..came {
            list.push(Some(random_box(state, 60)));
            tree.insert_still(small(list.len() - 1), &list[list.len() - 1].expect("it came"));
        }
        for _ in 0..20 {
            let id = next(state, small(list.len()));
            let Some(own) = &mut list[id as usize] else { continue };
            if next(state, 3) == 0 {
                tree.remove(id);
                list[id as usize] = None;
            } else {
                own.hi[0] += 0.25;
                tree.set_still(id, own);
            }
        }
        tree.refit();
        tree.commit_boxes();
        tree.maintain();
    }

    #[test]
    fn no_step_renews_much_and_nothing_is_lost() {
        let (mut state, mut list) = (3, List::new());
        let mut tree = Tree::<3>::sparing(Lanes::detect());
        let (mut renewed, mut was_renewing) = (0, false);
        for step in 0..1500 {
            let came = if step < 900 { 16 } else { 0 };
            play(&mut state, &mut tree, &mut list, came);
            let placed = take_placed();
            // The bound: 16 newcomers, a run of up to 1024 sorted with them, and a copied chunk or
            // a small tree of up to 1024.
            assert!(placed <= 16 + 2 * 1024, "{placed} objects in step {step}");
            renewed += usize::from(was_renewing && tree.renewal.is_none());
            was_renewing = tree.renewal.is_some();
            if step % 10 == 0 {
                assert_eq!(tree.validate(), Ok(()), "in step {step}");
                let kept = (0..small(list.len())).map(|id| tree.bounds(id));
                assert!(kept.eq(list.iter().copied()), "in step {step}");
            }
        }
        assert!(renewed > 5, "{renewed} renewals");
    }

    #[test]
    fn what_came_at_random_is_brought_into_order() {
        let (mut state, mut list) = (4, List::new());
        let mut tree = Tree::<3>::sparing(Lanes::detect());
        (0..400).for_each(|_| play(&mut state, &mut tree, &mut list, 16));
        (0..200).for_each(|_| play(&mut state, &mut tree, &mut list, 0));
        let own = tree.leaf_surface();
        tree.rebuild();
        tree.refit();
        assert!(own < 3.0 * tree.leaf_surface(), "{own} against {}", tree.leaf_surface());
    }
}
