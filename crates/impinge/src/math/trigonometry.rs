//! Sine and cosine in 8 lanes, bitwise equal on every platform.
//!
//! An angle is reduced to at most 45° with the three parts of π/2 (Cody and Waite); then two
//! polynomials, which interpolate sine and cosine at Chebyshev points, are evaluated. The absolute
//! error is at most 2 ε for angles up to [`MAX_ANGLE`]. Lanes with larger or non-finite angles are
//! computed by [`Real::sine_cosine`].

use super::lanes::lit;
use super::simd::{Simd, SimdMask};
use super::{Real, Wide};

/// The greatest angle, in radians, that is reduced in lanes. It is less than 2¹⁶ quarter turns, up
/// to which the reduction by [`Real::QUARTER_TURN`] is accurate.
pub(crate) const MAX_ANGLE: f64 = 1e5;

/// Coefficients of (sin r - r) / r³ in powers of r², for r up to π/4.
const SINE: [f64; 6] = [
    -0.166_666_666_666_666_66,
    0.008_333_333_333_330_7,
    -1.984_126_983_638_543_5e-4,
    2.755_731_591_093_9e-6,
    -2.505_109_230_843_131e-8,
    1.591_530_918_305_772_4e-10,
];

/// Coefficients of (cos r - 1 + r²/2) / r⁴ in powers of r², for r up to π/4.
const COSINE: [f64; 6] = [
    0.041_666_666_666_666_664,
    -1.388_888_888_888_724_1e-3,
    2.480_158_729_853_226e-5,
    -2.755_731_715_185_886_6e-7,
    2.087_612_153_460_845_4e-9,
    -1.138_086_817_144_977_1e-11,
];

/// Returns the sine and the cosine in each lane, for any angle in radians.
#[inline(always)]
pub(crate) fn sine_cosine<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, angle: V) -> [V; 2] {
    let found = reduced(simd, angle);
    let is_near = angle.abs().simd_le(lit(simd, MAX_ANGLE));
    if is_near.all_true() { found } else { mended(simd, angle, found) }
}

/// Returns the sine and the cosine in each lane, for angles up to [`MAX_ANGLE`].
#[inline(always)]
fn reduced<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, angle: V) -> [V; 2] {
    let quarters = rounded(simd, angle * lit(simd, core::f64::consts::FRAC_2_PI));
    let mut rest = angle;
    for part in N::QUARTER_TURN {
        rest = rest - quarters * V::all(simd, part);
    }
    let squared = rest * rest;
    let sine = rest + rest * squared * polynomial(simd, &SINE, squared);
    let fourth = squared * squared * polynomial(simd, &COSINE, squared);
    let cosine = (lit::<S, N, V>(simd, 1.0) - squared * lit(simd, 0.5)) + fourth;
    // The number of quarter turns modulo 4, from -2 to 2, where -2 and 2 are equivalent.
    let quarter = quarters - rounded(simd, quarters * lit(simd, 0.25)) * lit(simd, 4.0);
    let (half, low): (V, V) = (lit(simd, 0.5), lit(simd, -1.5));
    let is_odd = quarter.abs().simd_eq(lit(simd, 1.0));
    let is_below = quarter.simd_gt(-low) | quarter.simd_lt(-half);
    let is_left = quarter.simd_gt(half) | quarter.simd_lt(low);
    let (sine, cosine) = (is_odd.select(cosine, sine), is_odd.select(sine, cosine));
    [is_below.select(-sine, sine), is_left.select(-cosine, cosine)]
}

/// Rounds to the nearest integer. The magnitude must be far below 1 / ε.
#[inline(always)]
fn rounded<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, value: V) -> V {
    let large = V::all(simd, N::lit(1.5) / N::EPSILON);
    (value + large) - large
}

/// Evaluates a polynomial by Horner's rule.
#[inline(always)]
fn polynomial<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    coefficients: &[f64; 6],
    x: V,
) -> V {
    let mut sum = lit(simd, coefficients[5]);
    for power in [4, 3, 2, 1, 0] {
        sum = sum * x + lit(simd, coefficients[power]);
    }
    sum
}

/// Recomputes the lanes whose angle is above [`MAX_ANGLE`] or not finite.
#[inline(always)]
fn mended<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, angle: V, found: [V; 2]) -> [V; 2] {
    let (mut angles, mut pairs) = ([N::ZERO; 8], [[N::ZERO; 8]; 2]);
    angle.store(&mut angles);
    found[0].store(&mut pairs[0]);
    found[1].store(&mut pairs[1]);
    mend(&angles, &mut pairs);
    [V::load(simd, &pairs[0]), V::load(simd, &pairs[1])]
}

#[cold]
#[inline(never)]
fn mend<N: Real>(angles: &[N; 8], [sines, cosines]: &mut [[N; 8]; 2]) {
    for lane in 0..8 {
        let is_near = angles[lane].abs() <= N::lit(MAX_ANGLE);
        if !is_near {
            (sines[lane], cosines[lane]) = angles[lane].sine_cosine();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::lanes::with_lanes;
    use crate::math::simd::Level;

    /// Returns the sines and cosines of angles. Checks that the results of all levels are bitwise
    /// equal.
    fn of<N: Real>(angles: [N; 8]) -> [[N; 8]; 2] {
        let mut all = Level::available().into_iter().map(|level| {
            let mut found = [[N::ZERO; 8]; 2];
            with_lanes!(level, simd => at(simd, &angles, &mut found));
            found
        });
        let first = all.next().expect("the best level");
        for other in all {
            assert_eq!(bits(&other), bits(&first), "of {angles:?}");
        }
        first
    }

    fn bits<N: Real>(numbers: &[[N; 8]; 2]) -> [[u64; 8]; 2] {
        numbers.map(|row| row.map(N::bits))
    }

    #[inline(always)]
    fn at<S: Simd, N: Real>(simd: S, angles: &[N; 8], found: &mut [[N; 8]; 2]) {
        let [sine, cosine] = sine_cosine::<S, N, N::Lanes<S>>(simd, Wide::load(simd, angles));
        sine.store(&mut found[0]);
        cosine.store(&mut found[1]);
    }

    fn agrees_with_the_software_library<N: Real>() {
        let mut state = 7_u64;
        let mut worst = 0.0_f64;
        for round in 0..20_000 {
            let size = [0.01, 1.0, 4.0, 100.0, 1e5, 1e8][round % 6];
            let angles = [(); 8].map(|()| {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
                let share =
                    f64::from(u32::try_from(state >> 32).expect("half")) / f64::from(u32::MAX);
                N::lit(size * (2.0 * share - 1.0))
            });
            let [sines, cosines] = of(angles);
            for lane in 0..8 {
                let (sine, cosine) = libm::sincos(angles[lane].as_f64());
                let apart = |found: N, exact: f64| (found.as_f64() - exact).abs();
                worst = worst.max(apart(sines[lane], sine)).max(apart(cosines[lane], cosine));
            }
        }
        assert!(worst <= 2.0 * N::EPSILON.as_f64(), "off by {worst}");
        assert!(worst > 0.1 * N::EPSILON.as_f64(), "{worst} is too good");
    }

    #[test]
    fn errors_are_at_most_two_units() {
        agrees_with_the_software_library::<f32>();
        agrees_with_the_software_library::<f64>();
    }

    #[test]
    fn no_angle_is_exact() {
        let [sines, cosines] = of([0.0_f32; 8]);
        assert_eq!((sines, cosines), ([0.0; 8], [1.0; 8]), "the identity");
    }

    #[test]
    fn what_is_not_finite_has_no_sine() {
        let inf = f32::INFINITY;
        let [sines, cosines] = of([f32::NAN, inf, -inf, 1e30, -1e30, f32::MAX, 0.0, 1e5]);
        let is_nan = |numbers: [f32; 8]| numbers.map(f32::is_nan);
        let expected = [true, true, true, false, false, false, false, false];
        assert_eq!((is_nan(sines), is_nan(cosines)), (expected, expected), "three of eight");
    }
}
