//! The refit of the upper layers, and the end of a step.
//!
//! A leaf block with an object that moved far is listed as escaped. The join may miss ended pairs
//! of the objects in such a block; the owner of the tree finds these pairs in its table of pairs.

use super::kernel::{Kernel, with_kernel};
use super::tree::{Layer, small};
use super::{Block, Bounds, LANES, Lanes, Tree};

/// The swept bounds of a leaf block include the old boxes only if this enlarges their surface by at
/// most this factor. A larger factor means that an object was teleported: bounds around its old and
/// its new box would overlap everything between them.
const FAR_MOVED: f64 = 2.0;
/// Number of leaf blocks up to which a single thread refits.
#[cfg(feature = "parallel")]
const PARALLEL_LEAVES: usize = 256;

impl<const D: usize> Tree<D> {
    /// Sorts new objects and updates the upper layers, whose boxes are then exactly the unions of
    /// the boxes below.
    pub(crate) fn refit(&mut self) {
        self.refit_from(&[]);
    }

    /// Refits the tree as [`Self::refit`] does, with the new boxes of changed objects from `by_id`,
    /// which is indexed by id. `by_id` is empty if the tree already has the boxes.
    ///
    /// Ids have no spatial order. So the blocks are written in slot order, and each box is read
    /// from `by_id`: these reads are independent of each other, and their latencies overlap.
    pub(crate) fn refit_from(&mut self, mut by_id: &[Bounds<D>]) {
        if self.has_new() {
            self.fetch_boxes(by_id);
            by_id = &[];
            self.sort_new();
        }
        self.refit_layers(by_id);
    }

    /// Refits the touched leaf blocks and the layers above them, and lists the escaped blocks.
    /// Reads changed boxes from `by_id`, unless `by_id` is empty or no box is stale.
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

    /// Sorts the list of touched blocks.
    fn order_touched(&mut self) {
        if self.touched.is_sorted() {
            return;
        }
        // If more than a quarter of the blocks are touched, a pass over the flags replaces the
        // sort.
        let are_many = self.touched.len() * 4 > self.leaf_count();
        if are_many {
            self.touched.clear();
            let flagged = (0..).zip(&self.is_touched).filter(|&(_, &is_touched)| is_touched);
            self.touched.extend(flagged.map(|(block, _)| block));
        } else {
            self.touched.sort_unstable();
        }
    }

    /// Reads the changed boxes of the touched blocks from `by_id`, unless `by_id` is empty or no
    /// box is stale.
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

    /// Resizes the upper layers to the number of leaf blocks. The paths above the first and the
    /// last leaf block must then be refitted ([`Self::add_ends`]): the first for a new top layer,
    /// the last for lanes of removed blocks.
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

    /// Adds the first and the last leaf block to an ascending list.
    fn add_ends(&self, blocks: &mut Vec<u32>) {
        let Some(last) = self.leaf_count().checked_sub(1).map(small) else { return };
        if blocks.first() != Some(&0) {
            blocks.insert(0, 0);
        }
        if blocks.last() != Some(&last) {
            blocks.push(last);
        }
    }

    /// Reads the changed boxes of the listed leaf blocks, and computes their bounds and swept
    /// bounds.
    fn refit_leaves(&mut self, blocks: &[u32], by_id: &[Bounds<D>]) {
        let Layer { blocks: leaves, bounds, swept, changed, .. } = &mut self.layers[0];
        let (before, ids) = (&self.before[..], &self.ids[..]);
        let is_stale = self.is_stale;
        let source = RefitSource { before, ids, changed, by_id, is_stale, lanes: self.lanes };
        let leaves = Leaves { first: 0, blocks: leaves, bounds, swept };
        leaves.refit(&source, blocks, &mut self.escaped);
    }

    /// Refits the ancestors of the listed leaf blocks.
    #[inline(always)]
    fn refit_above<K: Kernel>(&mut self, kernel: K, blocks: &mut Vec<u32>) {
        for index in 1..self.layers.len() {
            let (below, above) = self.layers.split_at_mut(index);
            let (layer, parent) = (&below[index - 1], &mut above[0]);
            for &block in blocks.iter() {
                let block = block as usize;
                let (above, lane) = (block / LANES, block % LANES);
                parent.blocks[above].set_lane(lane, &layer.bounds[block]);
                parent.swept_blocks[above].set_lane(lane, &layer.swept[block]);
                parent.changed[above] |= u16::from(layer.changed[block] != 0) << lane;
            }
            // Bounds of a parent are computed once all its lanes are written.
            to_parents(blocks);
            for &block in blocks.iter() {
                let block = block as usize;
                parent.bounds[block] = kernel.bounds(&parent.blocks[block]);
                parent.swept[block] = kernel.bounds(&parent.swept_blocks[block]);
            }
        }
    }

    /// Makes the present boxes the old boxes of the next join, and clears all change bits and lists
    /// of the step.
    pub(crate) fn commit_boxes(&mut self) {
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
        // Without changes there is no change bit in any layer.
        if self.changed > 0 {
            let mut dirty = core::mem::take(&mut self.touched);
            for layer in &mut self.layers {
                dirty.iter().for_each(|&block| layer.commit_boxes(block as usize));
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

/// Consecutive leaf blocks, whose bounds and swept bounds are computed.
struct Leaves<'a, const D: usize> {
    /// Index of the first block.
    first: usize,
    blocks: &'a mut [Block<D>],
    bounds: &'a mut [Bounds<D>],
    swept: &'a mut [Bounds<D>],
}

/// Read-only input of the refit of leaf blocks.
struct RefitSource<'a, const D: usize> {
    /// Leaf boxes at the last [`Tree::commit_boxes`].
    before: &'a [Block<D>],
    ids: &'a [u32],
    /// Change bits by block.
    changed: &'a [u16],
    /// Present boxes by id; empty if the blocks have these already.
    by_id: &'a [Bounds<D>],
    is_stale: bool,
    lanes: Lanes,
}

impl<const D: usize> Leaves<'_, D> {
    /// Refits the listed blocks, which must be ascending and all in this range. Appends the blocks
    /// with an object that moved far to `escaped`.
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

    /// Refits one leaf block: its bounds enclose the present boxes. Its swept bounds enclose the
    /// old boxes too, unless the block is escaped.
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
        self.swept[at] = now;
        if changed != 0 {
            let both = now.merged(&kernel.bounds(&source.before[block]));
            if both.half_surface() <= FAR_MOVED * now.half_surface() {
                self.swept[at] = both;
            } else {
                escaped.push(small(block));
            }
        }
    }

    /// Splits the range before leaf block `block`.
    #[cfg(feature = "parallel")]
    fn split(&mut self, block: usize) -> (Leaves<'_, D>, Leaves<'_, D>) {
        let (first, count) = (self.first, block - self.first);
        let (blocks1, blocks2) = self.blocks.split_at_mut(count);
        let (bounds1, bounds2) = self.bounds.split_at_mut(count);
        let (swept1, swept2) = self.swept.split_at_mut(count);
        let left = Leaves { first, blocks: blocks1, bounds: bounds1, swept: swept1 };
        (left, Leaves { first: block, blocks: blocks2, bounds: bounds2, swept: swept2 })
    }
}

/// Copies the boxes of changed lanes of a block from `by_id`.
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
    /// Clears the change bits of a block; its swept bounds become its bounds.
    fn commit_boxes(&mut self, block: usize) {
        self.changed[block] = 0;
        self.swept[block] = self.bounds[block];
        if let Some(swept_blocks) = self.swept_blocks.get_mut(block) {
            *swept_blocks = self.blocks[block];
        }
    }
}

/// Replaces ascending block indices by the indices of the parents, without repeats.
fn to_parents(blocks: &mut Vec<u32>) {
    for block in blocks.iter_mut() {
        *block /= small(LANES);
    }
    blocks.dedup();
}
