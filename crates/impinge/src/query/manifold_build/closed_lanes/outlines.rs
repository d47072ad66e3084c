//! Segments of the plane, and what separates them: `separation/polygon_polygon.rs` in lanes, for
//! outlines of two vertices.

use super::nearest::{Nearest, nearest_on_segment};
use super::vectors::{dot, either, lit, minus, negated, norm, times, unit};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// A point or vector of the plane in each lane.
pub(super) type Plane<V> = [V; 2];

/// A segment there and back again.
pub(super) struct Outline<V> {
    pub(super) ends: [Plane<V>; 2],
    /// The outward normals of the way there and of the way back.
    pub(super) normals: [Plane<V>; 2],
}

/// A direction from the first outline to the second and the gap between them.
pub(super) struct Axis<V> {
    pub(super) gap: V,
    pub(super) normal: Plane<V>,
}

/// What is known of two segments that are apart.
pub(super) struct Apart<V, M> {
    pub(super) axis: Axis<V>,
    /// The nearest points.
    pub(super) points: [Plane<V>; 2],
    /// The lanes that the bound by the best axis puts out of reach, and those where all else is known.
    pub(super) is_beyond: M,
    pub(super) is_known: M,
}

/// `right_of`: from the direction of a side to its outward normal.
#[inline(always)]
fn right_of<S: Simd, V: Wide<S>>(v: &Plane<V>) -> Plane<V> {
    [v[1], -v[0]]
}

/// `perp`.
#[inline(always)]
fn left_of<S: Simd, V: Wide<S>>(v: &Plane<V>) -> Plane<V> {
    [-v[1], v[0]]
}

impl<V> Outline<V> {
    /// A segment in its own frame, and where it has a length.
    #[inline(always)]
    pub(super) fn of<S: Simd, N: Real>(simd: S, ends: [Plane<V>; 2]) -> (Self, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let (there, _, is_long) = unit(simd, &minus(&ends[1], &ends[0]));
        let (back, _, _) = unit(simd, &minus(&ends[0], &ends[1]));
        (Self { ends, normals: [right_of(&there), right_of(&back)] }, is_long)
    }

    /// `Reach::along`.
    #[inline(always)]
    fn reach<S: Simd>(&self, direction: &Plane<V>) -> V
    where
        V: Wide<S>,
    {
        let last = dot(direction, &self.ends[1]);
        last.larger(dot(direction, &self.ends[0])).larger(last)
    }

    /// `Outline::height`.
    #[inline(always)]
    fn height<S: Simd>(&self, direction: &Plane<V>) -> V
    where
        V: Wide<S>,
    {
        dot(direction, &self.ends[1]).larger(dot(direction, &self.ends[0]))
    }

    /// `Outline::reach`.
    #[inline(always)]
    fn size<S: Simd, N: Real>(&self, simd: S) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let [a, b] = &self.ends;
        let size = (a[0].abs() + a[1].abs()).larger(V::all(simd, N::ZERO));
        (b[0].abs() + b[1].abs()).larger(size)
    }

    /// The sum of all coordinates, which is a number if they are.
    #[inline(always)]
    fn extent<S: Simd>(&self) -> V
    where
        V: Wide<S>,
    {
        let [a, b] = &self.ends;
        (a[0].abs() + a[1].abs()) + (b[0].abs() + b[1].abs())
    }

    /// The directions of `visit_axes`, and where all of them are to be visited.
    #[inline(always)]
    fn axes<S: Simd, N: Real>(&self, simd: S) -> ([Plane<V>; 4], V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let [there, back] = &self.normals;
        let (first, _, is_first) = unit(simd, &minus(&left_of(back), &left_of(there)));
        let (last, _, is_last) = unit(simd, &minus(&left_of(there), &left_of(back)));
        let is_sharp = dot(there, back).simd_lt(V::all(simd, N::ZERO));
        ([*there, first, *back, last], is_first & is_last & is_sharp)
    }
}

/// `best_axis`, and where it is known.
#[inline(always)]
fn best_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [outline1, outline2]: [&Outline<V>; 2],
) -> (Axis<V>, V::Mask) {
    let ((axes1, is_known1), (axes2, is_known2)) = (outline1.axes(simd), outline2.axes(simd));
    let mut best = Axis { gap: V::all(simd, -N::INFINITY), normal: axes1[0] };
    for (number, axis) in axes1.iter().chain(&axes2).enumerate() {
        let normal = if number < 4 { *axis } else { negated(axis) };
        let gap = -outline2.reach(&negated(&normal)) - outline1.reach(&normal);
        let is_better = gap.simd_gt(best.gap);
        best.normal = either(is_better, &normal, &best.normal);
        best.gap = is_better.select(gap, best.gap);
    }
    (best, is_known1 & is_known2)
}

/// `separation` of outlines that are apart, but for the rounding radii.
#[inline(always)]
pub(super) fn separation<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [outline1, outline2]: [&Outline<V>; 2],
    (rounding, limit): (V, V),
) -> Apart<V, V::Mask> {
    let (best, is_known) = best_axis(simd, [outline1, outline2]);
    let extent = outline1.extent() + outline2.extent();
    let is_known = is_known & extent.simd_lt(V::all(simd, N::MAX.sqrt()));
    let size = outline1.size(simd).larger(outline2.size(simd));
    let noise = V::all(simd, N::lit(4.0) * N::EPSILON) * size;
    let slack = lit::<S, N, V>(simd, 16.0) * (noise + V::all(simd, N::EPSILON) * rounding);
    let is_beyond = (best.gap - rounding).simd_gt(limit + slack) & is_known;
    let (points, is_certain) = nearest_points(simd, [outline1, outline2]);
    let (axis, length, is_usual) = direct_axis(simd, [outline1, outline2], &points, &best, noise);
    let is_right = (length - axis.gap).simd_le(lit::<S, N, V>(simd, 4.0) * noise);
    let is_apart = best.gap.simd_gt(V::all(simd, N::ZERO)) & is_known;
    let is_known = is_certain & is_usual & is_right & is_apart;
    Apart { axis, points, is_beyond, is_known }
}

/// The nearest points of two segments, and where they are those of any order of ends: no other two
/// are as near.
#[inline(always)]
fn nearest_points<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [outline1, outline2]: [&Outline<V>; 2],
) -> ([Plane<V>; 2], V::Mask) {
    let (ends1, ends2) = (&outline1.ends, &outline2.ends);
    let near = [
        nearest_on_segment(simd, ends2, &ends1[0]),
        nearest_on_segment(simd, ends2, &ends1[1]),
        nearest_on_segment(simd, ends1, &ends2[0]),
        nearest_on_segment(simd, ends1, &ends2[1]),
    ];
    let points = [
        [ends1[0], near[0].point],
        [ends1[1], near[1].point],
        [near[2].point, ends2[0]],
        [near[3].point, ends2[1]],
    ];
    let mut best = points[0];
    let mut least = squared(&points[0]);
    for other in &points[1..] {
        let is_nearer = squared(other).simd_lt(least);
        best = [either(is_nearer, &other[0], &best[0]), either(is_nearer, &other[1], &best[1])];
        least = is_nearer.select(squared(other), least);
    }
    // Of two that are equally near the order of the ends decides, unless both are the same ends.
    let mut is_tied = least.simd_lt(least);
    let (mut is_level, mut is_between) = (is_tied, is_tied);
    for (found, near) in points.iter().zip(&near) {
        let is_one = squared(found).simd_eq(least);
        let is_other = is_one & !is_same(found, &best);
        is_tied |= is_other | (is_one & is_level & (is_between | near.is_inside));
        is_tied |= is_one & near.is_inside & is_halfway(near);
        is_level |= is_one;
        is_between |= is_one & near.is_inside;
    }
    (best, !is_tied)
}

/// A point half-way between the ends, which each end might be asked for.
#[inline(always)]
fn is_halfway<S: Simd, V: Wide<S>>(near: &Nearest<V, V::Mask, 2>) -> V::Mask {
    near.from_first.simd_eq(near.to_last)
}

#[inline(always)]
fn squared<S: Simd, V: Wide<S>>(points: &[Plane<V>; 2]) -> V {
    let between = minus(&points[1], &points[0]);
    dot(&between, &between)
}

#[inline(always)]
fn is_same<S: Simd, V: Wide<S>>(points: &[Plane<V>; 2], others: &[Plane<V>; 2]) -> V::Mask {
    points[0][0].simd_eq(others[0][0])
        & points[0][1].simd_eq(others[0][1])
        & points[1][0].simd_eq(others[1][0])
        & points[1][1].simd_eq(others[1][1])
}

/// `direct_axis`, the distance of the points, and where that is usual.
#[inline(always)]
fn direct_axis<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [outline1, outline2]: [&Outline<V>; 2],
    points: &[Plane<V>; 2],
    best: &Axis<V>,
    noise: V,
) -> (Axis<V>, V, V::Mask) {
    let slack = lit::<S, N, V>(simd, 8.0) * noise;
    let between = minus(&points[1], &points[0]);
    let beside = norm(&minus(&between, &times(&best.normal, best.gap)));
    let (normal, length, is_usual) = unit(simd, &between);
    let gap = -outline2.height(&negated(&normal)) - outline1.height(&normal);
    let is_direct = beside.simd_gt(noise) & (gap + slack).simd_ge(best.gap);
    let gap = is_direct.select(length, best.gap);
    (Axis { gap, normal: either(is_direct, &normal, &best.normal) }, length, is_usual)
}
