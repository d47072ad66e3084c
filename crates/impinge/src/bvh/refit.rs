//! The pass that makes the upper layers true again, and the end of a step.
//!
//! An object that was put elsewhere is listed as far moved: the join need not see which of its pairs ended, since
//! the table of pairs knows.

use super::kernel::{Kernel, with_kernel};
use super::tree::{Layer, small};
use super::{Block, Bounds, LANES, Lanes, Tree};

/// By how much the boxes of before may enlarge the surface of a leaf block. Beyond that, something
/// was put elsewhere, and a reach from there to here would meet everything in between.
const FAR_MOVED: f64 = 2.0;
/// Up to this many leaf blocks are refitted by one thread.
#[cfg(feature = "parallel")]
const PARALLEL_LEAVES: usize = 256;

impl<const D: usize> Tree<D> {
    /// Brings new objects into order and makes the upper layers enclose the lower ones exactly.
    pub(crate) fn refit(&mut self) {
        self.refit_from(&[]);
    }

    /// The same, after it has fetched the boxes of changed objects from a list by id; an empty list
    /// stands for those that the tree was given.
    ///
    /// Objects come in no spatial order: to look for the box of each slot takes reads that a processor
    /// does many of at once, to write each box to its slot does not.
    pub(crate) fn refit_from(&mut self, mut by_id: &[Bounds<D>]) {
        if self.has_new() {
            self.fetch_boxes(by_id);
            by_id = &[];
            self.sort_new();
        }
        self.refit_layers(by_id);
    }

    pub(super) fn refit_layers(&mut self, by_id: &[Bounds<D>]) {
        self.escaped.clear();
        if !self.touched.is_empty() || self.is_restructured {
            self.order_touched();
            let mut dirty = core::mem::take(&mut self.dirty);
            dirty.clear();
            dirty.extend_from_slice(&self.touched);
            if self.is_restructured {
                self.shape_layers();
                self.add_ends(&mut dirty);
            }
            self.refit_leaves(&dirty, by_id);
            self.note_strayed();
            with_kernel!(self.lanes, kernel => self.refit_above(kernel, &mut dirty));
            self.dirty = dirty;
        }
        self.is_restructured = false;
        self.is_stale = false;
    }

    /// Brings the list of touched blocks into ascending order.
    fn order_touched(&mut self) {
        if self.touched.is_sorted() {
            return;
        }
        let are_many = self.touched.len() * 4 > self.leaf_count();
        if are_many {
            self.touched.clear();
            let flagged = (0..).zip(&self.is_touched).filter(|&(_, &is_touched)| is_touched);
            self.touched.extend(flagged.map(|(block, _)| block));
        } else {
            self.touched.sort_unstable();
        }
    }

    fn fetch_boxes(&mut self, by_id: &[Bounds<D>]) {
        if by_id.is_empty() || !self.is_stale {
            return;
        }
        let Layer { blocks, changed, .. } = &mut self.layers[0];
        for &block in &self.touched {
            let block = block as usize;
            fetch(changed[block], &self.ids[block * LANES..], &mut blocks[block], by_id);
        }
    }

    /// Fits the upper layers to the number of leaf blocks. What is above the first block and above the last is left to
    /// a refit of these ([`Self::add_ends`]): a new top layer, and lanes of blocks that are no more.
    pub(super) fn shape_layers(&mut self) {
        let (mut layer, mut blocks) = (0, self.leaf_count());
        while blocks > 1 {
            layer += 1;
            if self.layers.len() <= layer {
                self.layers.push(Layer::new());
            }
            self.layers[layer].fit_above(blocks);
            blocks = blocks.div_ceil(LANES);
        }
        self.layers.truncate(layer + 1);
    }

    /// Adds the first leaf block and the last to an ascending list of them.
    fn add_ends(&self, blocks: &mut Vec<u32>) {
        let Some(last) = self.leaf_count().checked_sub(1).map(small) else { return };
        if blocks.first() != Some(&0) {
            blocks.insert(0, 0);
        }
        if blocks.last() != Some(&last) {
            blocks.push(last);
        }
    }

    /// Fetches the changed boxes of the listed leaf blocks, and takes their bounds.
    fn refit_leaves(&mut self, blocks: &[u32], by_id: &[Bounds<D>]) {
        let Layer { blocks: leaves, bounds, reach, changed, .. } = &mut self.layers[0];
        let (before, ids) = (&self.before[..], &self.ids[..]);
        let is_stale = self.is_stale;
        let source = RefitSource { before, ids, changed, by_id, is_stale, lanes: self.lanes };
        let leaves = Leaves { first: 0, blocks: leaves, bounds, reach };
        leaves.refit(&source, blocks, &mut self.escaped);
    }

    /// Walks up from the listed leaf blocks.
    #[inline(always)]
    fn refit_above<K: Kernel>(&mut self, kernel: K, blocks: &mut Vec<u32>) {
        for index in 1..self.layers.len() {
            let (below, above) = self.layers.split_at_mut(index);
            let (layer, parent) = (&below[index - 1], &mut above[0]);
            for &block in blocks.iter() {
                let block = block as usize;
                let (above, lane) = (block / LANES, block % LANES);
                parent.blocks[above].set_lane(lane, &layer.bounds[block]);
                parent.reaches[above].set_lane(lane, &layer.reach[block]);
                parent.changed[above] |= u16::from(layer.changed[block] != 0) << lane;
            }
            to_parents(blocks);
            for &block in blocks.iter() {
                let block = block as usize;
                parent.bounds[block] = kernel.bounds(&parent.blocks[block]);
                parent.reach[block] = kernel.bounds(&parent.reaches[block]);
            }
        }
    }

    /// Declares the present boxes those of before: nothing has changed.
    pub(crate) fn settle(&mut self) {
        if self.touched.is_empty() {
            return;
        }
        self.note_use();
        self.order_touched();
        let remembers = self.remembers && !self.is_sparing;
        for &block in &self.touched {
            let block = block as usize;
            if remembers {
                self.before[block] = self.layers[0].blocks[block];
            }
            self.is_touched[block] = false;
        }
        if self.changed > 0 {
            let mut dirty = core::mem::take(&mut self.touched);
            for layer in &mut self.layers {
                dirty.iter().for_each(|&block| layer.settle(block as usize));
                to_parents(&mut dirty);
            }
            self.touched = dirty;
        }
        self.touched.clear();
        self.escaped.clear();
        self.changed = 0;
        if !remembers {
            (self.before, self.remembers) = (Vec::new(), false);
        }
    }
}

/// A run of leaf blocks and what is beside them, to be written.
struct Leaves<'a, const D: usize> {
    /// The number of the first block.
    first: usize,
    blocks: &'a mut [Block<D>],
    bounds: &'a mut [Bounds<D>],
    reach: &'a mut [Bounds<D>],
}

/// What all leaf blocks are computed from.
struct RefitSource<'a, const D: usize> {
    before: &'a [Block<D>],
    ids: &'a [u32],
    changed: &'a [u16],
    by_id: &'a [Bounds<D>],
    is_stale: bool,
    lanes: Lanes,
}

impl<const D: usize> Leaves<'_, D> {
    /// Refits the listed blocks, ascending, which are all in this run. Appends those whose objects escaped their fat AABBs.
    fn refit(mut self, source: &RefitSource<'_, D>, listed: &[u32], escaped: &mut Vec<u32>) {
        #[cfg(feature = "parallel")]
        if listed.len() > PARALLEL_LEAVES && rayon::current_num_threads() > 1 {
            let (near, far) = listed.split_at(listed.len() / 2);
            let (left, right) = self.split(far[0] as usize);
            let mut beyond = Vec::new();
            rayon::join(
                || left.refit(source, near, escaped),
                || right.refit(source, far, &mut beyond),
            );
            return escaped.append(&mut beyond);
        }
        with_kernel!(source.lanes, kernel => {
            for &block in listed {
                self.refit_block(kernel, source, block, escaped);
            }
        });
    }

    #[inline(always)]
    fn refit_block<K: Kernel>(
        &mut self,
        kernel: K,
        source: &RefitSource<'_, D>,
        block: u32,
        escaped: &mut Vec<u32>,
    ) {
        let (at, block) = (block as usize - self.first, block as usize);
        let changed = source.changed[block];
        if source.is_stale && !source.by_id.is_empty() {
            fetch(changed, &source.ids[block * LANES..], &mut self.blocks[at], source.by_id);
        }
        let now = kernel.bounds(&self.blocks[at]);
        self.bounds[at] = now;
        self.reach[at] = now;
        if changed != 0 {
            let both = now.merged(&kernel.bounds(&source.before[block]));
            if both.half_surface() <= FAR_MOVED * now.half_surface() {
                self.reach[at] = both;
            } else {
                escaped.push(small(block));
            }
        }
    }

    /// Cuts the run before the block.
    #[cfg(feature = "parallel")]
    fn split(&mut self, block: usize) -> (Leaves<'_, D>, Leaves<'_, D>) {
        let (first, count) = (self.first, block - self.first);
        let (blocks1, blocks2) = self.blocks.split_at_mut(count);
        let (bounds1, bounds2) = self.bounds.split_at_mut(count);
        let (reach1, reach2) = self.reach.split_at_mut(count);
        let left = Leaves { first, blocks: blocks1, bounds: bounds1, reach: reach1 };
        (left, Leaves { first: block, blocks: blocks2, bounds: bounds2, reach: reach2 })
    }
}

/// Copies the boxes of changed lanes of a block from a list by id.
#[inline(always)]
fn fetch<const D: usize>(mut changed: u16, ids: &[u32], block: &mut Block<D>, by_id: &[Bounds<D>]) {
    let ids = &ids[..LANES];
    while changed != 0 {
        let lane = changed.trailing_zeros() as usize % LANES;
        changed &= changed - 1;
        block.set_lane(lane, &by_id[ids[lane] as usize]);
    }
}

impl<const D: usize> Layer<D> {
    fn settle(&mut self, block: usize) {
        self.changed[block] = 0;
        self.reach[block] = self.bounds[block];
        if let Some(reaches) = self.reaches.get_mut(block) {
            *reaches = self.blocks[block];
        }
    }
}

/// Replaces ascending block numbers by those of their parents, each once.
fn to_parents(blocks: &mut Vec<u32>) {
    for block in blocks.iter_mut() {
        *block /= small(LANES);
    }
    blocks.dedup();
}
