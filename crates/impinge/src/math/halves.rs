//! Vectors of 8 numbers for narrower registers: pairs of vectors with half of the lanes each, which
//! may themselves be [`Halves`].
//!
//! `fearless_simd` also has such vectors, as arrays of registers that each operation unpacks and
//! packs. Kernels with those vectors have the same machine code, but take twice as long to compile.

use core::ops::{
    Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, Div, Mul, Neg, Not, Sub,
};

use super::simd::{Simd, SimdMask, Wide};

/// The lanes of `low` followed by the lanes of `high`. `V` is a vector of numbers or a mask.
#[derive(Clone, Copy, Debug)]
#[expect(unnameable_types, reason = "for this crate alone")]
pub struct Halves<V> {
    low: V,
    high: V,
}

/// Implements binary operators by the operators of both halves. Closures are avoided, since they
/// are not inlined into SIMD code.
macro_rules! by_halves {
    ($($operator:ident $method:ident),*) => {$(
        impl<V: $operator<Output = V>> $operator for Halves<V> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self {
                    low: self.low.$method(other.low),
                    high: self.high.$method(other.high),
                }
            }
        }
    )*};
}

by_halves!(Add add, Sub sub, Mul mul, Div div, BitAnd bitand, BitOr bitor, BitXor bitxor);

/// Implements assignment operators by the operators of both halves.
macro_rules! in_place_by_halves {
    ($($operator:ident $method:ident),*) => {$(
        impl<V: $operator> $operator for Halves<V> {
            #[inline(always)]
            fn $method(&mut self, other: Self) {
                self.low.$method(other.low);
                self.high.$method(other.high);
            }
        }
    )*};
}

in_place_by_halves!(AddAssign add_assign, BitAndAssign bitand_assign, BitOrAssign bitor_assign);

impl<V: Neg<Output = V>> Neg for Halves<V> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self { low: -self.low, high: -self.high }
    }
}

impl<M: Not<Output = M>> Not for Halves<M> {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self { low: !self.low, high: !self.high }
    }
}

impl<S: Simd, M: SimdMask<S>> SimdMask<S> for Halves<M> {
    const LEN: usize = 2 * M::LEN;

    #[inline(always)]
    fn to_bitmask(self) -> u64 {
        self.low.to_bitmask() | self.high.to_bitmask() << M::LEN
    }

    #[inline(always)]
    fn any_true(self) -> bool {
        (self.low | self.high).any_true()
    }

    #[inline(always)]
    fn all_true(self) -> bool {
        (self.low & self.high).all_true()
    }
}

impl<S: Simd, V: Wide<S, Scalar: Copy>> Wide<S> for Halves<V> {
    type Scalar = V::Scalar;
    type Mask = Halves<V::Mask>;

    #[inline(always)]
    fn all(simd: S, value: V::Scalar) -> Self {
        let half = V::all(simd, value);
        Self { low: half, high: half }
    }

    #[inline(always)]
    fn load(simd: S, numbers: &[V::Scalar]) -> Self {
        let (low, high) = numbers.split_at(V::Mask::LEN);
        Self { low: V::load(simd, low), high: V::load(simd, high) }
    }

    #[inline(always)]
    fn store(self, numbers: &mut [V::Scalar]) {
        let (low, high) = numbers.split_at_mut(V::Mask::LEN);
        self.low.store(low);
        self.high.store(high);
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { low: self.low.sqrt(), high: self.high.sqrt() }
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self { low: self.low.abs(), high: self.high.abs() }
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> Self::Mask {
        Halves { low: self.low.simd_lt(other.low), high: self.high.simd_lt(other.high) }
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> Self::Mask {
        Halves { low: self.low.simd_gt(other.low), high: self.high.simd_gt(other.high) }
    }

    #[inline(always)]
    fn simd_le(self, other: Self) -> Self::Mask {
        Halves { low: self.low.simd_le(other.low), high: self.high.simd_le(other.high) }
    }

    #[inline(always)]
    fn simd_ge(self, other: Self) -> Self::Mask {
        Halves { low: self.low.simd_ge(other.low), high: self.high.simd_ge(other.high) }
    }

    #[inline(always)]
    fn simd_eq(self, other: Self) -> Self::Mask {
        Halves { low: self.low.simd_eq(other.low), high: self.high.simd_eq(other.high) }
    }

    #[inline(always)]
    fn selected(mask: Self::Mask, one: Self, other: Self) -> Self {
        Self {
            low: V::selected(mask.low, one.low, other.low),
            high: V::selected(mask.high, one.high, other.high),
        }
    }
}
