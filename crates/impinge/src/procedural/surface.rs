//! What the functions of this module return.

use crate::math::{Point, Real, Vector};

/// A closed line through points of the plane, counter-clockwise; the last leads back to the first.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Outline<N: Real> {
    /// The corners, in the frame of the shape.
    pub points: Vec<Point<N, 2>>,
}

/// A closed surface of triangles in space.
///
/// Triangles share their vertices: each edge belongs to two triangles, once in each direction. Where
/// the surface has a crease, the triangles on its two sides differ in their normals only.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TriangleSurface<N: Real> {
    /// The vertices, in the frame of the shape.
    pub vertices: Vec<Point<N, 3>>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle the outward unit normals, at its vertices, of the true surface: what smooth
    /// shading asks for. At the tip of a cone it is the normal on the middle of the triangle.
    pub normals: Vec<[Vector<N, 3>; 3]>,
}

impl<N: Real> TriangleSurface<N> {
    /// The points of each triangle, counter-clockwise seen from outside.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [Point<N, 3>; 3]> + '_ {
        self.triangles.iter().map(|triangle| triangle.map(|index| self.vertices[index as usize]))
    }

    /// A surface of these vertices, without triangles so far.
    pub(super) const fn of_vertices(vertices: Vec<Point<N, 3>>) -> Self {
        Self { vertices, triangles: Vec::new(), normals: Vec::new() }
    }

    /// Adds a flat convex face, given counter-clockwise, as triangles that meet at its first vertex.
    pub(super) fn push_face(&mut self, ring: &[u32], normal: Vector<N, 3>) {
        for side in ring[1..].windows(2) {
            self.triangles.push([ring[0], side[0], side[1]]);
            self.normals.push([normal; 3]);
        }
    }
}
