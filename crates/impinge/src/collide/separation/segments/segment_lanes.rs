//! Computes for several lanes at a time the nearest point of a segment to a given point and, in 2D,
//! the separation of two segments.
//!
//! A single pair in 2D runs the same code in one lane, so a query of two segments and a batch of
//! manifolds get the same normal and distance, to the bit.
//!
//! ```text
//!    first *--------+------* last     from_first = (point - first) · along
//!                   |                 to_last    = (last - point) · along
//!             point *                 is_inside: both are positive
//! ```

use super::nearest::core;
use crate::collide::Pair;
use crate::convex::Separation;
use crate::math::lanes::{dot, either, either_mask, minus, negated, norm, over, plus, times};
use crate::math::lone::{Lone, OneLane};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Real, Wide};
use crate::shape::Kind;

/// Nearest point of a segment to a given point.
pub(crate) struct Nearest<V, M, const D: usize> {
    pub(crate) point: [V; D],
    /// Lanes where the nearest point lies between the ends.
    pub(crate) is_inside: M,
    /// Vector from the first end to the last.
    pub(crate) along: [V; D],
    /// Coordinate of the given point along `along`, measured from the first end, times the length
    /// of the segment.
    pub(crate) from_first: V,
    /// Coordinate of the given point along the negated `along`, measured from the last end, times
    /// the length of the segment.
    pub(crate) to_last: V,
}

/// Returns for each lane the point of a segment nearest to `point`, computed from the nearer end.
#[inline(always)]
pub(crate) fn nearest_on_segment<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [first, last]: &[[V; D]; 2],
    point: &[V; D],
) -> Nearest<V, V::Mask, D> {
    let zero = V::all(simd, N::ZERO);
    let along = minus(last, first);
    let from_first = dot(&minus(point, first), &along);
    let to_last = dot(&minus(last, point), &along);
    let (is_beyond_first, whole) = (from_first.simd_gt(zero), from_first + to_last);
    let is_inside = is_beyond_first & to_last.simd_gt(zero);
    let is_first_half = from_first.simd_lt(to_last);
    let step = times(&along, is_first_half.select(from_first, to_last) / whole);
    let inside = either(is_first_half, &plus(first, &step), &minus(last, &step));
    let end = either(is_beyond_first, last, first);
    let point = either(is_inside, &inside, &end);
    Nearest { point, is_inside, along, from_first, to_last }
}

/// Returns the lanes where a squared length is far from underflow and overflow, so that its root is
/// accurate. Not set for NaN.
#[inline(always)]
pub(crate) fn is_square_in_range<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    squared: V,
) -> V::Mask {
    squared.simd_gt(V::all(simd, N::MIN_POSITIVE / N::EPSILON))
        & squared.simd_lt(V::all(simd, N::MAX * N::EPSILON))
}

/// Separation of two segments in 2D.
pub(crate) struct SegmentGap<V, M> {
    /// Unit vector from the first segment to the second.
    pub(crate) normal: [V; 2],
    pub(crate) gap: V,
    /// Nearest points of the first and the second segment.
    pub(crate) points: [[V; 2]; 2],
    /// Lanes where the other fields are valid. In the other lanes, the segments cross or touch, a
    /// squared length is near underflow or overflow, or supporting lines do not confirm the gap.
    pub(crate) is_known: M,
}

/// An end of one segment and the nearest point of the other segment.
struct EndAndSide<V, M> {
    points: [[V; 2]; 2],
    /// Lanes where the point of the other segment lies between that segment's ends.
    is_inside: M,
    /// Vector between the ends of the other segment.
    along: [V; 2],
    squared: V,
}

impl<V, M> EndAndSide<V, M> {
    /// Pairs end `end` of segment `which` (0 or 1) with the nearest point of the other segment.
    #[inline(always)]
    fn of<S: Simd, N: Real>(simd: S, ends: [&[[V; 2]; 2]; 2], which: usize, end: usize) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let own = ends[which][end];
        let near = nearest_on_segment(simd, ends[1 - which], &own);
        let points = if which == 0 { [own, near.point] } else { [near.point, own] };
        let between = minus(&points[1], &points[0]);
        let squared = dot(&between, &between);
        Self { points, is_inside: near.is_inside, along: near.along, squared }
    }

    /// Selects `other` in the lanes of `is_other`, else `self`.
    #[inline(always)]
    fn or<S: Simd>(&self, other: &Self, is_other: M) -> Self
    where
        V: Wide<S, Mask = M>,
        M: SimdMask<S>,
    {
        let [point1, point2] = &self.points;
        Self {
            points: [
                either(is_other, &other.points[0], point1),
                either(is_other, &other.points[1], point2),
            ],
            is_inside: either_mask(is_other, other.is_inside, self.is_inside),
            along: either(is_other, &other.along, &self.along),
            squared: is_other.select(other.squared, self.squared),
        }
    }
}

impl<V, M> SegmentGap<V, M> {
    /// Returns the separation of two segments, from their ends.
    ///
    /// Segments that do not cross are nearest at an end of one of them. If the nearest point of the
    /// other segment lies between its ends, the normal is perpendicular to that segment, which is
    /// accurate at any distance. Such a pair of points is preferred to others that are as near up
    /// to rounding; otherwise the first pair wins a tie.
    #[inline(always)]
    pub(crate) fn of<S: Simd, N: Real>(simd: S, ends: [&[[V; 2]; 2]; 2]) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let mut best = EndAndSide::of(simd, ends, 0, 0);
        let mut beside = EndAndSide::of(simd, ends, 0, 0);
        beside.squared = beside.is_inside.select(beside.squared, V::all(simd, N::INFINITY));
        for (which, end) in [(0, 1), (1, 0), (1, 1)] {
            let other = EndAndSide::of(simd, ends, which, end);
            best = best.or(&other, other.squared.simd_lt(best.squared));
            let is_nearer = other.is_inside & other.squared.simd_lt(beside.squared);
            beside = beside.or(&other, is_nearer);
        }
        let rounding_error = V::all(simd, N::lit(4.0) * N::EPSILON) * size(simd, ends);
        let is_beside = beside.squared.sqrt().simd_le(best.squared.sqrt() + rounding_error);
        best = best.or(&beside, is_beside);
        let (normal, gap) = best.normal(simd);
        let is_long = is_square_in_range(simd, length_squared(ends[0]))
            & is_square_in_range(simd, length_squared(ends[1]));
        // Lanes where the segments are apart by more than rounding, and supporting lines confirm
        // the gap.
        let slack = V::all(simd, N::lit(16.0)) * rounding_error;
        let parted = lowest(ends[1], &normal) + lowest(ends[0], &negated(&normal));
        let is_apart = gap.simd_gt(slack) & (parted + slack).simd_gt(gap);
        let is_known = is_long & is_apart & is_square_in_range(simd, best.squared);
        Self { normal, gap, points: best.points, is_known }
    }
}

impl<V, M> EndAndSide<V, M> {
    /// Returns the unit normal, and the distance of the points along it.
    #[inline(always)]
    fn normal<S: Simd, N: Real>(&self, simd: S) -> ([V; 2], V)
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let between = minus(&self.points[1], &self.points[0]);
        let length = self.squared.sqrt();
        let across = [self.along[1], -self.along[0]];
        let across = over(&across, norm(&across));
        let height = dot(&across, &between);
        let is_behind = height.simd_lt(V::all(simd, N::ZERO));
        let across = either(is_behind, &negated(&across), &across);
        let normal = either(self.is_inside, &across, &over(&between, length));
        (normal, self.is_inside.select(height.abs(), length))
    }
}

/// Returns an upper bound of the distance of the ends from the origin: their largest sum of
/// absolute coordinates.
#[inline(always)]
fn size<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, ends: [&[[V; 2]; 2]; 2]) -> V {
    let mut size = V::all(simd, N::ZERO);
    for end in ends.into_iter().flatten() {
        size = (end[0].abs() + end[1].abs()).larger(size);
    }
    size
}

#[inline(always)]
fn length_squared<S: Simd, V: Wide<S>>([first, last]: &[[V; 2]; 2]) -> V {
    let along = minus(last, first);
    dot(&along, &along)
}

/// Returns the smaller coordinate of the two ends along a direction.
#[inline(always)]
fn lowest<S: Simd, V: Wide<S>>([first, last]: &[[V; 2]; 2], direction: &[V; 2]) -> V {
    dot(direction, first).smaller(dot(direction, last))
}

/// Returns the separation of two segments or capsules in 2D; `None` for other kinds, and if
/// [`SegmentGap::is_known`] is false.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 2>,
) -> Option<Separation<N, 2>> {
    let is_segment = |kind: &Kind<'_, N, 2>| matches!(kind, Kind::Segment(_) | Kind::Capsule(_));
    if !(is_segment(&pair.first) && is_segment(&pair.second)) {
        return None;
    }
    let ((ends1, radius1), (local2, radius2)) = (core(pair, &pair.first), core(pair, &pair.second));
    let ends2 = local2.map(|end| pair.pose12.point(&end));
    let cores = alone(&ends1, &ends2)?;
    Some(cores.rounded(radius1, radius2))
}

/// Returns the separation of the cores of one pair; `None` if [`SegmentGap::is_known`] is false.
fn alone<N: Real>(ends1: &[Point<N, 2>; 2], ends2: &[Point<N, 2>; 2]) -> Option<Separation<N, 2>> {
    let lone = |ends: &[Point<N, 2>; 2]| [Lone::each(&ends[0].coords), Lone::each(&ends[1].coords)];
    let found = SegmentGap::of(OneLane(0), [&lone(ends1), &lone(ends2)]);
    found.is_known.0.then(|| Separation {
        distance: found.gap.0,
        normal: Lone::vector(&found.normal),
        point1: Point::from(Lone::vector(&found.points[0])),
        point2: Point::from(Lone::vector(&found.points[1])),
    })
}
