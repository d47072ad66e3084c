//! The join: finds the pairs of objects whose boxes began or ceased to overlap since the last
//! [`Tree::commit_boxes`].
//!
//! Two algorithms find the same pairs. The number of changed objects decides between them:
//! * many changes: a join of a tree with itself, or of two trees, layer by layer. The tasks of a
//!   layer are pairs of blocks in a flat list; each becomes tasks of the layer below, and pairs of
//!   unchanged blocks are dropped on the way. There is no recursion, and masks replace most
//!   unpredictable branches;
//! * few changes: each changed box queries the tree. All queries run together, layer by layer (see
//!   `query.rs`).
//!
//! Lists are cut into chunks of constant size whose outputs are concatenated in order, so that any
//! number of threads yields the same list.

use core::ops::Range;

use super::kernel::{Kernel, TaskList, with_kernel};
use super::tree::small;
use super::{Block, Bounds, LANES, Tree};
use crate::memory::{Look, clone_empty};
use crate::pairs::pack;

/// Number of tasks in a chunk: `UPPER_CHUNK` for queries and in the upper layers of the join,
/// `LEAF_CHUNK` in its leaf layer.
const UPPER_CHUNK: usize = 256;
const LEAF_CHUNK: usize = 512;
/// If fewer than one object in `QUERIES_BELOW` changed, queries are faster than the join.
const QUERIES_BELOW: usize = 4;

/// Flag in the first slot of a pair: the overlap ended.
const ENDED: u32 = 1 << 31;

/// The two trees of a join, or one tree twice.
#[derive(Clone, Copy, Debug)]
pub(super) struct JoinSides<'a, const D: usize> {
    pub(super) first: &'a Tree<D>,
    pub(super) second: &'a Tree<D>,
    /// Whether `first` and `second` are the same tree. Each pair of blocks or slots is then visited
    /// in one order only.
    pub(super) is_self: bool,
}

/// Pairs of ids, [`pack`]ed, whose overlap differs between the old and the present boxes.
#[derive(Debug, Default)]
pub(crate) struct Changes {
    /// Pairs that overlap now and did not before.
    pub began: Vec<u64>,
    /// Pairs that overlapped before and do not now.
    pub ended: Vec<u64>,
}

clone_empty!([] Changes);

impl Changes {
    /// Removes all pairs and keeps the memory.
    pub(crate) fn clear(&mut self) {
        self.began.clear();
        self.ended.clear();
    }
}

/// Finds the pairs that began and ended; keeps the memory of task lists from call to call.
#[derive(Debug, Default)]
pub(crate) struct Joiner<const D: usize> {
    /// Tasks of the current layer: pairs of blocks, one index for each tree.
    tasks: TaskList,
    /// Tasks of the layer below.
    next: TaskList,
    /// Pairs of slots. The first slot has the flag [`ENDED`] if the overlap ended.
    found: TaskList,
    /// Scratch: the slots of changed lanes.
    slots: Vec<u32>,
    desks: Desks<D>,
}

clone_empty!([const D: usize] Joiner<D>);

/// Scratch lists for one chunk.
#[derive(Debug, Default)]
pub(super) struct Scratch<const D: usize> {
    /// In a search: pairs of a query and a block. In a join: pairs of a block of `second` and a
    /// slot of `first`.
    pub(super) tasks: TaskList,
    /// In a search: pairs of a query and a block of the layer below.
    pub(super) next: TaskList,
    /// Swept box of each query of the chunk.
    pub(super) swept_slots: Vec<Bounds<D>>,
}

impl<const D: usize> Scratch<D> {
    /// Releases the memory of lists that have been short for some time.
    fn give_back(&mut self, look: Look) {
        self.tasks.give_back();
        self.next.give_back();
        look.trim(&mut self.swept_slots);
    }
}

/// Scratch lists: one set for work on a single thread, and one set for each chunk of parallel work.
#[derive(Debug, Default)]
struct Desks<const D: usize> {
    scratch: Scratch<D>,
    #[cfg(feature = "parallel")]
    parallel: Vec<(TaskList, Scratch<D>)>,
}

impl<const D: usize> Joiner<D> {
    /// Releases the memory of lists that have been short for some time.
    pub(crate) fn give_back(&mut self, look: Look) {
        for list in [&mut self.tasks, &mut self.next, &mut self.found] {
            list.give_back();
        }
        look.trim(&mut self.slots);
        self.desks.scratch.give_back(look);
        #[cfg(feature = "parallel")]
        for (list, scratch) in &mut self.desks.parallel {
            list.give_back();
            scratch.give_back(look);
        }
    }

    /// Appends the pairs within the tree that began or ended since the last [`Tree::commit_boxes`],
    /// each once. The same calls always give the same order of pairs. Some ended pairs of
    /// [`Tree::escaped`] objects may be missing. The tree must be refitted.
    pub(crate) fn self_join(&mut self, tree: &Tree<D>, changes: &mut Changes) {
        let sides = JoinSides { first: tree, second: tree, is_self: true };
        if tree.changed * QUERIES_BELOW < tree.live {
            self.search_changed(sides);
        } else {
            self.join(sides);
        }
        self.report(sides, changes);
    }

    /// Appends the pairs of an object of `first` and an object of `second` that began or ended,
    /// each once. Some ended pairs of [`Tree::escaped`] objects may be missing. Both trees must be
    /// refitted.
    pub(crate) fn cross_join(&mut self, first: &Tree<D>, second: &Tree<D>, changes: &mut Changes) {
        let sides = JoinSides { first, second, is_self: false };
        let flipped = JoinSides { first: second, second: first, is_self: false };
        let all = first.live + second.live;
        let few = (first.changed + second.changed) * QUERIES_BELOW < all;
        match (first.changed, second.changed) {
            (0, 0) => {}
            (_, 0) if few => self.search_and_report(sides, changes),
            (0, _) if few => self.search_and_report(flipped, changes),
            _ => {
                self.join(sides);
                self.report(sides, changes);
            }
        }
    }

    /// Finds, by queries, the pairs with a changed object of the first tree that began or ended,
    /// and appends them to `changes`.
    fn search_and_report(&mut self, sides: JoinSides<'_, D>, changes: &mut Changes) {
        self.search_changed(sides);
        self.report(sides, changes);
    }

    /// Converts the found pairs of slots to pairs of ids, and appends each to the list of `changes`
    /// for its kind.
    fn report(&mut self, sides: JoinSides<'_, D>, changes: &mut Changes) {
        let [first, second] = self.found.parts();
        for (&a, &b) in first.iter().zip(second) {
            let key = pack(sides.first.ids[(a & !ENDED) as usize], sides.second.ids[b as usize]);
            if a & ENDED == 0 {
                changes.began.push(key);
            } else {
                changes.ended.push(key);
            }
        }
        self.found.clear();
    }

    /// Queries the second tree with each changed box of the first. The second tree must have no
    /// changes, unless it is the first.
    fn search_changed(&mut self, sides: JoinSides<'_, D>) {
        let mut slots = core::mem::take(&mut self.slots);
        sides.first.list_changed_slots(&mut slots);
        if !slots.is_empty() && sides.second.live > 0 {
            let run = |range: Range<usize>, out: &mut TaskList, scratch: &mut Scratch<D>| {
                with_kernel!(sides.first.lanes, kernel => {
                    super::query::search(kernel, sides, &slots[range], out, scratch);
                });
            };
            let chunks = Chunks { count: slots.len(), size: UPPER_CHUNK };
            chunks.run(&mut self.found, &mut self.desks, run);
        }
        self.slots = slots;
    }

    /// Runs the join, layer by layer. Lists in `found` the pairs of slots whose overlap began or
    /// ended.
    fn join(&mut self, sides: JoinSides<'_, D>) {
        let nothing_changed = sides.first.changed == 0 && sides.second.changed == 0;
        if nothing_changed || sides.first.live == 0 || sides.second.live == 0 {
            return;
        }
        debug_assert!(!sides.first.is_stale && !sides.second.is_stale, "joins need refitted trees");
        assert!(sides.first.ids.len() < ENDED as usize, "a slot has a bit to spare");
        let top = sides.first.layers.len().min(sides.second.layers.len()) - 1;
        self.seed(sides, top);
        for layer in (1..=top).rev() {
            self.next.clear();
            let tasks = &self.tasks;
            let run = |range: Range<usize>, out: &mut TaskList, _: &mut Scratch<D>| {
                with_kernel!(sides.first.lanes, kernel => {
                    expand(kernel, sides, layer, tasks.part(range), out);
                });
            };
            let chunks = Chunks { count: tasks.len(), size: UPPER_CHUNK };
            chunks.run(&mut self.next, &mut self.desks, run);
            core::mem::swap(&mut self.tasks, &mut self.next);
        }
        let tasks = &self.tasks;
        let run = |range: Range<usize>, out: &mut TaskList, scratch: &mut Scratch<D>| {
            with_kernel!(sides.first.lanes, kernel => {
                join_leaves(kernel, sides, tasks.part(range), out, scratch);
            });
        };
        let chunks = Chunks { count: tasks.len(), size: LEAF_CHUNK };
        chunks.run(&mut self.found, &mut self.desks, run);
    }

    /// Lists the first tasks: all pairs of blocks at layer `top`, the highest layer that both trees
    /// have. One of the trees has a single block there.
    fn seed(&mut self, sides: JoinSides<'_, D>, top: usize) {
        self.tasks.clear();
        for a in 0..sides.first.layers[top].blocks.len() {
            for b in 0..sides.second.layers[top].blocks.len() {
                self.tasks.push(small(a), small(b));
            }
        }
    }
}

/// A list of `count` tasks in chunks of `size`.
struct Chunks {
    count: usize,
    size: usize,
}

impl Chunks {
    /// Runs `work` on every chunk, and appends the outputs to `out` in the order of the chunks.
    fn run<const D: usize, F>(&self, out: &mut TaskList, desks: &mut Desks<D>, work: F)
    where
        F: Fn(Range<usize>, &mut TaskList, &mut Scratch<D>) + Sync,
    {
        #[cfg(feature = "parallel")]
        if self.count >= super::PARALLEL_FROM && rayon::current_num_threads() > 1 {
            return self.run_parallel(out, &mut desks.parallel, work);
        }
        for chunk in 0..self.count.div_ceil(self.size) {
            work(self.range(chunk), out, &mut desks.scratch);
        }
    }

    /// Returns the range of task indices in chunk `chunk`.
    fn range(&self, chunk: usize) -> Range<usize> {
        chunk * self.size..self.count.min((chunk + 1) * self.size)
    }

    #[cfg(feature = "parallel")]
    fn run_parallel<const D: usize, F>(
        &self,
        out: &mut TaskList,
        desks: &mut Vec<(TaskList, Scratch<D>)>,
        work: F,
    ) where
        F: Fn(Range<usize>, &mut TaskList, &mut Scratch<D>) + Sync,
    {
        use rayon::prelude::*;
        let chunks = self.count.div_ceil(self.size);
        if desks.len() < chunks {
            desks.resize_with(chunks, Default::default);
        }
        desks[..chunks].par_iter_mut().enumerate().for_each(|(chunk, (list, scratch))| {
            list.clear();
            work(self.range(chunk), list, scratch);
        });
        desks[..chunks].iter().for_each(|(list, _)| out.append(list));
    }
}

/// Appends, for each pair of blocks in a layer, the pairs of their children whose swept boxes
/// overlap and of which at least one has changed.
#[inline(always)]
fn expand<K: Kernel, const D: usize>(
    kernel: K,
    sides: JoinSides<'_, D>,
    layer: usize,
    [first, second]: [&[u32]; 2],
    out: &mut TaskList,
) {
    let (layer_a, layer_b) = (&sides.first.layers[layer], &sides.second.layers[layer]);
    let (blocks_a, changed_a) = (&layer_a.swept_blocks[..], &layer_a.changed[..]);
    let (blocks_b, changed_b) = (&layer_b.swept_blocks[..], &layer_b.changed[..]);
    let (bounds_b, children) = (&layer_b.swept[..], &sides.first.layers[layer - 1].swept[..]);
    for (&a, &b) in first.iter().zip(second) {
        let block_b = &blocks_b[b as usize];
        let changed_a = u32::from(changed_a[a as usize]);
        let changed_b = u32::from(changed_b[b as usize]);
        let mut lanes = kernel.overlaps(&blocks_a[a as usize], &bounds_b[b as usize]);
        // If no lane of `b` has changed, the child of `a` must have.
        if changed_b == 0 {
            lanes &= changed_a;
        }
        let is_diagonal = sides.is_self & (a == b);
        while lanes != 0 {
            let lane = lanes.trailing_zeros();
            lanes &= lanes - 1;
            let child = a * small(LANES) + lane;
            let mask = kernel.overlaps(block_b, &children[child as usize]);
            // On the diagonal (a block paired with itself) only lanes from `lane` on: each pair of
            // children once, and each child with itself.
            let upper = u32::MAX << lane | u32::from(is_diagonal).wrapping_sub(1);
            // All lanes of `b` if child `lane` of `a` changed, else the changed lanes of `b`.
            let changed = changed_b | 0_u32.wrapping_sub(changed_a >> lane & 1);
            kernel.push(out, child, b * small(LANES), mask & upper & changed);
        }
    }
}

/// Appends, for each pair of leaf blocks, the pairs of their slots whose overlap began or ended.
#[inline(always)]
fn join_leaves<K: Kernel, const D: usize>(
    kernel: K,
    sides: JoinSides<'_, D>,
    [first, second]: [&[u32]; 2],
    out: &mut TaskList,
    scratch: &mut Scratch<D>,
) {
    let (leaves_a, leaves_b) = (&sides.first.layers[0], &sides.second.layers[0]);
    let (blocks_a, changed_a) = (&leaves_a.blocks[..], &leaves_a.changed[..]);
    let (before_a, changed_b) = (sides.first.was(), &leaves_b.changed[..]);
    let (swept_b, boxes) = (&leaves_b.swept[..], JoinBoxes::of(sides));
    let lanes = &mut scratch.tasks;
    lanes.clear();
    for (&a, &b) in first.iter().zip(second) {
        let swept = &swept_b[b as usize];
        let changed = u32::from(changed_a[a as usize]);
        // Lanes of `a` whose boxes, now or before, overlap the swept bounds of `b`.
        let mut mask = kernel.overlaps(&blocks_a[a as usize], swept);
        if changed != 0 {
            mask |= kernel.overlaps(&before_a[a as usize], swept);
        }
        if changed_b[b as usize] == 0 {
            mask &= changed;
        }
        kernel.push(lanes, b, a * small(LANES), mask);
    }
    let [blocks, slots] = lanes.parts();
    for (&b, &slot) in blocks.iter().zip(slots) {
        // On the diagonal (a block paired with itself), only lanes above the slot's own lane: each
        // pair once. Bit arithmetic replaces an unpredictable branch.
        let is_diagonal = sides.is_self & (slot / small(LANES) == b);
        let upper = 0xfffe << (slot % small(LANES)) | u32::from(is_diagonal).wrapping_sub(1);
        let masks = boxes.differing(kernel, slot, b);
        masks.push(kernel, upper, slot, b, out);
    }
}

/// Leaf boxes of both trees, now and at the last [`Tree::commit_boxes`].
#[derive(Clone, Copy)]
pub(super) struct JoinBoxes<'a, const D: usize> {
    now_a: &'a [Block<D>],
    before_a: &'a [Block<D>],
    now_b: &'a [Block<D>],
    before_b: &'a [Block<D>],
}

/// Masks of the lanes of a block that overlap a box: by the present boxes, and by the boxes at the
/// last [`Tree::commit_boxes`].
#[derive(Clone, Copy)]
pub(super) struct Overlaps {
    now: u32,
    before: u32,
}

impl Overlaps {
    /// Appends the pairs of `slot` with the lanes of block `b`, among `lanes`, whose overlap began
    /// or ended.
    #[inline(always)]
    pub(super) fn push<K: Kernel>(
        self,
        kernel: K,
        lanes: u32,
        slot: u32,
        b: u32,
        out: &mut TaskList,
    ) {
        let differing = (self.now ^ self.before) & lanes;
        if differing != 0 {
            kernel.push(out, slot, b * small(LANES), differing & self.now);
            kernel.push(out, slot | ENDED, b * small(LANES), differing & self.before);
        }
    }
}

impl<'a, const D: usize> JoinBoxes<'a, D> {
    /// Borrows the leaf blocks of both trees, now and at the last [`Tree::commit_boxes`].
    #[inline(always)]
    pub(super) fn of(sides: JoinSides<'a, D>) -> Self {
        let (first, second) = (sides.first, sides.second);
        let (now_a, before_a) = (&first.layers[0].blocks[..], first.was());
        let (now_b, before_b) = (&second.layers[0].blocks[..], second.was());
        // Slices of equal length, so that the compiler hoists bounds checks out of the loop over
        // pairs.
        let (now_a, now_b) = (&now_a[..before_a.len()], &now_b[..before_b.len()]);
        Self { now_a, before_a, now_b, before_b }
    }

    /// Returns the lanes of block `b` of the second tree that overlap the box in slot `slot` of the
    /// first tree, now and before. Both masks are equal if neither the slot nor the block changed.
    #[inline(always)]
    pub(super) fn differing<K: Kernel>(&self, kernel: K, slot: u32, b: u32) -> Overlaps {
        let (block, lane, b) = (slot as usize / LANES, slot as usize % LANES, b as usize);
        let now = self.now_a[block].lane(lane);
        let before = self.before_a[block].lane(lane);
        Overlaps {
            now: kernel.overlaps(&self.now_b[b], &now),
            before: kernel.overlaps(&self.before_b[b], &before),
        }
    }
}

impl<const D: usize> Tree<D> {
    /// Returns the union of the boxes in `slot` now and before; the present box alone if the old
    /// box is outside the swept bounds of an escaped block.
    #[inline]
    pub(super) fn swept_of_slot(&self, slot: u32) -> Bounds<D> {
        let (block, lane) = (slot as usize / LANES, slot as usize % LANES);
        let (now, before) = (self.lane(slot as usize), self.was()[block].lane(lane));
        // The swept bounds of an escaped block cover the present boxes alone.
        let is_near = self.layers[0].swept[block].contains(&before);
        if is_near { now.merged(&before) } else { now }
    }
}
