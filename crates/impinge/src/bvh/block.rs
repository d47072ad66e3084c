//! A block of sixteen boxes.

use super::Bounds;
use crate::math::filled;

/// Number of boxes in a block.
pub(crate) const LANES: usize = 16;

/// Sixteen boxes as a structure of arrays:
///
/// ```text
/// lo[0]  x of lanes 0 ... 15      hi[0]  x of lanes 0 ... 15
/// lo[1]  y of lanes 0 ... 15      hi[1]  y of lanes 0 ... 15
/// ```
///
/// 384 bytes (six cache lines) in 3D, 256 in 2D. A lane without a box has [`Bounds::EMPTY`]: no
/// bounded query overlaps it, and it is neutral in unions. So no lane count is needed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Block<const D: usize> {
    pub(crate) lo: [[f32; LANES]; D],
    pub(crate) hi: [[f32; LANES]; D],
}

impl<const D: usize> Block<D> {
    /// A block of sixteen empty lanes.
    pub(crate) const EMPTY: Self =
        Self { lo: [[f32::INFINITY; LANES]; D], hi: [[f32::NEG_INFINITY; LANES]; D] };

    /// Returns the box in lane `lane`; [`Bounds::EMPTY`] if the lane is unused.
    #[inline]
    #[must_use]
    pub(crate) fn lane(&self, lane: usize) -> Bounds<D> {
        Bounds { lo: filled(|axis| self.lo[axis][lane]), hi: filled(|axis| self.hi[axis][lane]) }
    }

    /// Returns the lane whose box has its centre nearest to `point`, the lowest lane in a tie;
    /// `None` if no centre is finite, or all squared distances overflow `f32`.
    #[inline]
    pub(crate) fn nearest_lane(&self, point: &[f32; D]) -> Option<usize> {
        let mut squares = [0.0; LANES];
        for ((lo, hi), point) in self.lo.iter().zip(&self.hi).zip(point) {
            for ((square, lo), hi) in squares.iter_mut().zip(lo).zip(hi) {
                let offset = lo * 0.5 + hi * 0.5 - point;
                *square += offset * offset;
            }
        }
        let (mut nearest, mut least) = (None, f32::INFINITY);
        for (lane, &square) in squares.iter().enumerate() {
            (nearest, least) = if square < least { (Some(lane), square) } else { (nearest, least) };
        }
        nearest
    }

    /// Returns, by lane, the least dot product of `along`, a vector of any length, with a point of
    /// the box. Infinite or NaN for a lane without a box.
    #[inline]
    pub(crate) fn lowest_along(&self, along: &[f32; D]) -> [f32; LANES] {
        let mut lowest = [0.0; LANES];
        for ((along, lo), hi) in along.iter().zip(&self.lo).zip(&self.hi) {
            let faces = if *along < 0.0 { hi } else { lo };
            for (sum, face) in lowest.iter_mut().zip(faces) {
                *sum += along * face;
            }
        }
        lowest
    }

    /// Replaces the box in lane `lane` by `bounds`.
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
