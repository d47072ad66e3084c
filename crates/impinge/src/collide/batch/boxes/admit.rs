//! Contact candidates of `L` pairs, each candidate in its own slot, and the rule that admits them.
//!
//! ```text
//!                lane 0  lane 1  ...                     masks of a slot: one bit per lane
//!   slot 0       x       -       ...   flat, height      valid: the slot holds a candidate
//!   slot 1       -       x       ...   distances         level: its distance is the gap,
//!   ...                                points1                  up to rounding
//! ```

use crate::math::lanes::{bits, norm};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// The slots of `L` pairs, each with two masks over the lanes. A slot holds one possible contact
/// point (candidate) of each pair.
pub(super) struct Slots<N: Real, const D: usize, const COUNT: usize, const L: usize> {
    /// Coordinates on the reference face after projection along the normal; in 2D along the
    /// reference side, with the second always zero.
    pub(super) flat: [[[N; L]; COUNT]; 2],
    /// Height above the reference face or side, along the normal away from its box.
    pub(super) height: [[N; L]; COUNT],
    /// For admitted candidates: the point on the first box, in its frame.
    pub(super) points1: [[[N; L]; D]; COUNT],
    /// For admitted candidates: the signed distance, at least the gap.
    pub(super) distances: [[N; L]; COUNT],
    /// Lanes where the slot holds a candidate.
    pub(super) valid: [u8; COUNT],
    /// Lanes where the candidate's height is the gap, up to the tolerance.
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

/// Bounds that decide which candidates are admitted.
#[derive(Clone, Copy)]
pub(super) struct Limits<V> {
    /// Signed distance along the separating axis. If the supporting faces are chosen correctly, the
    /// lowest candidate has this height.
    pub(super) gap: V,
    pub(super) prediction: V,
    /// Sine of the angle by which the boxes may rotate.
    pub(super) sine: V,
    /// Largest length that counts as a rounding error.
    pub(super) tolerance: V,
}

/// The rule that admits candidates, and the sums that it needs, collected while the slots are
/// filled.
///
/// A candidate is admitted if its height is at most the prediction, up to the tolerance, or if a
/// rotation of the boxes by the angle of [`Limits::sine`] can bring it within the prediction. The
/// pivot of this rotation is the mean position of the level candidates: those whose height is the
/// gap, up to rounding.
///
/// ```text
///     other box     .-o   height <= prediction + sine * arm
///              .-'    |
///     pivot o---------'---- face
///           |<- arm ->|
/// ```
pub(super) struct Admission<V> {
    limits: Limits<V>,
    /// Smallest height of a candidate so far; infinite without a candidate.
    lowest: V,
    /// Largest height admitted without rotation: the prediction plus the tolerance.
    most: V,
    /// Largest height that counts as level with the gap.
    level: V,
    /// Sum of the coordinates `flat` of the level candidates.
    sum: [V; 2],
    /// Number of level candidates, as a value of the scalar type.
    count: V,
}

impl<V> Admission<V> {
    /// Returns the state before the first candidate.
    #[inline(always)]
    pub(super) fn new<S: Simd, N: Real>(simd: S, limits: Limits<V>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, infinity) = (V::all(simd, N::ZERO), V::all(simd, N::INFINITY));
        let (most, level) = (limits.prediction + limits.tolerance, limits.gap + limits.tolerance);
        // If the gap is within the tolerance of the prediction, all candidates admitted without
        // rotation are level.
        let level = limits.prediction.simd_le(level).select(most, level);
        Self { limits, lowest: infinity, most, level, sum: [zero; 2], count: zero }
    }

    /// Stores coordinates and height of a candidate in a slot. `is_there` are the lanes that have
    /// the candidate.
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

    /// Returns the lanes where the lowest candidate has the height `gap`, up to the tolerance.
    #[inline(always)]
    pub(super) fn is_found<S: Simd, N: Real>(&self) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        (self.lowest - self.limits.gap).abs().simd_le(self.limits.tolerance)
    }

    /// Clears the bits of `valid` whose candidates are not admitted, and computes `points1` and
    /// `distances` of the others. `point1` maps coordinates and height to the point on the first
    /// box.
    #[inline(always)]
    pub(super) fn admit<S: Simd, N: Real, const D: usize, const COUNT: usize, const L: usize>(
        &self,
        simd: S,
        slots: &mut Slots<N, D, COUNT, L>,
        point1: impl Fn([V; 2], V) -> [V; D],
    ) where
        V: Wide<S, Scalar = N>,
    {
        let Limits { gap, prediction, sine, .. } = self.limits;
        // NaN in lanes without a level candidate, where a rotation admits nothing.
        let pivot = [self.sum[0] / self.count, self.sum[1] / self.count];
        for slot in 0..COUNT {
            if slots.valid[slot] == 0 {
                continue;
            }
            let [x, y] = &slots.flat;
            let flat = [V::load(simd, &x[slot]), V::load(simd, &y[slot])];
            let height = V::load(simd, &slots.height[slot]);
            let arm = norm(&[flat[0] - pivot[0], flat[1] - pivot[1]]);
            // If `sine` is NaN, the comparison is false and the rotation admits no further
            // candidate.
            let is_near = !height.simd_gt(self.most);
            let is_admitted = is_near | height.simd_le(prediction + sine * arm);
            slots.valid[slot] &= bits(is_admitted);
            if slots.valid[slot] == 0 {
                continue;
            }
            for (row, along) in slots.points1[slot].iter_mut().zip(point1(flat, height)) {
                along.store(row);
            }
            // Rounding must not put a distance below the gap, nor a near candidate beyond the
            // prediction.
            let distance = height.larger(gap);
            let distance = is_near.select(distance.smaller(prediction), distance);
            distance.store(&mut slots.distances[slot]);
        }
    }
}
