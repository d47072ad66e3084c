//! Renewal of a sparing tree: its boxes are copied in order to another tree, a bounded number in each step.
//!
//! Objects that came since the last renewal are at the end, or in lanes that others left. A renewal fills another tree
//! with the same objects, which then replaces the first:
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
//! The regions are those of a k-d tree over a sample (a sample sort), so that the order is nearly that of [`sort`],
//! whatever it was before. Removals and changed boxes are applied to both trees at once. The result depends only on the
//! calls, never on measured time.

use super::order::{Cut, Item, cut_in_half, sort};
use super::tree::{Layer, small};
use super::{Bounds, LANES, NONE, Tree};

/// Slots that one step routes, and objects that it sorts and copies.
const ROUTED: usize = 1024;
const COPIED: usize = 512;
/// Late objects that one step adds: at least [`FOLLOWED`], and at least one in [`FOLLOWED_OF`], so that the stage ends
/// however many come.
const FOLLOWED: usize = 128;
const FOLLOWED_OF: usize = 16;
/// Work units that a new object and a changed one add to the next call, and units for each further step of that call.
const OF_INSERT: usize = 64;
const OF_SET: usize = 1;
const OF_STEP: usize = 4096;
/// Greatest depth of the k-d tree, and sampled objects for each region.
const MAX_DEPTH: u32 = 10;
const SAMPLES: usize = 4;

/// A renewal under way.
#[derive(Clone, Debug)]
pub(super) struct Renewal<const D: usize> {
    stage: Stage,
    /// A binary tree of cuts: the children of cut `n` are `2 n + 1` and `2 n + 2`; regions follow the cuts in the same
    /// numbering.
    cuts: Vec<Cut>,
    /// Linked lists as indices in `ids`: by region the last object routed to it, and by object the previous one.
    last_of: Vec<u32>,
    before: Vec<u32>,
    ids: Vec<u32>,
    /// The tree being filled.
    other: Tree<D>,
    /// Objects that came since the renewal began. Some may be gone.
    late: Vec<u32>,
    /// Work units added by changes since the last call.
    asked: usize,
}

/// A stage, with its progress.
#[derive(Clone, Copy, Debug)]
enum Stage {
    /// Route the slots from the first number up to the second.
    Route(usize, usize),
    /// Copy the list that ends with this object ([`NONE`]: empty), then the regions from this one on.
    Copy(u32, usize),
    /// Add the objects that came in the meantime.
    Follow,
}

impl<const D: usize> Renewal<D> {
    /// Begins a renewal: chooses the regions by a sample of the objects.
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
            asked: 0,
        }
    }

    /// Notes that an object was inserted in this tree.
    pub(super) fn insert(&mut self, id: u32) {
        self.late.push(id);
        self.asked += OF_INSERT;
    }

    /// Notes that an object of this tree has another box.
    pub(super) fn set(&mut self, id: u32, bounds: &Bounds<D>) {
        if self.other.contains(id) {
            self.other.set_still(id, bounds);
        }
        self.asked += OF_SET;
    }

    /// Notes that an object was removed from this tree.
    pub(super) fn remove(&mut self, id: u32) {
        if self.other.contains(id) {
            self.other.remove(id);
        }
    }

    /// Does the next step, and more if many objects came or changed. Returns `true` if the other tree is complete.
    pub(super) fn proceed(&mut self, tree: &Tree<D>) -> bool {
        let steps = 1 + core::mem::take(&mut self.asked) / OF_STEP;
        (0..steps).any(|_| self.step(tree))
    }

    /// Does one step of the present stage; the other tree is settled afterwards. Returns `true` if it is complete.
    fn step(&mut self, tree: &Tree<D>) -> bool {
        match self.stage {
            Stage::Route(slot, end) => self.route(tree, slot, end),
            Stage::Copy(object, region) => self.copy(tree, object, region),
            Stage::Follow => return self.follow(tree),
        }
        self.other.refit_layers(&[]);
        self.other.settle();
        false
    }

    /// Returns the other tree once it is complete; settled, as it is after each step.
    pub(super) fn into_tree(self) -> Tree<D> {
        self.other
    }

    /// Routes the objects in the next slots, from `slot` on, to their regions.
    fn route(&mut self, tree: &Tree<D>, slot: usize, end: usize) {
        let next = end.min(slot + ROUTED);
        for item in tree.ids[slot..next].iter().filter_map(|&id| tree.item(id)) {
            let mut at = 0;
            // Down the tree of cuts: an index beyond the cuts is that of a region.
            while let Some(cut) = self.cuts.get(at) {
                at = 2 * at + 1 + usize::from(cut.is_beyond(&item));
            }
            let last = &mut self.last_of[at - self.cuts.len()];
            self.before.push(core::mem::replace(last, small(self.ids.len())));
            self.ids.push(item.id);
        }
        self.stage = if next < end { Stage::Route(next, end) } else { Stage::Copy(NONE, 0) };
    }

    /// Copies the next objects of a region, sorted, to the end of the other tree.
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

    /// Adds late objects; returns `true` if there are no more.
    fn follow(&mut self, tree: &Tree<D>) -> bool {
        let count = FOLLOWED.max(self.late.len() / FOLLOWED_OF);
        let rest = self.late.len().saturating_sub(count);
        for id in self.late.split_off(rest) {
            self.add(tree, id, false);
        }
        self.other.refit();
        self.other.settle();
        rest == 0
    }

    /// Adds an object to the other tree, at the end or where it fits, unless it is gone or there already.
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

/// Cuts a sample in half, and both halves recursively. Ends, since each call is one level deeper.
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
    /// Creates a sparing tree without objects and with memory for as many as this one.
    fn empty_twin(&self) -> Self {
        let (mut twin, blocks) = (Self::sparing(self.lanes), self.live.div_ceil(LANES) + 1);
        let Layer { blocks: leaves, bounds, reach, changed, .. } = &mut twin.layers[0];
        leaves.reserve(blocks);
        bounds.reserve(blocks);
        reach.reserve(blocks);
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

    /// Adds, removes and changes objects in one step of a tree.
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
        tree.settle();
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
            // The bound: 16 newcomers, a run of up to 1024 sorted with them, and a copied chunk or a small tree of up
            // to 1024.
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
