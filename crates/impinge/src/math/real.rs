//! The scalar: `f32` and, with the feature `f64`, `f64`. Nobody else.

use super::max;
use super::na::{RealField, Scalar};
use super::simd::Eight;
use crate::tables::Compiled;

/// A floating-point scalar of the library: `f32` or `f64`.
///
/// Sealed: the kernels are compiled in this crate for these two types and no other.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scalar of impinge",
    label = "neither `f32` nor `f64`",
    note = "scalars are `f32` and, with the feature `f64`, `f64`; generic code asks for `N: Real`"
)]
pub trait Real: RealField + Scalar + Copy + Default + Compiled + Eight {
    /// 0.
    const ZERO: Self;
    /// 1/2.
    const HALF: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// The distance from 1 to the next larger number; tolerances are this times a length.
    const EPSILON: Self;
    /// The largest finite number.
    const MAX: Self;
    /// The smallest positive normal number.
    const MIN_POSITIVE: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// π/2 as a sum, the largest first: integers up to 2¹⁶ times the first two are exact (W. J. Cody and W. Waite,
    /// "Software Manual for the Elementary Functions", 1980).
    #[doc(hidden)]
    const QUARTER_TURN: [Self; 3];

    /// The scalar nearest to a literal.
    fn lit(value: f64) -> Self;
    /// The value as `f64`, exactly.
    fn as_f64(self) -> f64;
    /// The value rounded to the nearest `f32`.
    fn as_f32(self) -> f32;
    /// The largest `f32` that is not above the value (−∞ below the range of `f32`).
    fn as_f32_below(self) -> f32;
    /// The smallest `f32` that is not below the value (+∞ above the range of `f32`).
    fn as_f32_above(self) -> f32;
    /// The bits, widened to 64; equal for equal bits.
    fn bits(self) -> u64;
    /// The largest power of two that is not above the magnitude; dividing by it is exact.
    ///
    /// The smallest normal number for zero and subnormal numbers, 1 for infinity and NaN.
    #[must_use]
    fn power_of_two_below(self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite_number(self) -> bool;
    /// Sine and cosine by a software library: the same bits on every platform.
    fn sine_cosine(self) -> (Self, Self);
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const HALF: Self = 0.5;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const EPSILON: Self = Self::EPSILON;
    const MAX: Self = Self::MAX;
    const MIN_POSITIVE: Self = Self::MIN_POSITIVE;
    const INFINITY: Self = Self::INFINITY;
    const QUARTER_TURN: [Self; 3] = [1.570_312_5, 4.825_592e-4, 1.267_590_8e-6];

    #[expect(clippy::cast_possible_truncation, reason = "rounds to nearest, as documented")]
    #[inline]
    fn lit(value: f64) -> Self {
        value as Self
    }

    fn as_f64(self) -> f64 {
        f64::from(self)
    }

    fn as_f32(self) -> f32 {
        self
    }

    fn as_f32_below(self) -> f32 {
        self
    }

    fn as_f32_above(self) -> f32 {
        self
    }

    #[inline]
    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }

    #[inline]
    fn power_of_two_below(self) -> Self {
        let power = Self::from_bits(self.to_bits() & 0x7f80_0000);
        if power.is_finite() { max(power, Self::MIN_POSITIVE) } else { 1.0 }
    }

    #[inline]
    fn is_finite_number(self) -> bool {
        self.is_finite()
    }

    fn sine_cosine(self) -> (Self, Self) {
        libm::sincosf(self)
    }
}

#[cfg(feature = "f64")]
impl Real for f64 {
    const ZERO: Self = 0.0;
    const HALF: Self = 0.5;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const EPSILON: Self = Self::EPSILON;
    const MAX: Self = Self::MAX;
    const MIN_POSITIVE: Self = Self::MIN_POSITIVE;
    const INFINITY: Self = Self::INFINITY;
    const QUARTER_TURN: [Self; 3] =
        [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21];

    #[inline]
    fn lit(value: f64) -> Self {
        value
    }

    fn as_f64(self) -> f64 {
        self
    }

    #[expect(clippy::cast_possible_truncation, reason = "rounds to nearest, as documented")]
    fn as_f32(self) -> f32 {
        self as f32
    }

    fn as_f32_below(self) -> f32 {
        let nearest = self.as_f32();
        if Self::from(nearest) > self { nearest.next_down() } else { nearest }
    }

    fn as_f32_above(self) -> f32 {
        let nearest = self.as_f32();
        if Self::from(nearest) < self { nearest.next_up() } else { nearest }
    }

    #[inline]
    fn bits(self) -> u64 {
        self.to_bits()
    }

    #[inline]
    fn power_of_two_below(self) -> Self {
        let power = Self::from_bits(self.to_bits() & 0x7ff0_0000_0000_0000);
        if power.is_finite() { max(power, Self::MIN_POSITIVE) } else { 1.0 }
    }

    #[inline]
    fn is_finite_number(self) -> bool {
        self.is_finite()
    }

    fn sine_cosine(self) -> (Self, Self) {
        libm::sincos(self)
    }
}

#[cfg(all(test, feature = "f64"))]
mod tests {
    use super::*;

    #[test]
    fn powers_of_two_below() {
        for (value, power) in [(1.0, 1.0), (-1.75, 1.0), (0.3, 0.25), (1e-45, f32::MIN_POSITIVE)] {
            assert_eq!(f32::power_of_two_below(value), power, "{value}");
        }
        assert_eq!(f64::NAN.power_of_two_below(), 1.0, "no exponent");
        assert_eq!((-6.0_f64).power_of_two_below(), 4.0, "of the magnitude");
    }

    #[test]
    fn rounding_to_f32_goes_outwards() {
        let third = 1.0_f64 / 3.0;
        for value in [third, -third, 1.0, 1e300, -1e300, 0.0, 1e-60, -1e-60] {
            assert!(f64::from(value.as_f32_below()) <= value, "{value} rounded up");
            assert!(f64::from(value.as_f32_above()) >= value, "{value} rounded down");
        }
        assert_eq!(1.5_f64.as_f32_below(), 1.5, "exact values stay");
        assert!(third.as_f32_below() < third.as_f32_above(), "a third lies between two f32");
    }
}
