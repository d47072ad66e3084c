//! The candidates of some pairs, each in a slot of its own, and which of them count.

use crate::math::lanes::{bits, norm};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// The places of `L` pairs, and for each of them a bit of a mask.
pub(super) struct Slots<N: Real, const D: usize, const COUNT: usize, const L: usize> {
    /// Seen along the normal; in 2D the second coordinate is always zero.
    pub(super) flat: [[[N; L]; COUNT]; 2],
    /// Above the face or side below.
    pub(super) height: [[N; L]; COUNT],
    /// Of the candidates that count: the point on the first box, in its frame, and the distance.
    pub(super) points1: [[[N; L]; D]; COUNT],
    pub(super) distances: [[N; L]; COUNT],
    /// The lanes where the slot holds a candidate.
    pub(super) valid: [u8; COUNT],
    /// Those where its distance is the smallest but for rounding.
    pub(super) level: [u8; COUNT],
}

impl<N: Real, const D: usize, const COUNT: usize, const L: usize> Slots<N, D, COUNT, L> {
    pub(super) const fn new() -> Self {
        Self {
            flat: [[[N::ZERO; L]; COUNT]; 2],
            height: [[N::ZERO; L]; COUNT],
            points1: [[[N::ZERO; L]; D]; COUNT],
            distances: [[N::ZERO; L]; COUNT],
            valid: [0; COUNT],
            level: [0; COUNT],
        }
    }
}

/// What the candidates are held against.
#[derive(Clone, Copy)]
pub(super) struct Limits<V> {
    /// The distance that the axis says, which the lowest candidate must have.
    pub(super) gap: V,
    pub(super) prediction: V,
    /// Of the angle that the boxes may turn by.
    pub(super) sine: V,
    pub(super) tolerance: V,
}

/// The candidates of all pairs as they are found.
///
/// A candidate counts up to the prediction; beyond it, where turning brings it as near. The boxes turn about the
/// middle of the candidates that are lowest but for rounding:
///
/// ```text
///     other box     .-o   height <= prediction + sine * arm
///              .-'    |
///     pivot o---------'---- face
///           |<- arm ->|
/// ```
pub(super) struct Admission<V> {
    limits: Limits<V>,
    /// The lowest candidate so far.
    lowest: V,
    /// The largest distance that counts without turning, and the largest that is level with the gap.
    most: V,
    level: V,
    /// The sum of the places of the level candidates, and their number.
    sum: [V; 2],
    count: V,
}

impl<V> Admission<V> {
    #[inline(always)]
    pub(super) fn new<S: Simd, N: Real>(simd: S, limits: Limits<V>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, infinity) = (V::all(simd, N::ZERO), V::all(simd, N::INFINITY));
        let (most, level) = (limits.prediction + limits.tolerance, limits.gap + limits.tolerance);
        let level = limits.prediction.simd_le(level).select(most, level);
        Self { limits, lowest: infinity, most, level, sum: [zero; 2], count: zero }
    }

    /// Stores where a candidate is seen and its height, where there is one.
    #[inline(always)]
    pub(super) fn store<S: Simd, N: Real, M, const D: usize, const COUNT: usize, const L: usize>(
        &mut self,
        simd: S,
        slots: &mut Slots<N, D, COUNT, L>,
        slot: usize,
        flat: &[V; 2],
        height: V,
        is_there: M,
    ) where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        flat[0].store(&mut slots.flat[0][slot]);
        flat[1].store(&mut slots.flat[1][slot]);
        height.store(&mut slots.height[slot]);
        self.lowest = (is_there & height.simd_lt(self.lowest)).select(height, self.lowest);
        let is_level = is_there & !height.simd_gt(self.level);
        self.sum[0] += is_level.select(flat[0], zero);
        self.sum[1] += is_level.select(flat[1], zero);
        self.count += is_level.select(one, zero);
        slots.valid[slot] = bits(is_there);
        slots.level[slot] = bits(is_level);
    }

    /// The lanes where the lowest candidate has the gap for its height.
    #[inline(always)]
    pub(super) fn is_found<S: Simd, N: Real>(&self) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        (self.lowest - self.limits.gap).abs().simd_le(self.limits.tolerance)
    }

    /// Leaves the candidates that count. Says of these where they are, and how far: `place` gets where a candidate
    /// is seen and how high.
    #[inline(always)]
    pub(super) fn admit<S: Simd, N: Real, const D: usize, const COUNT: usize, const L: usize>(
        &self,
        simd: S,
        slots: &mut Slots<N, D, COUNT, L>,
        place: impl Fn([V; 2], V) -> [V; D],
    ) where
        V: Wide<S, Scalar = N>,
    {
        let Limits { gap, prediction, sine, .. } = self.limits;
        let pivot = [self.sum[0] / self.count, self.sum[1] / self.count];
        for slot in 0..COUNT {
            if slots.valid[slot] == 0 {
                continue;
            }
            let [x, y] = &slots.flat;
            let flat = [V::load(simd, &x[slot]), V::load(simd, &y[slot])];
            let height = V::load(simd, &slots.height[slot]);
            let arm = norm(&[flat[0] - pivot[0], flat[1] - pivot[1]]);
            // Written so that an angle that is NaN admits nothing more.
            let is_near = !height.simd_gt(self.most);
            let is_admitted = is_near | height.simd_le(prediction + sine * arm);
            slots.valid[slot] &= bits(is_admitted);
            if slots.valid[slot] == 0 {
                continue;
            }
            for (row, along) in slots.points1[slot].iter_mut().zip(place(flat, height)) {
                along.store(row);
            }
            // Distances are never less than the gap, and rounding makes none more than the prediction.
            let distance = height.larger(gap);
            let distance = is_near.select(distance.smaller(prediction), distance);
            distance.store(&mut slots.distances[slot]);
        }
    }
}
