//! Sides of two polygons of the plane: each end against each side of the other, eight at a time.

use super::polygon_lanes::{highest, lane};
use crate::math::lanes::{dot, either};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Real, Wide};

/// The nearest points of the sides at two vertices, each given with its neighbours; `None` where the
/// numbers end.
///
/// Each end of a side against a side of the other outline: lane 4 is set for the second side of the
/// first outline, lane 2 for that of the second, lane 1 for the second end. Of equals the first counts
/// in the order of sides of the first, sides of the second, ends of the first, ends of the second.
#[inline(always)]
pub(super) fn nearest_points<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    around1: &[Point<N, 2>; 3],
    around2: &[Point<N, 2>; 3],
) -> Option<(Point<N, 2>, Point<N, 2>)> {
    let (zero, no, yes) = (V::all(simd, N::ZERO), N::ZERO, N::ONE);
    let is_second1 = V::load(simd, &[no, no, no, no, yes, yes, yes, yes]).simd_gt(zero);
    let is_second2 = V::load(simd, &[no, no, yes, yes, no, no, yes, yes]).simd_gt(zero);
    let is_end = V::load(simd, &[no, yes, no, yes, no, yes, no, yes]).simd_gt(zero);
    let before1: [V; 2] = spread(simd, &around1[0]);
    let at1: [V; 2] = spread(simd, &around1[1]);
    let after1: [V; 2] = spread(simd, &around1[2]);
    let before2: [V; 2] = spread(simd, &around2[0]);
    let at2: [V; 2] = spread(simd, &around2[1]);
    let after2: [V; 2] = spread(simd, &around2[2]);
    let from1 = either(is_second1, &at1, &before1);
    let to1 = either(is_second1, &after1, &at1);
    let from2 = either(is_second2, &at2, &before2);
    let to2 = either(is_second2, &after2, &at2);
    let end1 = either(is_end, &to1, &from1);
    let end2 = either(is_end, &to2, &from2);
    let (on2, squared1) = nearest_on_side(simd, &from2, &to2, &end1);
    let (on1, squared2) = nearest_on_side(simd, &from1, &to1, &end2);
    let (low1, lane1) = highest(simd, -squared1);
    let (low2, lane2) = highest(simd, -squared2);
    let (low1, low2) = (-low1, -low2);
    let is_usual = low1 < N::INFINITY && low2 < N::INFINITY;
    if !is_usual {
        return None;
    }
    let (rank1, rank2) = ((lane1 >> 1) * 4 + (lane1 & 1), (lane2 >> 1) * 4 + (lane2 & 1) + 2);
    let is_first = low1 < low2 || low1 == low2 && rank1 < rank2;
    Some(if is_first {
        (lane(&end1, lane1), lane(&on2, lane1))
    } else {
        (lane(&on1, lane2), lane(&end2, lane2))
    })
}

/// The same point in all lanes.
#[inline(always)]
fn spread<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, point: &Point<N, 2>) -> [V; 2] {
    [V::all(simd, point.x), V::all(simd, point.y)]
}

/// The points of some sides nearest to some points, and the squares of their distances; as
/// [`super::segments::nearest_on_segment`].
#[inline(always)]
fn nearest_on_side<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    from: &[V; 2],
    to: &[V; 2],
    point: &[V; 2],
) -> ([V; 2], V) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let from_a = dot(&[point[0] - from[0], point[1] - from[1]], &along);
    let to_b = dot(&[to[0] - point[0], to[1] - point[1]], &along);
    let zero = V::all(simd, N::ZERO);
    let is_beyond_a = from_a.simd_gt(zero);
    let is_between = is_beyond_a & to_b.simd_gt(zero);
    let whole = from_a + to_b;
    let is_nearer_a = from_a.simd_lt(to_b);
    let share = is_nearer_a.select(from_a, to_b) / whole;
    let step = [along[0] * share, along[1] * share];
    let after_a = [from[0] + step[0], from[1] + step[1]];
    let before_b = [to[0] - step[0], to[1] - step[1]];
    let between = either(is_nearer_a, &after_a, &before_b);
    let nearest = either(is_between, &between, &either(is_beyond_a, to, from));
    let way = [nearest[0] - point[0], nearest[1] - point[1]];
    (nearest, dot(&way, &way))
}
