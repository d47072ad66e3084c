//! Depth-first searches along a moving box or ray, and around a box at rest: near boxes before far ones.
//!
//! In each block the nearest child comes next (as in all ray tracers; Roussopoulos, Kelley and Vincent, "Nearest
//! neighbor queries", 1995), as long as it is within the limit, which shrinks with each result. One block for each
//! layer is open, with the keys of its children; the next child is selected only when its turn comes, since most are
//! never visited. The order is rough: objects of a later block may be nearer than some of an earlier one. This avoids
//! the queue of [`Frontier`](super::Frontier), which costs more than the boxes that it saves.

use super::gaps::Gaps;
use super::kernel::{Kernel, with_kernel};
use super::slabs::Slabs;
use super::tree::small;
use super::triangles::{ShearedLine, TriangleAt, Triangles};
use super::{Block, Bounds, LANES, Lanes, NONE, Tree};

/// Greatest number of layers: 2^32 objects need eight.
pub(super) const LAYERS: usize = 8;

/// Greatest number of objects passed on at once: their data are scattered in memory, and loads for several objects
/// overlap.
pub(crate) const GROUP: usize = 4;

/// A test of the lanes of a block.
pub(super) trait Probe<const D: usize> {
    /// Returns the lanes that may have a key of at most `limit`, and writes lower bounds of the keys. The mask contains
    /// every lane with such a key. Keys are zero or more.
    fn ask<K: Kernel>(
        &self,
        kernel: K,
        block: &Block<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32;
}

/// The key is the time of entry.
impl<const D: usize> Probe<D> for Slabs<D> {
    #[inline(always)]
    fn ask<K: Kernel>(
        &self,
        kernel: K,
        block: &Block<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        kernel.enter(block, self, limit, keys)
    }
}

/// The key is the squared distance.
impl<const D: usize> Probe<D> for Gaps<D> {
    #[inline(always)]
    fn ask<K: Kernel>(
        &self,
        kernel: K,
        block: &Block<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        kernel.apart(block, self, limit, keys)
    }
}

/// A block whose children are being visited.
#[derive(Clone, Copy, Debug)]
pub(super) struct Open {
    /// Keys of the children.
    pub(super) keys: [f32; LANES],
    /// Children not yet visited.
    pub(super) mask: u32,
    /// Index of the first child.
    pub(super) first: u32,
}

impl Open {
    /// A block without children left to visit.
    const NOTHING: Self = Self { keys: [0.0; LANES], mask: 0, first: 0 };

    /// Removes and returns the child with the least key, unless that is beyond the limit.
    #[inline(always)]
    fn next<K: Kernel>(&mut self, kernel: K, limit: f32) -> Option<u32> {
        if self.mask == 0 {
            return None;
        }
        let lane = kernel.least(&self.keys, self.mask) % LANES;
        let is_within = self.keys[lane] <= limit;
        self.mask &= !(1 << lane);
        is_within.then_some(self.first + small(lane))
    }
}

impl Lanes {
    /// Calls `found` with the objects of the trees that the moving box may touch by `limit`, in groups with their keys,
    /// near ones roughly first. `found` returns the new limit, which must not increase. Limits are in the units of the
    /// slabs. A negative limit ends the search.
    pub(crate) fn visit_along<const D: usize>(
        self,
        trees: &[&Tree<D>],
        slabs: &Slabs<D>,
        limit: f32,
        found: impl FnMut(&[(u32, f32)]) -> f32,
    ) {
        self.visit_near_first(trees, slabs, limit, found);
    }

    /// As [`Self::visit_along`], for the objects that may be as near as `limit`, a square in the units of the gaps.
    pub(crate) fn visit_around<const D: usize>(
        self,
        trees: &[&Tree<D>],
        gaps: &Gaps<D>,
        limit: f32,
        found: impl FnMut(&[(u32, f32)]) -> f32,
    ) {
        self.visit_near_first(trees, gaps, limit, found);
    }

    /// Searches the trees one after the other; the limit that one search leaves bounds the next.
    #[inline(always)]
    fn visit_near_first<const D: usize>(
        self,
        trees: &[&Tree<D>],
        probe: &impl Probe<D>,
        mut limit: f32,
        mut found: impl FnMut(&[(u32, f32)]) -> f32,
    ) {
        with_kernel!(self, kernel => {
            for tree in trees.iter().filter(|tree| !tree.is_empty()) {
                debug_assert!(!tree.is_stale, "searches need a refitted tree");
                limit = tree.near_first(kernel, probe, limit, &mut found);
            }
        });
    }
}

impl<const D: usize> Tree<D> {
    /// Searches one tree; see [`Lanes::visit_along`]. Returns the last limit.
    #[inline(always)]
    fn near_first<K: Kernel>(
        &self,
        kernel: K,
        probe: &impl Probe<D>,
        limit: f32,
        found: &mut impl FnMut(&[(u32, f32)]) -> f32,
    ) -> f32 {
        self.descend(
            kernel,
            probe,
            limit,
            |block| self.touch_leaf(block),
            #[inline(always)]
            |block, limit| {
                // Both loads first, so that they overlap.
                let ids = self.leaves()[block as usize];
                let mut open = self.opened(kernel, probe, 0, block, limit);
                hand_out(kernel, &ids, &mut open, limit, found)
            },
        )
    }

    /// Calls `leaf` with leaf blocks in which a key may be at most the limit; `leaf` returns the new limit. Opens each
    /// block at most once. Calls `touch` with leaf blocks that may come next, which prefetches them.
    #[inline(always)]
    fn descend<K: Kernel>(
        &self,
        kernel: K,
        probe: &impl Probe<D>,
        mut limit: f32,
        touch: impl Fn(u32),
        mut leaf: impl FnMut(u32, f32) -> f32,
    ) -> f32 {
        let top = self.layers.len() - 1;
        if top == 0 {
            return leaf(0, limit);
        }
        // The open blocks by layer; those from `top` down to `layer` are in use.
        let (mut path, mut layer) = ([Open::NOTHING; LAYERS], top);
        path[top] = self.opened(kernel, probe, top, 0, limit);
        loop {
            match path[layer].next(kernel, limit) {
                // No child within the limit is left: the search goes on in the parent, or ends.
                None if layer == top => return limit,
                None => layer += 1,
                Some(block) if layer == 1 => {
                    // Prefetches one of the remaining leaf blocks, though another one may come next.
                    if path[1].mask != 0 {
                        touch(path[1].first + path[1].mask.trailing_zeros());
                    }
                    limit = leaf(block, limit);
                }
                Some(block) => {
                    layer -= 1;
                    path[layer] = self.opened(kernel, probe, layer, block, limit);
                }
            }
        }
    }

    /// Opens block `number` of a layer: computes the keys of its lanes, and marks those whose child exists and may have
    /// a key of at most `limit`.
    #[inline(always)]
    fn opened<K: Kernel>(
        &self,
        kernel: K,
        probe: &impl Probe<D>,
        layer: usize,
        number: u32,
        limit: f32,
    ) -> Open {
        let block = &self.layers[layer].blocks[number as usize];
        let mut keys = [0.0; LANES];
        let first = number * small(LANES);
        let mask = self.lanes_in_use(layer, first, probe.ask(kernel, block, limit, &mut keys));
        Open { keys, mask, first }
    }

    /// Opens a block for the children that may be as near as `limit`; see [`Lanes::visit_around`].
    pub(super) fn opened_around(
        &self,
        gaps: &Gaps<D>,
        layer: usize,
        number: u32,
        limit: f32,
    ) -> Open {
        with_kernel!(self.lanes, kernel => self.opened(kernel, gaps, layer, number, limit))
    }

    /// Touches the cache lines of a leaf block.
    #[inline(always)]
    fn touch_leaf(&self, block: u32) {
        let block = block as usize;
        let Block { lo, hi } = &self.layers[0].blocks[block];
        // `black_box` keeps these loads, whose results are not used.
        for axis in 0..D {
            core::hint::black_box((lo[axis][0], hi[axis][0]));
        }
        core::hint::black_box(self.ids[block * LANES]);
    }

    /// Clears the lanes without a block below them.
    #[inline(always)]
    fn lanes_in_use(&self, layer: usize, first: u32, mask: u32) -> u32 {
        let Some(below) = layer.checked_sub(1) else { return mask };
        let left = self.layers[below].blocks.len() - first as usize;
        if left < LANES { mask & ((1 << left) - 1) } else { mask }
    }

    /// Returns the largest magnitude of a coordinate of the boxes. Valid right after a refit.
    pub(crate) fn size(&self) -> f32 {
        let top = &self.layers[self.layers.len() - 1].bounds;
        top.iter().map(Bounds::size).fold(0.0, |most, x| if x > most { x } else { most })
    }

    /// Returns the ids in the sixteen slots of each leaf block; [`NONE`] for an empty slot.
    pub(crate) fn leaves(&self) -> &[[u32; LANES]] {
        self.ids.as_chunks().0
    }
}

/// Passes the objects of a leaf block to `found`, in groups; returns the new limit.
#[inline(always)]
fn hand_out<K: Kernel>(
    kernel: K,
    ids: &[u32; LANES],
    open: &mut Open,
    mut limit: f32,
    found: &mut impl FnMut(&[(u32, f32)]) -> f32,
) -> f32 {
    while open.mask != 0 {
        let (mut group, mut count) = ([(NONE, 0.0); GROUP], 0);
        // Collects the nearest lanes left. `None` means that all others are beyond the limit.
        while count < GROUP {
            let Some(slot) = open.next(kernel, limit) else {
                open.mask = 0;
                break;
            };
            let lane = (slot - open.first) as usize % LANES;
            group[count] = (ids[lane], open.keys[lane]);
            // An empty slot is overwritten by the next object.
            count += usize::from(ids[lane] != NONE);
        }
        if count > 0 {
            limit = found(&group[..count]);
        }
    }
    limit
}

/// A ray in the representations for boxes and for triangles, as [`Tree::visit_triangles`] needs it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayProbe {
    pub(crate) slabs: Slabs<3>,
    pub(crate) line: ShearedLine,
}

impl Tree<3> {
    /// Calls `found` with each object whose triangle the ray may cross by `limit`, in the order of
    /// [`Lanes::visit_along`]. `triangles` are those of the leaf blocks.
    pub(crate) fn visit_triangles(
        &self,
        triangles: &[Triangles],
        probe: &RayProbe,
        limit: f32,
        mut found: impl FnMut(TriangleAt<'_>) -> f32,
    ) {
        if !self.is_empty() {
            with_kernel!(self.lanes, kernel => {
                self.near_triangles(kernel, triangles, probe, limit, &mut found);
            });
        }
    }

    /// Searches the tree; see [`Self::visit_triangles`]. In a leaf block the triangles themselves are tested, not their
    /// boxes, and reported by ascending lane.
    #[inline(always)]
    fn near_triangles<K: Kernel>(
        &self,
        kernel: K,
        triangles: &[Triangles],
        probe: &RayProbe,
        limit: f32,
        found: &mut impl FnMut(TriangleAt<'_>) -> f32,
    ) {
        self.descend(
            kernel,
            &probe.slabs,
            limit,
            |block| triangles[block as usize].touch(),
            #[inline(always)]
            |block: u32, mut limit: f32| {
                let own = &triangles[block as usize];
                let mut mask = kernel.crossed(own, &probe.line, limit);
                while mask != 0 {
                    let lane = mask.trailing_zeros() as usize;
                    mask &= mask - 1;
                    let id = self.ids[block as usize * LANES + lane];
                    if id != NONE {
                        limit = found(TriangleAt { id, block: own, lane });
                    }
                }
                limit
            },
        );
    }
}
