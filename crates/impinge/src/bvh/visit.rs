//! Searches for all objects whose boxes pass a test, in no particular order.

use super::kernel::{Kernel, with_kernel};
use super::tree::small;
use super::{Block, Bounds, LANES, NONE, Tree};

/// Capacity of the stack of unopened blocks. Each of at most seven layers below the top leaves at
/// most fifteen siblings, and the last expansion writes all sixteen children.
const STACK: usize = 128;

impl<const D: usize> Tree<D> {
    /// Calls `leaf` with the id of each object whose lane passes `test`. The order depends on the
    /// tree alone.
    ///
    /// `test` receives a block and returns the mask of lanes that pass. It must be monotone: if a
    /// box passes, every box that encloses it must pass too. Empty lanes may pass; they are
    /// skipped.
    #[inline(always)]
    pub(crate) fn visit(&self, mut test: impl FnMut(&Block<D>) -> u32, mut leaf: impl FnMut(u32)) {
        debug_assert!(!self.is_stale, "searches need a refitted tree");
        if self.live == 0 {
            return;
        }
        let (mut stack, mut depth) = ([(0_u8, 0_u32); STACK], 1);
        stack[0] = (self.top_layer(), 0);
        while depth > 0 {
            depth -= 1;
            let (layer, block) = stack[depth];
            let mut mask = test(&self.layers[usize::from(layer)].blocks[block as usize]);
            while mask != 0 {
                let child = block * small(LANES) + mask.trailing_zeros();
                mask &= mask - 1;
                if layer > 0 {
                    stack[depth] = (layer - 1, child);
                    depth += usize::from(self.is_block(layer - 1, child));
                } else if let Some(id) = self.id_in(child) {
                    leaf(id);
                }
            }
        }
    }

    /// Returns the index of the highest layer, which has one block.
    pub(super) fn top_layer(&self) -> u8 {
        u8::try_from(self.layers.len() - 1).expect("2^32 objects make eight layers")
    }

    /// Returns the id of the object in a slot; `None` if the slot is free.
    #[inline]
    pub(super) fn id_in(&self, slot: u32) -> Option<u32> {
        let id = self.ids[slot as usize];
        (id != NONE).then_some(id)
    }

    /// Returns `true` if `block` is an index in the layer; the last lanes of the layer above may
    /// have no block below.
    pub(super) fn is_block(&self, layer: u8, block: u32) -> bool {
        (block as usize) < self.layers[usize::from(layer)].blocks.len()
    }

    /// Calls `leaf` with the id of each object whose box overlaps `query`, which may be unbounded.
    pub(crate) fn visit_overlapping(&self, query: &Bounds<D>, leaf: impl FnMut(u32)) {
        let query = query.clamped();
        with_kernel!(self.lanes, kernel => {
            self.visit(#[inline(always)] |block| kernel.overlaps(block, &query), leaf);
        });
    }
}
