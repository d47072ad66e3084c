//! Where an object that comes is put.

use super::{Bounds, LANES, NONE, Tree};

/// By how much the surface of a leaf block may grow with an object that comes or moves.
const ROOM: f64 = 0.3;

impl<const D: usize> Tree<D> {
    /// A free lane near the box where there is one, else the end.
    pub(super) fn find_place(&mut self, bounds: &Bounds<D>) -> usize {
        let has_holes = self.live < self.end;
        let hole = if has_holes { self.hole_near(bounds) } else { None };
        hole.unwrap_or_else(|| self.append_slot())
    }

    /// A free lane near where a descent along the least growth ends: of the last sixteen blocks, that
    /// with a free lane which grows least. None if that would grow much: a block that reaches far makes
    /// every join dear, and at the end newcomers are sorted among themselves.
    fn hole_near(&self, bounds: &Bounds<D>) -> Option<usize> {
        let mut block = 0;
        for layer in (1..self.layers.len()).rev() {
            let children = &self.layers[layer - 1].bounds;
            let last = children.len().min((block + 1) * LANES);
            let mut least = (f64::INFINITY, NONE as usize);
            for (child, own) in (block * LANES..last).zip(&children[block * LANES..last]) {
                let growth = own.merged(bounds).half_surface() - own.half_surface();
                if growth < least.0 && (layer > 1 || self.has_hole(child)) {
                    least = (growth, child);
                }
            }
            block = least.1;
            if layer == 1 && !self.has_room_for(block, bounds) {
                return None;
            }
        }
        let slots = self.ids.get(block * LANES..(block + 1) * LANES)?;
        Some(block * LANES + slots.iter().position(|&id| id == NONE)?)
    }

    /// A leaf block does not grow much with a box in it; false if there is no such block.
    pub(super) fn has_room_for(&self, block: usize, bounds: &Bounds<D>) -> bool {
        self.layers[0].bounds.get(block).is_some_and(|block| {
            let own = block.half_surface();
            own == 0.0 || block.merged(bounds).half_surface() - own <= ROOM * own
        })
    }

    /// A lane of the leaf block is free. The search keeps no count of it, since it is short.
    fn has_hole(&self, block: usize) -> bool {
        let slots = &self.ids[block * LANES..(block + 1) * LANES];
        slots.iter().fold(false, |found, &id| found | (id == NONE))
    }

    /// The slot after the last one in use, in a new block if need be.
    pub(super) fn append_slot(&mut self) -> usize {
        if self.end == self.ids.len() {
            self.resize_leaves(self.leaf_count() + 1);
        }
        self.end
    }
}
