//! Depth-first searches that visit near boxes first: along a moving box or ray, or around a box at
//! rest.
//!
//! In each block the nearest child comes next (as in most ray tracers; Roussopoulos, Kelley and
//! Vincent, "Nearest neighbor queries", 1995), as long as it is within the limit, which shrinks
//! with each result. One block for each layer is open, with the keys of its children; the next
//! child is selected only when its turn comes, since most are never visited. The order is rough:
//! objects of a later block may be nearer than some of an earlier one. This avoids the queue of
//! [`Frontier`](super::Frontier), whose upkeep costs more than the tests of boxes that it saves.

use super::gaps::Gaps;
use super::kernel::{Kernel, with_kernel};
use super::slabs::Slabs;
use super::tree::small;
use super::triangles::{ShearedLine, TriangleAt, Triangles};
use super::{Block, Bounds, LANES, Lanes, NONE, Tree};

/// Greatest number of layers: 2^32 objects need 8.
pub(super) const LAYERS: usize = 8;

/// Greatest number of objects passed to `found` at once. Their data are scattered in memory, so
/// loads for several objects should overlap.
pub(crate) const GROUP: usize = 4;

/// A query that computes keys for the lanes of a block, and rejects lanes beyond a limit.
pub(super) trait Probe<const D: usize> {
    /// Returns the lanes whose key may be at most `limit`, and writes the keys, which are zero or
    /// more and may have rounding errors. The mask contains every lane whose exact key is within
    /// the time or distance from which `limit` was converted.
    fn test<K: Kernel>(
        &self,
        kernel: K,
        block: &Block<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32;
}

/// The key of a lane is the time at which the moving box enters it.
impl<const D: usize> Probe<D> for Slabs<D> {
    #[inline(always)]
    fn test<K: Kernel>(
        &self,
        kernel: K,
        block: &Block<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        kernel.enter(block, self, limit, keys)
    }
}

/// The key of a lane is its squared distance.
impl<const D: usize> Probe<D> for Gaps<D> {
    #[inline(always)]
    fn test<K: Kernel>(
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
    /// A block without unvisited children.
    const NOTHING: Self = Self { keys: [0.0; LANES], mask: 0, first: 0 };

    /// Removes the unvisited child with the least key and returns its index; `None` if all children
    /// are visited, or if the least key exceeds `limit` (the child is removed nevertheless).
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
    /// Calls `found` with the objects that the moving box may touch at or before time `limit`, and
    /// their keys: in groups of at most [`GROUP`], roughly by ascending key. `found` returns the
    /// new limit, which must not increase. Limits are in the units of the slabs. A negative limit
    /// ends the search.
    pub(crate) fn visit_along<const D: usize>(
        self,
        trees: &[&Tree<D>],
        slabs: &Slabs<D>,
        limit: f32,
        found: impl FnMut(&[(u32, f32)]) -> f32,
    ) {
        self.visit_near_first(trees, slabs, limit, found);
    }

    /// Calls `found` with the objects whose squared distance may be at most `limit`, in squared
    /// units of the gaps, and their keys: in groups of at most [`GROUP`], roughly by ascending key.
    /// `found` returns the new limit, which must not increase. A negative limit ends the search.
    pub(crate) fn visit_around<const D: usize>(
        self,
        trees: &[&Tree<D>],
        gaps: &Gaps<D>,
        limit: f32,
        found: impl FnMut(&[(u32, f32)]) -> f32,
    ) {
        self.visit_near_first(trees, gaps, limit, found);
    }

    /// Searches the trees one after another. The limit after one search is the first limit of the
    /// next.
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

    /// Calls `leaf` with each leaf block in which a key may be at most the limit; `leaf` returns
    /// the new limit. Opens each block at most once. Calls `touch`, which prefetches, with leaf
    /// blocks that may be visited soon. Returns the last limit.
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
                // No child within the limit is left: the search continues in the parent, or ends.
                None if layer == top => return limit,
                None => layer += 1,
                Some(block) if layer == 1 => {
                    // Prefetches one of the remaining leaf blocks, though another block may be
                    // visited first.
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

    /// Opens the block with index `number` in a layer: computes the keys of its lanes, and sets the
    /// mask of lanes that have a child and whose key may be at most `limit`.
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
        let mask = self.lanes_in_use(layer, first, probe.test(kernel, block, limit, &mut keys));
        Open { keys, mask, first }
    }

    /// Opens a block for the children whose squared distance to the box of `gaps` may be at most
    /// `limit`, in squared units of `gaps`.
    pub(super) fn opened_around(
        &self,
        gaps: &Gaps<D>,
        layer: usize,
        number: u32,
        limit: f32,
    ) -> Open {
        with_kernel!(self.lanes, kernel => self.opened(kernel, gaps, layer, number, limit))
    }

    /// Prefetches the first values of a leaf block: its boxes and its ids.
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

    /// Returns `mask` without the lanes that have no child block. A lane of layer 0 has a slot and
    /// no child block; for this layer the mask is returned unchanged.
    #[inline(always)]
    fn lanes_in_use(&self, layer: usize, first: u32, mask: u32) -> u32 {
        let Some(below) = layer.checked_sub(1) else { return mask };
        let left = self.layers[below].blocks.len() - first as usize;
        if left < LANES { mask & ((1 << left) - 1) } else { mask }
    }

    /// Returns the largest magnitude of a coordinate of the boxes. Exact after a refit, until a box
    /// changes.
    pub(crate) fn size(&self) -> f32 {
        let top = &self.layers[self.layers.len() - 1].bounds;
        top.iter().map(Bounds::size).fold(0.0, |most, x| if x > most { x } else { most })
    }

    /// Returns the ids in the sixteen slots of each leaf block; [`NONE`] for an empty slot.
    pub(crate) fn leaves(&self) -> &[[u32; LANES]] {
        self.ids.as_chunks().0
    }
}

/// Passes the objects of a leaf block to `found`, in groups by ascending key; returns the new
/// limit.
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
        // Collects the nearest remaining lanes. `None`: all remaining lanes are beyond the limit.
        while count < GROUP {
            let Some(slot) = open.next(kernel, limit) else {
                open.mask = 0;
                break;
            };
            let lane = (slot - open.first) as usize % LANES;
            group[count] = (ids[lane], open.keys[lane]);
            // If the slot is free, the next object overwrites this entry.
            count += usize::from(ids[lane] != NONE);
        }
        if count > 0 {
            limit = found(&group[..count]);
        }
    }
    limit
}

/// A ray, prepared for tests against boxes and against triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayProbe {
    pub(crate) slabs: Slabs<3>,
    pub(crate) line: ShearedLine,
}

impl Tree<3> {
    /// Calls `found` with each object whose triangle the ray may cross by `limit`, near leaf blocks
    /// roughly first. `found` returns the new limit, which must not increase. `triangles[i]` has
    /// the triangles of leaf block `i`.
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

    /// Searches a tree that is not empty. In a leaf block the triangles themselves are tested, not
    /// their boxes, and reported by ascending lane.
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
