//! The scalar types: `f32` and, with the feature `f64`, `f64`.

use super::max;
use super::na::{RealField, Scalar};
use super::simd::Eight;
use crate::tables::Compiled;

/// A floating-point scalar of the library: `f32` or, with the feature `f64`, `f64`.
///
/// Sealed: the kernels are compiled in this crate for these two types and no other.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a scalar of impinge",
    label = "neither `f32` nor, with the feature `f64` of impinge, `f64`",
    note = "scalars are `f32` and, with the feature `f64`, `f64`; generic code asks for `N: Real`"
)]
pub trait Real: RealField + Scalar + Copy + Default + Compiled<2> + Compiled<3> + Eight {
    /// 0.
    const ZERO: Self;
    /// 1/2.
    const HALF: Self;
    /// 1.
    const ONE: Self;
    /// 2.
    const TWO: Self;
    /// The distance from 1 to the next larger number; tolerances are multiples of this times a
    /// length.
    const EPSILON: Self;
    /// The largest finite number.
    const MAX: Self;
    /// The smallest positive normal number.
    const MIN_POSITIVE: Self;
    /// Positive infinity.
    const INFINITY: Self;
    /// π/2 as a sum of three parts, the largest first. The products of the first two parts with
    /// integers up to 2¹⁶ are exact (W. J. Cody and W. Waite, "Software Manual for the Elementary
    /// Functions", 1980).
    #[doc(hidden)]
    const QUARTER_TURN: [Self; 3];

    /// Returns the scalar nearest to a literal.
    fn lit(value: f64) -> Self;
    /// Returns the value as `f64`, exactly.
    fn as_f64(self) -> f64;
    /// Returns the value rounded to the nearest `f32`.
    #[expect(clippy::cast_possible_truncation, reason = "rounds to nearest, as documented")]
    #[inline]
    fn as_f32(self) -> f32 {
        self.as_f64() as f32
    }
    /// Returns the largest `f32` that is not above the value (−∞ below the range of `f32`); a zero
    /// is positive.
    #[inline]
    fn as_f32_below(self) -> f32 {
        f32_below(self.as_f64())
    }
    /// Returns the smallest `f32` that is not below the value (+∞ above the range of `f32`); a zero
    /// is positive.
    #[inline]
    fn as_f32_above(self) -> f32 {
        f32_above(self.as_f64())
    }
    /// Returns the bits of the value, zero-extended to 64 bits.
    fn bits(self) -> u64;
    /// Returns the number with these bits: the inverse of [`Self::bits`]. For `f32` only the lowest
    /// 32 bits are used.
    fn of_bits(bits: u64) -> Self;
    /// Returns the largest power of two that is not above the magnitude. Division by it is exact
    /// unless the quotient underflows.
    ///
    /// For zero and subnormal numbers the result is the smallest positive normal number, for
    /// infinity and NaN it is 1.
    #[must_use]
    fn power_of_two_below(self) -> Self;
    /// Returns whether the value is neither infinite nor NaN.
    fn is_finite_number(self) -> bool;
    /// Returns the sine and the cosine of the value, in radians. The crate `libm` computes them in
    /// software, so they are bitwise equal on every platform.
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

    #[inline]
    fn bits(self) -> u64 {
        u64::from(self.to_bits())
    }

    #[expect(clippy::cast_possible_truncation, reason = "the upper half does not count")]
    #[inline]
    fn of_bits(bits: u64) -> Self {
        Self::from_bits(bits as u32)
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

/// Implements [`Real::power_of_two_below`] for `f64`; also available without the feature `f64`.
#[inline]
pub(crate) fn f64_power_of_two_below(value: f64) -> f64 {
    let power = f64::from_bits(value.to_bits() & 0x7ff0_0000_0000_0000);
    if !power.is_finite() {
        1.0
    } else if power > f64::MIN_POSITIVE {
        power
    } else {
        f64::MIN_POSITIVE
    }
}

/// Returns the largest `f32` that is not above a number; a zero is positive. Compiles to selections
/// instead of branches, since the direction of rounding is unpredictable.
#[expect(clippy::cast_possible_truncation, reason = "one step down where it went up")]
#[inline]
pub(crate) fn f32_below(x: f64) -> f32 {
    let nearest = x as f32 + 0.0;
    let bits = nearest.to_bits();
    let smaller = if nearest > 0.0 { bits.wrapping_sub(1) } else { bits.wrapping_add(1) };
    let smaller = if nearest == 0.0 { 0x8000_0001 } else { smaller };
    f32::from_bits(if f64::from(nearest) > x { smaller } else { bits })
}

/// Returns the smallest `f32` that is not below a number; a zero is positive.
#[inline]
pub(crate) fn f32_above(x: f64) -> f32 {
    0.0 - f32_below(-x)
}

#[cfg(test)]
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
        let mut values = vec![0.0, 1e-60, 1e300, f64::INFINITY, f64::from(f32::MAX), 1e-40, 1.5];
        values.extend((1..2000).map(|k| f64::from(k) / 3.0 * 1.37_f64.powi(k % 100 - 50)));
        for x in values.iter().flat_map(|&x| [x, -x]) {
            let (below, above) = (x.as_f32_below(), x.as_f32_above());
            assert!(f64::from(below) <= x && f64::from(above) >= x, "{x} rounded inwards");
            let is_nearest = below == above || below.next_up() == above;
            assert!(is_nearest, "{x} lies between neighbours {below} and {above}");
            assert_eq!(below == above, f64::from(x.as_f32()) == x, "{x}: exact values stay");
        }
        assert_eq!((-0.1_f32).as_f32_below(), -0.1, "all of `f32` is exact");
        for zero in
            [(-0.0_f64).as_f32_below(), (-0.0_f64).as_f32_above(), (-0.0_f32).as_f32_below()]
        {
            assert_eq!(zero.to_bits(), 0, "zeros are positive");
        }
        assert!(f64::NAN.as_f32_below().is_nan() && f32::NAN.as_f32_above().is_nan(), "NaN stays");
    }
}
