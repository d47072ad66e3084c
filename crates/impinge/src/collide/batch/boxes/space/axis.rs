//! Separating axis test of `L` pairs of boxes in 3D, as in
//! `collide/separation/boxes/cuboid_axes.rs`.

use super::super::{Boxes, is_finite};
use crate::math::lanes::{dot, lit};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, filled};

/// Separating axis of each pair, perpendicular to a face or to two edges, and the gap along it.
pub(super) struct BestAxis<V, M> {
    /// Index of the axis that the best face is perpendicular to, as a value of the scalar type.
    pub(super) face: V,
    /// Lanes where the separating axis is perpendicular to a face of the second box.
    pub(super) is_second: M,
    /// Lanes where the separating axis is perpendicular to two edges, one of each box.
    pub(super) is_edges: M,
    /// Unit vector from the first box to the second, in the frame of the first.
    pub(super) normal: [V; 3],
    /// Signed distance along the normal; negative for an overlap.
    pub(super) gap: V,
    /// Length up to which differences count as rounding errors, for each pair.
    pub(super) rounding_error: V,
    /// Lanes where the pose is finite.
    pub(super) is_finite: M,
}

/// Selects in each lane the vector `three[k]` for which `is[k]` is set; the last if neither `is[0]`
/// nor `is[1]` is.
#[inline(always)]
pub(super) fn of_three<S: Simd, V: Wide<S>>(is: &[V::Mask; 3], three: [&[V; 3]; 3]) -> [V; 3] {
    filled(
        #[inline(always)]
        |axis| is[0].select(three[0][axis], is[1].select(three[1][axis], three[2][axis])),
    )
}

/// Returns the lanes where `number` is 0, those where it is 1, and those where it is 2.
#[inline(always)]
pub(super) fn which<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, number: V) -> [V::Mask; 3] {
    [
        number.simd_eq(V::all(simd, N::ZERO)),
        number.simd_eq(V::all(simd, N::ONE)),
        number.simd_eq(V::all(simd, N::TWO)),
    ]
}

/// Returns the absolute values of the entries of a rotation.
#[inline(always)]
fn abs_rotation<S: Simd, V: Wide<S>>(rotation: &[[V; 3]; 3]) -> [[V; 3]; 3] {
    filled(
        #[inline(always)]
        |j| [rotation[j][0].abs(), rotation[j][1].abs(), rotation[j][2].abs()],
    )
}

impl<V> Boxes<V, 3> {
    /// Returns for each pair the length up to which differences count as rounding errors.
    #[inline(always)]
    fn rounding_error<S: Simd, N: Real>(&self, simd: S) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let (half1, half2, t) = (&self.half1, &self.half2, &self.translation);
        let sizes = (half1[0] + half1[1] + half1[2]) + (half2[0] + half2[1] + half2[2]);
        let farthest = t[2].abs().larger(t[1].abs().larger(t[0].abs()));
        lit::<S, N, V>(simd, 4.0) * V::all(simd, N::EPSILON) * (sizes + farthest)
    }

    /// Returns the axis with the largest gap, bit-identical to `BoxPair::best_axis`.
    #[inline(always)]
    pub(super) fn best_axis<S: Simd, N: Real>(&self, simd: S) -> BestAxis<V, V::Mask>
    where
        V: Wide<S, Scalar = N>,
    {
        let abs_rotation = abs_rotation(&self.rotation);
        let (face, is_second, gap) = self.best_face(simd, &abs_rotation);
        let rounding_error = self.rounding_error(simd);
        let (edges, bound) =
            self.best_edges(simd, &abs_rotation, (gap + rounding_error).larger(gap));
        // Both indices in `edges` are -1 if no pair of edges has a gap that exceeds the best face's
        // gap by more than the rounding error.
        let is_edges = V::all(simd, N::ZERO).simd_le(edges[0]);
        let is_second = is_second & !is_edges;
        let ends = [is_edges.select(edges[0], face), is_edges.select(edges[1], face)];
        let normal = self.direction(simd, ends, (is_second, is_edges));
        let is_finite = is_finite(simd, self);
        let gap = is_edges.select(bound, gap);
        BestAxis { face, is_second, is_edges, normal, gap, rounding_error, is_finite }
    }

    /// Returns the face with the largest gap (the first one in a tie): the index of its axis, the
    /// lanes where the face belongs to the second box, and the gap.
    #[inline(always)]
    fn best_face<S: Simd, N: Real>(&self, simd: S, abs_rotation: &[[V; 3]; 3]) -> (V, V::Mask, V)
    where
        V: Wide<S, Scalar = N>,
    {
        let (t, number) = (&self.translation, [N::ZERO, N::ONE, N::TWO]);
        let (mut best, mut gap) = (V::all(simd, N::ZERO), V::all(simd, N::ZERO));
        for i in 0..3 {
            let row = [abs_rotation[0][i], abs_rotation[1][i], abs_rotation[2][i]];
            let found = t[i].abs() - self.half1[i] - dot(&row, &self.half2);
            let is_better = found.simd_gt(gap);
            best = is_better.select(V::all(simd, number[i]), best);
            gap = if i == 0 { found } else { is_better.select(found, gap) };
        }
        let mut is_second = V::all(simd, N::ONE).simd_lt(V::all(simd, N::ZERO));
        for j in 0..3 {
            let along = dot(&self.rotation[j], t);
            let found = along.abs() - dot(&abs_rotation[j], &self.half1) - self.half2[j];
            let is_better = found.simd_gt(gap);
            best = is_better.select(V::all(simd, number[j]), best);
            gap = is_better.select(found, gap);
            is_second |= is_better;
        }
        (best, is_second, gap)
    }

    /// Returns the pair of edges with the largest gap, if this gap exceeds `bound`: the index of
    /// the edge's axis in each box, and the gap. Both indices are -1 if no pair exceeds `bound`.
    #[inline(always)]
    fn best_edges<S: Simd, N: Real>(
        &self,
        simd: S,
        abs_rotation: &[[V; 3]; 3],
        mut bound: V,
    ) -> ([V; 2], V)
    where
        V: Wide<S, Scalar = N>,
    {
        let (r, t, zero) = (&self.rotation, &self.translation, V::all(simd, N::ZERO));
        let least = lit::<S, N, V>(simd, 16.0) * V::all(simd, N::EPSILON);
        let number = [N::ZERO, N::ONE, N::TWO];
        let mut best = [V::all(simd, -N::ONE); 2];
        for i in 0..3 {
            let (i1, i2) = ((i + 1) % 3, (i + 2) % 3);
            for j in 0..3 {
                let (j1, j2) = ((j + 1) % 3, (j + 2) % 3);
                let along = t[i2] * r[j][i1] - t[i1] * r[j][i2];
                let extent1 =
                    self.half1[i1] * abs_rotation[j][i2] + self.half1[i2] * abs_rotation[j][i1];
                // Components of the cross product on the other axes of the second box; see
                // `BoxPair::best_edges`.
                let product1 = (r[j][i1] * r[j1][i2] - r[j][i2] * r[j1][i1]).abs();
                let product2 = (r[j][i1] * r[j2][i2] - r[j][i2] * r[j2][i1]).abs();
                let extent2 = self.half2[j1] * product1 + self.half2[j2] * product2;
                let slack = along.abs() - extent1 - extent2;
                let sine = (r[j][i1] * r[j][i1] + r[j][i2] * r[j][i2]).sqrt();
                let is_better = !slack.simd_le(bound.smaller(zero))
                    & sine.simd_gt(least)
                    & slack.simd_gt(bound * sine);
                best[0] = is_better.select(V::all(simd, number[i]), best[0]);
                best[1] = is_better.select(V::all(simd, number[j]), best[1]);
                bound = is_better.select(slack / sine, bound);
            }
        }
        (best, bound)
    }

    /// Returns the unit vector perpendicular to a face or to a pair of edges, pointing from the
    /// first box to the second, in the frame of the first. `ends` are the indices of the axes of
    /// both edges, or the index of the face's axis twice.
    #[inline(always)]
    fn direction<S: Simd, N: Real>(
        &self,
        simd: S,
        ends: [V; 2],
        (is_second, is_edges): (V::Mask, V::Mask),
    ) -> [V; 3]
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let is1 = which(simd, ends[0]);
        let a = [is1[0].select(one, zero), is1[1].select(one, zero), is1[2].select(one, zero)];
        let b = of_three(&which(simd, ends[1]), self.rotation.each_ref());
        let across =
            [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let norm = dot(&across, &across).sqrt();
        let direction = filled(
            #[inline(always)]
            |axis| is_edges.select(across[axis] / norm, is_second.select(b[axis], a[axis])),
        );
        let is_away = dot(&direction, &self.translation).simd_lt(zero);
        filled(
            #[inline(always)]
            |axis| is_away.select(-direction[axis], direction[axis]),
        )
    }
}
