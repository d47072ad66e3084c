//! Mass properties in 2D, where the inertia is a single number.

use super::{MassError, MassProperties, Moments, amount, finite, inverse};
use crate::math::{Matrix, Point, Real, Vector};

impl<N: Real> MassProperties<N, 2> {
    /// Returns a body with the given centre of mass, mass, and moment of inertia about that centre.
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(center: Point<N, 2>, mass: N, inertia: N) -> Self {
        match Self::try_new(center, mass, inertia) {
            Ok(body) => body,
            Err(error) => panic!("{error}"),
        }
    }

    /// Returns a body with the given centre of mass, mass, and moment of inertia about that centre.
    ///
    /// # Errors
    /// If a number is not finite, or the mass or the moment is negative.
    pub fn try_new(center: Point<N, 2>, mass: N, inertia: N) -> Result<Self, MassError> {
        for coordinate in &center.coords {
            finite("a coordinate of the centre of mass", coordinate.as_f64())?;
        }
        let half = amount("the moment of inertia", inertia.as_f64())? * 0.5;
        Self::try_of_moments(&Moments {
            mass: amount("the mass", mass.as_f64())?,
            center: center.coords.map(N::as_f64),
            axes: Matrix::<f64, 2>::identity(),
            principal: Vector::<f64, 2>::repeat(half),
        })
    }

    /// Returns the moment of inertia about the centre of mass; not negative.
    #[must_use]
    pub fn inertia(&self) -> N {
        self.principal.x + self.principal.y
    }

    /// Returns 1 / inertia; zero for a body without inertia.
    #[must_use]
    pub fn inverse_inertia(&self) -> N {
        inverse(self.inertia())
    }

    /// Returns the moment of inertia about a point of the body's frame, by the parallel axis
    /// theorem.
    ///
    /// ```
    /// use impinge::dim2::math::{Point, Vector};
    /// use impinge::dim2::query::mass_properties;
    /// use impinge::dim2::shape::Cuboid;
    ///
    /// // The inertia of a door of length 2 and mass 3 about its hinge: slightly above m l² / 3.
    /// let door = mass_properties(&Cuboid::new(Vector::new(1.0_f64, 0.001)), 1.0)?.with_mass(3.0)?;
    /// assert!((door.inertia_about(&Point::new(-1.0, 0.0)) - 4.0).abs() < 1e-5);
    /// # Ok::<(), impinge::query::MassError>(())
    /// ```
    #[must_use]
    pub fn inertia_about(&self, point: &Point<N, 2>) -> N {
        self.inertia() + (point - self.center).norm_squared() * self.mass
    }
}
