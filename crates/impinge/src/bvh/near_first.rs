//! Searches along the way of a moving box or ray, near boxes before far ones, as deep as they go.
//!
//! Depth first, the children of a block by the time they are entered (as in all ray tracers), with the
//! limit held against that time once more when a child's turn comes. What is found shortens the search;
//! but unlike that of [`Frontier`](super::Frontier) the order is rough: objects of a block that is
//! entered later may come earlier than some before it. That saves a queue, which costs more than the
//! boxes it spares.

use super::kernel::{Kernel, with_kernel};
use super::slabs::Slabs;
use super::tree::small;
use super::triangles::{ShearedLine, Triangles};
use super::{LANES, Lanes, NONE, Tree};

/// Entries that a search may have put off: each of at most eight layers leaves at most fifteen, the
/// lowest expansion sixteen; and the other trees.
const STACK: usize = 160;

/// A block of a layer above 0, or what lies below: a slot, or the block of leaves.
#[derive(Clone, Copy, Debug)]
struct Entry {
    /// When it is entered.
    key: f32,
    tree: u8,
    layer: u8,
    number: u32,
}

impl Entry {
    #[inline(always)]
    fn rank(self) -> u64 {
        u64::from(self.key.to_bits()) << 32 | u64::from(self.number)
    }
}

/// What a search has put off, the nearest on top of those of one block: arrays of the members of
/// [`Entry`], which are emptied faster.
struct Pending {
    /// The keys, whose bits order as they do, and below them the numbers.
    ranks: [u64; STACK],
    /// The trees and layers.
    places: [[u8; 2]; STACK],
    len: usize,
}

impl Pending {
    #[inline(always)]
    fn new() -> Self {
        Self { ranks: [0; STACK], places: [[0; 2]; STACK], len: 0 }
    }

    #[inline(always)]
    fn push(&mut self, entry: Entry) {
        (self.ranks[self.len], self.places[self.len]) = (entry.rank(), [entry.tree, entry.layer]);
        self.len += 1;
    }

    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "the two halves of the rank")]
    fn pop(&mut self) -> Option<Entry> {
        self.len = self.len.checked_sub(1)?;
        let (rank, [tree, layer]) = (self.ranks[self.len], self.places[self.len]);
        Some(Entry { key: f32::from_bits((rank >> 32) as u32), tree, layer, number: rank as u32 })
    }

    /// Adds the lanes of the mask, those with the least keys last; `first` is the entry of lane 0.
    #[inline(always)]
    fn push_lanes(&mut self, mut mask: u32, keys: &[f32; LANES], first: Entry) {
        let start = self.len;
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let entry = Entry { key: keys[lane as usize], number: first.number + lane, ..first };
            let (rank, mut at) = (entry.rank(), self.len);
            while at > start && self.ranks[at - 1] < rank {
                self.ranks[at] = self.ranks[at - 1];
                at -= 1;
            }
            self.ranks[at] = rank;
            self.places[self.len] = [first.tree, first.layer];
            self.len += 1;
        }
    }
}

impl Lanes {
    /// Calls `found` with each object of the trees that the moving box may touch by `limit` near
    /// ones first but in no exact order; `found` returns the new limit, which
    /// never grows. Both are in the units of the slabs. A negative limit ends the search.
    pub(crate) fn visit_near_first<const D: usize>(
        self,
        trees: &[&Tree<D>],
        slabs: &Slabs<D>,
        limit: f32,
        mut found: impl FnMut(u32) -> f32,
    ) {
        with_kernel!(self, kernel => near_first(kernel, trees, slabs, limit, &mut found));
    }
}

#[inline(always)]
fn near_first<K: Kernel, const D: usize>(
    kernel: K,
    trees: &[&Tree<D>],
    slabs: &Slabs<D>,
    mut limit: f32,
    found: &mut impl FnMut(u32) -> f32,
) {
    let (mut pending, mut keys) = (Pending::new(), [0.0; LANES]);
    for (tree, number) in trees.iter().zip(0..).filter(|(tree, _)| !tree.is_empty()) {
        debug_assert!(!tree.is_stale, "searches need a refitted tree");
        pending.push(Entry { key: 0.0, tree: number, layer: tree.top_layer() + 1, number: 0 });
    }
    while let Some(entry) = pending.pop() {
        let is_within = entry.key <= limit;
        if !is_within {
            continue;
        }
        let tree = trees[usize::from(entry.tree)];
        let Some(layer) = entry.layer.checked_sub(1) else {
            if let Some(id) = tree.id_in(entry.number) {
                limit = found(id);
            }
            continue;
        };
        let blocks = &tree.layers[usize::from(layer)].blocks;
        let block = &blocks[entry.number as usize];
        let mask = kernel.enter(block, slabs, limit, &mut keys);
        let first = Entry { layer, number: entry.number * small(LANES), ..entry };
        pending.push_lanes(tree.lanes_in_use(layer, first.number, mask), &keys, first);
    }
}

impl<const D: usize> Tree<D> {
    /// Without the lanes that have no block below them.
    #[inline(always)]
    fn lanes_in_use(&self, layer: u8, first: u32, mask: u32) -> u32 {
        let Some(below) = layer.checked_sub(1) else { return mask };
        let left = self.layers[usize::from(below)].blocks.len() - first as usize;
        if left < LANES { mask & ((1 << left) - 1) } else { mask }
    }

    /// The largest magnitude of a coordinate of the boxes. Right after a refit only.
    pub(crate) fn size(&self) -> f32 {
        let top = &self.layers[self.layers.len() - 1].bounds;
        let all = top.iter().filter(|bounds| bounds.is_finite());
        let faces = all.flat_map(|bounds| bounds.lo.iter().chain(&bounds.hi));
        faces.fold(0.0, |most, x| if x.abs() > most { x.abs() } else { most })
    }

    /// The ids in the sixteen slots of each leaf block; [`NONE`] for an empty slot.
    pub(crate) fn leaves(&self) -> &[[u32; LANES]] {
        self.ids.as_chunks().0
    }
}

/// A ray among triangles: what [`Tree::visit_triangles`] asks the boxes and the triangles.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RayProbe {
    pub(crate) slabs: Slabs<3>,
    pub(crate) line: ShearedLine,
}

impl Tree<3> {
    /// Calls `found` with each object whose triangle the ray may cross by `limit`, its id, block and
    /// lane, as [`Lanes::visit_near_first`]. `triangles` are those of the leaf blocks.
    pub(crate) fn visit_triangles(
        &self,
        triangles: &[Triangles],
        probe: &RayProbe,
        limit: f32,
        mut found: impl FnMut(u32, &Triangles, usize) -> f32,
    ) {
        if !self.is_empty() {
            with_kernel!(self.lanes, kernel => {
                self.near_triangles(kernel, triangles, probe, limit, &mut found);
            });
        }
    }

    #[inline(always)]
    fn near_triangles<K: Kernel>(
        &self,
        kernel: K,
        triangles: &[Triangles],
        probe: &RayProbe,
        mut limit: f32,
        found: &mut impl FnMut(u32, &Triangles, usize) -> f32,
    ) {
        let (mut pending, mut keys) = (Pending::new(), [0.0; LANES]);
        pending.push(Entry { key: 0.0, tree: 0, layer: self.top_layer(), number: 0 });
        while let Some(entry) = pending.pop() {
            let is_within = entry.key <= limit;
            if !is_within {
                continue;
            }
            if entry.layer > 0 {
                let block = &self.layers[usize::from(entry.layer)].blocks[entry.number as usize];
                let mask = kernel.enter(block, &probe.slabs, limit, &mut keys);
                let number = entry.number * small(LANES);
                let mask = self.lanes_in_use(entry.layer, number, mask);
                pending.push_lanes(mask, &keys, Entry { layer: entry.layer - 1, number, ..entry });
                continue;
            }
            let own = &triangles[entry.number as usize];
            let mut mask = kernel.crossed(own, &probe.line, limit);
            while mask != 0 {
                let lane = mask.trailing_zeros() as usize;
                mask &= mask - 1;
                let id = self.ids[entry.number as usize * LANES + lane];
                if id != NONE {
                    limit = found(id, own, lane);
                }
            }
        }
    }
}
