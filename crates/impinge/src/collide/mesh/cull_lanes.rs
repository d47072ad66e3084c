//! Lower bounds of the distances of eight parts of a surface from a convex solid: those of [`cull`](super::cull),
//! side by side.
//!
//! Of the solid its core counts by its extents along its own axes alone, as that of a box.

use super::cull::{least_length, relative_slack};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{bits, dot, either, in_lanes, lit, load, minus, norm, spread};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Matrix, Real, Vector, Wide, filled, min};

/// A convex solid in the frame of a composite.
pub(super) struct LowerBoundQuery<N: Real, const D: usize> {
    /// Its middle.
    pub(super) center: Vector<N, D>,
    /// Its frame's axes, as columns.
    pub(super) turn: Matrix<N, D>,
    /// Half the extents of its core along them.
    pub(super) half: Vector<N, D>,
    pub(super) rounding: N,
    /// Parts beyond this are of no interest, nor those outside a box.
    pub(super) reach: N,
    pub(super) low: Vector<N, D>,
    pub(super) high: Vector<N, D>,
    /// The size of the solid, its place and the reach.
    pub(super) size: N,
}

/// Which of eight parts may be near, and how near.
pub(super) struct LowerBounds<N> {
    /// A bit for each part that may be within reach.
    pub(super) near: u8,
    /// Those in the box are at least so far from the middle of the solid; zero if that is not known.
    pub(super) from_middle: N,
}

impl<N: Real, const D: usize> LowerBoundQuery<N, D> {
    /// The bounds of eight parts.
    pub(super) fn bounds(&self, tiles: &PartPacket<N, D>) -> LowerBounds<N> {
        at(Level::new(), tiles, self)
    }
}

/// [`bounds`] of all lanes, on the level of which the answers do not depend.
fn at<N: Real, const D: usize>(
    level: Level,
    tiles: &PartPacket<N, D>,
    query: &LowerBoundQuery<N, D>,
) -> LowerBounds<N> {
    let mut all = LowerBounds { near: 0, from_middle: N::INFINITY };
    for run in level.runs(LANES) {
        let found = in_lanes!(run, simd => bounds::<_, N, N::Lanes<_>, D>(simd, tiles, query));
        all.near |= run.of_bits(found.near);
        all.from_middle = min(found.from_middle, all.from_middle);
    }
    all
}

#[inline(always)]
fn bounds<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    tiles: &PartPacket<N, D>,
    query: &LowerBoundQuery<N, D>,
) -> LowerBounds<N> {
    let corners: [[V; D]; 3] = [
        load(simd, &tiles.corners[0]),
        load(simd, &tiles.corners[1]),
        load(simd, &tiles.corners[2]),
    ];
    let is_in = is_in(simd, &corners, query);
    let center: [V; D] = spread(simd, &query.center);
    let arms =
        [minus(&center, &corners[0]), minus(&center, &corners[1]), minus(&center, &corners[2])];
    let toward = toward(simd, &arms);
    let heights = [dot(&toward, &arms[0]), dot(&toward, &arms[1]), dot(&toward, &arms[2])];
    let farthest =
        dot(&arms[0], &arms[0]).larger(dot(&arms[1], &arms[1])).larger(dot(&arms[2], &arms[2]));
    let slack = V::all(simd, relative_slack()) * (farthest.sqrt() + V::all(simd, query.size));
    let (length, tiny) = (norm(&toward), V::all(simd, least_length()));
    // NaN bounds nothing.
    let is_bound = length.simd_gt(slack)
        & heights[0].simd_gt(tiny)
        & heights[1].simd_gt(tiny)
        & heights[2].simd_gt(tiny);
    let from_middle = heights[0].smaller(heights[1]).smaller(heights[2]) / length - slack;
    let own = extent(simd, &toward, query) / length + V::all(simd, query.rounding);
    let is_beyond = is_bound & (from_middle - own - slack).simd_gt(V::all(simd, query.reach));
    let mut known = [N::ZERO; LANES];
    let known_bound = is_bound.select(from_middle, V::all(simd, N::ZERO));
    is_in.select(known_bound, V::all(simd, N::INFINITY)).store(&mut known);
    let near = bits(is_in & !is_beyond);
    LowerBounds { near, from_middle: known.into_iter().fold(N::INFINITY, |least, x| min(x, least)) }
}

/// The parts whose boxes overlap that of the search.
#[inline(always)]
fn is_in<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [a, b, c]: &[[V; D]; 3],
    query: &LowerBoundQuery<N, D>,
) -> V::Mask {
    let all = V::all(simd, N::ZERO);
    let mut is_in = all.simd_eq(all);
    for axis in 0..D {
        let least = a[axis].smaller(b[axis]).smaller(c[axis]);
        let most = a[axis].larger(b[axis]).larger(c[axis]);
        is_in = is_in
            & least.simd_le(V::all(simd, query.high[axis]))
            & most.simd_ge(V::all(simd, query.low[axis]));
    }
    is_in
}

/// From the nearest point of each part to a point, given the ways from the corners to it: in the middle of
/// a triangle by its shares of the corners, else the nearest of the sides.
#[inline(always)]
fn toward<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [a, b, c]: &[[V; D]; 3],
) -> [V; D] {
    let (ab, ac) = (minus(a, b), minus(a, c));
    let (along_ab, along_ac) = (dot(&ab, a), dot(&ac, a));
    let (bb, bc, cc) = (dot(&ab, &ab), dot(&ab, &ac), dot(&ac, &ac));
    let (at_b, at_c) = (along_ab * cc - along_ac * bc, along_ac * bb - along_ab * bc);
    let (area, zero) = (bb * cc - bc * bc, V::all(simd, N::ZERO));
    let is_over =
        at_b.simd_ge(zero) & at_c.simd_ge(zero) & (at_b + at_c).simd_le(area) & area.simd_gt(zero);
    let (share_b, share_c) = (at_b / area, at_c / area);
    let over = filled(
        #[inline(always)]
        |axis| a[axis] - ab[axis] * share_b - ac[axis] * share_c,
    );
    let (first, second, third) =
        (from_side(simd, a, b), from_side(simd, b, c), from_side(simd, c, a));
    either(is_over, &over, &shorter(&shorter(&first, &second), &third))
}

/// From the nearest point of a segment to a point, given the ways from its ends.
#[inline(always)]
fn from_side<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    from: &[V; D],
    to: &[V; D],
) -> [V; D] {
    let along = minus(from, to);
    let share = dot(&along, from) / dot(&along, &along);
    let zero = V::all(simd, N::ZERO);
    let share = share.simd_gt(zero).select(share.smaller(lit(simd, 1.0)), zero);
    filled(
        #[inline(always)]
        |axis| from[axis] - along[axis] * share,
    )
}

#[inline(always)]
fn shorter<S: Simd, V: Wide<S>, const D: usize>(first: &[V; D], second: &[V; D]) -> [V; D] {
    either(dot(second, second).simd_lt(dot(first, first)), second, first)
}

/// How far the core reaches along vectors, times their lengths.
#[inline(always)]
fn extent<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    toward: &[V; D],
    query: &LowerBoundQuery<N, D>,
) -> V {
    let mut sum = V::all(simd, N::ZERO);
    for axis in 0..D {
        let column: [V; D] = filled(
            #[inline(always)]
            |row| V::all(simd, query.turn[(row, axis)]),
        );
        sum += dot(&column, toward).abs() * V::all(simd, query.half[axis]);
    }
    sum
}
