//! The candidates of eight pairs, each in a slot of its own, and which of them count.

use super::LANES;
use super::masks::bits;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// The places of eight pairs, and for each of them a bit of a mask.
pub(super) struct Slots<N: Real, const D: usize, const COUNT: usize> {
    /// Seen along the normal; in the plane the second coordinate is always zero.
    pub(super) flat: [[[N; LANES]; COUNT]; 2],
    /// Above the face or side below.
    pub(super) height: [[N; LANES]; COUNT],
    /// What is said of a candidate: on the first box, in its frame; no nearer than the gap, and no
    /// farther than the prediction.
    pub(super) points1: [[[N; LANES]; D]; COUNT],
    pub(super) distances: [[N; LANES]; COUNT],
    /// The lanes where the slot holds a candidate.
    pub(super) valid: [u8; COUNT],
    /// Those where its distance is the smallest but for rounding.
    pub(super) level: [u8; COUNT],
}

impl<N: Real, const D: usize, const COUNT: usize> Slots<N, D, COUNT> {
    pub(super) const fn new() -> Self {
        Self {
            flat: [[[N::ZERO; LANES]; COUNT]; 2],
            height: [[N::ZERO; LANES]; COUNT],
            points1: [[[N::ZERO; LANES]; D]; COUNT],
            distances: [[N::ZERO; LANES]; COUNT],
            valid: [0; COUNT],
            level: [0; COUNT],
        }
    }

    /// Says of all candidates where they are, and how far: `place` is told where a candidate is seen
    /// and how high.
    #[inline(always)]
    pub(super) fn place<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        limits: &Limits<V>,
        place: impl Fn([V; 2], V) -> [V; D],
    ) {
        for slot in 0..COUNT {
            if self.valid[slot] == 0 {
                continue;
            }
            let [x, y] = &self.flat;
            let flat = [V::load(simd, &x[slot]), V::load(simd, &y[slot])];
            let height = V::load(simd, &self.height[slot]);
            for (row, along) in self.points1[slot].iter_mut().zip(place(flat, height)) {
                along.store(row);
            }
            let distance = height.larger(limits.gap).smaller(limits.prediction);
            distance.store(&mut self.distances[slot]);
        }
    }
}

/// What the candidates are held against.
pub(super) struct Limits<V> {
    /// The distance that the axis says, which the lowest candidate must have.
    pub(super) gap: V,
    pub(super) prediction: V,
    pub(super) tolerance: V,
}

/// The candidates of eight pairs as they are found.
pub(super) struct Admission<V> {
    gap: V,
    tolerance: V,
    /// The lowest candidate so far.
    lowest: V,
    /// The largest distance that is admitted, and the largest that is level with the gap.
    most: V,
    level: V,
}

impl<V> Admission<V> {
    #[inline(always)]
    pub(super) fn new<S: Simd, N: Real>(simd: S, limits: &Limits<V>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let Limits { gap, prediction, tolerance } = *limits;
        let infinity = V::all(simd, N::INFINITY);
        let (most, level) = (prediction + tolerance, gap + tolerance);
        let level = prediction.simd_le(level).select(infinity, level);
        Self { gap, tolerance, lowest: infinity, most, level }
    }

    /// Stores the height of a candidate where there is one and the prediction admits it.
    #[inline(always)]
    pub(super) fn admit<S: Simd, N: Real, M, const D: usize, const COUNT: usize>(
        &mut self,
        slots: &mut Slots<N, D, COUNT>,
        slot: usize,
        height: V,
        is_there: M,
    ) where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        height.store(&mut slots.height[slot]);
        self.lowest = (is_there & height.simd_lt(self.lowest)).select(height, self.lowest);
        // Distances are never less than the gap nor more than the prediction: both pass anyway.
        let is_admitted = is_there & !height.simd_gt(self.most);
        slots.valid[slot] = bits(is_admitted);
        slots.level[slot] = bits(is_admitted & !height.simd_gt(self.level));
    }

    /// The lanes where the lowest candidate has the gap for its height.
    #[inline(always)]
    pub(super) fn is_found<S: Simd, N: Real>(&self) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        (self.lowest - self.gap).abs().simd_le(self.tolerance)
    }
}
