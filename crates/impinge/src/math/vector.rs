//! Vector operations, and versions of nalgebra's operations that are safe for extreme lengths.

use super::{Point, Real, Vector};

/// Returns the smaller of two numbers; the second if either is NaN.
#[inline]
pub fn min<N: Real>(a: N, b: N) -> N {
    if a < b { a } else { b }
}

/// Returns the larger of two numbers; the second if either is NaN.
#[inline]
pub fn max<N: Real>(a: N, b: N) -> N {
    if a > b { a } else { b }
}

/// Returns the largest magnitude among the components; 0 if all are zero or NaN.
#[inline]
pub fn max_component<N: Real, const D: usize>(v: &Vector<N, D>) -> N {
    let mut largest = N::ZERO;
    for axis in 0..D {
        largest = max(v[axis].abs(), largest);
    }
    largest
}

/// Returns the unit vector along `v` and the length of `v`; `None` for a zero or non-finite vector.
///
/// Scales `v` by a power of two if its squared length overflows or underflows, so that the result
/// is accurate. Scaling `v` by a power of two scales the length exactly.
#[inline]
pub fn unit<N: Real, const D: usize>(v: &Vector<N, D>) -> Option<(Vector<N, D>, N)> {
    let squared = v.norm_squared();
    // The common case needs no rescaling: the square is far from both ends of the range.
    let (small, large) = (N::MIN_POSITIVE.sqrt(), N::MAX.sqrt());
    if squared > small && squared < large {
        let length = squared.sqrt();
        return Some((v / length, length));
    }
    let scale = max_component(v).power_of_two_below();
    let scaled = v / scale;
    let length = scaled.norm();
    let usable = length > N::ZERO && length.is_finite_number();
    usable.then(|| (scaled / length, length * scale))
}

/// Returns the unit vector along `v`, or `fallback` if `v` is zero or not finite.
#[inline]
pub fn unit_or<N: Real, const D: usize>(v: &Vector<N, D>, fallback: Vector<N, D>) -> Vector<N, D> {
    unit(v).map_or(fallback, |(direction, _)| direction)
}

/// Returns `v` rotated by 90° counter-clockwise.
#[inline]
pub fn perp<N: Real>(v: &Vector<N, 2>) -> Vector<N, 2> {
    Vector::<N, 2>::new(-v.y, v.x)
}

/// Returns the signed area of the parallelogram of `a` and `b`: positive if `b` is
/// counter-clockwise of `a`.
#[inline]
pub fn cross2<N: Real>(a: &Vector<N, 2>, b: &Vector<N, 2>) -> N {
    a.x * b.y - a.y * b.x
}

/// Returns the cross product `a × b`.
#[inline]
pub fn cross<N: Real>(a: &Vector<N, 3>, b: &Vector<N, 3>) -> Vector<N, 3> {
    Vector::<N, 3>::new(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x)
}

/// Returns a unit vector perpendicular to the unit vector `d`, as close as possible to the axis
/// along which the component of `d` has the smallest magnitude (the first such axis).
pub fn perpendicular_to<N: Real, const D: usize>(d: &Vector<N, D>) -> Vector<N, D> {
    let mut least = 0;
    for axis in 1..D {
        if d[axis].abs() < d[least].abs() {
            least = axis;
        }
    }
    let mut v = -d * d[least];
    v[least] += N::ONE;
    unit_or(&v, v)
}

/// Returns two unit vectors `u` and `v` that complete the unit vector `n` to a right-handed basis
/// `(u, v, n)`.
///
/// The method is from Duff et al., "Building an Orthonormal Basis, Revisited" (JCGT 2017). It has
/// no branch except for the sign.
#[inline]
pub fn orthonormal_basis<N: Real>(n: &Vector<N, 3>) -> (Vector<N, 3>, Vector<N, 3>) {
    let sign = if n.z < N::ZERO { -N::ONE } else { N::ONE };
    let a = -N::ONE / (sign + n.z);
    let b = n.x * n.y * a;
    let u = Vector::<N, 3>::new(N::ONE + sign * n.x * n.x * a, sign * b, -sign * n.x);
    let v = Vector::<N, 3>::new(b, sign + n.y * n.y * a, -n.y);
    (u, v)
}

/// Returns the mean of the points; the origin if there are none.
pub fn centroid<N: Real, const D: usize>(points: &[Point<N, D>]) -> Point<N, D> {
    let sum = points.iter().fold(Vector::<N, D>::zeros(), |sum, p| sum + p.coords);
    let count = points.iter().fold(N::ZERO, |count, _| count + N::ONE);
    Point::from(if points.is_empty() { sum } else { sum / count })
}

/// The largest accepted deviation from 1 of the squared length of a unit vector or of a rotation's
/// quaternion. It allows for rounding errors that accumulate over hours of simulation.
const UNIT_SLACK: f64 = 1.0 / 64.0;

/// Returns whether `squared_length` is the square of a length within 0.8 % of 1, as for a unit
/// vector or the quaternion of a rotation. `false` for NaN.
#[inline]
pub(crate) fn is_unit<N: Real>(squared_length: N) -> bool {
    (squared_length - N::ONE).abs() <= N::lit(UNIT_SLACK)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_survives_extreme_lengths() {
        for length in [1e-42_f32, 1e-30, 1.0, 1e30] {
            let (direction, found) = unit(&Vector::<f32, 2>::new(0.0, -length)).expect("finite");
            assert_eq!(direction, Vector::<f32, 2>::new(0.0, -1.0), "length {length}");
            assert_eq!(found, length, "the length comes back");
        }
        assert_eq!(unit(&Vector::<f32, 3>::zeros()), None, "zero has no direction");
        assert_eq!(unit(&Vector::<f32, 3>::new(f32::NAN, 0.0, 1.0)), None, "nor has NaN");
    }

    #[test]
    fn basis_is_right_handed() {
        for n in [[0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [0.6, 0.0, 0.8], [0.0, -1.0, 0.0]] {
            let n = Vector::<f64, 3>::from(n);
            let (u, v) = orthonormal_basis(&n);
            assert!((cross(&u, &v) - n).norm() < 1e-15, "{n}");
        }
    }

    #[test]
    fn minimum_of_nan_is_the_second() {
        assert_eq!(min(f32::NAN, 1.0), 1.0, "as documented");
        assert_eq!(max(f32::NAN, 1.0), 1.0, "as documented");
    }
}
