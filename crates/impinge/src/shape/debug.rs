//! `Debug` output of shapes: the input that a user gave, without trees and tables. Meshes,
//! polylines and height fields may hold millions of elements; their output has only counts and
//! options.

use core::fmt;

use crate::math::{Real, Space};
use crate::shape::{
    Compound, ConvexHull, ConvexPolygon, HeightField, Polyline, Polytope, Tetrahedron, TriMesh,
};

/// Writes the vertices of a polytope, and its faces in 3D. In 2D the order of the vertices
/// determines the sides.
fn polytope<N: Real, const D: usize>(
    f: &mut fmt::Formatter<'_>,
    name: &str,
    polytope: &Polytope<N, D>,
) -> fmt::Result {
    let mut fields = f.debug_struct(name);
    fields.field("vertices", &polytope.vertices());
    if !polytope.edges().is_empty() {
        let rings = polytope.faces().iter().map(|face| polytope.face_vertices(face));
        fields.field("faces", &rings.collect::<Vec<_>>());
    }
    fields.finish()
}

impl<N: Real, const D: usize> fmt::Debug for Polytope<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        polytope(f, "Polytope", self)
    }
}

impl<N: Real> fmt::Debug for ConvexPolygon<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        polytope(f, "ConvexPolygon", self.polytope())
    }
}

impl<N: Real> fmt::Debug for ConvexHull<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        polytope(f, "ConvexHull", self.polytope())
    }
}

impl<N: Real> fmt::Debug for Tetrahedron<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Tetrahedron").field("corners", self.corners()).finish()
    }
}

impl<N: Space<D>, const D: usize> fmt::Debug for Compound<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Compound").field("children", &self.children()).finish()
    }
}

impl<N: Real, const D: usize> fmt::Debug for TriMesh<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("TriMesh")
            .field("num_vertices", &self.vertices().len())
            .field("num_triangles", &self.triangles().len())
            .field("is_one_sided", &self.is_one_sided())
            .field("keeps_internal_edges", &self.keeps_internal_edges())
            .finish()
    }
}

impl<N: Real, const D: usize> fmt::Debug for Polyline<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Polyline")
            .field("num_vertices", &self.vertices.len())
            .field("num_segments", &self.segments.len())
            .field("is_one_sided", &self.front.is_some())
            .field("keeps_internal_edges", &self.keeps_internal_edges)
            .finish()
    }
}

impl<N: Real, const D: usize> fmt::Debug for HeightField<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("HeightField")
            .field("num_heights", &self.heights().len())
            .field("scale", self.scale())
            .field("is_one_sided", &self.is_one_sided())
            .field("keeps_internal_edges", &self.keeps_internal_edges())
            .finish()
    }
}
