//! The edges and faces of a shape, in its own frame.

use super::sketch::Sketch;
use crate::math::{Point, Real, Space};
use crate::procedural::MIN_SUBDIVISIONS;
use crate::shape::Shape;

/// The mesh for drawing a shape: lines and, if the shape has a surface or an interior, triangles.
///
/// The lines are the outlines that are usual in drawings: edges of a box, great circles of a ball.
/// In 2D the triangles fill the shape, in 3D they are its surface; segments and polylines have no
/// triangles. A triangle shape in 3D, alone or in a mesh, has one mesh triangle, for the side from
/// which its corners are counter-clockwise.
///
/// Lines without length and triangles with two equal corners are left out, and each line occurs
/// once. The mesh of a shape without extent is one vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMesh<N: Real, const D: usize> {
    /// A hash of all other fields. Equal meshes have equal hashes, in every program and on every
    /// machine; different meshes have different hashes, except for collisions of 64 bits. A back
    /// end can use it as a cache key.
    pub id: u64,
    /// The ends of all lines and the corners of all triangles.
    pub vertices: Vec<Point<N, D>>,
    /// The vertex indices of each line.
    pub lines: Vec<[u32; 2]>,
    /// The vertex indices of each triangle, counter-clockwise seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// The resolution of curved shapes, and the drawn extent of half-spaces.
///
/// ```
/// use impinge::debug_render::MeshOptions;
///
/// let fine = MeshOptions { subdivisions: 96, ..MeshOptions::default() };
/// assert_eq!((fine.subdivisions, fine.half_space_extent), (96, 10.0_f32));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshOptions<N: Real> {
    /// The number of segments of a full circle; 24 by default. Clamped to the range from 3 to
    /// [`Self::MAX_SUBDIVISIONS`].
    pub subdivisions: u32,
    /// The distance from the origin of a half-space to the sides of the square (in 2D the ends of
    /// the line) that represents it; 10 by default. If it is not finite, half-spaces are not drawn.
    pub half_space_extent: N,
}

impl<N: Real> MeshOptions<N> {
    /// The maximum number of segments of a full circle; finer circles look equal on a screen.
    pub const MAX_SUBDIVISIONS: u32 = 256;

    /// Returns the number of segments of a full circle, clamped to the supported range.
    pub(super) fn parts_of_turn(&self) -> u32 {
        self.subdivisions.clamp(MIN_SUBDIVISIONS, Self::MAX_SUBDIVISIONS)
    }
}

impl<N: Real> Default for MeshOptions<N> {
    fn default() -> Self {
        Self { subdivisions: 24, half_space_extent: N::lit(10.0) }
    }
}

impl<N: Space<D>, const D: usize> ShapeMesh<N, D> {
    /// Returns the lines and triangles of a shape, in its own frame.
    ///
    /// The vertices of round shapes lie on the surface, up to rounding. The mesh of a composite
    /// consists of the meshes of its parts at their poses; vertices and lines that parts share
    /// occur once. A custom convex shape is sampled by its support points in the directions of a
    /// ball's vertices. A half-space is drawn as a square with short marks on its solid side; half
    /// a side of the square is [`MeshOptions::half_space_extent`] long. In 2D the square is a line.
    ///
    /// The cost is O(n log n) for n vertices, so cache the result, as
    /// [`DebugDrawing`](super::DebugDrawing) does.
    ///
    /// ```
    /// use impinge::debug_render::{MeshOptions, ShapeMesh};
    /// use impinge::dim3::math::Vector;
    /// use impinge::dim3::shape::Cuboid;
    ///
    /// let brick = Cuboid::new(Vector::new(1.0_f64, 2.0, 3.0));
    /// let mesh = ShapeMesh::of(&brick, &MeshOptions::default());
    /// assert_eq!((mesh.vertices.len(), mesh.lines.len(), mesh.triangles.len()), (8, 12, 12));
    /// assert_eq!(mesh, ShapeMesh::of(&brick, &MeshOptions::default()), "with the same id");
    /// ```
    #[must_use]
    pub fn of(shape: &dyn Shape<N, D>, options: &MeshOptions<N>) -> Self {
        let mut sketch = Sketch::new(options);
        sketch.add(shape.geometry());
        sketch.finish()
    }
}

impl<N: Real, const D: usize> ShapeMesh<N, D> {
    /// Returns the hash of all numbers of the mesh (Fowler, Noll and Vo, FNV-1a, 64 bits per step).
    pub(super) fn hash(&self) -> u64 {
        let coordinates = self.vertices.iter().flat_map(|vertex| vertex.iter().map(|x| x.bits()));
        let lines = self.lines.iter().flatten().map(|&index| u64::from(index));
        let triangles = self.triangles.iter().flatten().map(|&index| u64::from(index));
        let counts = [self.vertices.len(), self.lines.len()].map(|count| count as u64);
        let numbers = counts.into_iter().chain(coordinates).chain(lines).chain(triangles);
        numbers.fold(0xcbf2_9ce4_8422_2325, |hash, number| {
            // The upper bits of a product depend on all bits of its factors; the shift mixes them
            // into the lower bits for the next step.
            let mixed = (hash ^ number).wrapping_mul(0x0100_0000_01b3);
            mixed ^ (mixed >> 32)
        })
    }
}
