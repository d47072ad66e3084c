//! The edges and faces of a shape, in its own frame.

use super::sketch::Sketch;
use crate::math::{Point, Real, Space};
use crate::procedural::MIN_SUBDIVISIONS;
use crate::shape::Shape;

/// What is drawn of a shape: lines and, where it has a surface or an inside, triangles.
///
/// The lines are what people draw of a shape: edges of a box, circles of a ball. In 2D the triangles
/// fill the shape, in 3D they are its surface; shapes without either (segments, polylines) have none.
/// Of a triangle in 3D, alone or in a mesh, there is one side: that of its order of corners.
///
/// Lines and triangles whose corners coincide are left out, and each is there once. A shape without
/// extent is one vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMesh<N: Real, const D: usize> {
    /// Computed from all that follows: equal for equal meshes, in every program and on every machine, and
    /// different for others but for an accident of 64 bits. A back end that keeps meshes knows one again
    /// by it.
    pub id: u64,
    /// The corners of all lines and triangles.
    pub vertices: Vec<Point<N, D>>,
    /// The indices of two vertices for each line.
    pub lines: Vec<[u32; 2]>,
    /// The indices of three vertices for each triangle, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
}

/// How finely shapes are drawn, and how much of those without end.
///
/// ```
/// use impinge::debug_render::MeshOptions;
///
/// let fine = MeshOptions { subdivisions: 96, ..MeshOptions::default() };
/// assert_eq!((fine.subdivisions, fine.half_space_extent), (96, 10.0_f32));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshOptions<N: Real> {
    /// The parts of a full turn of circles; 24 by default. It counts as 3 below that and as
    /// [`Self::MAX_SUBDIVISIONS`] above that.
    pub subdivisions: u32,
    /// Of a half-space the square (in 2D the line) around its origin that reaches so far is drawn; 10 by
    /// default. Nothing is drawn of it if this is not finite.
    pub half_space_extent: N,
}

impl<N: Real> MeshOptions<N> {
    /// The greatest number of parts of a turn: finer circles cannot be told apart on a screen.
    pub const MAX_SUBDIVISIONS: u32 = 256;

    /// The number of parts that stands for the number asked for.
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
    /// The lines and triangles of a shape, in its own frame.
    ///
    /// Of round shapes the vertices lie on the surface, up to rounding. Composites give those of their
    /// parts, each where it lies, and a seam once. A convex shape of your own is known by its support
    /// points only: those along the directions of a ball's vertices are taken. A half-space is a square
    /// (in 2D a line) of [`MeshOptions::half_space_extent`] with short marks on its solid side.
    ///
    /// Costs O(n log n) for n vertices, so keep it: a [`DebugDrawing`](super::DebugDrawing) does.
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
    /// The hash of all numbers of the mesh (Fowler, Noll and Vo, FNV-1a, 64 bits a step).
    pub(super) fn hash(&self) -> u64 {
        let coordinates = self.vertices.iter().flat_map(|vertex| vertex.iter().map(|x| x.bits()));
        let lines = self.lines.iter().flatten().map(|&index| u64::from(index));
        let triangles = self.triangles.iter().flatten().map(|&index| u64::from(index));
        let counts = [self.vertices.len(), self.lines.len()].map(|count| count as u64);
        let numbers = counts.into_iter().chain(coordinates).chain(lines).chain(triangles);
        numbers.fold(0xcbf2_9ce4_8422_2325, |hash, number| {
            // The upper bits of a product depend on all of its factors: they come down for the next step.
            let mixed = (hash ^ number).wrapping_mul(0x0100_0000_01b3);
            mixed ^ (mixed >> 32)
        })
    }
}
