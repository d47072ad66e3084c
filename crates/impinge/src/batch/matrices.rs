//! Poses as homogeneous matrices in a flat array.

use super::{BatchError, MatrixError, PoseSource};
use crate::math::{Matrix, Pose, Real, Space, Vector};

/// The greatest accepted deviation of the scalar product of two columns of a rotation from 0 or 1:
/// 2⁻¹⁶.
const TOLERANCE: f64 = 1.0 / 65536.0;

/// Poses as homogeneous matrices, read in place. Each matrix has (D+1) × (D+1) numbers in row-major
/// order; together they are an array of shape (n, D+1, D+1) in C order.
///
/// ```text
///   | r00 r01 r02 t0 |
///   | r10 r11 r12 t1 |     x ↦ r · x + t maps the local frame of a shape to the world
///   | r20 r21 r22 t2 |
///   |  0   0   0   1 |
/// ```
///
/// ```
/// use impinge::dim2::batch::{Matrices, PoseSource};
/// use impinge::dim2::math::Point;
///
/// // A quarter turn, and a translation by (5, 7).
/// let numbers = [0.0, -1.0, 5.0, 1.0, 0.0, 7.0, 0.0, 0.0, 1.0_f64];
/// let matrices = Matrices::try_new(&numbers)?;
/// assert_eq!(matrices.pose(0).point(&Point::new(2.0, 0.0)), Point::new(5.0, 9.0));
/// # Ok::<(), impinge::batch::BatchError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Matrices<'a, N: Real, const D: usize> {
    numbers: &'a [N],
}

impl<'a, N: Space<D>, const D: usize> Matrices<'a, N, D> {
    /// The number of entries of a matrix.
    const WIDTH: usize = (D + 1) * (D + 1);

    /// Accepts matrices whose last row is 0, …, 0, 1 and whose rotation part is orthogonal with
    /// determinant 1.
    ///
    /// The scalar products of the rotation's columns may differ by 2⁻¹⁶, about 1.5e-5, from 0 or 1:
    /// five correct decimals suffice. The matrix is used as given. Such a deviation displaces the
    /// points of a shape by about 2⁻¹⁶ times their distance from the shape's origin.
    ///
    /// Cost: some nanoseconds for each matrix, on one thread.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`] if the length of `numbers` is not a multiple of the matrix size,
    /// and [`BatchError::Matrix`] for the first matrix that is not a pose.
    pub fn try_new(numbers: &'a [N]) -> Result<Self, BatchError> {
        let (given, width) = (numbers.len(), Self::WIDTH);
        if !given.is_multiple_of(width) {
            return Err(BatchError::PartialRow { argument: "matrices", given, width });
        }
        for (index, matrix) in numbers.chunks_exact(width).enumerate() {
            if !is_pose::<N, D>(matrix) {
                check::<N, D>(matrix).map_err(|error| BatchError::Matrix { index, error })?;
            }
        }
        Ok(Self { numbers })
    }

    /// Returns the numbers of matrix `index`.
    #[inline]
    fn matrix(&self, index: usize) -> &'a [N] {
        &self.numbers[index * Self::WIDTH..][..Self::WIDTH]
    }
}

impl<N: Space<D>, const D: usize> PoseSource<N, D> for Matrices<'_, N, D> {
    fn len(&self) -> usize {
        self.numbers.len() / Self::WIDTH
    }

    #[inline]
    fn pose(&self, index: usize) -> Pose<N, D> {
        let matrix = self.matrix(index);
        Pose { rotation: rotation_of(matrix), translation: translation_of(matrix) }
    }

    #[inline]
    fn translation(&self, index: usize) -> Vector<N, D> {
        translation_of(self.matrix(index))
    }

    /// Skips the rotation: [`Self::try_new`] has checked that it is finite.
    #[inline]
    fn unturned(&self, index: usize) -> Pose<N, D> {
        Pose::from_translation(self.translation(index))
    }
}

#[inline]
fn rotation_of<N: Real, const D: usize>(matrix: &[N]) -> Matrix<N, D> {
    let mut rotation = Matrix::<N, D>::identity();
    for row in 0..D {
        for column in 0..D {
            rotation[(row, column)] = matrix[row * (D + 1) + column];
        }
    }
    rotation
}

#[inline]
fn translation_of<N: Real, const D: usize>(matrix: &[N]) -> Vector<N, D> {
    let mut translation = Vector::<N, D>::zeros();
    for row in 0..D {
        translation[row] = matrix[row * (D + 1) + D];
    }
    translation
}

/// Returns `true` if [`check`] finds no error. Evaluates all conditions without branches, which is
/// faster than an early exit.
#[inline]
fn is_pose<N: Space<D>, const D: usize>(matrix: &[N]) -> bool {
    let (rows, last) = matrix.split_at(D * (D + 1));
    let mut is_pose = rows.iter().fold(true, |is_pose, x| is_pose & x.is_finite_number());
    for (column, &value) in last.iter().enumerate() {
        is_pose &= value == if column == D { N::ONE } else { N::ZERO };
    }
    let rotation = rotation_of::<N, D>(matrix);
    for one in 0..D {
        for other in one..D {
            is_pose &= deviation(&rotation, one, other) <= N::lit(TOLERANCE);
        }
    }
    is_pose & (N::determinant(&rotation) > N::ZERO)
}

/// Returns the deviation of the scalar product of two columns from its value in a rotation: 1 if
/// both are the same column, else 0.
#[inline]
fn deviation<N: Real, const D: usize>(rotation: &Matrix<N, D>, one: usize, other: usize) -> N {
    let product = rotation.column(one).dot(&rotation.column(other));
    (product - if one == other { N::ONE } else { N::ZERO }).abs()
}

fn check<N: Space<D>, const D: usize>(matrix: &[N]) -> Result<(), MatrixError> {
    if let Some(at) = matrix.iter().position(|x| !x.is_finite_number()) {
        let (row, column, value) = (at / (D + 1), at % (D + 1), matrix[at].as_f64());
        return Err(MatrixError::NotFinite { row, column, value });
    }
    for column in 0..=D {
        let (value, needed) =
            (matrix[D * (D + 1) + column], if column == D { N::ONE } else { N::ZERO });
        if value != needed {
            return Err(MatrixError::LastRow { column, value: value.as_f64() });
        }
    }
    check_rotation(&rotation_of::<N, D>(matrix))
}

fn check_rotation<N: Space<D>, const D: usize>(rotation: &Matrix<N, D>) -> Result<(), MatrixError> {
    for one in 0..D {
        for other in one..D {
            let is_near = deviation(rotation, one, other) <= N::lit(TOLERANCE);
            if !is_near {
                let product = rotation.column(one).dot(&rotation.column(other)).as_f64();
                return Err(MatrixError::NotOrthogonal { columns: [one, other], product });
            }
        }
    }
    // The columns are orthonormal up to the tolerance, so the determinant is near 1 or -1.
    let determinant = N::determinant(rotation);
    if determinant > N::ZERO {
        Ok(())
    } else {
        Err(MatrixError::NotARotation { determinant: determinant.as_f64() })
    }
}
