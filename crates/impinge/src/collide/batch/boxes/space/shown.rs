//! Supporting feature on the most aligned face of a box, for `L` pairs, by the rule of
//! `SupportMap::core_feature`: the face, its nearest side, or its nearest corner.
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

/// A part of a face, by its two axes: the lanes where it extends along the axis, and, for the
/// others, those where it is at the positive end.
#[derive(Clone, Copy)]
pub(super) struct ShownFaces<M> {
    is_free: [M; 2],
    is_positive: [M; 2],
}

impl<M> ShownFaces<M> {
    /// Computes the feature from the components of a unit vector on the two axes of the face.
    /// `is_middle` are the lanes where the face's own axis is the second axis of the box; it breaks
    /// ties.
    #[inline(always)]
    pub(super) fn of<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>>(
        simd: S,
        is_middle: M,
        leans: [V; 2],
    ) -> Self
    where
        M: SimdMask<S>,
    {
        let (zero, limit) = (V::all(simd, N::ZERO), lit::<S, N, V>(simd, FACING_SINE_SQUARED));
        let squares = [leans[0] * leans[0], leans[1] * leans[1]];
        let is_all = Self::is_all(simd, leans);
        let [one, other] = [leans[0].abs(), leans[1].abs()];
        // The weaker tilt is free first; ties go by the order of the box's axes.
        let is_first_weaker = one.simd_lt(other) | (one.simd_eq(other) & !is_middle);
        Self {
            is_free: [
                is_all | (is_first_weaker & squares[0].simd_le(limit)),
                is_all | (!is_first_weaker & squares[1].simd_le(limit)),
            ],
            is_positive: [!leans[0].simd_lt(zero), !leans[1].simd_lt(zero)],
        }
    }

    /// Returns the lanes where a face with these components along it is not tilted too far.
    #[inline(always)]
    pub(super) fn is_all<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>>(
        simd: S,
        [u, v]: [V; 2],
    ) -> M {
        (u * u + v * v).simd_le(lit::<S, N, V>(simd, FACING_SINE_SQUARED))
    }

    /// Returns the lanes where the whole face is the feature.
    #[inline(always)]
    pub(super) fn is_whole<S: Simd>(&self) -> M
    where
        M: SimdMask<S>,
    {
        self.is_free[0] & self.is_free[1]
    }

    /// Returns the lanes where a corner, in the order of the slots, belongs to the feature.
    #[inline(always)]
    pub(super) fn has_corner<S: Simd>(&self, corner: usize) -> M
    where
        M: SimdMask<S>,
    {
        let [x, y] = SIGNS[corner];
        (self.is_free[0] | self.is_at(0, x)) & (self.is_free[1] | self.is_at(1, y))
    }

    /// Returns the lanes where the side at one end of an axis belongs to the feature.
    #[inline(always)]
    pub(super) fn has_side<S: Simd>(&self, axis: usize, is_positive: bool) -> M
    where
        M: SimdMask<S>,
    {
        self.is_free[1 - axis] & (self.is_free[axis] | self.is_at(axis, is_positive))
    }

    /// Returns the lanes where a point at some ends of the face (`at_end`), on their positive sides
    /// or not (`beyond`), belongs to the feature, if that is more than a corner.
    #[inline(always)]
    pub(super) fn has_place<S: Simd>(&self, at_end: &[M; 2], beyond: &[M; 2]) -> M
    where
        M: SimdMask<S>,
    {
        let [x, y] = [self.is_positive[0] ^ beyond[0], self.is_positive[1] ^ beyond[1]];
        (self.is_free[0] | (at_end[0] & !x & self.is_free[1]))
            & (self.is_free[1] | (at_end[1] & !y & self.is_free[0]))
    }

    /// Returns the lanes where the feature is at this end of an axis, if it does not extend along
    /// it.
    #[inline(always)]
    fn is_at<S: Simd>(&self, axis: usize, is_positive: bool) -> M
    where
        M: SimdMask<S>,
    {
        if is_positive { self.is_positive[axis] } else { !self.is_positive[axis] }
    }
}
