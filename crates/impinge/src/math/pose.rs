//! Rigid transformations with the rotation as a matrix. They are generic over the dimension, and
//! transform points about twice as fast as the quaternion isometries of nalgebra.

use super::na::ArrayStorage;
use super::{AbstractRotation, Isometry, Mapped, Matrix, Point, Real, Vector, filled};

// The following functions replace products of nalgebra, which make about thirty nested calls for
// each number in builds without optimisation. The results are bitwise equal: each sum runs over the
// columns in order.

/// Returns `matrix · v`.
#[inline]
fn times<N: Real, const D: usize>(matrix: &Matrix<N, D>, v: &Vector<N, D>) -> Vector<N, D> {
    let (columns, v) = (&matrix.data.0, &v.data.0[0]);
    vector(filled(|row| sum_of::<N, D>(|column| columns[column][row] * v[column])))
}

/// Returns `matrixᵀ · v`.
#[inline]
fn transposed_times<N: Real, const D: usize>(
    matrix: &Matrix<N, D>,
    v: &Vector<N, D>,
) -> Vector<N, D> {
    let (columns, v) = (&matrix.data.0, &v.data.0[0]);
    vector(columns.mapped(|column| sum_of::<N, D>(|row| column[row] * v[row])))
}

/// Returns `a + b`.
#[inline]
fn plus<N: Real, const D: usize>(a: &Vector<N, D>, b: &Vector<N, D>) -> Vector<N, D> {
    let (a, b) = (&a.data.0[0], &b.data.0[0]);
    vector(filled(|axis| a[axis] + b[axis]))
}

/// Returns `a - b`.
#[inline]
fn minus<N: Real, const D: usize>(a: &Vector<N, D>, b: &Vector<N, D>) -> Vector<N, D> {
    let (a, b) = (&a.data.0[0], &b.data.0[0]);
    vector(filled(|axis| a[axis] - b[axis]))
}

/// Returns the matrix whose columns are the results of `times` for the columns of `matrix`.
#[inline]
fn of_columns<N: Real, const D: usize>(
    matrix: &Matrix<N, D>,
    mut times: impl FnMut(&Vector<N, D>) -> Vector<N, D>,
) -> Matrix<N, D> {
    let columns = matrix.data.0.mapped(|column| times(&vector(column)).data.0[0]);
    Matrix::<N, D>::from_array_storage(ArrayStorage(columns))
}

#[inline]
fn vector<N: Real, const D: usize>(components: [N; D]) -> Vector<N, D> {
    Vector::<N, D>::from_array_storage(ArrayStorage([components]))
}

/// Returns `terms(0) + … + terms(D − 1)`, summed from left to right.
#[inline]
fn sum_of<N: Real, const D: usize>(terms: impl Fn(usize) -> N) -> N {
    let mut sum = terms(0);
    let mut index = 1;
    while index < D {
        sum += terms(index);
        index += 1;
    }
    sum
}

/// The position and orientation of a solid: `x ↦ rotation · x + translation` maps its local frame
/// to the world.
///
/// In the whole library, `pose12` is the pose of the second solid in the frame of the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose<N: Real, const D: usize> {
    /// The rotation, an orthogonal matrix of determinant 1.
    pub rotation: Matrix<N, D>,
    /// The position of the local origin in the outer frame.
    pub translation: Vector<N, D>,
}

impl<N: Real, const D: usize> Pose<N, D> {
    /// Returns the identity: the pose of a solid whose local frame is the world frame.
    #[must_use]
    pub fn identity() -> Self {
        Self { rotation: Matrix::<N, D>::identity(), translation: Vector::<N, D>::zeros() }
    }

    /// Returns a pose with the identity as its rotation.
    #[must_use]
    pub fn from_translation(translation: Vector<N, D>) -> Self {
        Self { rotation: Matrix::<N, D>::identity(), translation }
    }

    /// Converts an isometry of nalgebra to a pose.
    #[must_use]
    #[inline]
    pub fn from_isometry<R: AbstractRotation<N, D>>(isometry: &Isometry<N, R, D>) -> Self {
        let mut rotation = Matrix::<N, D>::identity();
        for axis in 0..D {
            let mut e = Vector::<N, D>::zeros();
            e[axis] = N::ONE;
            rotation.set_column(axis, &isometry.rotation.transform_vector(&e));
        }
        Self { rotation, translation: isometry.translation.vector }
    }

    /// Returns the pose of an isometry without its rotation, for a solid that no rotation changes,
    /// such as a ball. If the rotation is not finite, the translation of the result is infinite.
    #[must_use]
    #[inline]
    pub fn unturned<R: AbstractRotation<N, D>>(isometry: &Isometry<N, R, D>) -> Self {
        let mut e = Vector::<N, D>::zeros();
        e[0] = N::ONE;
        // Each number of the rotation is a factor in the rotated vector, so a number that is not
        // finite makes the rotated vector not finite.
        let rotated = isometry.rotation.transform_vector(&e);
        Self::from_translation(isometry.translation.vector).unless_broken(rotated.as_slice())
    }

    /// Returns this pose without its rotation, for a solid that no rotation changes; see
    /// [`Self::unturned`].
    #[must_use]
    pub(crate) fn without_rotation(&self) -> Self {
        Self::from_translation(self.translation).unless_broken(self.rotation.as_slice())
    }

    /// Returns this pose, with an infinite translation if one of `numbers` is not finite. `numbers`
    /// are the numbers of the rotation.
    #[inline]
    pub(super) fn unless_broken(self, numbers: &[N]) -> Self {
        // An infinity or NaN times zero is NaN, and a sum with NaN is NaN.
        let is_finite = numbers.iter().fold(N::ZERO, |sum, &x| sum + x * N::ZERO) == N::ZERO;
        let nowhere = Vector::<N, D>::repeat(N::INFINITY);
        Self { translation: if is_finite { self.translation } else { nowhere }, ..self }
    }

    /// Returns the pose of `second` in the frame of `first`.
    ///
    /// The translations are subtracted first, so that the relative position of nearby solids has a
    /// small error even far from the origin.
    #[must_use]
    #[inline]
    pub fn relative(first: &Self, second: &Self) -> Self {
        Self {
            rotation: of_columns(&second.rotation, |axis| first.inverse_vector(axis)),
            translation: first.inverse_vector(&minus(&second.translation, &first.translation)),
        }
    }

    /// Returns the inverse transformation. If this is the pose of solid 2 in the frame of solid 1,
    /// the inverse is the pose of solid 1 in the frame of solid 2.
    #[must_use]
    #[inline]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -times(&rotation, &self.translation) }
    }

    /// Returns the composition `self ∘ inner`. It maps the local frame of `inner` to the outer
    /// frame of this pose.
    #[must_use]
    #[inline]
    pub fn compose(&self, inner: &Self) -> Self {
        Self {
            rotation: of_columns(&inner.rotation, |axis| self.vector(axis)),
            translation: plus(&self.vector(&inner.translation), &self.translation),
        }
    }

    /// Transforms a local point to the outer frame.
    #[inline]
    #[must_use]
    pub fn point(&self, local: &Point<N, D>) -> Point<N, D> {
        Point::from(plus(&self.vector(&local.coords), &self.translation))
    }

    /// Rotates a local direction to the outer frame.
    #[inline]
    #[must_use]
    pub fn vector(&self, local: &Vector<N, D>) -> Vector<N, D> {
        times(&self.rotation, local)
    }

    /// Transforms a point of the outer frame to the local frame.
    #[inline]
    #[must_use]
    pub fn inverse_point(&self, outer: &Point<N, D>) -> Point<N, D> {
        Point::from(self.inverse_vector(&minus(&outer.coords, &self.translation)))
    }

    /// Rotates a direction of the outer frame to the local frame.
    #[inline]
    #[must_use]
    pub fn inverse_vector(&self, outer: &Vector<N, D>) -> Vector<N, D> {
        transposed_times(&self.rotation, outer)
    }

    /// Returns the half extents, along the outer axes, of the rotated box with these half extents
    /// along the local axes.
    #[inline]
    pub(crate) fn rotated_extents(&self, half_extents: &Vector<N, D>) -> Vector<N, D> {
        let mut extents = Vector::<N, D>::zeros();
        for row in 0..D {
            for column in 0..D {
                extents[row] += self.rotation[(row, column)].abs() * half_extents[column];
            }
        }
        extents
    }

    /// Returns whether the pose maps axes to axes. Then each coordinate of a rotated point is
    /// exactly plus or minus a coordinate of the point.
    #[inline]
    #[must_use]
    pub(crate) fn is_aligned(&self) -> bool {
        self.rotation.as_slice().iter().all(|&x| x == N::ZERO || x.abs() == N::ONE)
    }

    /// Returns whether all components are equal, as `==` does. This function is faster, since the
    /// optimiser sees plain arrays.
    #[inline]
    #[must_use]
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.rotation.as_slice() == other.rotation.as_slice()
            && self.translation.as_slice() == other.translation.as_slice()
    }

    /// Returns whether no component is NaN or infinite.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        // Nearly always all components are finite, so there is no early exit. A finite number times
        // zero is zero; an infinity or NaN times zero is NaN, and a sum with NaN is NaN.
        let mut sum = N::ZERO;
        for row in 0..D {
            let mut in_row = self.translation[row] * N::ZERO;
            for column in 0..D {
                in_row += self.rotation[(row, column)] * N::ZERO;
            }
            sum += in_row;
        }
        sum == N::ZERO
    }
}

#[cfg(test)]
mod tests {
    use super::super::na::UnitQuaternion;
    use super::super::{Isometry2, Isometry3};
    use super::*;

    #[test]
    fn what_is_no_rotation_gives_no_finite_pose() {
        let quaternion = |[x, y, z, w]: [f32; 4]| crate::math::na::Quaternion::new(w, x, y, z);
        for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
            for index in 0..4 {
                let mut numbers = [0.5_f32, 0.0, -0.5, 0.5];
                numbers[index] = bad;
                let rotation = UnitQuaternion::new_unchecked(quaternion(numbers));
                let pose = Pose::unturned(&Isometry3::from_parts(Default::default(), rotation));
                assert!(!pose.is_finite(), "{bad} at {index}");
            }
        }
    }

    #[test]
    fn without_its_rotation_a_pose_is_where_it_was() {
        let at = Isometry3::new(Vector::<f32, 3>::new(1.0, -2.0, 3.0), [0.3, -0.2, 0.9].into());
        let expected = Pose::from_translation(at.translation.vector);
        assert!(Pose::unturned(&at).is_same(&expected), "of an isometry");
        assert!(Pose::from_isometry(&at).without_rotation().is_same(&expected), "of a pose");
        let mut broken = Pose::from_isometry(&at);
        broken.rotation[(1, 2)] = f32::NAN;
        assert!(!broken.without_rotation().is_finite(), "a rotation that is none");
    }

    #[test]
    fn agrees_with_isometries() {
        let iso = Isometry3::new(Vector::<f64, 3>::new(1.0, 2.0, 3.0), [0.1, -0.7, 0.4].into());
        let other = Isometry3::new(Vector::<f64, 3>::new(-4.0, 0.5, 3.0), [1.1, 0.2, 0.9].into());
        let p = Point::<f64, 3>::new(0.3, -1.0, 2.0);
        let (pose, second) = (Pose::from_isometry(&iso), Pose::from_isometry(&other));
        assert!((pose.point(&p) - iso * p).norm() < 1e-14, "forward");
        assert!((pose.inverse_point(&p) - iso.inverse_transform_point(&p)).norm() < 1e-14, "back");
        let relative = Pose::relative(&pose, &second);
        assert!((relative.point(&p) - iso.inv_mul(&other) * p).norm() < 1e-14, "relative");
        assert!((pose.compose(&relative).point(&p) - other * p).norm() < 1e-14, "compose");
        assert!((relative.inverse().point(&relative.point(&p)) - p).norm() < 1e-14, "inverse");
    }

    #[test]
    fn quarter_turn_2d() {
        let iso = Isometry2::new(Vector::<f32, 2>::new(1.0, 0.0), std::f32::consts::FRAC_PI_2);
        let p = Pose::from_isometry(&iso).point(&Point::<f32, 2>::new(1.0, 0.0));
        assert!((p - Point::<f32, 2>::new(1.0, 1.0)).norm() < 1e-6, "{p}");
    }

    fn finite_in_every_number_but_one<const D: usize>() {
        for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
            for index in 0..D * D {
                let mut pose = Pose::<f32, D>::from_translation(Vector::<f32, D>::repeat(f32::MAX));
                assert!(pose.is_finite(), "the largest numbers are numbers");
                pose.rotation[index] = bad;
                assert!(!pose.is_finite(), "{bad} at {index} of the rotation");
            }
            for axis in 0..D {
                let mut pose = Pose::<f32, D>::identity();
                pose.translation[axis] = bad;
                assert!(!pose.is_finite(), "{bad} at {axis} of the translation");
            }
        }
    }

    #[test]
    fn one_number_that_is_not_finite_is_found() {
        finite_in_every_number_but_one::<2>();
        finite_in_every_number_but_one::<3>();
    }
}
