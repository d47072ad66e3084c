//! Exact areas and volumes for points on the lattice of multiples of 2⁻⁶⁰ with coordinates below 2.
//!
//! Multiplied by 2⁶⁰, such a coordinate is an integer of 61 bits and a sign. A difference of two
//! coordinates has 62 bits. A 2×2 minor of differences has 125 bits, which fit an `i128`. A volume
//! has about 190 bits, so its minors are split in two. No product underflows.

use crate::math::{Mapped, Point, Vector, filled};

type P2 = Point<f64, 2>;
type P3 = Point<f64, 3>;

/// 2⁶⁰, the number of lattice steps per unit.
const PER_UNIT: f64 = (1_u64 << 60) as f64;

/// The number of bits of the lower half of a minor.
const HALF: u32 = 63;

/// 2⁶³, the weight of the upper half of a minor.
const PER_HALF: f64 = (1_u64 << HALF) as f64;

/// Rounds a number to the nearest multiple of 2⁻⁶⁰.
pub(super) fn rounded(x: f64) -> f64 {
    // The magnitude of the sum lies between 2⁻⁸ and 2⁻⁷, where doubles are 2⁻⁶⁰ apart, so the
    // addition rounds. Larger numbers are multiples already.
    let rounder = (1.0_f64 / 256.0).copysign(x);
    if x.abs() < 1.0 / 256.0 { (x + rounder) - rounder } else { x }
}

#[expect(clippy::cast_possible_truncation, reason = "it is whole and has 61 bits")]
fn whole(x: f64) -> i64 {
    (x * PER_UNIT) as i64
}

/// Returns `p - q` as integers, in lattice steps.
fn offset<const D: usize>(p: &Point<f64, D>, q: &Point<f64, D>) -> [i64; D] {
    filled(|axis| whole(p[axis]) - whole(q[axis]))
}

/// Returns `a · d − b · c`.
fn minor(a: i64, b: i64, c: i64, d: i64) -> i128 {
    i128::from(a) * i128::from(d) - i128::from(b) * i128::from(c)
}

/// Returns the cross product of two integer vectors.
fn minors([ux, uy, uz]: [i64; 3], [vx, vy, vz]: [i64; 3]) -> [i128; 3] {
    [minor(uy, uz, vy, vz), minor(uz, ux, vz, vx), minor(ux, uy, vx, vy)]
}

/// Converts an integer in squared lattice steps to an area.
#[expect(clippy::cast_precision_loss, reason = "rounds to nearest")]
fn area_of(minor: i128) -> f64 {
    minor as f64 / (PER_UNIT * PER_UNIT)
}

/// Returns twice the area of the triangle, positive if it is counter-clockwise. The sign is exact.
///
/// The error bound of the rounded determinant is from Shewchuk, "Adaptive Precision Floating-Point
/// Arithmetic and Fast Robust Geometric Predicates" (1997).
pub(super) fn area(a: &P2, b: &P2, c: &P2) -> f64 {
    let (u, v) = (a - c, b - c);
    let (left, right) = (u.x * v.y, u.y * v.x);
    let (area, bound) = (left - right, 4.0 * f64::EPSILON * (left.abs() + right.abs()));
    if area.abs() > bound { area } else { exact_area(a, b, c) }
}

#[cold]
fn exact_area(a: &P2, b: &P2, c: &P2) -> f64 {
    let ([ux, uy], [vx, vy]) = (offset(a, c), offset(b, c));
    area_of(minor(ux, uy, vx, vy))
}

/// Returns the normal of the triangle on the side from which its corners run counter-clockwise. The
/// length of the normal is twice the area. Each coordinate is the double nearest to the exact
/// value.
pub(super) fn area_vector([a, b, c]: [&P3; 3]) -> Vector<f64, 3> {
    Vector::from(minors(offset(b, a), offset(c, a)).mapped(area_of))
}

/// Returns six times the volume of the tetrahedron, accurate up to rounding. Positive if `q` lies
/// on the side of the triangle from which its corners appear counter-clockwise; exactly 0 if `q`
/// lies in the plane of the triangle.
#[expect(clippy::cast_possible_truncation, reason = "an upper half has 62 bits, a lower one 63")]
#[expect(clippy::cast_precision_loss, reason = "rounds to nearest")]
#[cold]
pub(super) fn volume([a, b, c]: [&P3; 3], q: &P3) -> f64 {
    let minors = minors(offset(b, a), offset(c, a));
    // The volume is `upper · 2⁶³ + lower`, and 0 ≤ lower < 2⁶³ once the carry has moved.
    let (mut upper, mut lower) = (0, 0);
    for (minor, along) in minors.into_iter().zip(offset(q, a)) {
        upper += i128::from((minor >> HALF) as i64) * i128::from(along);
        lower += i128::from(minor as i64 & i64::MAX) * i128::from(along);
    }
    upper += lower >> HALF;
    lower &= i128::from(i64::MAX);
    // If the upper half has more than 64 bits, the lower half is below the rounding error of the
    // result.
    let is_short = i128::from(upper as i64) == upper;
    let value = if is_short { ((upper << HALF) + lower) as f64 } else { upper as f64 * PER_HALF };
    value / (PER_UNIT * PER_UNIT) / PER_UNIT
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::exact;

    /// Returns a generator of numbers from −2 to 2 on the lattice, of all magnitudes.
    fn numbers() -> impl FnMut() -> f64 {
        let mut state = 1_u64;
        move || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            let value = f64::from((state >> 32) as u32) / f64::from(1_u32 << 30) - 2.0;
            let power = i32::try_from(state >> 20 & 63).expect("small");
            rounded(value * 0.5_f64.powi(power))
        }
    }

    #[test]
    fn numbers_are_rounded_to_the_lattice() {
        let step = 1.0 / PER_UNIT;
        for (x, expected) in
            [(0.0, 0.0), (1.5, 1.5), (1e-30, 0.0), (0.7 * step, step), (-2.2 * step, -2.0 * step)]
        {
            assert_eq!(rounded(x), expected, "{x}");
        }
        let mut next = numbers();
        for _ in 0..1000 {
            let x = next();
            assert_eq!((x * PER_UNIT).fract(), 0.0, "{x}");
            assert_eq!(whole(x) as f64, x * PER_UNIT, "{x}");
        }
    }

    /// Tests that volumes, area vectors and the signs of 2D areas agree with the results of
    /// [`exact`], for random points and for points that are, up to rounding, in the plane of the
    /// triangle.
    #[test]
    fn volumes_are_those_of_expansions() {
        let mut next = numbers();
        let mut flat = 0;
        for round in 0..4000 {
            let mut point = || P3::from(Vector::<f64, 3>::from_fn(|_, _| next()));
            let [a, b, c, mut q] = [(); 4].mapped(|()| point());
            if round % 2 == 0 {
                // A point in the plane up to rounding, sometimes exactly.
                q = (a + (b - a) * 0.25 + (c - a) * 0.5).map(rounded);
            }
            let (found, expected) = (volume([&a, &b, &c], &q), exact::volume(&a, &b, &c, &q));
            assert!((found - expected).abs() <= 1e-6 * expected.abs(), "{found} for {expected}");
            assert_eq!(found == 0.0, expected == 0.0, "{found} for {expected}");
            flat += u32::from(found.abs() < 1e-15);
            let (found, expected) = (area_vector([&a, &b, &c]), exact::area_vector(&a, &b, &c));
            assert!((found - expected).norm() <= 1e-15 * expected.norm(), "{found} for {expected}");
            let found = area(&a.xy(), &b.xy(), &c.xy());
            let expected = exact::area(&a.xy(), &b.xy(), &c.xy());
            assert_eq!(found.partial_cmp(&0.0), expected.partial_cmp(&0.0), "{a} {b} {c}");
        }
        assert!(flat > 1000, "half of the points lie in the plane: {flat}");
    }

    #[test]
    fn volumes_of_the_largest_and_of_the_least() {
        let (far, step) = (2.0_f64.next_down(), 1.0 / PER_UNIT);
        let corners = [[-far, -far, -far], [far, far, -far], [-far, far, far]].mapped(P3::from);
        let [a, b, c] = &corners;
        let found = volume([a, b, c], &P3::new(far, -far, far));
        assert_eq!(
            found.abs(),
            exact::volume(a, b, c, &P3::new(far, -far, far)).abs(),
            "as large as they come"
        );
        let [a, b, c] = [[0.0, 0.0, 0.0], [step, 0.0, 0.0], [0.0, step, 0.0]].mapped(P3::from);
        assert_eq!(
            volume([&a, &b, &c], &P3::new(1.0, 1.0, step)),
            step * step * step,
            "one step high"
        );
        assert_eq!(
            volume([&a, &b, &c], &P3::new(1.0, 1.0, -step)),
            -step * step * step,
            "one step low"
        );
        assert_eq!(volume([&a, &b, &c], &P3::new(1.0, 1.0, 0.0)), 0.0, "in the plane");
    }
}
