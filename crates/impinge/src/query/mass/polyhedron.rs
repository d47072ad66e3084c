//! Convex polyhedra, and the sets of points within a radius of them.
//!
//! Steiner's decomposition cuts a rounded polyhedron into the polyhedron, a prism on each face, a
//! sector of a cylinder along each edge between the normals of its two faces, and a sector of a
//! ball at each vertex: the directions for which that vertex is the support point. The integrals of
//! the ball sectors follow from their sides by Stokes' theorem.

use super::integrals::{Integrals, LocalUnits};
use super::plate::{EdgeWedge, Plate, radial};
use crate::math::{Matrix, Real, Vector};
use crate::shape::{Moments, Polytope};

type V3 = Vector<f64, 3>;

/// Returns the moments of the set of points within `radius` of a convex polyhedron.
pub(super) fn round_polyhedron<N: Real>(solid: &Polytope<N, 3>, radius: N) -> Moments<3> {
    let units = LocalUnits::around(solid.vertices(), radius);
    let vertices: Vec<V3> = solid.vertices().iter().map(|vertex| units.point(vertex)).collect();
    let (radius, mut sum, mut normals) = (units.length(radius), Integrals::none(), Vec::new());
    for face in solid.faces() {
        let corners = solid.face_vertices(face).iter().map(|&corner| vertices[corner as usize]);
        let corners: Vec<V3> = corners.collect();
        add_cones(&corners, &mut sum);
        let plate = Plate::new(&corners);
        let normal = plate.normal.unwrap_or_else(|| face.normal.map(N::as_f64));
        plate.add_prism([radius, 1.0, radius * 0.5], &normal, &mut sum);
        normals.push(normal);
    }
    if radius > 0.0 {
        let edges = solid.edges().iter();
        let ridges = edges.map(|edge| Ridge {
            vertices: edge.vertices.map(|vertex| vertex as usize),
            ends: edge.vertices.map(|vertex| vertices[vertex as usize]),
            normals: edge.faces.map(|face| normals[face as usize]),
        });
        add_ridges(&ridges.collect::<Vec<_>>(), vertices.len(), radius, &mut sum);
    }
    units.grown(&sum.moments())
}

/// Adds the tetrahedra between the origin and a face, whose corners are counter-clockwise seen from
/// outside.
pub(super) fn add_cones(corners: &[V3], sum: &mut Integrals<3>) {
    for pair in corners.windows(2).skip(1) {
        let [a, b, c] = [&corners[0], &pair[0], &pair[1]];
        sum.add_cone(a.cross(b).dot(c) / 6.0, &[a, b, c]);
    }
}

/// An edge between two faces, with their outward unit normals.
#[derive(Clone, Copy, Debug)]
struct Ridge {
    vertices: [usize; 2],
    ends: [V3; 2],
    normals: [V3; 2],
}

impl Ridge {
    fn wedge(&self) -> EdgeWedge {
        let [one, other] = &self.normals;
        let angle = libm::atan2(one.cross(other).norm(), one.dot(other));
        let middle = (one + other).try_normalize(0.0).unwrap_or(*one);
        EdgeWedge { ends: self.ends, middle, angle }
    }
}

/// Adds the cylinder sectors of all edges and the ball sectors of all vertices.
fn add_ridges(ridges: &[Ridge], vertices: usize, radius: f64, sum: &mut Integrals<3>) {
    let wedges: Vec<EdgeWedge> = ridges.iter().map(Ridge::wedge).collect();
    // For each vertex, a direction within its normal cone.
    let mut inner = vec![V3::zeros(); vertices];
    for (ridge, wedge) in ridges.iter().zip(&wedges) {
        for vertex in ridge.vertices {
            inner[vertex] += wedge.middle;
        }
    }
    for (ridge, wedge) in ridges.iter().zip(&wedges) {
        wedge.add(radius, sum);
        let [a, b] = ridge.ends;
        let Some(along) = (b - a).try_normalize(0.0) else { continue };
        for (end, outward) in [along, -along].into_iter().enumerate() {
            let inner = inner[ridge.vertices[end]];
            let side = SectorSide { ridge, wedge, inner, outward };
            sum.add_about(&ridge.ends[end], &side.integrals(radius));
        }
    }
}

/// The contribution of one edge to the ball sector at one end of the edge: the arc between the
/// normals of the two faces, and the triangle from that arc to a direction within the sector.
struct SectorSide<'a> {
    ridge: &'a Ridge,
    wedge: &'a EdgeWedge,
    /// A direction within the sector, of any length.
    inner: V3,
    /// The unit normal of the arc's plane, out of the sector: along the edge, away from the vertex.
    outward: V3,
}

impl SectorSide<'_> {
    /// Returns the contribution of the arc to the sector's integrals. By Stokes' theorem the
    /// integral of u over directions is half of the sum of the angles of the arcs times their
    /// inward normals. The integral of u uᵀ is a third of the solid angle minus a sixth of the flux
    /// of the gradient of u uᵀ through the arcs.
    fn integrals(&self, radius: f64) -> Integrals<3> {
        let (middle, angle) = (&self.wedge.middle, self.wedge.angle);
        let solid_angle = self.solid_angle();
        let along_arc = middle * (2.0 * libm::sin(angle * 0.5));
        let flux = self.outward * along_arc.transpose();
        let third = Matrix::<f64, 3>::from_diagonal_element(solid_angle / 3.0);
        let [cubic, quartic, quintic] = radial(radius);
        Integrals {
            mass: solid_angle * cubic,
            first: self.outward * (-0.5 * angle * quartic),
            second: (third - (flux + flux.transpose()) / 6.0) * quintic,
        }
    }

    /// Returns the solid angle between the arc and the inner direction, computed in two halves, so
    /// that no triangle has a side of 180°.
    fn solid_angle(&self) -> f64 {
        let middle = &self.wedge.middle;
        let [one, other] = &self.ridge.normals;
        // The direction of the arc that is counter-clockwise around the sector, seen from outside.
        let forward = middle.cross(&self.outward);
        let ends = if (other - one).dot(&forward) >= 0.0 { [one, other] } else { [other, one] };
        let Some(inner) = self.inner.try_normalize(0.0) else { return 0.0 };
        solid_angle(&inner, ends[0], middle) + solid_angle(&inner, middle, ends[1])
    }
}

/// Returns the solid angle of a triangle of unit vectors, positive if they run counter-clockwise
/// seen from outside (van Oosterom and Strackee, "The solid angle of a plane triangle", 1983).
fn solid_angle(a: &V3, b: &V3, c: &V3) -> f64 {
    2.0 * libm::atan2(a.cross(b).dot(c), 1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
