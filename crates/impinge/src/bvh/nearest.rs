//! Searches around a box, near boxes before far ones, as deep as they go.
//!
//! Depth first, of each block the nearest child next, as long as that is within the limit, which shrinks
//! with what is found (Roussopoulos, Kelley and Vincent, "Nearest neighbor queries", 1995). As many
//! blocks lie open as there are layers, each with the distances of its children; which of them comes
//! next is looked for only when its turn comes, since most never have one. The order is rough, as that
//! of [`near_first`](super::near_first): it saves the queue of [`Frontier`](super::Frontier).

use super::gaps::Gaps;
use super::kernel::{Kernel, with_kernel};
use super::tree::small;
use super::{LANES, Lanes, Tree};

/// Layers that a tree may have: 2^32 objects make eight.
const LAYERS: usize = 8;

/// A block that lies open.
#[derive(Clone, Copy, Debug)]
struct Open {
    /// Of the children, the squares of their distances.
    keys: [f32; LANES],
    /// The children to be looked at.
    mask: u32,
    /// The number of the first child.
    first: u32,
}

impl Lanes {
    /// Calls `found` with each object of the trees whose box may be as near as `limit`, near ones first
    /// but in no exact order; `found` returns the new limit, which never grows. Both are squares of
    /// distances in the units of the gaps. A negative limit ends the search.
    pub(crate) fn visit_nearest_first<const D: usize>(
        self,
        trees: &[&Tree<D>],
        gaps: &Gaps<D>,
        mut limit: f32,
        mut found: impl FnMut(u32) -> f32,
    ) {
        with_kernel!(self, kernel => {
            for tree in trees.iter().filter(|tree| !tree.is_empty()) {
                debug_assert!(!tree.is_stale, "searches need a refitted tree");
                limit = tree.nearest_first(kernel, gaps, limit, &mut found);
            }
        });
    }
}

impl<const D: usize> Tree<D> {
    /// Opens at most as many blocks as there are; returns the last limit.
    #[inline(always)]
    fn nearest_first<K: Kernel>(
        &self,
        kernel: K,
        gaps: &Gaps<D>,
        mut limit: f32,
        found: &mut impl FnMut(u32) -> f32,
    ) -> f32 {
        let top = self.layers.len() - 1;
        let mut path = [Open { keys: [0.0; LANES], mask: 0, first: 0 }; LAYERS];
        let mut layer = top;
        path[top] = self.opened(kernel, (top, 0), gaps, limit);
        loop {
            let open = &mut path[layer];
            let lane = kernel.least(&open.keys, open.mask) % LANES;
            let is_within = open.mask != 0 && open.keys[lane] <= limit;
            if !is_within {
                if layer == top {
                    return limit;
                }
                layer += 1;
                continue;
            }
            open.mask &= !(1 << lane);
            let child = open.first + small(lane);
            if layer > 0 {
                layer -= 1;
                path[layer] = self.opened(kernel, (layer, child), gaps, limit);
            } else if let Some(id) = self.id_in(child) {
                limit = found(id);
            }
        }
    }

    #[inline(always)]
    fn opened<K: Kernel>(
        &self,
        kernel: K,
        (layer, number): (usize, u32),
        gaps: &Gaps<D>,
        limit: f32,
    ) -> Open {
        let block = &self.layers[layer].blocks[number as usize];
        let mut keys = [0.0; LANES];
        let mask = kernel.apart(block, gaps, limit, &mut keys);
        Open { keys, mask, first: number * small(LANES) }
    }
}
