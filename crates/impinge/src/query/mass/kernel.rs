//! What differs by dimension in the integration of shapes.

use core::fmt;

use super::enclosed::{enclosed2, enclosed3};
use super::outline::{self, round_polygon};
use super::plate;
use super::polyhedron::round_polyhedron;
use super::round_ellipsoid::{round_ellipse, round_ellipsoid};
use super::{support2, support3};
use crate::math::{Point, Real, Vector};
use crate::shape::{MassError, Moments, Polytope, Shape, SupportMap};

/// Functions for one scalar and dimension. Unlike the entry points in [`crate::tables`] they are made where they are
/// used: a program that asks for no mass holds none of them.
pub struct MassKernel<N: Real, const D: usize> {
    /// The points within a radius of a polytope.
    pub(super) polytope: fn(&Polytope<N, D>, N) -> Moments<D>,
    /// The points within a radius of a triangle.
    pub(super) triangle: fn(&[Point<N, D>; 3], N) -> Moments<D>,
    /// The points within a positive radius of an ellipsoid.
    pub(super) ellipsoid: fn(&Vector<N, D>, N) -> Moments<D>,
    pub(super) by_support: fn(&dyn SupportMap<N, D>) -> Result<Moments<D>, MassError>,
    /// What a composite of the library's encloses that is no compound.
    pub(super) enclosed: fn(&dyn Shape<N, D>) -> Result<Moments<D>, MassError>,
}

impl<N: Real> MassKernel<N, 2> {
    pub(crate) fn in_plane() -> Self {
        Self {
            polytope: round_polygon,
            triangle: outline::round_triangle,
            ellipsoid: round_ellipse,
            by_support: support2::by_support,
            enclosed: enclosed2,
        }
    }
}

impl<N: Real> MassKernel<N, 3> {
    pub(crate) fn in_space() -> Self {
        Self {
            polytope: round_polyhedron,
            triangle: plate::round_triangle,
            ellipsoid: round_ellipsoid,
            by_support: support3::by_support,
            enclosed: enclosed3,
        }
    }
}

impl<N: Real, const D: usize> fmt::Debug for MassKernel<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MassKernel").finish_non_exhaustive()
    }
}
