//! The dispatch of mass integrals by dimension.

use super::enclosed::{enclosed2, enclosed3};
use super::outline::{self, round_polygon};
use super::plate;
use super::polyhedron::round_polyhedron;
use super::round_ellipsoid::{round_ellipse, round_ellipsoid};
use super::{support2, support3};
use crate::math::{Point, Real, Vector};
use crate::shape::{MassError, Moments, Polytope, Shape, SupportMap};
use crate::tables::Here;

/// Mass integrals that differ by dimension, at density one.
#[expect(unnameable_types, private_interfaces, reason = "for this crate alone")]
pub trait MassByDimension<N: Real, const D: usize> {
    /// Returns the moments of the set of points within a radius of a polytope.
    fn round_polytope(polytope: &Polytope<N, D>, radius: N) -> Moments<D>;

    /// Returns the moments of the set of points within a radius of a triangle.
    fn round_triangle(corners: &[Point<N, D>; 3], radius: N) -> Moments<D>;

    /// Returns the moments of the set of points within a positive radius of an ellipsoid.
    fn round_ellipsoid(half_axes: &Vector<N, D>, radius: N) -> Moments<D>;

    /// Returns the moments of a convex solid, integrated from its support points; an error if a
    /// support point is not finite.
    fn by_support(solid: &dyn SupportMap<N, D>) -> Result<Moments<D>, MassError>;

    /// Returns the moments of the area (in 2D) or the volume (in 3D) of a built-in composite other
    /// than a compound; an error if it bounds none.
    fn enclosed(shape: &dyn Shape<N, D>) -> Result<Moments<D>, MassError>;
}

#[expect(private_interfaces, reason = "for this crate alone")]
impl<N: Real> MassByDimension<N, 2> for Here {
    fn round_polytope(polytope: &Polytope<N, 2>, radius: N) -> Moments<2> {
        round_polygon(polytope, radius)
    }

    fn round_triangle(corners: &[Point<N, 2>; 3], radius: N) -> Moments<2> {
        outline::round_triangle(corners, radius)
    }

    fn round_ellipsoid(half_axes: &Vector<N, 2>, radius: N) -> Moments<2> {
        round_ellipse(half_axes, radius)
    }

    fn by_support(solid: &dyn SupportMap<N, 2>) -> Result<Moments<2>, MassError> {
        support2::by_support(solid)
    }

    fn enclosed(shape: &dyn Shape<N, 2>) -> Result<Moments<2>, MassError> {
        enclosed2(shape)
    }
}

#[expect(private_interfaces, reason = "for this crate alone")]
impl<N: Real> MassByDimension<N, 3> for Here {
    fn round_polytope(polytope: &Polytope<N, 3>, radius: N) -> Moments<3> {
        round_polyhedron(polytope, radius)
    }

    fn round_triangle(corners: &[Point<N, 3>; 3], radius: N) -> Moments<3> {
        plate::round_triangle(corners, radius)
    }

    fn round_ellipsoid(half_axes: &Vector<N, 3>, radius: N) -> Moments<3> {
        round_ellipsoid(half_axes, radius)
    }

    fn by_support(solid: &dyn SupportMap<N, 3>) -> Result<Moments<3>, MassError> {
        support3::by_support(solid)
    }

    fn enclosed(shape: &dyn Shape<N, 3>) -> Result<Moments<3>, MassError> {
        enclosed3(shape)
    }
}
