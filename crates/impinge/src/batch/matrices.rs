//! Poses as homogeneous matrices in a flat array.

use super::{BatchError, MatrixError, PoseSource};
use crate::math::{Matrix, Pose, Real, Space, Vector};

/// By how much the scalar product of two columns of a rotation may differ from 0 or 1: 2⁻¹⁶.
const TOLERANCE: f64 = 1.0 / 65536.0;

/// Poses as homogeneous matrices, read where they lie: (D+1) × (D+1) numbers each, row by row, one matrix after the
/// other: an array of the shape (n, D+1, D+1) in C order.
///
/// ```text
///   | r00 r01 r02 t0 |
///   | r10 r11 r12 t1 |     x ↦ r · x + t takes the local frame of a shape to the world
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

impl<'a, N: Real, const D: usize> Matrices<'a, N, D> {
    /// How many numbers a matrix has.
    const WIDTH: usize = (D + 1) * (D + 1);

    /// The numbers of one matrix.
    #[inline]
    fn matrix(&self, index: usize) -> &'a [N] {
        &self.numbers[index * Self::WIDTH..][..Self::WIDTH]
    }
}

impl<'a, N: Space<D>, const D: usize> Matrices<'a, N, D> {
    /// Takes matrices whose last row is 0, …, 0, 1 and whose rotation is orthogonal with the determinant 1.
    ///
    /// The scalar products of the columns of the rotation, which have no unit, may differ from 0 and 1 by 2⁻¹⁶, about
    /// 1.5e-5: five correct decimals will do. The matrix is used as it is given: a rotation that is off
    /// by so much puts the points of a shape off by as much of their distance from its origin.
    ///
    /// Cost: some ten nanoseconds for each matrix, on one thread.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`] if the numbers are not whole matrices, and [`BatchError::Matrix`] for the first
    /// matrix that is no pose.
    pub fn try_new(numbers: &'a [N]) -> Result<Self, BatchError> {
        let (given, width) = (numbers.len(), Self::WIDTH);
        if !given.is_multiple_of(width) {
            return Err(BatchError::PartialRow { argument: "matrices", given, width });
        }
        for (index, matrix) in numbers.chunks_exact(width).enumerate() {
            check::<N, D>(matrix).map_err(|error| BatchError::Matrix { index, error })?;
        }
        Ok(Self { numbers })
    }
}

impl<N: Real, const D: usize> PoseSource<N, D> for Matrices<'_, N, D> {
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

    /// All rotations are finite.
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
    check_rotation(rotation_of::<N, D>(matrix))
}

fn check_rotation<N: Space<D>, const D: usize>(rotation: Matrix<N, D>) -> Result<(), MatrixError> {
    for one in 0..D {
        for other in one..D {
            let product = rotation.column(one).dot(&rotation.column(other));
            let needed = if one == other { N::ONE } else { N::ZERO };
            let is_near = (product - needed).abs() <= N::lit(TOLERANCE);
            if !is_near {
                let (columns, product) = ([one, other], product.as_f64());
                return Err(MatrixError::NotOrthogonal { columns, product });
            }
        }
    }
    // Near 1 or -1 now.
    let determinant = N::determinant(&rotation);
    let mirrors = determinant <= N::ZERO;
    if mirrors {
        return Err(MatrixError::NotARotation { determinant: determinant.as_f64() });
    }
    Ok(())
}
