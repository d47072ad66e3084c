//! Mass properties of rigid bodies: mass, centre of mass, inertia.
//!
//! This module has the type and its arithmetic; [`crate::query::mass_properties`] computes the
//! properties of shapes. Arithmetic is in double precision for both scalars and is rounded once.
//! Principal moments are stored instead of the tensor: a small moment keeps its relative precision
//! next to a large one, and no moment becomes negative.

mod error;
mod moments;
mod plane;
mod space;

pub use error::MassError;
pub(crate) use error::{amount, finite};
pub(crate) use moments::Moments;

use core::iter::Sum;
use core::ops::{Add, AddAssign, Sub, SubAssign};

use crate::math::{AbstractRotation, Isometry, Matrix, Point, Pose, Real, Vector};

/// The mass of a rigid body, its centre of mass, and its inertia about that centre.
///
/// All quantities are in the frame of the body. [`mass_properties`](crate::query::mass_properties)
/// computes them from a shape and a density; `new` takes their values. In 2D the inertia is a
/// number: the moment about the centre of mass and the axis out of the plane. In 3D it is a tensor,
/// stored as its principal moments and axes.
///
/// `+` joins two bodies in one frame, by the parallel axis theorem; an overlap counts twice. `-`
/// removes a part from a body: a hollow ball is a ball minus a smaller ball. [`Self::transformed`]
/// converts a body to another frame.
///
/// **Inverses.** A solver multiplies impulses by the inverses of the mass and the inertia. Here the
/// inverse of zero is zero. So a body without mass does not move, and a body without inertia about
/// an axis, such as a segment about its own line, does not rotate about that axis, as if its
/// inertia were infinite. For a body that must not rotate or move, use zero as the inverse.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::query::mass_properties;
/// use impinge::dim3::shape::{Ball, Cuboid};
///
/// // A hammer: a wooden handle along x, an iron head at its end. Lengths in metres.
/// let handle = mass_properties(&Cuboid::new(Vector::new(0.2_f64, 0.02, 0.01)), 700.0)?;
/// let head = mass_properties(&Ball::new(0.05), 7800.0)?;
/// let hammer = handle + head.transformed(&Isometry::translation(0.2, 0.0, 0.0));
/// assert!((hammer.mass() - 4.308).abs() < 1e-3, "kilograms");
/// assert!((hammer.center_of_mass().x - 0.190).abs() < 1e-3, "near the head");
///
/// // The angular acceleration by a torque of 1 about y.
/// let inverse = hammer.inverse_inertia_at(&Isometry::identity());
/// assert!((inverse * Vector::y() - Vector::y() * 64.2).norm() < 0.1);
/// # Ok::<(), impinge::query::MassError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct MassProperties<N: Real, const D: usize> {
    mass: N,
    center: Point<N, D>,
    /// A rotation whose columns are the principal axes, in the frame of the body.
    axes: Matrix<N, D>,
    /// The principal moments, by axis, of the tensor that [`Moments`] defines.
    principal: Vector<N, D>,
}

/// The default has no mass and its centre at the origin.
impl<N: Real, const D: usize> Default for MassProperties<N, D> {
    fn default() -> Self {
        let (axes, principal) = (Matrix::<N, D>::identity(), Vector::<N, D>::zeros());
        Self { mass: N::ZERO, center: Point::origin(), axes, principal }
    }
}

impl<N: Real, const D: usize> MassProperties<N, D> {
    /// Returns the mass; zero or more.
    #[must_use]
    pub const fn mass(&self) -> N {
        self.mass
    }

    /// Returns 1 / mass; zero for a body without mass.
    #[must_use]
    pub fn inverse_mass(&self) -> N {
        inverse(self.mass)
    }

    /// Returns the centre of mass in the frame of the body. For a shape without mass it is a point
    /// at or near the shape, without physical meaning.
    #[must_use]
    pub const fn center_of_mass(&self) -> &Point<N, D> {
        &self.center
    }

    /// Returns the centre of mass, in world coordinates, of a body placed at `position`.
    #[must_use]
    pub fn center_of_mass_at<R: AbstractRotation<N, D>>(
        &self,
        position: &Isometry<N, R, D>,
    ) -> Point<N, D> {
        position.transform_point(&self.center)
    }

    /// Returns the properties in the outer frame, in which the body is placed at `position`.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point, Vector};
    /// use impinge::dim2::query::mass_properties;
    /// use impinge::dim2::shape::Cuboid;
    ///
    /// let plate = mass_properties(&Cuboid::new(Vector::new(1.0_f64, 2.0)), 3.0)?;
    /// let placed = plate.transformed(&Isometry::new(Vector::new(5.0, 1.0), 0.5));
    /// assert_eq!((placed.mass(), placed.inertia()), (plate.mass(), plate.inertia()));
    /// assert_eq!(placed.center_of_mass(), &Point::new(5.0, 1.0));
    /// # Ok::<(), impinge::query::MassError>(())
    /// ```
    #[must_use]
    pub fn transformed<R: AbstractRotation<N, D>>(&self, position: &Isometry<N, R, D>) -> Self {
        let Pose { rotation, translation } = Pose::from_isometry(position);
        let (rotation, translation) = (rotation.map(N::as_f64), translation.map(N::as_f64));
        Self::of_moments(&self.moments().placed(&rotation, &translation))
    }

    /// Returns the body with the mass `mass` and a proportional inertia. A body without mass
    /// becomes a point mass.
    ///
    /// # Errors
    /// If the mass is negative or not finite, or a moment is beyond the range of the scalar.
    ///
    /// ```
    /// use impinge::dim2::query::{MassProperties, mass_properties};
    /// use impinge::dim2::shape::Ball;
    ///
    /// let disk: MassProperties<f64> = mass_properties(&Ball::new(0.5), 1.0)?;
    /// let wheel = disk.with_mass(8.0)?;
    /// assert!((wheel.inertia() - 1.0).abs() < 1e-15, "half of m r²");
    /// # Ok::<(), impinge::query::MassError>(())
    /// ```
    pub fn with_mass(&self, mass: N) -> Result<Self, MassError> {
        let (body, mass) = (self.moments(), amount("the mass", mass.as_f64())?);
        let factor = if body.mass > 0.0 { mass / body.mass } else { 0.0 };
        Self::try_of_moments(&Moments { mass, principal: body.principal * factor, ..body })
    }

    /// Returns the properties in double precision.
    pub(crate) fn moments(&self) -> Moments<D> {
        Moments {
            mass: self.mass.as_f64(),
            center: self.center.coords.map(N::as_f64),
            axes: self.axes.map(N::as_f64),
            principal: self.principal.map(N::as_f64),
        }
    }

    /// Returns the properties rounded to the scalar.
    fn of_moments(moments: &Moments<D>) -> Self {
        Self {
            mass: N::lit(moments.mass),
            center: Point::from(moments.center.map(N::lit)),
            axes: moments.axes.map(N::lit),
            principal: moments.principal.map(N::lit),
        }
    }

    /// Returns the properties rounded to the scalar.
    ///
    /// # Errors
    /// If a property is NaN or exceeds the range of the scalar.
    pub(crate) fn try_of_moments(moments: &Moments<D>) -> Result<Self, MassError> {
        let found = Self::of_moments(moments);
        finite("the mass", found.mass.as_f64())?;
        for coordinate in &found.center.coords {
            finite("a coordinate of the centre of mass", coordinate.as_f64())?;
        }
        for moment in &found.principal {
            finite("a moment of inertia", moment.as_f64())?;
        }
        Ok(found)
    }
}

/// Returns 1 / x; zero if the quotient is infinite or NaN.
fn inverse<N: Real>(x: N) -> N {
    let inverse = N::ONE / x;
    if inverse.is_finite_number() { inverse } else { N::ZERO }
}

/// Joins two bodies in one frame. A mass beyond the range of the scalar becomes infinite.
impl<N: Real, const D: usize> Add for MassProperties<N, D> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::of_moments(&self.moments().plus(&other.moments()))
    }
}

impl<N: Real, const D: usize> AddAssign for MassProperties<N, D> {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

/// Removes a part from a body in the same frame. The result has no mass if the part weighs at least
/// as much as the body.
impl<N: Real, const D: usize> Sub for MassProperties<N, D> {
    type Output = Self;

    fn sub(self, part: Self) -> Self {
        Self::of_moments(&self.moments().minus(&part.moments()))
    }
}

impl<N: Real, const D: usize> SubAssign for MassProperties<N, D> {
    fn sub_assign(&mut self, part: Self) {
        *self = *self - part;
    }
}

/// Joins all bodies in one frame and rounds once; the default for an empty iterator.
impl<N: Real, const D: usize> Sum for MassProperties<N, D> {
    fn sum<I: Iterator<Item = Self>>(bodies: I) -> Self {
        let all = bodies.map(|body| body.moments()).reduce(|all, body| all.plus(&body));
        all.map_or_else(Self::default, |all| Self::of_moments(&all))
    }
}
