//! Separating axis test of `L` pairs of boxes in 2D: `collide/separation/boxes/rectangle_axes.rs`
//! in lanes.

use super::super::{Boxes, is_finite};
use crate::math::lanes::{dot, either_mask, lit};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};

/// Direction of the largest gap of each pair.
pub(super) struct BestSide<V, M> {
    /// The side belongs to the second box.
    pub(super) is_second: M,
    /// It is perpendicular to the second axis of its box.
    pub(super) is_y: M,
    /// Unit vector from the first box to the second.
    pub(super) normal: [V; 2],
    /// Signed distance along the normal.
    pub(super) gap: V,
    /// Rounding error of lengths of the pair.
    pub(super) noise: V,
    /// The sum of all numbers of the pose is finite.
    pub(super) is_finite: M,
}

/// The side of one box with the larger gap.
struct AxisSide<V, M> {
    /// Signed distance along the best axis of the box.
    gap: V,
    /// It is the box's second axis.
    is_y: M,
    /// The other box is on the positive side of the axis.
    is_positive: M,
}

impl<V> Boxes<V, 2> {
    /// Rounding error of lengths of each pair.
    #[inline(always)]
    fn noise<S: Simd, N: Real>(&self, simd: S) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let (half1, half2, t) = (&self.half1, &self.half2, &self.translation);
        let farthest = t[1].abs().larger(t[0].abs());
        let size = (half1[0] + half1[1]) + (half2[0] + half2[1]) + farthest;
        lit::<S, N, V>(simd, 4.0) * V::all(simd, N::EPSILON) * size
    }

    /// Returns the direction of the largest gap, as `Rectangles::best_axis` does for one pair.
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
        let (noise, is_finite) = (self.noise(simd), is_finite(simd, self));
        BestSide { is_second, is_y, normal, gap, noise, is_finite }
    }

    /// Returns the best side of each box; of equal gaps the one that comes first in the box's
    /// outline.
    #[inline(always)]
    fn best_sides<S: Simd, N: Real, M>(&self, simd: S) -> (AxisSide<V, M>, AxisSide<V, M>)
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (r, t, zero) = (&self.rotation, &self.translation, V::all(simd, N::ZERO));
        let leans = [[r[0][0].abs(), r[0][1].abs()], [r[1][0].abs(), r[1][1].abs()]];
        let reach2: [V; 2] = filled(
            #[inline(always)]
            |i| dot(&[leans[0][i], leans[1][i]], &self.half2),
        );
        let gaps: [V; 2] = filled(
            #[inline(always)]
            |i| t[i].abs() - self.half1[i] - reach2[i],
        );
        let is = [t[0].simd_ge(zero), t[1].simd_gt(zero)];
        // Ties go by the outline: below, right, above, left. So x is first only for right and
        // above.
        let is_y = gaps[1].simd_gt(gaps[0]) | (gaps[1].simd_eq(gaps[0]) & !(is[0] & is[1]));
        let first = side(gaps, is_y, is);
        let seen = [dot(&r[0], t), dot(&r[1], t)];
        let gaps: [V; 2] = filled(
            #[inline(always)]
            |j| seen[j].abs() - self.half2[j] - dot(&leans[j], &self.half1),
        );
        let is = [seen[0].simd_gt(zero), seen[1].simd_ge(zero)];
        // The side of the second box is opposite to the normal: x is first only for left and below.
        let is_y = gaps[1].simd_gt(gaps[0]) | (gaps[1].simd_eq(gaps[0]) & (is[0] | is[1]));
        (first, side(gaps, is_y, is))
    }
}

/// Selects the side on the second axis where `is_y`.
#[inline(always)]
fn side<S: Simd, V: Wide<S, Mask = M>, M: SimdMask<S>>(
    gaps: [V; 2],
    is_y: M,
    is_positive: [M; 2],
) -> AxisSide<V, M> {
    let gap = is_y.select(gaps[1], gaps[0]);
    AxisSide { gap, is_y, is_positive: either_mask(is_y, is_positive[1], is_positive[0]) }
}
