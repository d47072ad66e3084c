//! The trait [`Space`], with the operations of a scalar that differ between 2D and 3D.

use super::na::{Quaternion, Rotation2, Rotation3, UnitComplex, UnitQuaternion};
use super::{Isometry2, Isometry3, Matrix, Pose, Real, Vector};
use crate::tables::{ByDimension, Compiled, Here};
use core::fmt::Debug;

/// A scalar `Self` in `D` dimensions: implemented for every [`Real`] with `D` = 2 and `D` = 3.
///
/// Generic code that needs an operation which depends on the dimension has the bound `N: Space<D>`.
/// A function for one dimension needs only `N: Real`, which implies `Space<2>` and `Space<3>`.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not known to be a scalar of impinge in {D} dimensions",
    label = "`Space<{D}>` is not implemented for `{Self}`",
    note = "there are 2 and 3 dimensions, of `f32` and `f64`",
    note = "code for one dimension uses the types of `dim2` or `dim3` and asks for `N: Real`; code for both asks \
            for `N: Space<D>`"
)]
pub trait Space<const D: usize>: Real + Compiled<D> {
    /// The type of positions in the public interface: `Isometry2` or `Isometry3` of nalgebra.
    type Isometry: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// The algorithms that differ by dimension.
    #[doc(hidden)]
    type Algorithms: ByDimension<Self, D>;

    /// Converts an isometry to a pose.
    fn pose(isometry: &Self::Isometry) -> Pose<Self, D>;

    /// Converts an isometry to a pose without rotation, for a solid that no rotation changes; see
    /// [`Pose::unturned`].
    #[doc(hidden)]
    fn unturned(isometry: &Self::Isometry) -> Pose<Self, D>;

    /// Returns the translation of an isometry: the position of the local origin.
    fn translation(isometry: &Self::Isometry) -> Vector<Self, D>;

    /// Returns the numbers of an isometry as an array, padded with zeros.
    #[doc(hidden)]
    fn numbers(isometry: &Self::Isometry) -> [Self; 7];

    /// Returns the isometry with the numbers of [`Self::numbers`]. The rotation is not normalised.
    #[doc(hidden)]
    fn of_numbers(numbers: &[Self; 7]) -> Self::Isometry;

    /// Converts a pose to an isometry, up to rounding.
    fn isometry(pose: &Pose<Self, D>) -> Self::Isometry;

    /// Returns the squared length of the complex number or quaternion of an isometry: 1 up to
    /// rounding for a rotation.
    #[doc(hidden)]
    fn squared_length_of_rotation(isometry: &Self::Isometry) -> Self;

    /// Returns the determinant of a matrix.
    #[doc(hidden)]
    fn determinant(matrix: &Matrix<Self, D>) -> Self;
}

impl<N: Real> From<Isometry2<N>> for Pose<N, 2> {
    fn from(isometry: Isometry2<N>) -> Self {
        N::pose(&isometry)
    }
}

impl<N: Real> From<Isometry3<N>> for Pose<N, 3> {
    fn from(isometry: Isometry3<N>) -> Self {
        N::pose(&isometry)
    }
}

impl<N: Real> Space<2> for N {
    type Isometry = Isometry2<N>;
    type Algorithms = Here;

    #[inline]
    fn pose(isometry: &Isometry2<N>) -> Pose<N, 2> {
        Pose::from_isometry(isometry)
    }

    #[inline]
    fn unturned(isometry: &Isometry2<N>) -> Pose<N, 2> {
        let numbers = [isometry.rotation.re, isometry.rotation.im];
        Pose::from_translation(isometry.translation.vector).unless_broken(&numbers)
    }

    #[inline]
    fn translation(isometry: &Isometry2<N>) -> Vector<N, 2> {
        isometry.translation.vector
    }

    #[inline]
    fn numbers(isometry: &Isometry2<N>) -> [N; 7] {
        let (t, r) = (&isometry.translation.vector, &isometry.rotation);
        [t.x, t.y, r.re, r.im, N::ZERO, N::ZERO, N::ZERO]
    }

    fn of_numbers(&[x, y, re, im, ..]: &[N; 7]) -> Isometry2<N> {
        let rotation = UnitComplex::from_cos_sin_unchecked(re, im);
        Isometry2::from_parts(Vector::<N, 2>::new(x, y).into(), rotation)
    }

    fn isometry(pose: &Pose<N, 2>) -> Isometry2<N> {
        let rotation = Rotation2::from_matrix_unchecked(pose.rotation);
        let rotation = UnitComplex::from_rotation_matrix(&rotation);
        Isometry2::from_parts(pose.translation.into(), rotation)
    }

    #[inline]
    fn squared_length_of_rotation(isometry: &Isometry2<N>) -> N {
        let (re, im) = (isometry.rotation.re, isometry.rotation.im);
        re * re + im * im
    }

    #[inline]
    fn determinant(matrix: &Matrix<N, 2>) -> N {
        matrix.determinant()
    }
}

impl<N: Real> Space<3> for N {
    type Isometry = Isometry3<N>;
    type Algorithms = Here;

    #[inline]
    fn pose(isometry: &Isometry3<N>) -> Pose<N, 3> {
        let rotation = matrix_of(&isometry.rotation);
        Pose { rotation, translation: isometry.translation.vector }
    }

    #[inline]
    fn unturned(isometry: &Isometry3<N>) -> Pose<N, 3> {
        let numbers = isometry.rotation.coords.as_slice();
        Pose::from_translation(isometry.translation.vector).unless_broken(numbers)
    }

    #[inline]
    fn translation(isometry: &Isometry3<N>) -> Vector<N, 3> {
        isometry.translation.vector
    }

    #[inline]
    fn numbers(isometry: &Isometry3<N>) -> [N; 7] {
        let (t, r) = (&isometry.translation.vector, &isometry.rotation.coords);
        [t.x, t.y, t.z, r.x, r.y, r.z, r.w]
    }

    fn of_numbers(&[x, y, z, i, j, k, w]: &[N; 7]) -> Isometry3<N> {
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Vector::<N, 3>::new(x, y, z).into(), rotation)
    }

    fn isometry(pose: &Pose<N, 3>) -> Isometry3<N> {
        let rotation = Rotation3::from_matrix_unchecked(pose.rotation);
        let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
        Isometry3::from_parts(pose.translation.into(), rotation)
    }

    #[inline]
    fn squared_length_of_rotation(isometry: &Isometry3<N>) -> N {
        isometry.rotation.coords.norm_squared()
    }

    #[inline]
    fn determinant(matrix: &Matrix<N, 3>) -> N {
        matrix.determinant()
    }
}

/// Returns the matrix of a 3D rotation. Its columns are bitwise equal to the rotated axes, but are
/// computed without products with the zeros of the axes.
#[inline]
fn matrix_of<N: Real>(rotation: &UnitQuaternion<N>) -> Matrix<N, 3> {
    let q = rotation.coords;
    let (x, y, z, w) = (q.x, q.y, q.z, q.w);
    let (x2, y2, z2) = (x * N::TWO, y * N::TWO, z * N::TWO);
    let (xx, yy, zz) = (x * x2, y * y2, z * z2);
    let (xy, xz, yz) = (x * y2, x * z2, y * z2);
    let (wx, wy, wz) = (x2 * w, y2 * w, z2 * w);
    // Adding zero makes zeros positive, as the addition of a zero component of the axis would.
    let zero = N::ZERO;
    Matrix::<N, 3>::new(
        (-yy - zz) + N::ONE,
        (-wz + xy) + zero,
        (wy + xz) + zero,
        (wz + xy) + zero,
        (-zz - xx) + N::ONE,
        (-wx + yz) + zero,
        (-wy + xz) + zero,
        (wx + yz) + zero,
        (-xx - yy) + N::ONE,
    )
}

#[cfg(test)]
mod tests {
    use super::super::na::Quaternion;
    use super::*;

    fn check<N: Real>(coordinates: [N; 4]) {
        let [x, y, z, w] = coordinates;
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
        let expected_pose =
            Pose::from_isometry(&Isometry3::from_parts(Default::default(), rotation));
        let found = matrix_of(&rotation);
        for (number, expected) in found.iter().zip(expected_pose.rotation.iter()) {
            assert_eq!(number.bits(), expected.bits(), "{found} of {rotation}");
        }
    }

    fn rotations<N: Real>(tiny: f64) {
        let numbers = [0.0, -0.0, 1.0, -1.0, 0.3, -0.7, 0.123_456_789, tiny, -tiny].map(N::lit);
        let count = numbers.len();
        for index in 0..count.pow(4) {
            let digit = |place: u32| numbers[index / count.pow(place) % count];
            check([digit(0), digit(1), digit(2), digit(3)]);
        }
    }

    #[test]
    fn matrices_have_the_bits_of_rotated_axes() {
        rotations::<f32>(1e-23);
        rotations::<f64>(1e-162);
    }

    #[test]
    fn what_is_no_rotation_gives_no_finite_matrix() {
        for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
            for index in 0..4 {
                let mut q = [0.5_f32, 0.0, -0.5, 0.5];
                q[index] = bad;
                let [x, y, z, w] = q;
                let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
                let is_finite = matrix_of(&rotation).iter().all(|number| number.is_finite());
                assert!(!is_finite, "{bad} at {index}");
            }
        }
    }

    #[test]
    fn determinants_by_hand() {
        let swaps = Matrix::<f64, 3>::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
        assert_eq!(f64::determinant(&swaps), 1.0, "a third of a turn about the diagonal");
        assert_eq!(f64::determinant(&-swaps), -1.0, "the same and a mirror");
        let other = Matrix::<f64, 3>::new(2.0, 1.0, 0.0, 4.0, 0.0, 1.0, 0.0, 1.0, 1.0);
        assert_eq!(f64::determinant(&other), -6.0, "by the rule of Sarrus");
        let quarter = Matrix::<f32, 2>::new(0.0, -1.0, 1.0, 0.0);
        assert_eq!(f32::determinant(&quarter), 1.0, "a quarter turn");
    }
}
