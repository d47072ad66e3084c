//! Orientation predicates in 2D and 3D with the exact sign.
//!
//! The method is from Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
//! Geometric Predicates" (1997): a rounded determinant with a bound on its error and, if the bound
//! does not decide the sign, the exact determinant as an unevaluated sum of doubles. Two stages
//! suffice here, as the second is rare. The sign is exact unless a product underflows, which needs
//! differences below 1e-90 for coordinates of magnitude 1. The sign may then be wrong, but the
//! callers still terminate.

use crate::math::Mapped;
use smallvec::SmallVec;

use super::outward::sum_and_error;
use super::{Point, Vector};

type P2 = Point<f64, 2>;
type P3 = Point<f64, 3>;

/// A number as an unevaluated sum of nonoverlapping doubles in order of increasing magnitude; empty
/// for zero.
type Expansion = SmallVec<[f64; 32]>;

/// Splits a double into the sum of two doubles with 26 significant bits each (Dekker, Veltkamp).
fn split(a: f64) -> (f64, f64) {
    let c = 134_217_729.0 * a;
    let high = c - (c - a);
    (high, a - high)
}

/// Returns the rounded product `a · b` and its rounding error. It does not use fused multiply-add,
/// so that the bits are equal on every machine.
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let product = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    let error = product - a_high * b_high - a_low * b_high - a_high * b_low;
    (product, a_low * b_low - error)
}

/// Adds a double to an expansion without rounding error.
fn grow(expansion: &mut Expansion, addend: f64) {
    let mut carry = addend;
    let mut kept = 0;
    for at in 0..expansion.len() {
        let (sum, error) = sum_and_error(carry, expansion[at]);
        carry = sum;
        if error != 0.0 {
            expansion[kept] = error;
            kept += 1;
        }
    }
    expansion.truncate(kept);
    if carry != 0.0 {
        expansion.push(carry);
    }
}

/// Returns `a − b` as an expansion, without rounding error.
fn difference(a: f64, b: f64) -> Expansion {
    let (high, low) = sum_and_error(a, -b);
    let mut expansion = Expansion::new();
    grow(&mut expansion, low);
    grow(&mut expansion, high);
    expansion
}

/// Adds `sign · a · b` to the expansion `sum` without rounding error. `sign` is 1 or −1.
fn add_product(sum: &mut Expansion, a: &[f64], b: &[f64], sign: f64) {
    for &x in a {
        for &y in b {
            let (high, low) = two_product(sign * x, y);
            grow(sum, low);
            grow(sum, high);
        }
    }
}

/// Returns `a · d − b · c` as an expansion, without rounding error.
fn minor(a: &[f64], b: &[f64], c: &[f64], d: &[f64]) -> Expansion {
    let mut sum = Expansion::new();
    add_product(&mut sum, a, d, 1.0);
    add_product(&mut sum, b, c, -1.0);
    sum
}

/// Returns the rounded value of an expansion. Its sign is exact, since the last term exceeds the
/// sum of all other terms in magnitude.
fn value(expansion: &[f64]) -> f64 {
    expansion.iter().sum::<f64>()
}

/// Returns twice the signed area of the triangle `abc`, positive if its corners are
/// counter-clockwise. The sign is exact.
pub(crate) fn area(a: &P2, b: &P2, c: &P2) -> f64 {
    let (u, v) = (a - c, b - c);
    let (left, right) = (u.x * v.y, u.y * v.x);
    let (det, bound) = (left - right, 4.0 * f64::EPSILON * (left.abs() + right.abs()));
    if det.abs() > bound { det } else { area_exact(a, b, c) }
}

fn area_exact(a: &P2, b: &P2, c: &P2) -> f64 {
    let (ux, uy) = (difference(a.x, c.x), difference(a.y, c.y));
    let (vx, vy) = (difference(b.x, c.x), difference(b.y, c.y));
    value(&minor(&ux, &uy, &vx, &vy))
}

/// The rounded determinant of [`volume`] is used if its magnitude exceeds this fraction of the sum
/// of the magnitudes of its terms.
const MARGIN: f64 = 4.0 * 1_048_576.0 * f64::EPSILON;

/// Returns `a · b − c · d` with a relative error of about ε, despite cancellation.
fn product_difference(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let ((left, left_error), (right, right_error)) = (two_product(a, b), two_product(c, d));
    (left - right) + (left_error - right_error)
}

/// Returns the normal of the triangle on the side from which it appears counter-clockwise, with a
/// length of twice its area. The error of each component is about ε times its magnitude plus ε²
/// times the product of the lengths of two sides, so slivers have normals too.
pub(crate) fn area_vector(a: &P3, b: &P3, c: &P3) -> Vector<f64, 3> {
    let two_sums = |p: &P3| [0, 1, 2].mapped(|axis| sum_and_error(p[axis], -a[axis]));
    let (u, v) = (two_sums(b), two_sums(c));
    Vector::<f64, 3>::from_fn(|axis, _| {
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        let head = product_difference(u[i].0, v[j].0, u[j].0, v[i].0);
        let tail = u[i].0 * v[j].1 + u[i].1 * v[j].0 - u[j].0 * v[i].1 - u[j].1 * v[i].0;
        head + tail
    })
}

/// Returns six times the volume of the tetrahedron, positive if `q` lies on the side of the
/// triangle `abc` from which `abc` appears counter-clockwise. The sign is exact.
#[inline]
pub(crate) fn volume(a: &P3, b: &P3, c: &P3, q: &P3) -> f64 {
    let (u, v, w): (Vector<f64, 3>, Vector<f64, 3>, Vector<f64, 3>) = (a - q, b - q, c - q);
    let (vw, wv) = (v.x * w.y, v.y * w.x);
    let (wu, uw) = (w.x * u.y, w.y * u.x);
    let (uv, vu) = (u.x * v.y, u.y * v.x);
    let det = u.z * (vw - wv) + v.z * (wu - uw) + w.z * (uv - vu);
    let permanent = u.z.abs() * (vw.abs() + wv.abs())
        + v.z.abs() * (wu.abs() + uw.abs())
        + w.z.abs() * (uv.abs() + vu.abs());
    // Shewchuk's bound is 7 half-units. Requiring a million times this bound also limits the
    // relative error of the magnitude to 1e-6. Heights over slivers need this accuracy. The exact
    // stage is still rare.
    if det.abs() > MARGIN * permanent { -det } else { volume_exact([a, b, c], q) }
}

/// Computes [`volume`] from the exact determinant.
#[cold]
fn volume_exact(corners: [&P3; 3], q: &P3) -> f64 {
    let [u, v, w] = corners.map(|p| [0, 1, 2].map(|axis| difference(p[axis], q[axis])));
    let mut sum = Expansion::new();
    add_product(&mut sum, &minor(&v[0], &v[1], &w[0], &w[1]), &u[2], -1.0);
    add_product(&mut sum, &minor(&w[0], &w[1], &u[0], &u[1]), &v[2], -1.0);
    add_product(&mut sum, &minor(&u[0], &u[1], &v[0], &v[1]), &w[2], -1.0);
    value(&sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sign_survives_where_rounding_loses_it() {
        // Kettner et al., "Classroom Examples of Robustness Problems" (2004): a grid of
        // neighbouring doubles around a point of the line y = x, whose side the rounded determinant
        // gets wrong.
        let step = f64::EPSILON / 2.0;
        let (b, c) = (P2::new(12.0, 12.0), P2::new(24.0, 24.0));
        let mut rounded_wrong = 0;
        for i in 0..64_u32 {
            for j in 0..64_u32 {
                let a = P2::new(0.5 + f64::from(i) * step, 0.5 + f64::from(j) * step);
                let expected = f64::from(j) - f64::from(i);
                let sign = |x: f64| if x == 0.0 { 0.0 } else { x.signum() };
                assert_eq!(sign(area(&a, &b, &c)), sign(expected), "{a}");
                let rounded = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
                rounded_wrong += u32::from(sign(rounded) != sign(expected));
            }
        }
        assert!(rounded_wrong > 100, "the example is hard: {rounded_wrong} of 4096");
    }

    #[test]
    fn volumes_are_positive_in_front() {
        let [a, b, c] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].mapped(P3::from);
        assert_eq!(volume(&a, &b, &c, &P3::new(0.25, 0.25, 3.0)), 3.0, "above");
        assert_eq!(volume(&a, &b, &c, &P3::new(7.0, -4.0, 0.0)), 0.0, "in 2D");
        assert_eq!(volume_exact([&a, &b, &c], &P3::new(0.25, 0.25, 3.0)), 3.0, "exactly");
        let tiny = volume(&a, &b, &c, &P3::new(0.1, 0.7, -1e-60));
        assert!(tiny < 0.0 && tiny > -1.1e-60, "{tiny} just below");
    }

    #[test]
    fn slivers_have_normals() {
        let (a, b) = (P3::new(0.1, 0.3, 0.7), P3::new(1.1, 1.3, 1.7));
        let c = P3::new(0.6, 0.8, 1.2 + f64::EPSILON);
        let normal = area_vector(&a, &b, &c);
        // The normal is accurate: the heights of `b` and `c` over the plane through `a` with this
        // normal vanish up to rounding.
        for p in [b, c] {
            let height = normal.normalize().dot(&(p - a));
            assert!(height.abs() < 1e-16, "{p} lies {height} out of the plane");
        }
        assert!(normal.norm() > 1e-17, "a sliver is not nothing: {normal}");
    }

    #[test]
    fn exact_volumes_of_a_thin_tetrahedron() {
        // Three points whose coordinate differences need more than 53 bits.
        let far = 1.0 + f64::EPSILON;
        let [a, b, c] = [[1e-20, 0.0, far], [far, 1e-20, 0.0], [0.0, far, 1e-20]].mapped(P3::from);
        let inside = P3::from((a.coords + b.coords + c.coords) / 3.0);
        for (x, expected) in [(inside.x + 1e-15, 1.0), (inside.x - 1e-15, -1.0)] {
            let q = P3::new(x, inside.y, inside.z);
            assert_eq!(volume(&a, &b, &c, &q).signum(), expected, "{q}");
            assert_eq!(volume_exact([&a, &b, &c], &q).signum(), expected, "{q} exactly");
        }
    }
}
