//! A vector with one lane. A kernel compiled for it computes one of 8 lanes, bitwise equal to that
//! lane of a SIMD vector.

use core::ops::{
    Add, AddAssign, BitAnd, BitAndAssign, BitOr, BitOrAssign, BitXor, Div, Mul, Neg, Not, Sub,
};

use super::na::{ComplexField, RealField};
use super::simd::{Simd, SimdMask, Wide};
use super::{Vector, filled};

/// The index of the lane to compute. Loads read the number of this lane from 8 numbers; stores
/// write the result to all 8.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OneLane(pub(crate) usize);

impl Simd for OneLane {
    type F32x8 = Lone<f32>;
    type F64x8 = Lone<f64>;
}

/// A number as a vector with one lane.
#[derive(Clone, Copy, Debug)]
#[allow(unnameable_types, unreachable_pub, reason = "in the interface of `Eight`")]
pub struct Lone<N>(pub(crate) N);

impl<N: RealField + Copy> Lone<N> {
    /// Returns one single-lane vector for each coordinate.
    #[inline(always)]
    pub(crate) fn each<const D: usize>(vector: &Vector<N, D>) -> [Self; D] {
        filled(
            #[inline(always)]
            |axis| Self(vector[axis]),
        )
    }

    /// Converts one single-lane vector for each coordinate to a vector.
    #[inline(always)]
    pub(crate) fn vector<const D: usize>(coordinates: &[Self; D]) -> Vector<N, D> {
        Vector::<N, D>::from_fn(
            #[inline(always)]
            |axis, _| coordinates[axis].0,
        )
    }
}

/// A truth value as a mask with one lane; its bitmask repeats it for all 8 lanes.
#[derive(Clone, Copy, Debug)]
#[allow(unnameable_types, unreachable_pub, reason = "in the interface of `Eight`")]
pub struct LoneMask(pub(crate) bool);

/// Implements binary operators of [`Lone`] by the operators of its number.
macro_rules! by_number {
    ($($operator:ident $method:ident),*) => {$(
        impl<N: RealField + Copy> $operator for Lone<N> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self(self.0.$method(other.0))
            }
        }
    )*};
}

by_number!(Add add, Sub sub, Mul mul, Div div);

impl<N: RealField + Copy> AddAssign for Lone<N> {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        self.0 += other.0;
    }
}

impl<N: RealField + Copy> Neg for Lone<N> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl<N: RealField + Copy> Wide<OneLane> for Lone<N> {
    type Scalar = N;
    type Mask = LoneMask;

    #[inline(always)]
    fn all(_: OneLane, value: N) -> Self {
        Self(value)
    }

    #[inline(always)]
    fn load(OneLane(lane): OneLane, numbers: &[N]) -> Self {
        Self(numbers[lane])
    }

    #[inline(always)]
    fn store(self, numbers: &mut [N]) {
        numbers.fill(self.0);
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

impl SimdMask<OneLane> for LoneMask {
    const LEN: usize = 1;

    #[inline(always)]
    fn to_bitmask(self) -> u64 {
        if self.0 { 0xff } else { 0 }
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

/// Implements binary operators of [`LoneMask`] by the operators of its truth value.
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
