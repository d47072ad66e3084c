//! Slabs around the contents of blocks, perpendicular to the mean normal of their faces.
//!
//! ```text
//! box of a slanted patch         its slab
//!  +------------+                    / /
//!  |          .´|                   / /
//!  |       .´   |              low / / high
//!  |    .´      |                 / /
//!  | .´         |                / /
//!  +------------+               / /
//! ```
//!
//! The box of a slanted patch of a surface is about as thick as the patch is wide. A slab is thin:
//! where the surface is smooth, its thickness is of the order of the squared width. Slab and box
//! together are almost as tight as oriented boxes along any direction (Gottschalk, Lin and Manocha,
//! "`OBBTree`", 1996).

use super::tree::small;
use super::{Bounds, LANES, NONE, Tree};
use crate::math::{Point, Real, Vector, filled, max, min, unit};

/// A slab is used only if the box is at least `THINNER` times as thick as the slab, along the
/// slab's normal.
const THINNER: f64 = 4.0;
/// Error bound of a dot product of the slab's normal and a corner, in rounding units of the tree's
/// largest coordinate.
const ROUNDING: f64 = 32.0;

/// The space between two planes, in the frame of a tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct BlockSlab<const D: usize> {
    /// Normal of the planes, of unit length up to rounding.
    pub(super) across: [f32; D],
    pub(super) low: f32,
    pub(super) high: f32,
}

/// A box and a slab around the same objects.
#[derive(Clone, Copy, Debug)]
pub(super) struct SlabBox<'a, const D: usize> {
    pub(super) bounds: &'a Bounds<D>,
    pub(super) slab: Option<&'a BlockSlab<D>>,
}

impl<const D: usize> BlockSlab<D> {
    /// Returns the normal of the planes, converted to the scalar type `N`.
    pub(super) fn across<N: Real>(&self) -> Vector<N, D> {
        Vector::from_fn(|axis, _| N::lit(self.across[axis].into()))
    }

    /// Returns the slab around the contents of a block. Its planes are perpendicular to `sum`, the
    /// sum of the normals of the block's faces. `extent` returns the extent of the contents along a
    /// direction. `None` if the sum has no direction, or if the slab is not thin compared with
    /// `bounds` (see [`THINNER`]).
    fn around<N: Real>(
        sum: &Vector<N, D>,
        bounds: &Bounds<D>,
        extent: impl Fn(&Vector<N, D>) -> N,
    ) -> Option<Self> {
        let (across, _) = unit(sum)?;
        let across = filled(|axis| across[axis].as_f32());
        // The planes are perpendicular to the rounded direction.
        let normal = Vector::from_fn(|axis, _| N::lit(f64::from(across[axis])));
        let (low, high) = (-extent(&-normal), extent(&normal));
        let of_box = bounds.extent(&normal) + bounds.extent(&-normal);
        if (high - low) * N::lit(THINNER) > of_box {
            return None;
        }
        Some(Self { across, low: low.as_f32_below(), high: high.as_f32_above() })
    }
}

impl<const D: usize> SlabBox<'_, D> {
    /// Returns an upper bound of the extent of the contents along a direction.
    pub(super) fn extent<N: Real>(&self, along: &Vector<N, D>) -> N {
        let whole = self.bounds.extent(along);
        let Some(slab) = self.slab else { return whole };
        // `along` is the sum of a multiple of the slab's normal, bounded by the slab, and a
        // remainder, bounded by the box. The bound holds for any multiple. With this one, the
        // projection of `along` on the normal, the remainder is parallel to the planes.
        let across = slab.across::<N>();
        let share = along.dot(&across);
        let height = N::lit(if share < N::ZERO { slab.low } else { slab.high }.into());
        min(share * height + self.bounds.extent(&(along - across * share)), whole)
    }
}

impl<const D: usize> Tree<D> {
    /// Stores a slab around the contents of each block, or `None` where the slab would not be thin.
    /// `normals` are indexed by object id; `corners` returns the three corners of an object.
    pub(crate) fn add_slabs<N: Real>(
        &mut self,
        normals: &[Vector<N, D>],
        corners: impl Fn(u32) -> [Point<N, D>; 3],
    ) {
        let mut sums: Vec<Vector<N, D>> = self
            .leaves()
            .iter()
            .map(|ids| in_use(ids).map(|id| &normals[id as usize]).sum())
            .collect();
        let size = N::lit(f64::from(self.size()) * ROUNDING) * N::EPSILON;
        self.slabs.clear();
        let slab = |((ids, sum), bounds): ((&[u32; LANES], &Vector<N, D>), &Bounds<D>)| {
            let corners: Vec<_> = in_use(ids).flat_map(&corners).collect();
            BlockSlab::around(sum, bounds, |along| {
                corners.iter().fold(-N::INFINITY, |extent, at| max(at.coords.dot(along), extent))
                    + size
            })
        };
        self.slabs
            .push(self.leaves().iter().zip(&sums).zip(&self.layers[0].bounds).map(slab).collect());
        for layer in 1..self.layers.len() {
            sums = sums.chunks(LANES).map(|below| below.iter().sum()).collect();
            let blocks = (0..).zip(&sums);
            let slab = |(block, sum): (u32, &Vector<N, D>)| {
                let below = || self.children(layer - 1, block);
                BlockSlab::around(sum, &self.layers[layer].bounds[block as usize], |along| {
                    below().fold(-N::INFINITY, |extent, below| max(below.extent(along), extent))
                        + size
                })
            };
            let slabs = blocks.map(slab).collect();
            self.slabs.push(slabs);
        }
    }

    /// Removes the slabs.
    pub(crate) fn drop_slabs(&mut self) {
        self.slabs.clear();
    }

    /// Returns the box and the slab of a block.
    pub(super) fn slab_box(&self, layer: usize, block: u32) -> SlabBox<'_, D> {
        let slab = self.slabs.get(layer).and_then(|slabs| slabs[block as usize].as_ref());
        SlabBox { bounds: &self.layers[layer].bounds[block as usize], slab }
    }

    /// Iterates over the children of block `above`; `layer` is the layer of the children.
    fn children(&self, layer: usize, above: u32) -> impl Iterator<Item = SlabBox<'_, D>> {
        let first = above * small(LANES);
        let blocks = (first..small(self.layers[layer].blocks.len())).take(LANES);
        blocks.map(move |block| self.slab_box(layer, block))
    }
}

/// Iterates over the ids in a leaf block; skips [`NONE`].
pub(super) fn in_use(ids: &[u32; LANES]) -> impl Iterator<Item = u32> {
    ids.iter().copied().filter(|&id| id != NONE)
}
