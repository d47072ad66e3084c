//! The reference side and the incident side of `L` pairs, and the ends of their overlap.
//!
//! The lower side (the reference side) is perpendicular to the separating axis; it is an interval
//! along an axis of its own box. The upper side (the incident side) is the side of the other box
//! most aligned with the lower side; it may be tilted. The contact points are the ends of their
//! overlap interval. If the tilt exceeds atan(1/2) ≈ 26.6° ("tilted too far"), only the lower end
//! of the upper side is used: the corner that faces the other box.
//!
//! ```text
//!      height |    *-- ends[1]               coordinate: along the lower side, zero in its middle;
//!             | .-'                                      from -half to half
//!    ends[0]  *'                             height: above the lower side
//!      -half ===================== half
//!                coordinate ->
//! ```

use super::super::admit::{Admission, Slots};
use super::super::{Boxes, other, tolerance};
use super::SLOTS;
use super::axis::BestSide;
use crate::math::lanes::{bits, dot, either, lit};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};
use crate::shape::FACING_SINE_SQUARED;

/// The lower side of each pair, and the upper side in the frame of the lower side's box.
pub(super) struct BoxSides<V, M> {
    /// Lanes where the lower side is perpendicular to the y axis of its box.
    pub(super) is_y: M,
    /// Lanes where the lower side is at the positive end of the axis that it is perpendicular to.
    pub(super) is_upward: M,
    /// Coordinate of the lower side along the axis perpendicular to it.
    level: V,
    /// Half the length of the lower side.
    half: V,
    /// Lanes where the upper side is perpendicular to the y axis of its own box.
    pub(super) is_own_y: M,
    /// Lanes where the upper side is at the positive end of the axis that it is perpendicular to.
    pub(super) is_positive: M,
    /// Lanes where the end of the upper side with the smaller `coordinate` is at the positive end,
    /// in the frame of the upper box.
    pub(super) is_reversed: M,
    /// Ends of the upper side, in the order of their coordinates along the lower side.
    ends: [End<V>; 2],
    /// Length of the upper side, projected onto the lower side.
    length: V,
    /// Lanes where the upper side is tilted too far. There only its lower end is used.
    is_corner: M,
    /// Lanes where `ends[1]`, not `ends[0]`, faces the lower box.
    is_second_lower: M,
    /// Largest length that counts as a rounding error.
    pub(super) tolerance: V,
    /// Lanes where neither side is too short: both exceed 8 tolerances along the lower side.
    pub(super) is_fit: M,
}

/// A point, in coordinates of the lower side.
#[derive(Clone, Copy)]
struct End<V> {
    /// Coordinate along the lower side, zero at its middle.
    coordinate: V,
    /// Height above the lower side, outward from its box.
    height: V,
}

/// An end of one side, compared with the interval of the other side.
struct SideCandidate<V, M> {
    end: End<V>,
    /// Lanes where `end` is within the other side's interval, or outside by at most twice the
    /// tolerance.
    is_inside: M,
    /// Lanes where `end` is at or beyond the first end of the other side, and at or beyond the
    /// second, up to the tolerance.
    at_end: [M; 2],
}

/// Selects the y coordinate in the lanes of `is_y`, else the x coordinate.
#[inline(always)]
fn on<S: Simd, V: Wide<S>>(is_y: V::Mask, v: &[V; 2]) -> V {
    is_y.select(v[1], v[0])
}

impl<V, M> BoxSides<V, M> {
    /// Finds the lower side from the separating axis, and the upper side above it.
    #[inline(always)]
    pub(super) fn of_axis<S: Simd, N: Real>(
        simd: S,
        boxes: &Boxes<V, 2>,
        axis: &BestSide<V, M>,
    ) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (zero, is_y) = (V::all(simd, N::ZERO), axis.is_y);
        let own = filled(
            #[inline(always)]
            |i| is_y.select(boxes.rotation[1][i], boxes.rotation[0][i]),
        );
        let outward = axis.is_second.select(-dot(&own, &axis.normal), on(is_y, &axis.normal));
        let is_upward = !outward.simd_lt(zero);
        let half = either(axis.is_second, &boxes.half2, &boxes.half1);
        let level = on(is_y, &half);
        let level = is_upward.select(level, -level);
        let upper = Upper::facing(simd, boxes, axis, is_upward, level);
        let half = is_y.select(half[0], half[1]);
        let (tolerance, length) =
            (tolerance(simd, boxes), upper.ends[1].coordinate - upper.ends[0].coordinate);
        let shortest = (half + half).smaller(length);
        let is_long = shortest.simd_gt(lit::<S, N, V>(simd, 8.0) * tolerance);
        Self {
            is_y,
            is_upward,
            level,
            half,
            is_own_y: upper.is_own_y,
            is_positive: upper.is_positive,
            is_reversed: upper.is_reversed,
            ends: upper.ends,
            length,
            is_corner: !upper.is_aligned,
            is_second_lower: upper.is_second_lower,
            tolerance,
            is_fit: is_long,
        }
    }

    /// Fills the slots with the ends of the overlap interval, or only with the lower end of the
    /// upper side where that side is tilted too far. Returns two masks for each slot: the `at_end`
    /// of its [`SideCandidate`].
    #[inline(always)]
    pub(super) fn share<S: Simd, N: Real, const L: usize>(
        &self,
        simd: S,
        admission: &mut Admission<V>,
        slots: &mut Slots<N, 2, SLOTS, L>,
    ) -> [u8; 2 * SLOTS]
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let mut above = [self.above(simd, 0), self.above(simd, 1)];
        above[0].is_inside &= !self.is_corner | !self.is_second_lower;
        above[1].is_inside &= !self.is_corner | self.is_second_lower;
        let mut below = [self.below(simd, -self.half), self.below(simd, self.half)];
        // Where ends of both sides coincide, the slot of the upper end holds the candidate.
        for (end, found) in below.iter_mut().enumerate() {
            found.is_inside &= !self.is_corner;
            for (other, known) in above.iter().enumerate() {
                let is_same = found.at_end[other] & known.at_end[end] & known.is_inside;
                found.is_inside &= !is_same;
            }
        }
        let (mut at_ends, [near, far], [low, high]) = ([0; 2 * SLOTS], &above, &below);
        for (slot, found) in [near, far, low, high].into_iter().enumerate() {
            let flat = [found.end.coordinate, V::all(simd, N::ZERO)];
            admission.store(simd, slots, slot, &flat, found.end.height, found.is_inside);
            at_ends[2 * slot] = bits(found.at_end[0]);
            at_ends[2 * slot + 1] = bits(found.at_end[1]);
        }
        at_ends
    }

    /// Returns the point on the first box, in that box's frame, for a `coordinate` along the lower
    /// side and a `height` above it. If the lower side belongs to the second box (`is_second`), the
    /// point lies on the upper side, at `height`, and is transformed with the rounding of
    /// `Pose::point`.
    #[inline(always)]
    pub(super) fn point1<S: Simd, N: Real>(
        &self,
        simd: S,
        boxes: &Boxes<V, 2>,
        is_second: M,
        coordinate: V,
        height: V,
    ) -> [V; 2]
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let rise = self.is_upward.select(height, -height);
        let level = self.level + is_second.select(rise, V::all(simd, N::ZERO));
        let own = [self.is_y.select(coordinate, level), self.is_y.select(level, coordinate)];
        let ([x, y], shift) = (&boxes.rotation, &boxes.translation);
        filled(
            #[inline(always)]
            |axis| {
                let there = x[axis] * own[0] + y[axis] * own[1] + shift[axis];
                is_second.select(there, own[axis])
            },
        )
    }

    /// Compares one end of the upper side, `ends[end]`, with the lower side.
    #[inline(always)]
    fn above<S: Simd, N: Real>(&self, simd: S, end: usize) -> SideCandidate<V, M>
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let end = self.ends[end];
        self.beside(simd, end, end.coordinate + self.half, self.half + self.half)
    }

    /// Compares the point of the lower side at `coordinate` with the upper side.
    #[inline(always)]
    fn below<S: Simd, N: Real>(&self, simd: S, coordinate: V) -> SideCandidate<V, M>
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let along = coordinate - self.ends[0].coordinate;
        let share = (along / self.length).larger(zero).smaller(one);
        let (low, high) = (self.ends[0].height, self.ends[1].height);
        let height = low + (high - low) * share;
        self.beside(simd, End { coordinate, height }, along, self.length)
    }

    /// Compares a point with a side of length `length`; `along` is the point's coordinate along
    /// this side, measured from its first end.
    #[inline(always)]
    fn beside<S: Simd, N: Real>(
        &self,
        simd: S,
        end: End<V>,
        along: V,
        length: V,
    ) -> SideCandidate<V, M>
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let slack = V::all(simd, N::TWO) * self.tolerance;
        let is_inside = !(along.simd_lt(-slack) | along.simd_gt(length + slack));
        let at_second = along.simd_ge(length - self.tolerance);
        let at_first = along.simd_le(self.tolerance) & !at_second;
        SideCandidate { end, is_inside, at_end: [at_first, at_second] }
    }
}

/// The upper side: the side of the other box that is most aligned with the lower side. Fields named
/// as those of [`BoxSides`] have the same meaning; `is_aligned` is the negation of
/// `BoxSides::is_corner`.
struct Upper<V, M> {
    is_own_y: M,
    is_positive: M,
    is_reversed: M,
    ends: [End<V>; 2],
    is_second_lower: M,
    is_aligned: M,
}

impl<V, M> Upper<V, M> {
    /// Finds the upper side. `level` is the coordinate of the lower side along the axis
    /// perpendicular to it; `is_upward` are the lanes where the lower side is at the positive end
    /// of that axis.
    #[inline(always)]
    fn facing<S: Simd, N: Real>(
        simd: S,
        boxes: &Boxes<V, 2>,
        axis: &BestSide<V, M>,
        is_upward: M,
        level: V,
    ) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (rotation, shift) = other(boxes, axis.is_second);
        let facing: [V; 2] = filled(
            #[inline(always)]
            |j| {
                let along = on(axis.is_y, &rotation[j]);
                is_upward.select(-along, along)
            },
        );
        let is_own_y = facing[1].abs().simd_gt(facing[0].abs());
        let (across, sine) = (on(is_own_y, &facing), is_own_y.select(facing[0], facing[1]));
        // Within this tilt, `SupportMap::core_feature` also returns the whole side.
        let is_aligned = (sine * sine).simd_le(lit::<S, N, V>(simd, FACING_SINE_SQUARED));
        let zero = V::all(simd, N::ZERO);
        let is_positive = across.simd_gt(zero);
        let half = either(axis.is_second, &boxes.half1, &boxes.half2);
        let out = on(is_own_y, &half);
        let out = is_positive.select(out, -out);
        let side = is_own_y.select(half[0], half[1]);
        let [near, far]: [End<V>; 2] = filled(
            #[inline(always)]
            |end| {
                let side = if end == 0 { -side } else { side };
                let point = filled(
                    #[inline(always)]
                    |i| {
                        let own = is_own_y.select(rotation[1][i], rotation[0][i]);
                        let next = is_own_y.select(rotation[0][i], rotation[1][i]);
                        own * out + next * side + shift[i]
                    },
                );
                let height = on(axis.is_y, &point) - level;
                let coordinate = axis.is_y.select(point[0], point[1]);
                End { coordinate, height: is_upward.select(height, -height) }
            },
        );
        let is_reversed = far.coordinate.simd_lt(near.coordinate);
        let ends = [in_order(is_reversed, far, near), in_order(is_reversed, near, far)];
        // The sign of `sine` gives the lower end in the order of the box; where the ends are
        // swapped, it gives the other end.
        let is_second_lower = is_reversed ^ !sine.simd_lt(zero);
        Self { is_own_y, is_positive, is_reversed, ends, is_second_lower, is_aligned }
    }
}

#[inline(always)]
fn in_order<S: Simd, V: Wide<S>>(is: V::Mask, one: End<V>, other: End<V>) -> End<V> {
    End {
        coordinate: is.select(one.coordinate, other.coordinate),
        height: is.select(one.height, other.height),
    }
}
