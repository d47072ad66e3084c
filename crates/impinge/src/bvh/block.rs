//! Sixteen boxes side by side.

use super::Bounds;

/// Boxes in a block.
pub(crate) const LANES: usize = 16;

/// Sixteen boxes as a structure of arrays: by axis, all least coordinates, then all greatest.
///
/// 384 bytes (six cache lines) in 3D, 256 in 2D. A lane without a box holds
/// [`Bounds::EMPTY`], which no bounded query overlaps and which is neutral when bounds are taken,
/// so that no count of lanes is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Block<const D: usize> {
    pub(crate) lo: [[f32; LANES]; D],
    pub(crate) hi: [[f32; LANES]; D],
}

impl<const D: usize> Block<D> {
    /// Sixteen empty lanes.
    pub(crate) const EMPTY: Self =
        Self { lo: [[f32::INFINITY; LANES]; D], hi: [[f32::NEG_INFINITY; LANES]; D] };

    /// The box in a lane.
    #[inline]
    #[must_use]
    pub(crate) fn lane(&self, lane: usize) -> Bounds<D> {
        Bounds {
            lo: core::array::from_fn(|axis| self.lo[axis][lane]),
            hi: core::array::from_fn(|axis| self.hi[axis][lane]),
        }
    }

    /// Puts a box into a lane.
    #[inline]
    pub(crate) fn set_lane(&mut self, lane: usize, bounds: &Bounds<D>) {
        for axis in 0..D {
            self.lo[axis][lane] = bounds.lo[axis];
            self.hi[axis][lane] = bounds.hi[axis];
        }
    }
}

impl<const D: usize> Default for Block<D> {
    fn default() -> Self {
        Self::EMPTY
    }
}
