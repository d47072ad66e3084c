//! Numbers of about 31 decimal digits: an unevaluated sum of two `f64`.
//!
//! The error-free sum is that of O. Møller and D. Knuth, the error-free product that of T. Dekker,
//! "A Floating-Point Technique for Extending the Available Precision" (1971). The operations on
//! pairs follow Y. Hida, X. Li and D. Bailey, "Library for Double-Double and Quad-Double
//! Arithmetic" (2007). Each operation is accurate to about 2⁻¹⁰², for magnitudes between about
//! 1e-140 and 1e140.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number of about 31 decimal digits.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Quad {
    /// The nearest `f64`.
    high: f64,
    /// The remainder: at most half a unit in the last place of `high`.
    low: f64,
}

impl Quad {
    /// 0.
    pub const ZERO: Self = Self { high: 0.0, low: 0.0 };
    /// 1.
    pub const ONE: Self = Self { high: 1.0, low: 0.0 };

    /// Returns the number `value`, exactly.
    #[must_use]
    pub const fn new(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// Returns the nearest `f64`.
    #[must_use]
    pub const fn to_f64(self) -> f64 {
        self.high
    }

    /// Returns the absolute value.
    #[must_use]
    pub fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }

    /// Returns the square root; zero for zero and negative numbers.
    #[must_use]
    pub fn sqrt(self) -> Self {
        let positive = self.high > 0.0;
        if !positive {
            return Self::ZERO;
        }
        // Two Newton steps: the first doubles the 53 bits to 106, the second corrects the rounding.
        let mut root = Self::new(self.high.sqrt());
        for _ in 0..2 {
            root = (root + self / root) * Self::new(0.5);
        }
        root
    }

    /// Returns the larger number.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }

    /// Returns the smaller number.
    #[must_use]
    pub fn min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
}

/// Returns the rounded sum `a + b` and its rounding error.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let b_part = sum - a;
    (sum, (a - (sum - b_part)) + (b - b_part))
}

/// Returns the rounded sum `a + b` and its rounding error, for `|a| ≥ |b|`.
fn quick_two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    (sum, b - (sum - a))
}

/// Splits `a` into two numbers of 26 bits whose sum is `a`.
fn split(a: f64) -> (f64, f64) {
    let spread = 134_217_729.0 * a;
    let high = spread - (spread - a);
    (high, a - high)
}

/// Returns the rounded product `a · b` and its rounding error.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a1, a2), (b1, b2)) = (split(a), split(b));
    (product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2)
}

fn pair((high, low): (f64, f64)) -> Quad {
    Quad { high, low }
}

impl Add for Quad {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let (high, rest) = two_sum(self.high, other.high);
        let (low, least) = two_sum(self.low, other.low);
        let (high, rest) = quick_two_sum(high, rest + low);
        pair(quick_two_sum(high, rest + least))
    }
}

impl Sub for Quad {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Quad {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let (high, low) = two_product(self.high, other.high);
        pair(quick_two_sum(high, low + (self.high * other.low + self.low * other.high)))
    }
}

impl Div for Quad {
    type Output = Self;

    /// Divides by long division, with three quotient digits of 53 bits each.
    fn div(self, other: Self) -> Self {
        let first = self.high / other.high;
        let rest = self - other * Self::new(first);
        let second = rest.high / other.high;
        let rest = rest - other * Self::new(second);
        let third = rest.high / other.high;
        pair(quick_two_sum(first, second)) + Self::new(third)
    }
}

impl Neg for Quad {
    type Output = Self;

    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl AddAssign for Quad {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Quad {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl PartialOrd for Quad {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    const ROUNDING: f64 = 2.5e-31;

    fn close(a: Quad, b: Quad) {
        let error = (a - b).abs().to_f64();
        assert!(error <= ROUNDING * b.to_f64().abs(), "{a:?} and {b:?} differ by {error}");
    }

    #[test]
    fn a_third_has_both_halves() {
        let third = Quad::ONE / Quad::new(3.0);
        assert_ne!(third.low, 0.0, "the second half holds digits");
        close(third * Quad::new(3.0), Quad::ONE);
        assert_eq!(third.to_f64(), 1.0 / 3.0, "the first half is the nearest number");
    }

    #[test]
    fn digits_of_the_root_of_two() {
        // 1.41421356237309504880168872420969807856967… in two parts, each of which is the sum of a
        // number of few digits and a small remainder.
        let expected = Quad::new(14_142_135_623_730_950.0) / Quad::new(1e16)
            + Quad::new(4_880_168_872_420_970.0) / Quad::new(1e32);
        assert!((Quad::new(2.0).sqrt() - expected).abs().to_f64() < 4e-32, "32 digits");
        assert_eq!(Quad::new(-2.0).sqrt(), Quad::ZERO, "of no use, but no NaN");
    }

    /// Differences that cancel to zero in `f64` keep their remainder.
    #[test]
    fn small_rests_survive() {
        let small = Quad::new(1e-25);
        close(Quad::ONE + small - Quad::ONE, small + Quad::new(0.0));
        assert_eq!((Quad::new(1e20) + Quad::new(1e-5)) - Quad::new(1e20), Quad::new(1e-5));
    }

    #[test]
    fn laws_hold_on_random_numbers() {
        let mut random = Random::new(1);
        let mut number = || {
            let high = random.range(-4.0, 4.0);
            Quad::new(high) + Quad::new(random.range(-1e-17, 1e-17))
        };
        for _ in 0..1000 {
            let (a, b) = (number(), number());
            close((a * b) / b, a);
            close((a * a).sqrt(), a.abs());
            let (square, parts) = ((a + b) * (a - b), a * a - b * b);
            let scale = (a * a + b * b).to_f64();
            assert!((square - parts).abs().to_f64() < 4.0 * ROUNDING * scale, "{a:?} {b:?}");
            assert_eq!(a < b, b > a, "order");
            assert_eq!(a.max(b) + a.min(b), a + b, "one of them each");
        }
    }
}
