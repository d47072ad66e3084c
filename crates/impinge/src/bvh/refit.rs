//! The pass that makes the upper layers true again, and the end of a step.

use super::kernel::{Kernel, with_kernel};
use super::tree::{Layer, small};
use super::{Bounds, LANES, Tree};

/// By how much the boxes of before may enlarge the surface of a leaf block. Beyond that, something
/// was put elsewhere, and a reach from there to here would meet everything in between.
const STRAYED: f64 = 2.0;

impl<const D: usize> Tree<D> {
    /// Brings new objects into order and makes the upper layers enclose the lower ones exactly.
    pub fn refit(&mut self) {
        self.refit_from(&[]);
    }

    /// The same, after it has fetched the boxes of changed objects from a list by id; an empty list
    /// stands for those that the tree was given.
    ///
    /// Objects come in no spatial order: to look for the box of each slot takes reads that a processor
    /// does many of at once, to write each box to its slot does not.
    pub(crate) fn refit_from(&mut self, by_id: &[Bounds<D>]) {
        if !by_id.is_empty() && self.is_stale {
            self.order_touched();
            self.fetch_boxes(by_id);
        }
        self.sort_new();
        self.refit_layers();
    }

    pub(super) fn refit_layers(&mut self) {
        if self.touched.is_empty() && !self.is_restructured {
            self.strayed.clear();
            self.is_stale = false;
            return;
        }
        self.order_touched();
        if self.is_stale {
            self.fill_blocks();
        }
        self.strayed.clear();
        let many = self.touches_many();
        with_kernel!(self.lanes, kernel => {
            if self.is_restructured || many {
                self.refit_all(kernel);
            } else {
                self.refit_touched(kernel);
            }
        });
        self.is_restructured = false;
        self.is_stale = false;
    }

    /// So many blocks were touched that all of them are looked at.
    fn touches_many(&self) -> bool {
        self.touched.len() * 4 > self.before.len()
    }

    /// Brings the list of touched blocks into ascending order.
    fn order_touched(&mut self) {
        if self.touched.is_sorted() {
            return;
        }
        if self.touches_many() {
            self.touched.clear();
            let flagged = (0..).zip(&self.is_touched).filter(|&(_, &is_touched)| is_touched);
            self.touched.extend(flagged.map(|(block, _)| block));
        } else {
            self.touched.sort_unstable();
        }
    }

    fn fetch_boxes(&mut self, by_id: &[Bounds<D>]) {
        for &block in &self.touched {
            let first = block as usize * LANES;
            let mut mask = self.layers[0].changed[block as usize];
            let (ids, boxes) = (&self.ids[first..], &mut self.boxes[first..first + LANES]);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                boxes[lane] = by_id[ids[lane] as usize];
            }
        }
    }

    /// Copies the boxes one by one to the blocks that were written to.
    fn fill_blocks(&mut self) {
        for &block in &self.touched {
            let block = block as usize;
            let boxes = self.boxes[block * LANES..].first_chunk();
            let boxes = boxes.expect("every block has sixteen slots");
            self.layers[0].blocks[block].set_all(boxes);
        }
    }

    /// Lays the upper layers out for the number of leaf blocks, every lane empty.
    pub(super) fn shape_layers(&mut self) {
        let (mut layer, mut blocks) = (0, self.before.len());
        while blocks > 1 {
            (layer, blocks) = (layer + 1, blocks.div_ceil(LANES));
            if self.layers.len() <= layer {
                self.layers.push(Layer::new());
            }
            self.layers[layer].empty(blocks);
        }
        self.layers.truncate(layer + 1);
    }

    #[inline(always)]
    fn refit_all<K: Kernel>(&mut self, kernel: K) {
        if self.is_restructured {
            self.shape_layers();
        }
        self.layers.iter_mut().skip(1).for_each(|layer| layer.changed.fill(0));
        for index in 0..self.layers.len() {
            for block in 0..self.layers[index].blocks.len() {
                self.bound_block(kernel, index, block);
            }
        }
    }

    /// Walks up from the touched leaf blocks only.
    #[inline(always)]
    fn refit_touched<K: Kernel>(&mut self, kernel: K) {
        let mut dirty = core::mem::take(&mut self.dirty);
        dirty.clear();
        dirty.extend_from_slice(&self.touched);
        for index in 0..self.layers.len() {
            for &block in &dirty {
                self.bound_block(kernel, index, block as usize);
            }
            to_parents(&mut dirty);
        }
        self.dirty = dirty;
    }

    /// Takes the bounds and the reach of a block and tells the layer above.
    #[inline(always)]
    fn bound_block<K: Kernel>(&mut self, kernel: K, index: usize, block: usize) {
        let layer = &self.layers[index];
        let bounds = kernel.bounds(&layer.blocks[block]);
        let changed = layer.changed[block];
        let reach = match layer.reaches.get(block) {
            Some(reaches) => kernel.bounds(reaches),
            None if changed == 0 => bounds,
            None => self.leaf_reach(kernel, &bounds, block),
        };
        let layer = &mut self.layers[index];
        layer.bounds[block] = bounds;
        layer.reach[block] = reach;
        let Some(parent) = self.layers.get_mut(index + 1) else { return };
        let (above, lane) = (block / LANES, block % LANES);
        parent.blocks[above].set_lane(lane, &bounds);
        parent.reaches[above].set_lane(lane, &reach);
        parent.changed[above] |= u16::from(changed != 0) << lane;
    }

    #[inline(always)]
    fn leaf_reach<K: Kernel>(&mut self, kernel: K, now: &Bounds<D>, block: usize) -> Bounds<D> {
        let both = now.merged(&kernel.bounds(&self.before[block]));
        if both.half_surface() <= STRAYED * now.half_surface() {
            return both;
        }
        self.strayed.push(small(block));
        *now
    }

    /// Declares the present boxes those of before: nothing has changed.
    pub fn settle(&mut self) {
        if self.touched.is_empty() {
            return;
        }
        self.note_use();
        self.order_touched();
        for &block in &self.touched {
            let block = block as usize;
            self.before[block] = self.layers[0].blocks[block];
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
        self.strayed.clear();
        self.changed = 0;
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
