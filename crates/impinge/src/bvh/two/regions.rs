//! Regions around blocks and objects of one tree in the frame of another, in `f32`, and the test of
//! which boxes in a block a region may touch.
//!
//! ```text
//!    own frame            the other tree's frame
//!   +--------+               /\_               along the axes of both frames (`bounds`, `slabs`)
//!   |  box   |  -- pose -->  \  \_   gap  [ ]  across the slab of the box's contents
//!   +--------+                \__/ ------>[ ]  along the line to the centre of each box ([`Extent`])
//! ```
//!
//! Boxes and slabs separate blocks that face each other. In a search for the nearest pair most
//! blocks lie beside each other, and the direction between their centres separates these.

use smallvec::SmallVec;

use crate::bvh::block_slabs::BlockSlab;
use crate::bvh::{Block, Bounds, LANES};
use crate::math::lanes::{bits, with_lanes};
use crate::math::simd::{Level, Simd};
use crate::math::{Pose, Real, Vector, Wide, filled};

/// Number of lanes that are tested at once.
const HALF: usize = LANES / 2;

/// The pose of one tree in the frame of the other.
#[derive(Clone, Copy)]
pub(super) struct TreePose<const D: usize> {
    /// Columns of the rotation matrix.
    axes: [[f32; D]; D],
    pub(super) shift: [f32; D],
}

/// A convex region in the frame of the blocks that it is tested against: the intersection of a box
/// and slabs. Box and slabs are widened by the maximum distance and the rounding error.
pub(super) struct RotatedBox<const D: usize> {
    bounds: Bounds<D>,
    /// Slabs along the axes of the region's own frame, and its block's slab.
    slabs: SmallVec<[BlockSlab<D>; 4]>,
    /// Set only in a search for the nearest pair.
    extent: Option<Extent<D>>,
}

/// A set that contains a region, so its extent along any direction bounds the extent of the region.
/// The set is the convex hull of `points`, plus (Minkowski sum) a segment from `-w` to `w` for each
/// `w` of `wider`, widened by `margin`.
struct Extent<const D: usize> {
    middle: [f32; D],
    points: SmallVec<[[f32; D]; 3]>,
    wider: SmallVec<[[f32; D]; 3]>,
    margin: f32,
}

/// The boxes in a block that a region may touch.
pub(super) struct Held {
    pub(super) mask: u32,
    /// Lower bounds of the distances of the boxes to the region: the largest gap along the tested
    /// directions.
    pub(super) gaps: [f32; LANES],
}

impl<const D: usize> TreePose<D> {
    /// Converts a pose to `f32`.
    pub(super) fn of<N: Real>(pose: &Pose<N, D>) -> Self {
        let axes = filled(|axis| filled(|row| pose.rotation[(row, axis)].as_f32()));
        Self { axes, shift: filled(|row| pose.translation[row].as_f32()) }
    }

    /// Rotates a vector into the frame of the other tree.
    pub(super) fn vector(&self, local: &[f32; D]) -> [f32; D] {
        filled(|row| (0..D).map(|axis| self.axes[axis][row] * local[axis]).sum())
    }

    /// Takes a box and its slab in this tree's frame. Returns the region in which both overlap, in
    /// the frame of the other tree and widened by `margin`. The region has an [`Extent`] only if
    /// `is_for_nearest`.
    pub(super) fn region_of(
        &self,
        bounds: &Bounds<D>,
        slab: Option<&BlockSlab<D>>,
        margin: f32,
        is_for_nearest: bool,
    ) -> RotatedBox<D> {
        let half: [f32; D] = filled(|axis| bounds.hi[axis] * 0.5 - bounds.lo[axis] * 0.5);
        let rotated: [f32; D] = self.vector(&bounds.center());
        let center: [f32; D] = filled(|row| rotated[row] + self.shift[row]);
        let extents: [f32; D] = filled(|row| {
            margin + (0..D).map(|axis| self.axes[axis][row].abs() * half[axis]).sum::<f32>()
        });
        let mut slabs = SmallVec::new();
        for (across, half) in self.axes.iter().zip(half) {
            let height = dot(across, &center);
            let (low, high) = (height - half - margin, height + half + margin);
            slabs.push(BlockSlab { across: *across, low, high });
        }
        if let Some(slab) = slab {
            let across = self.vector(&slab.across);
            let height = dot(&across, &self.shift);
            let (low, high) = (height + slab.low - margin, height + slab.high + margin);
            slabs.push(BlockSlab { across, low, high });
        }
        let bounds = Bounds {
            lo: filled(|row| center[row] - extents[row]),
            hi: filled(|row| center[row] + extents[row]),
        };
        let wider = self.axes.iter().zip(half).map(|(axis, half)| axis.map(|at| at * half));
        let extent = is_for_nearest.then(|| Extent {
            middle: center,
            points: SmallVec::from_slice(&[center]),
            wider: wider.collect(),
            margin,
        });
        RotatedBox { bounds, slabs, extent }
    }
}

fn dot<const D: usize>(a: &[f32; D], b: &[f32; D]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl<const D: usize> RotatedBox<D> {
    /// Returns the region of an object's box, and of the object's corners if it has any, all in the
    /// frame of the blocks and widened by `margin`.
    pub(super) fn of_object<N: Real>(
        bounds: &Bounds<D>,
        corners: Option<[Vector<N, D>; 3]>,
        margin: f32,
    ) -> Self {
        let bounds = Bounds {
            lo: filled(|axis| bounds.lo[axis] - margin),
            hi: filled(|axis| bounds.hi[axis] + margin),
        };
        let extent = corners.map(|corners| Extent::of_corners(&corners, margin));
        Self { bounds, slabs: SmallVec::new(), extent }
    }

    /// Tests all boxes in a block, and returns the mask of the boxes that the region may touch.
    pub(super) fn held(&self, level: Level, block: &Block<D>) -> Held {
        let mut held = Held { mask: 0, gaps: [0.0; LANES] };
        for first in [0, HALF] {
            let gaps = &mut held.gaps[first..first + HALF];
            let mask = with_lanes!(level, simd => self.held_half(simd, block, first, gaps));
            held.mask |= u32::from(mask) << first;
        }
        held
    }

    /// Tests 8 boxes in a block, from lane `first` on: writes their gaps and returns the mask of
    /// the boxes that may be touched. Empty lanes have an infinite gap.
    #[inline(always)]
    fn held_half<S: Simd>(&self, simd: S, block: &Block<D>, first: usize, gaps: &mut [f32]) -> u8 {
        let (lanes, zero) = (first..first + HALF, S::F32x8::all(simd, 0.0));
        let (mut lo, mut hi) = ([zero; D], [zero; D]);
        let mut gap = S::F32x8::all(simd, f32::NEG_INFINITY);
        for axis in 0..D {
            lo[axis] = S::F32x8::load(simd, &block.lo[axis][lanes.clone()]);
            hi[axis] = S::F32x8::load(simd, &block.hi[axis][lanes.clone()]);
            gap = (lo[axis] - S::F32x8::all(simd, self.bounds.hi[axis])).larger(gap);
            gap = (S::F32x8::all(simd, self.bounds.lo[axis]) - hi[axis]).larger(gap);
        }
        if bits(gap.simd_gt(zero)) != u8::MAX {
            for BlockSlab { across, low, high } in &self.slabs {
                let (mut lowest, mut highest) = (zero, zero);
                for axis in 0..D {
                    let along = S::F32x8::all(simd, across[axis]);
                    let ends = [along * lo[axis], along * hi[axis]];
                    let far = usize::from(across[axis] >= 0.0);
                    (lowest, highest) = (lowest + ends[1 - far], highest + ends[far]);
                }
                // A NaN is not larger, so it does not change `gap`.
                gap = (lowest - S::F32x8::all(simd, *high)).larger(gap);
                gap = (S::F32x8::all(simd, *low) - highest).larger(gap);
            }
        }
        if let Some(extent) = &self.extent
            && bits(gap.simd_gt(zero)) != u8::MAX
        {
            gap = extent.gaps(simd, &[lo, hi]).larger(gap);
        }
        gap.store(gaps);
        !bits(gap.simd_gt(zero))
    }
}

impl<const D: usize> Extent<D> {
    /// Returns the extent of the convex hull of three corners, widened by `margin`.
    fn of_corners<N: Real>(corners: &[Vector<N, D>; 3], margin: f32) -> Self {
        let points: [[f32; D]; 3] = filled(|at: usize| filled(|axis| corners[at][axis].as_f32()));
        let middle = filled(|axis| points.iter().map(|corner| corner[axis] / 3.0).sum());
        Self { middle, points: SmallVec::from_slice(&points), wider: SmallVec::new(), margin }
    }

    /// Returns the gaps to 8 boxes, each along the line from `middle` to the centre of the box; NaN
    /// if the two points coincide.
    #[inline(always)]
    fn gaps<S: Simd>(&self, simd: S, [lo, hi]: &[[S::F32x8; D]; 2]) -> S::F32x8 {
        let (half, zero) = (S::F32x8::all(simd, 0.5), S::F32x8::all(simd, 0.0));
        let (mut offset, mut squared, mut low) = ([zero; D], zero, zero);
        for axis in 0..D {
            let middle = (lo[axis] + hi[axis]) * half;
            offset[axis] = middle - S::F32x8::all(simd, self.middle[axis]);
            squared = offset[axis] * offset[axis] + squared;
            low = low + offset[axis] * middle - offset[axis].abs() * ((hi[axis] - lo[axis]) * half);
        }
        let along = |vector: &[f32; D]| {
            let mut height = zero;
            for axis in 0..D {
                height = offset[axis] * S::F32x8::all(simd, vector[axis]) + height;
            }
            height
        };
        let mut high = -S::F32x8::all(simd, f32::INFINITY);
        for point in &self.points {
            high = along(point).larger(high);
        }
        for wider in &self.wider {
            high += along(wider).abs();
        }
        (low - high) / squared.sqrt() - S::F32x8::all(simd, self.margin)
    }
}
