//! SIMD vectors emulated by arrays of 8 numbers: for targets without SIMD, for `f64` on SSE2, and
//! for tests.
//!
//! The operations are functions that are not inlined. Inlining would turn a kernel of a thousand
//! operations into a function with thousands of loops, which takes too long to compile.

use crate::math::filled;
use core::ops::{
    Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, Div, Mul, Neg, Not, Sub,
};

use super::na::ComplexField;
use super::na::RealField;
use super::simd::{Simd, SimdMask, Wide};

/// The number of lanes in a vector.
const LANES: usize = 8;

/// The vector types of this file as a SIMD level, which every machine supports.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrays;

/// A vector of 8 numbers.
#[derive(Clone, Copy, Debug)]
#[allow(unnameable_types, unreachable_pub, reason = "in the interface only where `f64` is")]
pub struct Array<N>([N; LANES]);

/// A mask with a bit for each lane; the first lane is the lowest bit.
#[derive(Clone, Copy, Debug)]
#[allow(unnameable_types, unreachable_pub, reason = "in the interface only where `f64` is")]
pub struct Bits(u8);

impl Simd for Arrays {
    type F32x8 = Array<f32>;
    type F64x8 = Array<f64>;
}

#[inline(never)]
fn each<N: RealField + Copy>(a: &Array<N>, operation: impl Fn(N) -> N) -> Array<N> {
    Array(a.0.map(operation))
}

#[inline(never)]
fn both<N: RealField + Copy>(
    a: &Array<N>,
    b: &Array<N>,
    operation: impl Fn(N, N) -> N,
) -> Array<N> {
    Array(filled(|lane| operation(a.0[lane], b.0[lane])))
}

#[inline(never)]
fn compared<N: RealField + Copy>(
    a: &Array<N>,
    b: &Array<N>,
    holds: impl Fn(&N, &N) -> bool,
) -> Bits {
    Bits((0..LANES).fold(0, |bits, lane| bits | u8::from(holds(&a.0[lane], &b.0[lane])) << lane))
}

#[inline(never)]
fn selected<N: RealField + Copy>(mask: Bits, one: &Array<N>, other: &Array<N>) -> Array<N> {
    Array(filled(|lane| if mask.0 >> lane & 1 == 1 { one.0[lane] } else { other.0[lane] }))
}

impl<N: RealField + Copy> Add for Array<N> {
    type Output = Self;

    #[inline(always)]
    fn add(self, other: Self) -> Self {
        both(&self, &other, |a, b| a + b)
    }
}

impl<N: RealField + Copy> AddAssign for Array<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl<N: RealField + Copy> Sub for Array<N> {
    type Output = Self;

    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        both(&self, &other, |a, b| a - b)
    }
}

impl<N: RealField + Copy> Mul for Array<N> {
    type Output = Self;

    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        both(&self, &other, |a, b| a * b)
    }
}

impl<N: RealField + Copy> Div for Array<N> {
    type Output = Self;

    #[inline(always)]
    fn div(self, other: Self) -> Self {
        both(&self, &other, |a, b| a / b)
    }
}

impl<N: RealField + Copy> Neg for Array<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        each(&self, |a| -a)
    }
}

impl<N: RealField + Copy, S: Simd> Wide<S> for Array<N> {
    type Scalar = N;
    type Mask = Bits;

    #[inline(always)]
    fn all(_: S, value: N) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    fn load(_: S, numbers: &[N]) -> Self {
        let mut all = [N::zero(); LANES];
        all.copy_from_slice(numbers);
        Self(all)
    }

    #[inline(always)]
    fn store(self, numbers: &mut [N]) {
        numbers.copy_from_slice(&self.0);
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        each(&self, ComplexField::sqrt)
    }

    #[inline(always)]
    fn abs(self) -> Self {
        each(&self, ComplexField::abs)
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> Bits {
        compared(&self, &other, N::lt)
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> Bits {
        compared(&self, &other, N::gt)
    }

    #[inline(always)]
    fn simd_le(self, other: Self) -> Bits {
        compared(&self, &other, N::le)
    }

    #[inline(always)]
    fn simd_ge(self, other: Self) -> Bits {
        compared(&self, &other, N::ge)
    }

    #[inline(always)]
    fn simd_eq(self, other: Self) -> Bits {
        compared(&self, &other, N::eq)
    }

    #[inline(always)]
    fn selected(mask: Bits, one: Self, other: Self) -> Self {
        selected(mask, &one, &other)
    }

    #[inline(always)]
    fn smaller(self, other: Self) -> Self {
        both(&self, &other, |a, b| if a < b { a } else { b })
    }

    #[inline(always)]
    fn larger(self, other: Self) -> Self {
        both(&self, &other, |a, b| if a > b { a } else { b })
    }
}

impl<S: Simd> SimdMask<S> for Bits {
    const LEN: usize = LANES;

    #[inline(always)]
    fn to_bitmask(self) -> u64 {
        u64::from(self.0)
    }

    #[inline(always)]
    fn any_true(self) -> bool {
        self.0 != 0
    }

    #[inline(always)]
    fn all_true(self) -> bool {
        self.0 == u8::MAX
    }
}

impl BitAnd for Bits {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(self.0 & other.0)
    }
}

impl BitAndAssign for Bits {
    #[inline(always)]
    fn bitand_assign(&mut self, other: Self) {
        *self = *self & other;
    }
}

impl BitOr for Bits {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl BitOrAssign for Bits {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Self) {
        *self = *self | other;
    }
}

impl BitXor for Bits {
    type Output = Self;

    #[inline(always)]
    fn bitxor(self, other: Self) -> Self {
        Self(self.0 ^ other.0)
    }
}

impl Not for Bits {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}
