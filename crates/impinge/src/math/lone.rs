//! A vector of one number: a kernel compiled for it computes a lone pair with the bits of a lane.

use core::ops::{
    Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, Div, Mul, Neg, Not, Sub,
};

use super::Real;
use super::na::ComplexField;
use super::simd::{Simd, SimdMask, Wide};

/// One number as a vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lone<N>(pub(crate) N);

/// One truth value as a mask.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoneMask(bool);

/// Operators of the number inside.
macro_rules! by_number {
    ($($operator:ident $method:ident),*) => {$(
        impl<N: Real> $operator for Lone<N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}

by_number!(Add add, Sub sub, Mul mul, Div div);

impl<N: Real> AddAssign for Lone<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl<N: Real> Neg for Lone<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<N: Real, S: Simd> Wide<S> for Lone<N> {
    type Scalar = N;
    type Mask = LoneMask;

    #[inline(always)]
    fn all(_: S, value: N) -> Self {
        Self(value)
    }

    #[inline(always)]
    fn load(_: S, numbers: &[N]) -> Self {
        Self(numbers[0])
    }

    #[inline(always)]
    fn store(self, numbers: &mut [N]) {
        numbers[0] = self.0;
    }

    #[inline(always)]
    fn sqrt(self) -> Self {
        Self(ComplexField::sqrt(self.0))
    }

    #[inline(always)]
    fn abs(self) -> Self {
        Self(ComplexField::abs(self.0))
    }

    #[inline(always)]
    fn simd_lt(self, other: Self) -> LoneMask {
        LoneMask(self.0 < other.0)
    }

    #[inline(always)]
    fn simd_gt(self, other: Self) -> LoneMask {
        LoneMask(self.0 > other.0)
    }

    #[inline(always)]
    fn simd_le(self, other: Self) -> LoneMask {
        LoneMask(self.0 <= other.0)
    }

    #[inline(always)]
    fn simd_ge(self, other: Self) -> LoneMask {
        LoneMask(self.0 >= other.0)
    }

    #[inline(always)]
    fn simd_eq(self, other: Self) -> LoneMask {
        LoneMask(self.0 == other.0)
    }

    #[inline(always)]
    fn selected(mask: LoneMask, one: Self, other: Self) -> Self {
        if mask.0 { one } else { other }
    }
}

impl<S: Simd> SimdMask<S> for LoneMask {
    const LEN: usize = 1;

    #[inline(always)]
    fn to_bitmask(self) -> u64 {
        u64::from(self.0)
    }

    #[inline(always)]
    fn any_true(self) -> bool {
        self.0
    }

    #[inline(always)]
    fn all_true(self) -> bool {
        self.0
    }
}

/// Operators of the truth value inside.
macro_rules! by_truth {
    ($($operator:ident $method:ident),*) => {$(
        impl $operator for LoneMask {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}

by_truth!(BitAnd bitand, BitOr bitor, BitXor bitxor);

impl BitAndAssign for LoneMask {
    #[inline(always)]
    fn bitand_assign(&mut self, other: Self) {
        self.0 &= other.0;
    }
}

impl BitOrAssign for LoneMask {
    #[inline(always)]
    fn bitor_assign(&mut self, other: Self) {
        self.0 |= other.0;
    }
}

impl Not for LoneMask {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        Self(!self.0)
    }
}
