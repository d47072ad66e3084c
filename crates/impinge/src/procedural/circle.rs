//! Evenly spaced directions around a circle.

use core::f64::consts::FRAC_PI_2;

use crate::math::{Real, Vector};

/// The minimum number of subdivisions of a full turn: one or two corners enclose no area.
pub const MIN_SUBDIVISIONS: u32 = 3;

/// The maximum number of subdivisions of a full turn. The surface of a ball of radius 1 then
/// deviates from the true surface by at most 4e-8, which is below the resolution of `f32`, and the
/// vertices of every surface fit 32-bit indices.
pub const MAX_SUBDIVISIONS: u32 = 1 << 14;

/// Clamps a requested number of subdivisions to the supported range.
pub(super) fn parts_of_turn(subdivisions: u32) -> u32 {
    subdivisions.clamp(MIN_SUBDIVISIONS, MAX_SUBDIVISIONS)
}

/// Returns the unit vector at `index / count` of a full turn from x towards y. `index` may be
/// several times `count`; `count` may be up to four times [`MAX_SUBDIVISIONS`].
///
/// Each vector is computed independently, from an angle of at most 45°: errors do not accumulate,
/// and quarter turns are exact.
pub(super) fn direction<N: Real>(index: u32, count: u32) -> Vector<N, 2> {
    let (quarters, rest) = (4 * index / count, 4 * index % count);
    let is_mirrored = 2 * rest > count;
    let part = if is_mirrored { count - rest } else { rest };
    let (sine, cosine) = N::lit(f64::from(part) / f64::from(count) * FRAC_PI_2).sine_cosine();
    let (x, y) = if is_mirrored { (sine, cosine) } else { (cosine, sine) };
    // Subtracted from zero, so that no zero is negative.
    match quarters % 4 {
        0 => Vector::<N, 2>::new(x, y),
        1 => Vector::<N, 2>::new(N::ZERO - y, x),
        2 => Vector::<N, 2>::new(N::ZERO - x, N::ZERO - y),
        _ => Vector::<N, 2>::new(y, N::ZERO - x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[expect(clippy::disallowed_methods, reason = "another source to compare with")]
    fn check<N: Real>() {
        let quarters = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]];
        for (index, expected) in (0..).zip(quarters) {
            let expected = Vector::<f64, 2>::from(expected).map(N::lit);
            for count in [4, 8, 1 << 16] {
                assert_eq!(direction::<N>(index * count / 4, count), expected, "exact quarters");
            }
        }
        for count in [3, 5, 12, 360, 1 << 16] {
            for index in 0..=count {
                let (sine, cosine) =
                    (f64::from(index) / f64::from(count) * 4.0 * FRAC_PI_2).sin_cos();
                let found = direction::<N>(index, count).map(N::as_f64);
                let error = (found - Vector::<f64, 2>::new(cosine, sine)).norm();
                // The reference is the standard library at an angle up to 2π, which is itself
                // rounded.
                let allowed = 1.5 * N::EPSILON.as_f64() + 4.0 * f64::EPSILON;
                assert!(error <= allowed, "{index} of {count}: off by {error}");
            }
        }
    }

    #[test]
    fn directions_are_those_of_the_library() {
        check::<f32>();
        check::<f64>();
    }

    #[test]
    fn counts_are_clamped() {
        let counts = [0, 2, 3, 100, u32::MAX].map(parts_of_turn);
        assert_eq!(counts, [3, 3, 3, 100, MAX_SUBDIVISIONS], "to what can be built");
    }
}
