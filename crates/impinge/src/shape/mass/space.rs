//! Mass properties in 3D, where the inertia is a tensor.

use super::{MassError, MassProperties, Moments, amount, finite, inverse};
use crate::math::na::UnitQuaternion;
use crate::math::{Isometry3, Matrix, Point, Pose, Real, Space, Vector};

impl<N: Real> MassProperties<N, 3> {
    /// Returns a body with the given centre of mass, mass, and inertia tensor about that centre, in
    /// the axes of the frame.
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(center: Point<N, 3>, mass: N, inertia: &Matrix<N, 3>) -> Self {
        match Self::try_new(center, mass, inertia) {
            Ok(body) => body,
            Err(error) => panic!("{error}"),
        }
    }

    /// Returns a body with the given centre of mass, mass, and inertia tensor about that centre, in
    /// the axes of the frame.
    ///
    /// Only the symmetric part of the tensor is used. In a physical body no principal moment
    /// exceeds the sum of the other two; this is not checked.
    ///
    /// # Errors
    /// If a number is not finite, the mass is negative, or a principal moment is negative by more
    /// than rounding.
    ///
    /// ```
    /// use impinge::dim3::math::{Matrix, Point, Vector};
    /// use impinge::dim3::query::{MassError, MassProperties};
    ///
    /// let inertia = Matrix::new(2.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0, 0.0, 5.0);
    /// let body = MassProperties::<f64>::try_new(Point::origin(), 1.0, &inertia)?;
    /// let mut moments: Vec<f64> = body.principal_moments().iter().copied().collect();
    /// moments.sort_by(f64::total_cmp);
    /// assert!((Vector::new(moments[0], moments[1], moments[2]) - Vector::new(1.0, 3.0, 5.0)).norm() < 1e-14);
    /// assert!((body.inertia() - inertia).norm() < 1e-14);
    /// let refused = MassProperties::<f64>::try_new(Point::origin(), 1.0, &-inertia);
    /// assert!(matches!(refused, Err(MassError::Negative { .. })));
    /// # Ok::<(), MassError>(())
    /// ```
    pub fn try_new(
        center: Point<N, 3>,
        mass: N,
        inertia: &Matrix<N, 3>,
    ) -> Result<Self, MassError> {
        for element in inertia {
            finite("an element of the inertia tensor", element.as_f64())?;
        }
        let inertia = inertia.map(N::as_f64);
        let symmetric = inertia * 0.5 + inertia.transpose() * 0.5;
        let (values, _) = crate::math::eigen::symmetric_eigen(&symmetric);
        let tolerance = values.amax() * 64.0 * N::EPSILON.as_f64();
        for &moment in values.iter().filter(|&&moment| moment < -tolerance) {
            amount("a principal moment of inertia", moment)?;
        }
        let mass = amount("the mass", mass.as_f64())?;
        let center = center.coords.map(N::as_f64);
        Self::try_of_moments(&Moments::of_tensor(mass, center, &symmetric))
    }

    /// Returns a body with the given centre of mass, mass, and principal moments of inertia.
    /// `frame` rotates the axes of the body's frame to the principal axes.
    ///
    /// # Errors
    /// If a number is not finite, or the mass or a moment is negative.
    pub fn try_from_principal(
        center: Point<N, 3>,
        mass: N,
        moments: &Vector<N, 3>,
        frame: &UnitQuaternion<N>,
    ) -> Result<Self, MassError> {
        for &moment in moments {
            amount("a principal moment of inertia", moment.as_f64())?;
        }
        let axes = *frame.to_rotation_matrix().matrix();
        for element in &axes {
            finite("a number of the frame", element.as_f64())?;
        }
        Self::try_of_moments(&Moments {
            mass: amount("the mass", mass.as_f64())?,
            center: center.coords.map(N::as_f64),
            axes: axes.map(N::as_f64),
            principal: moments.map(N::as_f64),
        })
    }

    /// Returns the principal moments of inertia about the centre of mass, in the order of the axes
    /// of [`Self::principal_frame`]; zero or more.
    #[must_use]
    pub const fn principal_moments(&self) -> &Vector<N, 3> {
        &self.principal
    }

    /// Returns the rotation from the axes of the body's frame to the principal axes.
    ///
    /// The result is the identity if the inertia tensor is diagonal, and for a shape whose
    /// principal axes are the axes of its frame: a ball, a box, a cylinder.
    #[must_use]
    pub fn principal_frame(&self) -> UnitQuaternion<N> {
        let pose = Pose { rotation: self.axes, translation: Vector::<N, 3>::zeros() };
        <N as Space<3>>::isometry(&pose).rotation
    }

    /// Returns the inertia tensor about the centre of mass, in the axes of the body's frame.
    #[must_use]
    pub fn inertia(&self) -> Matrix<N, 3> {
        self.along(&self.axes, &self.principal)
    }

    /// Returns the inverse of the inertia tensor about the centre of mass, in the axes of the
    /// body's frame; zero about an axis without inertia.
    #[must_use]
    pub fn inverse_inertia(&self) -> Matrix<N, 3> {
        self.along(&self.axes, &self.principal.map(inverse))
    }

    /// Returns the inertia tensor about the centre of mass, in the world's axes, of a body placed
    /// at `position`.
    #[must_use]
    pub fn inertia_at(&self, position: &Isometry3<N>) -> Matrix<N, 3> {
        self.along(&self.world_axes(position), &self.principal)
    }

    /// Returns the inverse of [`Self::inertia_at`]: its product with a torque is the angular
    /// acceleration. Zero about an axis without inertia. The cost is two matrix products.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Vector};
    /// use impinge::dim3::query::mass_properties;
    /// use impinge::dim3::shape::Cylinder;
    ///
    /// // A wheel whose axis is y in its own frame, placed so that its axis is z.
    /// let wheel = mass_properties(&Cylinder::new(0.25_f64, 2.0), 1.0)?.with_mass(2.0)?;
    /// let lying = Isometry::new(Vector::zeros(), Vector::x() * std::f64::consts::FRAC_PI_2);
    /// let inverse = wheel.inverse_inertia_at(&lying);
    /// assert!((inverse * Vector::z() - Vector::z() * 0.25).norm() < 1e-15, "half of m r² is 4");
    /// # Ok::<(), impinge::query::MassError>(())
    /// ```
    #[must_use]
    pub fn inverse_inertia_at(&self, position: &Isometry3<N>) -> Matrix<N, 3> {
        self.along(&self.world_axes(position), &self.principal.map(inverse))
    }

    /// Returns the inertia tensor about a point of the body's frame, in the axes of that frame, by
    /// the parallel axis theorem.
    #[must_use]
    pub fn inertia_about(&self, point: &Point<N, 3>) -> Matrix<N, 3> {
        let offset = point - self.center;
        let across = Matrix::<N, 3>::from_diagonal_element(offset.norm_squared());
        self.inertia() + (across - offset * offset.transpose()) * self.mass
    }

    /// Returns a rotation whose columns are the principal axes in the world's axes.
    fn world_axes(&self, position: &Isometry3<N>) -> Matrix<N, 3> {
        <N as Space<3>>::pose(position).rotation * self.axes
    }

    /// Returns the symmetric matrix with the eigenvalues `values` along the columns of `axes`;
    /// exact for coordinate axes.
    fn along(&self, axes: &Matrix<N, 3>, values: &Vector<N, 3>) -> Matrix<N, 3> {
        Matrix::<N, 3>::from_fn(|row, column| {
            let product = |axis: usize| axes[(row, axis)] * axes[(column, axis)] * values[axis];
            product(0) + product(1) + product(2)
        })
    }
}
