//! Arithmetic on plain arrays: `[f64; D]` is a point, a vector or a direction.

/// Returns `a + b`.
#[must_use]
pub fn add<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| a[i] + b[i])
}

/// Returns `a - b`.
#[must_use]
pub fn sub<const D: usize>(a: &[f64; D], b: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|i| a[i] - b[i])
}

/// Returns `a * factor`.
#[must_use]
pub fn scale<const D: usize>(a: &[f64; D], factor: f64) -> [f64; D] {
    a.map(|x| x * factor)
}

/// Returns `-a`.
#[must_use]
pub fn negate<const D: usize>(a: &[f64; D]) -> [f64; D] {
    a.map(|x| -x)
}

/// Returns the dot product.
#[must_use]
pub fn dot<const D: usize>(a: &[f64; D], b: &[f64; D]) -> f64 {
    let mut sum = 0.0;
    for i in 0..D {
        sum += a[i] * b[i];
    }
    sum
}

/// Returns the Euclidean length. Squares stay in range for lengths between about 1e-150 and 1e150.
#[must_use]
pub fn norm<const D: usize>(a: &[f64; D]) -> f64 {
    dot(a, a).sqrt()
}

/// Returns `a` scaled to length one; `None` for the zero vector, and if the length overflows.
#[must_use]
pub fn unit<const D: usize>(a: &[f64; D]) -> Option<[f64; D]> {
    let length = norm(a);
    (length > 0.0 && length.is_finite()).then(|| a.map(|x| x / length))
}

/// Returns the component of `a` perpendicular to the unit vector `direction`.
///
/// The projection is subtracted twice: the first subtraction leaves a remainder of the size of the
/// rounding error of `a`.
#[must_use]
pub fn reject<const D: usize>(a: &[f64; D], direction: &[f64; D]) -> [f64; D] {
    let once = sub(a, &scale(direction, dot(a, direction)));
    sub(&once, &scale(direction, dot(&once, direction)))
}

/// Returns the unit vector along the axis with this index.
#[must_use]
pub fn axis<const D: usize>(index: usize) -> [f64; D] {
    std::array::from_fn(|i| if i == index { 1.0 } else { 0.0 })
}

/// Returns a vector perpendicular to the D-1 given vectors: in 2D the counter-clockwise quarter
/// turn, in 3D the cross product. Zero if the given vectors are linearly dependent.
///
/// # Panics
/// Unless D is 2 or 3 and D-1 vectors are given.
#[must_use]
pub fn perpendicular<const D: usize>(spans: &[[f64; D]]) -> [f64; D] {
    assert_eq!(spans.len() + 1, D, "a hyperplane is spanned by D - 1 vectors");
    let mut result = [0.0; D];
    match D {
        2 => {
            result[0] = -spans[0][1];
            result[1] = spans[0][0];
        }
        3 => {
            let (a, b) = (&spans[0], &spans[1]);
            result[0] = a[1] * b[2] - a[2] * b[1];
            result[1] = a[2] * b[0] - a[0] * b[2];
            result[2] = a[0] * b[1] - a[1] * b[0];
        }
        _ => panic!("only the plane and space are known, not dimension {D}"),
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn perpendicular_turns_left_and_crosses() {
        assert_eq!(perpendicular(&[[1.0, 0.0]]), [0.0, 1.0]);
        assert_eq!(perpendicular(&[[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), [0.0, 0.0, 1.0]);
        assert_eq!(perpendicular(&[[1.0, 2.0, 3.0], [2.0, 4.0, 6.0]]), [0.0; 3]);
    }

    #[test]
    fn unit_of_zero_is_none() {
        assert_eq!(unit(&[0.0, 0.0]), None);
        assert_eq!(unit(&[0.0, -4.0]), Some([0.0, -1.0]));
    }

    #[test]
    fn reject_leaves_the_perpendicular_part() {
        assert_eq!(reject(&[3.0, 4.0, 5.0], &[0.0, 0.0, 1.0]), [3.0, 4.0, 0.0]);
    }
}
