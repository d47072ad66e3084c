//! The common core of convex polygons and convex hulls: vertices, faces, edges and who meets whom.

use super::SupportMap;
use crate::math::{Point, Real, Vector, max};

/// A convex solid with flat faces, in any dimension.
///
/// In the plane the faces are the sides: face `i` leads from vertex `i` to vertex `i + 1`,
/// counter-clockwise, and there are no edges. In space the faces are polygons, counter-clockwise
/// seen from outside, and each edge lies between two faces.
#[derive(Clone, Debug, PartialEq)]
pub struct Polytope<N: Real, const D: usize> {
    pub(super) vertices: Vec<Point<N, D>>,
    pub(super) faces: Vec<PolytopeFace<N, D>>,
    /// The vertices of all faces, one loop after the other.
    pub(super) loops: Vec<u32>,
    /// For each entry of `loops`, the edge (in the plane: the face) that leads to the next vertex.
    pub(super) loop_sides: Vec<u32>,
    /// Empty in the plane.
    pub(super) edges: Vec<PolytopeEdge>,
    pub(super) center: Point<N, D>,
    pub(super) reach: N,
}

/// A flat face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolytopeFace<N: Real, const D: usize> {
    /// The unit vector out of the solid.
    pub normal: Vector<N, D>,
    /// Every point of the solid has `normal · x ≤ offset`, up to rounding.
    pub offset: N,
    pub(super) first: u32,
    pub(super) len: u32,
}

/// An edge between two faces, in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PolytopeEdge {
    /// Its ends: the loop of the first face runs from the first to the second.
    pub vertices: [u32; 2],
    /// The faces on its two sides.
    pub faces: [u32; 2],
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// The vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Point<N, D>] {
        &self.vertices
    }

    /// The faces.
    #[must_use]
    pub fn faces(&self) -> &[PolytopeFace<N, D>] {
        &self.faces
    }

    /// The edges; none in the plane.
    #[must_use]
    pub fn edges(&self) -> &[PolytopeEdge] {
        &self.edges
    }

    /// The vertices around a face of this solid.
    #[must_use]
    pub fn face_vertices(&self, face: &PolytopeFace<N, D>) -> &[u32] {
        let first = face.first as usize;
        &self.loops[first..first + face.len as usize]
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Polytope<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let mut best = self.vertices[0];
        let mut height = best.coords.dot(direction);
        for vertex in &self.vertices[1..] {
            let candidate = vertex.coords.dot(direction);
            if candidate > height {
                (best, height) = (*vertex, max(candidate, height));
            }
        }
        best
    }

    fn center(&self) -> Point<N, D> {
        self.center
    }

    fn reach(&self) -> N {
        self.reach
    }
}
