//! The supporting feature on the most aligned face of a box, of eight pairs, by the rule of
//! `SupportMap::core_feature`: the face, its nearest side, or its nearest corner.

use super::clip::SIGNS;
use crate::math::lanes::lit;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};
use crate::shape::FACING_SINE_SQUARED;

/// The part of a face: by its axes, the lanes where it ranges along the axis, and those where the end
/// that it is confined to elsewhere is on the positive side.
#[derive(Clone, Copy)]
pub(super) struct ShownFaces<M> {
    is_free: [M; 2],
    is_positive: [M; 2],
}

impl<M> ShownFaces<M> {
    /// By the components of a unit vector on the axes after that of the face; `is_middle` are the lanes
    /// where that is the second axis of the box.
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
        let is_first_weaker = one.simd_lt(other) | (one.simd_eq(other) & !is_middle);
        Self {
            is_free: [
                is_all | (is_first_weaker & squares[0].simd_le(limit)),
                is_all | (!is_first_weaker & squares[1].simd_le(limit)),
            ],
            is_positive: [!leans[0].simd_lt(zero), !leans[1].simd_lt(zero)],
        }
    }

    /// The face does not lean too far: by the components along it.
    #[inline(always)]
    pub(super) fn is_all<S: Simd, N: Real, V: Wide<S, Scalar = N, Mask = M>>(
        simd: S,
        [u, v]: [V; 2],
    ) -> M {
        (u * u + v * v).simd_le(lit::<S, N, V>(simd, FACING_SINE_SQUARED))
    }

    /// All of the face is part of it.
    #[inline(always)]
    pub(super) fn is_whole<S: Simd>(&self) -> M
    where
        M: SimdMask<S>,
    {
        self.is_free[0] & self.is_free[1]
    }

    /// Of the corners that have a place among the slots, which are part of it.
    #[inline(always)]
    pub(super) fn has_corner<S: Simd>(&self, corner: usize) -> M
    where
        M: SimdMask<S>,
    {
        let [x, y] = SIGNS[corner];
        (self.is_free[0] | self.is_at(0, x)) & (self.is_free[1] | self.is_at(1, y))
    }

    /// The side at one end of an axis is part of it.
    #[inline(always)]
    pub(super) fn has_side<S: Simd>(&self, axis: usize, is_positive: bool) -> M
    where
        M: SimdMask<S>,
    {
        self.is_free[1 - axis] & (self.is_free[axis] | self.is_at(axis, is_positive))
    }

    /// Where more than a corner is shown: a place that is at an end of some axes, on positive sides or
    /// not, is part of it.
    #[inline(always)]
    pub(super) fn has_place<S: Simd>(&self, at_end: &[M; 2], beyond: &[M; 2]) -> M
    where
        M: SimdMask<S>,
    {
        let [x, y] = [self.is_positive[0] ^ beyond[0], self.is_positive[1] ^ beyond[1]];
        (self.is_free[0] | (at_end[0] & !x & self.is_free[1]))
            & (self.is_free[1] | (at_end[1] & !y & self.is_free[0]))
    }

    #[inline(always)]
    fn is_at<S: Simd>(&self, axis: usize, is_positive: bool) -> M
    where
        M: SimdMask<S>,
    {
        if is_positive { self.is_positive[axis] } else { !self.is_positive[axis] }
    }
}
