//! The pairs that began since trees were settled.
//!
//! Two ways to the same answer, chosen by how much changed:
//! * many changes: a join of the tree with itself (or of two trees), layer by layer. The tasks of
//!   a layer are pairs of blocks in a flat list; each becomes tasks of the layer below, and what
//!   did not change on either side is dropped on the way. No recursion, and no branch that a
//!   processor could not foresee but the loops' ends;
//! * few changes: the changed boxes go down the tree together, layer by layer (see `query.rs`).
//!
//! Lists are cut into chunks of constant size whose outputs are concatenated in order, so that any
//! number of threads yields the same list.

use super::kernel::{Kernel, TaskList, with_kernel};
use super::tree::small;
use super::{LANES, Tree};
use crate::pairs::pack;

/// Tasks per chunk in the upper layers, and block pairs per chunk in the lowest.
const UPPER_CHUNK: usize = 256;
const LEAF_CHUNK: usize = 2048;
/// Up to one object in so many changed, queries beat the join.
const QUERIES_BELOW: usize = 4;

/// The trees of a join: `first` with `second`, or one tree with itself.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides<'a, const D: usize> {
    pub(super) first: &'a Tree<D>,
    pub(super) second: &'a Tree<D>,
    pub(super) is_self: bool,
}

/// Finds beginnings; keeps the task lists from call to call.
#[derive(Clone, Debug, Default)]
pub struct Joiner {
    tasks: TaskList,
    next: TaskList,
    found: TaskList,
    scratch: Scratch,
}

/// Lists for the work inside a chunk.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    pub(super) tasks: TaskList,
    pub(super) next: TaskList,
    met: Vec<Met>,
}

/// A slot and the lanes of a block that it overlaps.
#[derive(Clone, Copy, Debug, Default)]
struct Met {
    slot: u32,
    block: u32,
    mask: u32,
}

impl Joiner {
    /// Appends the pairs within the tree that began, each once, as [`pack`]ed ids in no
    /// particular (but always the same) order. The tree must be refitted.
    pub fn self_join<const D: usize>(&mut self, tree: &Tree<D>, began: &mut Vec<u64>) {
        let sides = Sides { first: tree, second: tree, is_self: true };
        if tree.changed * QUERIES_BELOW < tree.live {
            self.ask_changed(sides);
        } else {
            self.join(sides);
        }
        self.report(sides, began);
    }

    /// Appends the pairs of an object of `first` with one of `second` that began, like
    /// [`Self::self_join`].
    pub fn cross_join<const D: usize>(
        &mut self,
        first: &Tree<D>,
        second: &Tree<D>,
        began: &mut Vec<u64>,
    ) {
        let sides = Sides { first, second, is_self: false };
        let flipped = Sides { first: second, second: first, is_self: false };
        let all = first.live + second.live;
        let few = (first.changed + second.changed) * QUERIES_BELOW < all;
        match (first.changed, second.changed) {
            (0, 0) => {}
            (_, 0) if few => self.ask_and_report(sides, began),
            (0, _) if few => self.ask_and_report(flipped, began),
            _ => {
                self.join(sides);
                self.report(sides, began);
            }
        }
    }

    fn ask_and_report<const D: usize>(&mut self, sides: Sides<'_, D>, began: &mut Vec<u64>) {
        self.ask_changed(sides);
        self.report(sides, began);
    }

    /// The found pairs of slots as pairs of ids.
    fn report<const D: usize>(&mut self, sides: Sides<'_, D>, began: &mut Vec<u64>) {
        let (first, second) = self.found.parts();
        let ids = |(&a, &b): (&u32, &u32)| {
            pack(sides.first.ids[a as usize], sides.second.ids[b as usize])
        };
        began.extend(first.iter().zip(second).map(ids));
        self.found.clear();
    }

    /// Asks the second tree about each changed box of the first; nothing in the second may have
    /// changed unless the two are one.
    fn ask_changed<const D: usize>(&mut self, sides: Sides<'_, D>) {
        let slots = sides.first.changed_slots();
        if slots.is_empty() || sides.second.live == 0 {
            return;
        }
        let run = |range: core::ops::Range<usize>, out: &mut TaskList, scratch: &mut Scratch| {
            with_kernel!(sides.first.lanes, kernel => {
                super::query::ask(kernel, sides, &slots[range], out, scratch);
            });
        };
        let chunks = Chunks { count: slots.len(), size: UPPER_CHUNK };
        chunks.run(&mut self.found, &mut self.scratch, run);
    }

    fn join<const D: usize>(&mut self, sides: Sides<'_, D>) {
        let nothing_changed = sides.first.changed == 0 && sides.second.changed == 0;
        if nothing_changed || sides.first.live == 0 || sides.second.live == 0 {
            return;
        }
        debug_assert!(!sides.first.is_stale && !sides.second.is_stale, "joins need refitted trees");
        let top = sides.first.layers.len().min(sides.second.layers.len()) - 1;
        self.seed(sides, top);
        for layer in (1..=top).rev() {
            self.next.clear();
            let tasks = &self.tasks;
            let run = |range: core::ops::Range<usize>, out: &mut TaskList, _: &mut Scratch| {
                with_kernel!(sides.first.lanes, kernel => {
                    expand(kernel, sides, layer, tasks.part(range), out);
                });
            };
            let chunks = Chunks { count: tasks.len(), size: UPPER_CHUNK };
            chunks.run(&mut self.next, &mut self.scratch, run);
            core::mem::swap(&mut self.tasks, &mut self.next);
        }
        let tasks = &self.tasks;
        let run = |range: core::ops::Range<usize>, out: &mut TaskList, scratch: &mut Scratch| {
            with_kernel!(sides.first.lanes, kernel => {
                join_leaves(kernel, sides, tasks.part(range), out, scratch);
            });
        };
        let chunks = Chunks { count: tasks.len(), size: LEAF_CHUNK };
        chunks.run(&mut self.found, &mut self.scratch, run);
    }

    /// The first tasks: all pairs of blocks at the highest layer that both trees have. One of the
    /// trees has a single block there.
    fn seed<const D: usize>(&mut self, sides: Sides<'_, D>, top: usize) {
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
    /// Appends to `out` what `work` makes of every chunk, in the order of the chunks.
    fn run<F>(&self, out: &mut TaskList, scratch: &mut Scratch, work: F)
    where
        F: Fn(core::ops::Range<usize>, &mut TaskList, &mut Scratch) + Sync,
    {
        #[cfg(feature = "parallel")]
        if self.count >= super::PARALLEL_FROM && rayon::current_num_threads() > 1 {
            return self.run_parallel(out, work);
        }
        for chunk in 0..self.count.div_ceil(self.size) {
            work(self.range(chunk), out, scratch);
        }
    }

    fn range(&self, chunk: usize) -> core::ops::Range<usize> {
        chunk * self.size..self.count.min((chunk + 1) * self.size)
    }

    #[cfg(feature = "parallel")]
    fn run_parallel<F>(&self, out: &mut TaskList, work: F)
    where
        F: Fn(core::ops::Range<usize>, &mut TaskList, &mut Scratch) + Sync,
    {
        use rayon::prelude::*;
        let one = |scratch: &mut Scratch, chunk: usize| {
            let mut list = TaskList::default();
            work(self.range(chunk), &mut list, scratch);
            list
        };
        let chunks = 0..self.count.div_ceil(self.size);
        let lists: Vec<TaskList> = chunks.into_par_iter().map_init(Scratch::default, one).collect();
        for list in &lists {
            out.append(list);
        }
    }
}

/// Turns tasks of one layer into tasks of the layer below.
#[inline(always)]
fn expand<K: Kernel, const D: usize>(
    kernel: K,
    sides: Sides<'_, D>,
    layer: usize,
    (first, second): (&[u32], &[u32]),
    out: &mut TaskList,
) {
    let (layer_a, layer_b) = (&sides.first.layers[layer], &sides.second.layers[layer]);
    let (blocks_a, changed_a) = (&layer_a.blocks[..], &layer_a.changed[..]);
    let (blocks_b, changed_b) = (&layer_b.blocks[..], &layer_b.changed[..]);
    let (bounds_b, children) = (&layer_b.bounds[..], &sides.first.layers[layer - 1].bounds[..]);
    for (&a, &b) in first.iter().zip(second) {
        let block_b = &blocks_b[b as usize];
        let changed_a = u32::from(changed_a[a as usize]);
        let changed_b = u32::from(changed_b[b as usize]);
        let mut lanes = kernel.overlaps(&blocks_a[a as usize], &bounds_b[b as usize]);
        if changed_b == 0 {
            lanes &= changed_a;
        }
        let is_diagonal = sides.is_self & (a == b);
        while lanes != 0 {
            let lane = lanes.trailing_zeros();
            lanes &= lanes - 1;
            let child = a * small(LANES) + lane;
            let mask = kernel.overlaps(block_b, &children[child as usize]);
            let upper = u32::MAX << lane | u32::from(is_diagonal).wrapping_sub(1);
            let changed = changed_b | 0_u32.wrapping_sub(changed_a >> lane & 1);
            kernel.push(out, child, b * small(LANES), mask & upper & changed);
        }
    }
}

/// Turns pairs of leaf blocks into pairs of slots that began.
#[inline(always)]
fn join_leaves<K: Kernel, const D: usize>(
    kernel: K,
    sides: Sides<'_, D>,
    (first, second): (&[u32], &[u32]),
    out: &mut TaskList,
    scratch: &mut Scratch,
) {
    let (leaves_a, leaves_b) = (&sides.first.layers[0], &sides.second.layers[0]);
    let (blocks_a, changed_a) = (&leaves_a.blocks[..], &leaves_a.changed[..]);
    let (blocks_b, changed_b) = (&leaves_b.blocks[..], &leaves_b.changed[..]);
    let (bounds_b, boxes) = (&leaves_b.bounds[..], &sides.first.boxes[..]);
    let Scratch { tasks: lanes, met, .. } = scratch;
    lanes.clear();
    for (&a, &b) in first.iter().zip(second) {
        let mut mask = kernel.overlaps(&blocks_a[a as usize], &bounds_b[b as usize]);
        if changed_b[b as usize] == 0 {
            mask &= u32::from(changed_a[a as usize]);
        }
        kernel.push(lanes, b, a * small(LANES), mask);
    }
    let (blocks, slots) = lanes.parts();
    met.clear();
    met.resize(blocks.len(), Met::default());
    let mut count = 0;
    for (&b, &slot) in blocks.iter().zip(slots) {
        let (a, lane) = (slot / small(LANES), slot % small(LANES));
        let mask = kernel.overlaps(&blocks_b[b as usize], &boxes[slot as usize]);
        // Arithmetic in place of branches: how these go, no processor foresees.
        let is_diagonal = sides.is_self & (a == b);
        let upper = 0xfffe << lane | u32::from(is_diagonal).wrapping_sub(1);
        let is_changed = u32::from(changed_a[a as usize]) >> lane & 1;
        let changed = u32::from(changed_b[b as usize]) | 0_u32.wrapping_sub(is_changed);
        let mask = mask & upper & changed;
        met[count] = Met { slot, block: b, mask };
        count += usize::from(mask != 0);
    }
    for &Met { slot, block, mask } in &met[..count] {
        let mask = mask & !overlapped_before(kernel, sides, slot, block);
        if mask != 0 {
            kernel.push(out, slot, block * small(LANES), mask);
        }
    }
}

/// The lanes of block `b` of the second tree that overlapped the first tree's slot before.
#[inline(always)]
pub(super) fn overlapped_before<K: Kernel, const D: usize>(
    kernel: K,
    sides: Sides<'_, D>,
    slot: u32,
    b: u32,
) -> u32 {
    let (block, lane) = (slot as usize / LANES, slot as usize % LANES);
    kernel.overlaps(&sides.second.before[b as usize], &sides.first.before[block].lane(lane))
}
