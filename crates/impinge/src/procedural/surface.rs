//! The results of the procedural functions: outlines and surfaces.

use crate::math::{Point, Real, Vector};
use crate::shape::{MeshError, Polyline, TriMesh};

/// A closed line through 2D points, counter-clockwise; the last is joined to the first.
///
/// ```
/// use impinge::dim2::procedural;
/// use impinge::dim2::shape::Ball;
///
/// let outline = procedural::ball(&Ball::new(1.0_f32), 8);
/// assert_eq!(outline.points.len(), 8);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Outline<N: Real> {
    /// The corners, in the frame of the shape.
    pub points: Vec<Point<N, 2>>,
}

/// A closed surface of triangles in 3D.
///
/// Triangles share their vertices: each edge belongs to two triangles, once in each direction. At a
/// crease, the triangles on the two sides have different normals at the same vertices.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::procedural;
/// use impinge::dim3::shape::Cuboid;
///
/// let surface = procedural::cuboid(&Cuboid::new(Vector::repeat(1.0_f32)));
/// assert_eq!((surface.vertices.len(), surface.triangles.len()), (8, 12));
/// assert_eq!(surface.corners().len(), 12);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct TriangleSurface<N: Real> {
    /// The vertices, in the frame of the shape.
    pub vertices: Vec<Point<N, 3>>,
    /// The vertices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle, the outward unit normals of the true surface at its vertices, for smooth
    /// shading. The normal at the apex of a cone is the normal along the middle line of the
    /// triangle.
    pub normals: Vec<[Vector<N, 3>; 3]>,
}

impl<N: Real> TriangleSurface<N> {
    /// Returns the corner points of each triangle, counter-clockwise seen from outside.
    pub fn corners(&self) -> impl ExactSizeIterator<Item = [Point<N, 3>; 3]> + '_ {
        self.triangles.iter().map(|triangle| triangle.map(|index| self.vertices[index as usize]))
    }

    /// Returns a surface with the given vertices and without triangles.
    pub(super) const fn of_vertices(vertices: Vec<Point<N, 3>>) -> Self {
        Self { vertices, triangles: Vec::new(), normals: Vec::new() }
    }

    /// Appends a flat convex face, given counter-clockwise, as triangles that meet at its first
    /// vertex.
    pub(super) fn push_face(&mut self, ring: &[u32], normal: Vector<N, 3>) {
        for side in ring[1..].windows(2) {
            self.triangles.push([ring[0], side[0], side[1]]);
            self.normals.push([normal; 3]);
        }
    }
}

/// Converts the closed surface to a shape; its vertices and triangles keep their indices.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::procedural;
/// use impinge::dim3::shape::{Cuboid, TriMesh};
///
/// let surface = procedural::cuboid(&Cuboid::new(Vector::new(1.0_f32, 2.0, 3.0)));
/// let mesh = TriMesh::try_from(surface).expect("a good surface").one_sided();
/// assert!(mesh.is_closed() && mesh.is_oriented());
/// assert_eq!(mesh.normal(0), Some([1.0, 0.0, 0.0].into()));
/// ```
impl<N: Real> TryFrom<TriangleSurface<N>> for TriMesh<N, 3> {
    type Error = MeshError;

    fn try_from(surface: TriangleSurface<N>) -> Result<Self, MeshError> {
        Self::try_new(surface.vertices, surface.triangles)
    }
}

/// Converts the closed line to a shape: segment `i` starts at point `i`.
///
/// ```
/// use impinge::dim2::procedural;
/// use impinge::dim2::shape::{Ball, Polyline};
///
/// let ring = Polyline::try_from(procedural::ball(&Ball::new(2.0_f64), 24)).expect("a good line");
/// assert!(ring.is_closed());
/// assert_eq!(ring.num_segments(), 24);
/// ```
impl<N: Real> TryFrom<Outline<N>> for Polyline<N, 2> {
    type Error = MeshError;

    fn try_from(outline: Outline<N>) -> Result<Self, MeshError> {
        Self::try_closed(outline.points)
    }
}
