//! Sums and products that are rounded in a known direction, for bounding volumes.
//!
//! The rounding error of a sum is representable (Knuth, "The Art of Computer Programming", volume
//! 2, theorem 4.2.2 B), so a sum with an error of zero is left unchanged. Therefore boxes with
//! representable corners are exact.

use core::ops::{Add, Sub};

use super::Real;

/// Returns the rounded sum `a + b`, and its error: the exact sum minus the rounded sum. The error
/// is NaN if the sum overflows.
#[inline(always)]
pub(super) fn sum_and_error<N: Copy + Add<Output = N> + Sub<Output = N>>(a: N, b: N) -> (N, N) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// Returns `a + b` rounded down by at most two units in the last place. The result equals the exact
/// sum if that is representable. Otherwise it is below the exact sum, unless the sum overflows to
/// infinity.
#[inline(always)]
pub(crate) fn sum_below<N: Real>(a: N, b: N) -> N {
    let (sum, error) = sum_and_error(a, b);
    if error < N::ZERO { sum - sum.abs() * N::EPSILON } else { sum }
}

/// Returns `a + b` rounded up by at most two units in the last place. The result equals the exact
/// sum if that is representable. Otherwise it is above the exact sum, unless the sum overflows to
/// minus infinity.
#[inline(always)]
pub(crate) fn sum_above<N: Real>(a: N, b: N) -> N {
    let (sum, error) = sum_and_error(a, b);
    if error > N::ZERO { sum + sum.abs() * N::EPSILON } else { sum }
}

/// Returns a lower and an upper bound of the exact product. Both bounds equal the product if a
/// factor is zero, or if a factor is a power of two and the product is a normal number. The bounds
/// are infinite or NaN if the product overflows.
pub(crate) fn product_within<N: Real>(a: N, b: N) -> [N; 2] {
    let product = a * b;
    let is_zero_or_power = |x: N| x == N::ZERO || x.abs() == x.power_of_two_below();
    let is_exact = (is_zero_or_power(a) || is_zero_or_power(b)) && product.abs() >= N::MIN_POSITIVE;
    if is_exact || a == N::ZERO || b == N::ZERO {
        return [product; 2];
    }
    let slack = product.abs() * N::EPSILON + smallest::<N>();
    [product - slack, product + slack]
}

/// Returns an upper bound of the error of a few sums and products of lengths up to `size`, as for
/// the coordinates of a rotated point. The bound is 8 ε times `size` plus 8 times the smallest
/// positive number.
#[inline(always)]
pub(crate) fn slack_of<N: Real>(size: N) -> N {
    N::lit(8.0) * (N::EPSILON * size + smallest::<N>())
}

/// Returns the smallest positive (subnormal) number.
#[inline(always)]
fn smallest<N: Real>() -> N {
    N::MIN_POSITIVE * N::EPSILON
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_sums_stay() {
        for (a, b) in
            [(1.0_f32, 2.0), (0.1, -0.1), (16_777_215.0, 1.0), (1e-45, 1e-45), (0.0, -0.0)]
        {
            assert_eq!((sum_below(a, b), sum_above(a, b)), (a + b, a + b), "{a} + {b}");
        }
        assert_eq!(product_within(-2.0_f32, 0.1), [-0.2; 2], "a power of two");
        assert_eq!(product_within(0.0_f32, 1e30), [0.0; 2], "zero");
    }

    #[test]
    fn others_lie_between() {
        let numbers = [1.0_f32, 0.1, -0.3, 1e-8, 3e7, -2e-40, 1.5e-39, 3e38, -3e38, 7e-23];
        for a in numbers {
            for b in numbers {
                // Infinite results have no rounding error to check.
                if (a * b).is_infinite() || (a + b).is_infinite() {
                    continue;
                }
                let exact = f64::from(a) + f64::from(b);
                let [low, high] = [sum_below(a, b), sum_above(a, b)].map(f64::from);
                assert!(low <= exact && exact <= high, "{a} + {b}: {low} to {high}");
                assert!(
                    high - low <= 4e-7 * exact.abs() || high.is_infinite(),
                    "{a} + {b} is narrow"
                );
                let exact = f64::from(a) * f64::from(b);
                let [low, high] = product_within(a, b).map(f64::from);
                assert!(low <= exact && exact <= high, "{a} * {b}: {low} to {high}");
            }
        }
    }
}
