//! SIMD kernels of polytopes: the support vertex of a solid with many vertices, and the face plane
//! over which a point has the greatest height.

use crate::math::lanes::{dot, highest_lane, load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide};
use crate::shape::polytope::{LANES, Planes};

/// Returns the index of the vertex farthest along a direction, the first if there are several.
pub(in crate::shape) fn vertex<N: Real, const D: usize>(
    level: Level,
    blocks: &[[[N; LANES]; D]],
    direction: &Vector<N, D>,
) -> usize {
    with_lanes!(level, simd => vertex_in_lanes::<_, N, N::Lanes<_>, D>(simd, blocks, direction))
}

/// Returns the index of the plane over which a point has the greatest height, the first if there
/// are several.
pub(in crate::shape) fn plane<N: Real, const D: usize>(
    level: Level,
    planes: &[Planes<N, D>],
    point: &Point<N, D>,
) -> usize {
    with_lanes!(level, simd => plane_in_lanes::<_, N, N::Lanes<_>, D>(simd, planes, point))
}

/// Implements [`vertex`] with the vector instructions `simd`.
#[inline(always)]
fn vertex_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    blocks: &[[[N; LANES]; D]],
    direction: &Vector<N, D>,
) -> usize {
    let along: [V; D] = spread(simd, direction);
    highest(
        simd,
        blocks,
        #[inline(always)]
        |block| dot(&load::<_, _, V, D, LANES>(simd, block), &along),
    )
}

/// Implements [`plane`] with the vector instructions `simd`.
#[inline(always)]
fn plane_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    planes: &[Planes<N, D>],
    point: &Point<N, D>,
) -> usize {
    let point: [V; D] = spread(simd, &point.coords);
    highest(
        simd,
        planes,
        #[inline(always)]
        |planes| {
            let normals = load::<_, _, V, D, LANES>(simd, &planes.normals);
            dot(&normals, &point) - V::load(simd, &planes.offsets)
        },
    )
}

/// Returns the index of the greatest height over all lanes of all blocks, the first if there are
/// several.
#[inline(always)]
fn highest<S: Simd, N: Real, V: Wide<S, Scalar = N>, B>(
    simd: S,
    blocks: &[B],
    heights: impl Fn(&B) -> V,
) -> usize {
    let mut highest = heights(&blocks[0]);
    // Block indices are exact in the scalar type, in `f32` up to 2²⁴ blocks.
    let (mut indices, mut index) = (V::all(simd, N::ZERO), N::ZERO);
    for block in &blocks[1..] {
        index += N::ONE;
        let heights = heights(block);
        let is_higher = heights.simd_gt(highest);
        indices = is_higher.select(V::all(simd, index), indices);
        highest = is_higher.select(heights, highest);
    }
    let all = V::all(simd, highest_lane(highest));
    let (mut ties, mut numbers) = (highest.simd_eq(all).to_bitmask(), [N::ZERO; LANES]);
    indices.store(&mut numbers);
    let mut first = usize::MAX;
    while ties != 0 {
        let lane = ties.trailing_zeros() as usize;
        ties &= ties - 1;
        let index = block_number(numbers[lane]) * LANES + lane;
        first = if index < first { index } else { first };
    }
    if first == usize::MAX { 0 } else { first }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "it was counted up from zero"
)]
fn block_number<N: Real>(number: N) -> usize {
    number.as_f64() as usize
}
