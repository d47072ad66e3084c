//! Separating axis test of `L` pairs of boxes in 2D, as in
//! `collide/separation/boxes/rectangle_axes.rs`.

use super::super::{Boxes, is_finite};
use crate::math::lanes::{dot, either_mask, lit};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};

/// Separating axis of each pair, perpendicular to one side of a box, and the gap along it.
pub(super) struct BestSide<V, M> {
    /// Lanes where the side belongs to the second box.
    pub(super) is_second: M,
    /// Lanes where the side is perpendicular to the y axis of its box, else to the x axis.
    pub(super) is_y: M,
    /// Unit vector from the first box to the second, in the frame of the first.
    pub(super) normal: [V; 2],
    /// Signed distance along the normal; negative for an overlap.
    pub(super) gap: V,
    /// Length up to which differences count as rounding errors, for each pair.
    pub(super) rounding_error: V,
    /// Lanes where the pose is finite.
    pub(super) is_finite: M,
}

/// Axis of one box along which the gap is largest.
struct AxisSide<V, M> {
    /// Signed distance along the axis; negative for an overlap.
    gap: V,
    /// Lanes where the axis is the y axis of the box, else the x axis.
    is_y: M,
    /// Lanes where the normal from the first box to the second points in the positive direction of
    /// the axis, else in the negative direction.
    is_positive: M,
}

impl<V> Boxes<V, 2> {
    /// Returns for each pair the length up to which differences count as rounding errors.
    #[inline(always)]
    fn rounding_error<S: Simd, N: Real>(&self, simd: S) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let (half1, half2, t) = (&self.half1, &self.half2, &self.translation);
        let farthest = t[1].abs().larger(t[0].abs());
        let size = (half1[0] + half1[1]) + (half2[0] + half2[1]) + farthest;
        lit::<S, N, V>(simd, 4.0) * V::all(simd, N::EPSILON) * size
    }

    /// Returns the axis with the largest gap, bit-identical to `Rectangles::best_axis`.
    #[inline(always)]
    pub(super) fn best_side<S: Simd, N: Real, M>(&self, simd: S) -> BestSide<V, M>
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let (first, second) = self.best_sides(simd);
        let is_second = !second.gap.simd_le(first.gap);
        let is_y = either_mask(is_second, second.is_y, first.is_y);
        let is_positive = either_mask(is_second, second.is_positive, first.is_positive);
        let unit = [is_y.select(zero, one), is_y.select(one, zero)];
        let normal = filled(
            #[inline(always)]
            |axis| {
                let own = is_y.select(self.rotation[1][axis], self.rotation[0][axis]);
                let along = is_second.select(own, unit[axis]);
                is_positive.select(along, -along)
            },
        );
        let gap = is_second.select(second.gap, first.gap);
        let (rounding_error, is_finite) = (self.rounding_error(simd), is_finite(simd, self));
        BestSide { is_second, is_y, normal, gap, rounding_error, is_finite }
    }

    /// Returns for each box its axis with the largest gap. In a tie, the side that comes first in
    /// the box's outline wins.
    #[inline(always)]
    fn best_sides<S: Simd, N: Real, M>(&self, simd: S) -> (AxisSide<V, M>, AxisSide<V, M>)
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (r, t, zero) = (&self.rotation, &self.translation, V::all(simd, N::ZERO));
        let abs_rotation = [[r[0][0].abs(), r[0][1].abs()], [r[1][0].abs(), r[1][1].abs()]];
        let extent2: [V; 2] = filled(
            #[inline(always)]
            |i| dot(&[abs_rotation[0][i], abs_rotation[1][i]], &self.half2),
        );
        let gaps: [V; 2] = filled(
            #[inline(always)]
            |i| t[i].abs() - self.half1[i] - extent2[i],
        );
        let is = [t[0].simd_ge(zero), t[1].simd_gt(zero)];
        // Ties are resolved by the order of the sides in the outline: bottom, right, top, left. So
        // x wins a tie only if its side is the right one and the side of y is the top.
        let is_y = gaps[1].simd_gt(gaps[0]) | (gaps[1].simd_eq(gaps[0]) & !(is[0] & is[1]));
        let first = side(gaps, is_y, is);
        let offset2 = [dot(&r[0], t), dot(&r[1], t)];
        let gaps: [V; 2] = filled(
            #[inline(always)]
            |j| offset2[j].abs() - self.half2[j] - dot(&abs_rotation[j], &self.half1),
        );
        let is = [offset2[0].simd_gt(zero), offset2[1].simd_ge(zero)];
        // The side of the second box faces against the normal. So x wins a tie only if both signs
        // are negative: its side is the right one and the side of y is the top.
        let is_y = gaps[1].simd_gt(gaps[0]) | (gaps[1].simd_eq(gaps[0]) & (is[0] | is[1]));
        (first, side(gaps, is_y, is))
    }
}

/// Selects the gap and sign of the y axis in the lanes of `is_y`, else of the x axis.
#[inline(always)]
fn side<S: Simd, V: Wide<S, Mask = M>, M: SimdMask<S>>(
    gaps: [V; 2],
    is_y: M,
    is_positive: [M; 2],
) -> AxisSide<V, M> {
    let gap = is_y.select(gaps[1], gaps[0]);
    AxisSide { gap, is_y, is_positive: either_mask(is_y, is_positive[1], is_positive[0]) }
}
