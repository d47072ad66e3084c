//! The slot of a new object.

use super::{Bounds, LANES, NONE, Tree};

/// Greatest relative growth of a leaf block's surface by an object that is added or moves.
const ROOM: f64 = 0.3;

impl<const D: usize> Tree<D> {
    /// Returns a free slot near the box if there is one, else the slot at the end.
    pub(super) fn find_place(&mut self, bounds: &Bounds<D>) -> usize {
        let has_holes = self.live < self.end;
        let hole = if has_holes { self.hole_near(bounds) } else { None };
        hole.unwrap_or_else(|| self.append_slot())
    }

    /// Returns a free slot in the block at which a descent by least growth ends: among its last
    /// sixteen blocks, the one with a free lane that grows least. `None` if that grows much: a
    /// large block makes every join expensive, whereas newcomers at the end are sorted among
    /// themselves.
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

    /// Returns `true` if the surface of a leaf block hardly grows by a box; `false` if there is no
    /// such block.
    pub(super) fn has_room_for(&self, block: usize, bounds: &Bounds<D>) -> bool {
        self.layers[0].bounds.get(block).is_some_and(|block| {
            let own = block.half_surface();
            own == 0.0 || block.merged(bounds).half_surface() - own <= ROOM * own
        })
    }

    /// Returns `true` if a lane of the leaf block is free. There is no counter, since the scan is
    /// short.
    fn has_hole(&self, block: usize) -> bool {
        let slots = &self.ids[block * LANES..(block + 1) * LANES];
        slots.iter().fold(false, |found, &id| found | (id == NONE))
    }

    /// Returns the slot after the last one in use, in a new block if necessary.
    pub(super) fn append_slot(&mut self) -> usize {
        if self.end == self.ids.len() {
            self.resize_leaves(self.leaf_count() + 1);
        }
        self.end
    }
}
