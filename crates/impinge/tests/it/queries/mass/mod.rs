//! Tests of mass, centre of mass and inertia.

mod by_hand;
mod counted;
mod laws;
mod meshes;
mod own;

use impinge::math::{Matrix, Point, Real, Space, Vector};
use impinge::query::{MassProperties, mass_properties};
use impinge::shape::Shape;

/// Mass properties at density one in `f64`: mass, centre, and inertia about the centre.
pub(super) type Found<const D: usize> = (f64, Vector<f64, D>, Matrix<f64, D>);

/// Scalars and dimensions whose inertia is read as a matrix. In 2D the moment of inertia is the
/// element in the first row and column; all other elements are zero.
pub(super) trait Inertia<const D: usize>: Space<D> {
    fn inertia_of(body: &MassProperties<Self, D>) -> Matrix<f64, D>;
}

impl<N: Real> Inertia<2> for N {
    fn inertia_of(body: &MassProperties<N, 2>) -> Matrix<f64, 2> {
        Matrix::<f64, 2>::new(body.inertia().as_f64(), 0.0, 0.0, 0.0)
    }
}

impl<N: Real> Inertia<3> for N {
    fn inertia_of(body: &MassProperties<N, 3>) -> Matrix<f64, 3> {
        body.inertia().map(N::as_f64)
    }
}

pub(super) fn wide<N: Inertia<D>, const D: usize>(body: &MassProperties<N, D>) -> Found<D> {
    (body.mass().as_f64(), body.center_of_mass().coords.map(N::as_f64), N::inertia_of(body))
}

/// Returns the mass properties of a shape at density one.
pub(super) fn unit<N: Inertia<D>, const D: usize>(shape: &dyn Shape<N, D>) -> Found<D> {
    wide(&mass_properties(shape, N::ONE).unwrap_or_else(|error| panic!("{error}: {shape:?}")))
}

/// Asserts that the mass properties are equal up to a fraction of the size of each value. For the
/// centre of mass, that size is the extent of the solid plus the distance from the origin.
#[track_caller]
pub(super) fn assert_alike<const D: usize>(
    found: &Found<D>,
    expected: &Found<D>,
    share: f64,
    what: &str,
) {
    let reach = (expected.2.amax() / expected.0.max(f64::MIN_POSITIVE)).sqrt() + expected.1.norm();
    let alike = (found.0 - expected.0).abs() <= share * expected.0
        && (found.1 - expected.1).norm() <= share * reach
        && (found.2 - expected.2).amax() <= share * expected.2.amax();
    assert!(alike, "{what}: {found:?}\nis not {expected:?}");
}

pub(super) fn p2(x: f64, y: f64) -> Point<f64, 2> {
    Point::<f64, 2>::new(x, y)
}

pub(super) fn p3(x: f64, y: f64, z: f64) -> Point<f64, 3> {
    Point::<f64, 3>::new(x, y, z)
}
