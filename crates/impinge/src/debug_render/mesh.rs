//! The edges and faces of a shape, in its own frame.

use crate::math::{Point, Real};

/// What is drawn of a shape: lines and, where it has a surface or an inside, triangles.
///
/// The lines are what people draw of a shape: edges of a box, circles of a ball. In 2D the triangles
/// fill the shape, in 3D they are its surface; shapes without either (segments, polylines) have none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShapeMesh<N: Real, const D: usize> {
    /// Equal for meshes of the same shape and fineness, different for all others in one program: a back end
    /// that keeps meshes knows one again by it.
    pub id: u64,
    /// The corners of all lines and triangles.
    pub vertices: Vec<Point<N, D>>,
    /// The indices of two vertices for each line.
    pub lines: Vec<[u32; 2]>,
    /// The indices of three vertices for each triangle, counter-clockwise as seen from outside.
    pub triangles: Vec<[u32; 3]>,
}
