//! Mass of the areas and volumes that closed polylines and meshes enclose, and of filled meshes in
//! 2D.

use super::integrals::{Integrals, LocalUnits};
use super::outline::crossed;
use super::polyhedron::add_cones;
use crate::bounding_volume::Aabb;
use crate::math::{Point, Real};
use crate::shape::{EdgeNeighbor, MassError, Moments, Polyline, Shape, TriMesh};

/// The enclosed area or volume is treated as zero if it is at most this fraction of the sum of the
/// magnitudes of all cones.
const NONE: f64 = 1024.0 * f64::EPSILON;

/// A sum of signed cones with their apex at the origin; a cone is positive if the origin lies
/// behind its base.
struct Cones<const D: usize> {
    sum: Integrals<D>,
    /// The sum of the magnitudes of all cones.
    total: f64,
}

impl<const D: usize> Cones<D> {
    fn none() -> Self {
        Self { sum: Integrals::none(), total: 0.0 }
    }

    /// Runs `add` on `sum`, and adds the magnitude of the change to `total`.
    fn add(&mut self, add: impl FnOnce(&mut Integrals<D>)) {
        let before = self.sum.mass;
        add(&mut self.sum);
        self.total += (self.sum.mass - before).abs();
    }

    /// Returns the moments of the body, for either orientation of its surface. The body has no mass
    /// if the sum is treated as zero.
    fn moments(&self) -> Moments<D> {
        if self.sum.mass.abs() <= NONE * self.total {
            return Integrals::none().moments();
        }
        if self.sum.mass < 0.0 { self.sum.negated().moments() } else { self.sum.moments() }
    }
}

/// Returns the moments of the triangles of a 2D mesh, or of the area that a closed polyline
/// encloses.
///
/// # Errors
/// If the shape is an open polyline or another composite.
pub(super) fn enclosed2<N: Real>(shape: &dyn Shape<N, 2>) -> Result<Moments<2>, MassError> {
    let mut cones = Cones::none();
    let units = if let Some(mesh) = shape.as_shape::<TriMesh<N, 2>>() {
        let units = units(mesh.tree().bounds());
        for index in (0_u32..).take(mesh.num_triangles()) {
            let [a, b, c] =
                mesh.triangle(index).corners().each_ref().map(|corner| units.point(corner));
            // The cone is about a corner, so a small triangle far from the others loses no digits.
            let (to_b, to_c) = (b - a, c - a);
            let mut triangle = Integrals::none();
            triangle.add_cone(crossed(&to_b, &to_c) * 0.5, &[&to_b, &to_c]);
            let filled = if triangle.mass < 0.0 { triangle.negated() } else { triangle };
            cones.add(|sum| sum.add_about(&a, &filled));
        }
        units
    } else if let Some(line) = shape.as_shape::<Polyline<N, 2>>().filter(|line| line.is_outline()) {
        let units = units(line.tree().bounds());
        for segment in (0_u32..).take(line.num_segments()).map(|index| line.segment(index)) {
            let [a, b] = [segment.a(), segment.b()].map(|end| units.point(end));
            cones.add(|sum| sum.add_cone(crossed(&a, &b) * 0.5, &[&a, &b]));
        }
        units
    } else {
        return Err(MassError::NotClosed { part: 0 });
    };
    Ok(units.grown(&cones.moments()))
}

/// Returns the moments of the volume that a closed 3D mesh encloses.
///
/// # Errors
/// If the mesh bounds no volume (the error names the first triangle at fault), or the shape is
/// another composite.
pub(super) fn enclosed3<N: Real>(shape: &dyn Shape<N, 3>) -> Result<Moments<3>, MassError> {
    let Some(mesh) = shape.as_shape::<TriMesh<N, 3>>() else {
        return Err(MassError::NotClosed { part: 0 });
    };
    if !mesh.is_volume() {
        return Err(MassError::NotClosed { part: opening(mesh) });
    }
    let (units, mut cones) = (units(mesh.tree().bounds()), Cones::none());
    for index in (0_u32..).take(mesh.num_triangles()) {
        let corners = mesh.triangle(index).corners().each_ref().map(|corner| units.point(corner));
        cones.add(|sum| add_cones(&corners, sum));
    }
    Ok(units.grown(&cones.moments()))
}

/// Returns the local units for a shape with the box `bounds`; about the origin for `None`.
fn units<N: Real, const D: usize>(bounds: Option<&Aabb<N, D>>) -> LocalUnits<D> {
    let origin = Point::<N, D>::origin();
    let [low, high] = bounds.map_or([&origin; 2], |bounds| [bounds.mins(), bounds.maxs()]);
    LocalUnits::around([low, high], N::ZERO)
}

/// Returns the first triangle with a side that has no neighbour, several neighbours, or a neighbour
/// that traverses the side in the same direction; 0 if there is none.
fn opening<N: Real>(mesh: &TriMesh<N, 3>) -> u32 {
    let is_open = |triangle: u32| {
        let corners = *mesh.triangle(triangle).corners();
        (0..3_u32).any(|side| {
            let [from, to] = [side as usize, (side as usize + 1) % 3].map(|corner| corners[corner]);
            let fits = matches!(
                mesh.neighbor(triangle, side),
                EdgeNeighbor::Triangle { is_flipped: false, .. }
            );
            from != to && !fits
        })
    };
    (0_u32..).take(mesh.num_triangles()).find(|&triangle| is_open(triangle)).unwrap_or(0)
}
