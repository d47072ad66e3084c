//! The choice of a slot for a new object.

use super::{Bounds, LANES, NONE, Tree};

/// An added or moved object may enlarge the surface area of a leaf block by at most this fraction
/// of the area.
const MAX_GROWTH: f64 = 0.3;

impl<const D: usize> Tree<D> {
    /// Returns a free slot near the box if there is one, else the slot after the last one in use,
    /// for which it may add a leaf block.
    pub(super) fn find_slot(&mut self, bounds: &Bounds<D>) -> usize {
        let has_holes = self.live < self.end;
        let hole = if has_holes { self.hole_near(bounds) } else { None };
        hole.unwrap_or_else(|| self.append_slot())
    }

    /// Returns a free slot near a box: descends in each layer to the child that grows least, in the
    /// lowest layer only among leaf blocks with a free lane. `None` if there is no such block or
    /// its surface would grow by more than [`MAX_GROWTH`]: a large block makes every join
    /// expensive, whereas new objects at the end are sorted among themselves.
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
            if layer == 1 && !self.hardly_grows_by(block, bounds) {
                return None;
            }
        }
        let slots = self.ids.get(block * LANES..(block + 1) * LANES)?;
        Some(block * LANES + slots.iter().position(|&id| id == NONE)?)
    }

    /// Returns `true` if the surface of leaf block `block` is zero, or would grow by at most
    /// [`MAX_GROWTH`] if the box were added; `false` if the block does not exist.
    pub(super) fn hardly_grows_by(&self, block: usize, bounds: &Bounds<D>) -> bool {
        self.layers[0].bounds.get(block).is_some_and(|block| {
            let own = block.half_surface();
            own == 0.0 || block.merged(bounds).half_surface() - own <= MAX_GROWTH * own
        })
    }

    /// Returns `true` if a lane of leaf block `block` is free. A scan is short enough to need no
    /// counter.
    fn has_hole(&self, block: usize) -> bool {
        let slots = &self.ids[block * LANES..(block + 1) * LANES];
        slots.iter().fold(false, |found, &id| found | (id == NONE))
    }

    /// Returns the slot after the last one in use; adds an empty leaf block if the last one is
    /// full.
    pub(super) fn append_slot(&mut self) -> usize {
        if self.end == self.ids.len() {
            self.resize_leaves(self.leaf_count() + 1);
        }
        self.end
    }
}
