//! Arithmetic on plain arrays of [`Quad`]; see [`crate::geometry::vector`].

use super::number::Quad;

/// A point, a vector or a direction.
pub type Vector<const D: usize> = [Quad; D];

/// Converts a vector of `f64`, exactly.
#[must_use]
pub fn exact<const D: usize>(v: &[f64; D]) -> Vector<D> {
    v.map(Quad::new)
}

/// Returns the nearest vector of `f64`.
#[must_use]
pub fn rounded<const D: usize>(v: &Vector<D>) -> [f64; D] {
    v.map(Quad::to_f64)
}

/// Returns the zero vector.
#[must_use]
pub fn zero<const D: usize>() -> Vector<D> {
    [Quad::ZERO; D]
}

/// Returns `a + b`.
#[must_use]
pub fn add<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> Vector<D> {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Returns `a - b`.
#[must_use]
pub fn sub<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> Vector<D> {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Returns `a * factor`.
#[must_use]
pub fn scale<const D: usize>(a: &Vector<D>, factor: Quad) -> Vector<D> {
    a.map(|x| x * factor)
}

/// Returns `-a`.
#[must_use]
pub fn negate<const D: usize>(a: &Vector<D>) -> Vector<D> {
    a.map(|x| -x)
}

/// Returns the dot product.
#[must_use]
pub fn dot<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> Quad {
    let mut sum = Quad::ZERO;
    for i in 0..D {
        sum += a[i] * b[i];
    }
    sum
}

/// Returns the Euclidean length.
#[must_use]
pub fn norm<const D: usize>(a: &Vector<D>) -> Quad {
    dot(a, a).sqrt()
}

/// Returns `a` scaled to length one; `None` for the zero vector, and if a component is infinite.
#[must_use]
pub fn unit<const D: usize>(a: &Vector<D>) -> Option<Vector<D>> {
    // Squares of components below 1e-140 would lose digits. Therefore `a` is first scaled to a
    // length near one.
    let size = a.iter().map(|x| x.to_f64().abs()).fold(0.0, f64::max);
    if size == 0.0 || !size.is_finite() {
        return None;
    }
    let near_one = a.map(|x| x / Quad::new(size));
    let length = norm(&near_one);
    Some(near_one.map(|x| x / length))
}

/// Returns the component of `a` perpendicular to `direction`, which may have any length but 0.
#[must_use]
pub fn reject<const D: usize>(a: &Vector<D>, direction: &Vector<D>) -> Vector<D> {
    let share = dot(a, direction) / dot(direction, direction);
    sub(a, &scale(direction, share))
}

/// Returns a vector perpendicular to the D-1 given vectors; see
/// [`crate::geometry::vector::perpendicular`].
///
/// # Panics
/// Unless D is 2 or 3 and D-1 vectors are given.
#[must_use]
pub fn perpendicular<const D: usize>(spans: &[Vector<D>]) -> Vector<D> {
    assert_eq!(spans.len() + 1, D, "a hyperplane is spanned by D - 1 vectors");
    let mut result = zero();
    if D == 2 {
        result[0] = -spans[0][1];
        result[1] = spans[0][0];
        return result;
    }
    let (a, b) = (&spans[0], &spans[1]);
    for (i, component) in result.iter_mut().enumerate() {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        *component = a[j] * b[k] - a[k] * b[j];
    }
    result
}

/// Returns the angle between two unit vectors, computed from the length of their difference:
/// accurate for small angles.
#[must_use]
pub fn angle<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> f64 {
    let chord = norm(&sub(a, b)).to_f64();
    2.0 * (chord / 2.0).min(1.0).asin()
}
