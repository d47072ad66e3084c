//! Eigenvalues and eigenvectors of small symmetric matrices, bitwise equal on every platform.
//!
//! Uses Jacobi rotations, each of which makes one off-diagonal element zero. They need only
//! arithmetic and square roots. Small eigenvalues of positive definite matrices have a small
//! relative error even if other eigenvalues are much larger (Demmel and Veselić, "Jacobi's method
//! is more accurate than QR", 1992).

use super::real::f64_power_of_two_below;
use super::{Matrix, Vector};

/// The maximum number of sweeps over all off-diagonal elements. Near the end each sweep squares the
/// error, so about five sweeps suffice.
const MAX_SWEEPS: usize = 32;

/// An off-diagonal element is negligible if its magnitude is at most this fraction of the geometric
/// mean of the diagonal elements in its row and its column. It is then no larger than the rounding
/// errors of the matrix.
const NEGLIGIBLE: f64 = 8.0 * f64::EPSILON;

/// Returns the eigenvalues of a finite symmetric matrix, and a rotation whose columns are the
/// eigenvectors: `matrix = rotation · diagonal · rotationᵀ`.
///
/// Each Jacobi rotation is by at most 45°. So the eigenvectors of a diagonal matrix are the axes,
/// and the eigenvectors of a nearly diagonal matrix are near the axes, in the order of the axes.
/// Scaling the matrix by powers of two scales the eigenvalues exactly.
pub(crate) fn symmetric_eigen<const D: usize>(
    matrix: &Matrix<f64, D>,
) -> (Vector<f64, D>, Matrix<f64, D>) {
    let largest = matrix
        .iter()
        .fold(0.0, |largest: f64, x| if x.abs() > largest { x.abs() } else { largest });
    let scale = f64_power_of_two_below(largest);
    let (mut diagonal, mut rotation) = (matrix / scale, Matrix::<f64, D>::identity());
    for _ in 0..MAX_SWEEPS {
        let mut is_done = true;
        for (p, q) in (0..D).flat_map(|q| (0..q).map(move |p| (p, q))) {
            let (at_p, beside, at_q) = (diagonal[(p, p)], diagonal[(p, q)], diagonal[(q, q)]);
            if beside * beside > NEGLIGIBLE * NEGLIGIBLE * (at_p * at_q).abs() {
                is_done = false;
                rotate(&mut diagonal, &mut rotation, p, q);
            }
        }
        if is_done {
            break;
        }
    }
    (diagonal.diagonal() * scale, rotation)
}

/// Rotates `matrix` and `rotation` by the angle that makes the element at `(p, q)` zero.
fn rotate<const D: usize>(
    matrix: &mut Matrix<f64, D>,
    rotation: &mut Matrix<f64, D>,
    p: usize,
    q: usize,
) {
    let beside = matrix[(p, q)];
    let cotangent = (matrix[(q, q)] - matrix[(p, p)]) / (2.0 * beside);
    let side = if cotangent < 0.0 { -1.0 } else { 1.0 };
    let tangent = side / (cotangent.abs() + (1.0 + cotangent * cotangent).sqrt());
    let cosine = 1.0 / (1.0 + tangent * tangent).sqrt();
    let sine = tangent * cosine;
    for k in 0..D {
        let (a, b) = (rotation[(k, p)], rotation[(k, q)]);
        rotation[(k, p)] = cosine * a - sine * b;
        rotation[(k, q)] = sine * a + cosine * b;
        if k != p && k != q {
            let (a, b) = (matrix[(k, p)], matrix[(k, q)]);
            (matrix[(k, p)], matrix[(k, q)]) = (cosine * a - sine * b, sine * a + cosine * b);
            (matrix[(p, k)], matrix[(q, k)]) = (matrix[(k, p)], matrix[(k, q)]);
        }
    }
    matrix[(p, p)] -= tangent * beside;
    matrix[(q, q)] += tangent * beside;
    (matrix[(p, q)], matrix[(q, p)]) = (0.0, 0.0);
}

#[cfg(test)]
mod tests {
    use super::*;

    type M3 = Matrix<f64, 3>;
    type V3 = Vector<f64, 3>;

    fn check<const D: usize>(matrix: &Matrix<f64, D>) -> Vector<f64, D> {
        let (values, rotation) = symmetric_eigen(matrix);
        let largest = matrix.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let again = rotation * Matrix::<f64, D>::from_diagonal(&values) * rotation.transpose();
        let off = (again - matrix).iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        assert!(off <= 1e-14 * largest, "off by {off}: {matrix} {values} {rotation}");
        let tilted = rotation.transpose() * rotation - Matrix::<f64, D>::identity();
        assert!(tilted.iter().all(|x| x.abs() < 1e-14), "no rotation: {rotation}");
        values
    }

    #[test]
    fn values_by_hand() {
        let diagonal = M3::from_diagonal(&V3::new(3.0, 1.0, 2.0));
        assert_eq!(
            symmetric_eigen(&diagonal),
            (V3::new(3.0, 1.0, 2.0), M3::identity()),
            "as it is"
        );
        assert_eq!(symmetric_eigen(&M3::zeros()), (V3::zeros(), M3::identity()), "nothing");
        let plane = Matrix::<f64, 2>::new(2.0, 1.0, 1.0, 2.0);
        let values = check(&plane);
        assert!((values - Vector::<f64, 2>::new(1.0, 3.0)).norm() < 1e-15, "{values}");
        // A matrix of rank 1: two of the three eigenvalues are zero.
        let line = V3::new(1.0, 2.0, -2.0);
        let values = check(&(line * line.transpose()));
        assert!((values.sum() - 9.0).abs() < 1e-14 && values.amin() < 1e-15, "{values}");
    }

    #[test]
    fn random_matrices_of_all_sizes() {
        let mut state = 5_u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
        };
        for round in 0..2000 {
            let flat = [1.0, 1e-4, 1e-9][round % 3];
            let half = M3::from_fn(|row, _| random() * if row == 0 { flat } else { 1.0 });
            let matrix = half.transpose() * half;
            let values = check(&matrix);
            let huge = 2.0_f64.powi(700);
            assert_eq!(symmetric_eigen(&(matrix * huge)).0, values * huge, "scales exactly");
            assert_eq!(symmetric_eigen(&(matrix / huge)).0, values / huge, "scales exactly");
        }
    }

    /// Tests that an eigenvalue of magnitude 1e-17 beside an eigenvalue of 1 has a small relative
    /// error.
    #[test]
    fn small_values_beside_large_ones() {
        let graded = M3::new(1.0, 1e-6, 0.0, 1e-6, 1e-9, 1e-13, 0.0, 1e-13, 1e-18);
        let (values, _) = symmetric_eigen(&graded);
        // The smallest eigenvalue is 1e-18 minus (1e-13)² over 1e-9 - 1e-12.
        let expected = 1e-18 - 1e-26 / (1e-9 - 1e-12);
        assert!((values[2] / expected - 1.0).abs() < 1e-6, "{values}, not {expected}");
    }
}
