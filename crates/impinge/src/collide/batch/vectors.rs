//! Vector operations in lanes, each with the order of operations of its scalar counterpart, so that
//! results are bit-identical.

use crate::collide::manifold::frame::ROUNDING_ERRORS;
use crate::collide::separation::is_square_in_range;
pub(super) use crate::math::lanes::{
    bits, cross, dot, either, either_mask, lit, minus, negated, norm, over, plus, rotated_into,
    times,
};
use crate::math::simd::Simd;
use crate::math::{Real, Wide};

/// Returns the length up to which differences are rounding errors, as `rounding` of `frame.rs`
/// does. `size` is the sum of the bounding radii of both solids and the distance of their origins.
#[inline(always)]
pub(super) fn rounding_of<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, size: V) -> V {
    V::all(simd, N::lit(ROUNDING_ERRORS) * N::EPSILON) * size
}

/// Returns direction and length of a vector, as the scalar `unit` does. The mask has the lanes
/// whose squared length is far from underflow and overflow; in the other lanes, direction and
/// length may be wrong.
#[inline(always)]
pub(super) fn unit<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    v: &[V; D],
) -> ([V; D], V, V::Mask) {
    let squared = dot(v, v);
    let length = squared.sqrt();
    (over(v, length), length, is_square_in_range(simd, squared))
}

/// Returns the length of a vector. The mask has the lanes where the length is zero, or its square
/// is far from underflow and overflow.
#[inline(always)]
pub(super) fn length_of<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    v: &[V; D],
) -> (V, V::Mask) {
    let squared = dot(v, v);
    let mut sum = v[0].abs();
    for coordinate in &v[1..] {
        sum += coordinate.abs();
    }
    // Unlike the square, the sum does not underflow.
    let is_zero = sum.simd_le(V::all(simd, N::ZERO));
    (squared.sqrt(), is_square_in_range(simd, squared) | is_zero)
}

/// Returns the lanes whose number is neither infinite nor NaN.
#[inline(always)]
pub(super) fn is_finite<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, number: V) -> V::Mask {
    number.abs().simd_lt(V::all(simd, N::INFINITY))
}
