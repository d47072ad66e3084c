//! Supporting feature on the face of a box most aligned with the normal, for `L` pairs, by the rule
//! of `SupportMap::core_feature`: the face itself, its nearest side, or its nearest corner.
//!
//! ```text
//!    is_free     [1, 1]  the whole face     [1, 0] or [0, 1]  one side     [0, 0]  one corner
//!    tilt        small                      large along one axis           large along both
//! ```

use super::clip::SIGNS;
use crate::math::lanes::lit;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};
use crate::shape::FACING_SINE_SQUARED;

/// The supporting part of a face: the face itself, a side or a corner. Index `i` of both fields is
/// an axis of the face. `is_free[i]` are the lanes where the part extends along axis `i`. For the
/// other lanes, `is_positive[i]` are those where the part is at the positive end of axis `i`.
#[derive(Clone, Copy)]
pub(super) struct SupportingParts<M> {
    is_free: [M; 2],
    is_positive: [M; 2],
}

impl<M> SupportingParts<M> {
    /// Computes the part from the components `tilt` of a unit vector along the two axes of the
    /// face. `is_middle` are the lanes where the face is perpendicular to the second axis of the
    /// box. If the tilts along both axes are equal, the second axis of the face counts as the less
    /// tilted one in these lanes, the first axis in all others.
    #[inline(always)]
    pub(super) fn of<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>>(
        simd: S,
        is_middle: M,
        tilt: [V; 2],
    ) -> Self
    where
        M: SimdMask<S>,
    {
        let (zero, limit) = (V::all(simd, N::ZERO), lit::<S, N, V>(simd, FACING_SINE_SQUARED));
        let squares = [tilt[0] * tilt[0], tilt[1] * tilt[1]];
        let is_all = Self::is_all(simd, tilt);
        let [one, other] = [tilt[0].abs(), tilt[1].abs()];
        // A side extends along the axis with the smaller tilt; a tie is resolved by the order of
        // the box's axes.
        let is_first_weaker = one.simd_lt(other) | (one.simd_eq(other) & !is_middle);
        Self {
            is_free: [
                is_all | (is_first_weaker & squares[0].simd_le(limit)),
                is_all | (!is_first_weaker & squares[1].simd_le(limit)),
            ],
            is_positive: [!tilt[0].simd_lt(zero), !tilt[1].simd_lt(zero)],
        }
    }

    /// Returns the lanes where a face is tilted by at most atan(1/2) ≈ 26.6°. There the whole face
    /// is the supporting feature. `[u, v]` are the components of the unit normal along the face.
    #[inline(always)]
    pub(super) fn is_all<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>>(
        simd: S,
        [u, v]: [V; 2],
    ) -> M {
        (u * u + v * v).simd_le(lit::<S, N, V>(simd, FACING_SINE_SQUARED))
    }

    /// Returns the lanes where the part is the whole face.
    #[inline(always)]
    pub(super) fn is_whole<S: Simd>(&self) -> M
    where
        M: SimdMask<S>,
    {
        self.is_free[0] & self.is_free[1]
    }

    /// Returns the lanes where a corner of the face, in the order of `SIGNS`, belongs to the part.
    #[inline(always)]
    pub(super) fn has_corner<S: Simd>(&self, corner: usize) -> M
    where
        M: SimdMask<S>,
    {
        let [x, y] = SIGNS[corner];
        (self.is_free[0] | self.is_at(0, x)) & (self.is_free[1] | self.is_at(1, y))
    }

    /// Returns the lanes where the side at one end of `axis` belongs to the part.
    #[inline(always)]
    pub(super) fn has_side<S: Simd>(&self, axis: usize, is_positive: bool) -> M
    where
        M: SimdMask<S>,
    {
        self.is_free[1 - axis] & (self.is_free[axis] | self.is_at(axis, is_positive))
    }

    /// Returns the lanes where a point of the face belongs to the part, but no lane whose part is a
    /// corner. For each axis, `at_end` are the lanes where the point is at an end of the face, and
    /// `beyond` the lanes where its coordinate is positive.
    #[inline(always)]
    pub(super) fn has_position<S: Simd>(&self, at_end: &[M; 2], beyond: &[M; 2]) -> M
    where
        M: SimdMask<S>,
    {
        let [x, y] = [self.is_positive[0] ^ beyond[0], self.is_positive[1] ^ beyond[1]];
        (self.is_free[0] | (at_end[0] & !x & self.is_free[1]))
            & (self.is_free[1] | (at_end[1] & !y & self.is_free[0]))
    }

    /// Returns the lanes where the part is at the end of `axis` that `is_positive` selects. Valid
    /// only where the part does not extend along `axis`.
    #[inline(always)]
    fn is_at<S: Simd>(&self, axis: usize, is_positive: bool) -> M
    where
        M: SimdMask<S>,
    {
        if is_positive { self.is_positive[axis] } else { !self.is_positive[axis] }
    }
}
