//! The trait that back ends of debug drawing implement.

use super::{Color, ShapeMesh};
use crate::math::{Point, Space, Vector, unit};
use crate::tables::ByDimension;

/// The kind of object that a line, a point or another primitive belongs to. A back end can use it
/// for layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Drawn {
    /// The shape of an object.
    Object,
    /// The smallest box around an object.
    TightBox,
    /// The loosened box of an object in the broad phase.
    LoosenedBox,
    /// The box of a node of the broad phase's tree.
    TreeNode,
    /// A contact point, on one of the shapes.
    ContactPoint,
    /// The normal and the depth of a contact.
    ContactNormal,
    /// The area spanned by the points of a manifold.
    Manifold,
    /// A line between two objects or points that are near each other.
    Proximity,
    /// The input of a query: a ray, a box, a moving shape.
    Query,
    /// The result of a query.
    QueryHit,
}

/// A back end of debug drawing, which draws to a picture, a window, a file or a network.
///
/// Lengths and positions are in world coordinates. Only [`line`](Self::line) is required. By
/// default the other methods draw lines, and text is not drawn. `N` and `D` are the scalar and the
/// dimension of the drawing. So a back end for 2D and 3D implements the trait twice, or for all
/// `D`.
///
/// ```
/// use impinge::debug_render::{Color, DebugRender, Drawn};
/// use impinge::dim2::math::Point;
///
/// /// Counts lines by the kind of object.
/// #[derive(Default)]
/// struct Count(std::collections::BTreeMap<Drawn, u32>);
///
/// impl DebugRender<f32, 2> for Count {
///     fn line(&mut self, _: [Point<f32>; 2], _: Color, what: Drawn) {
///         *self.0.entry(what).or_default() += 1;
///     }
/// }
///
/// let mut count = Count::default();
/// count.point(&Point::new(1.0, 2.0), 0.1, Color::rgb(255, 0, 0), Drawn::ContactPoint);
/// assert_eq!(count.0[&Drawn::ContactPoint], 2, "a cross");
/// ```
pub trait DebugRender<N: Space<D>, const D: usize> {
    /// Draws a straight line.
    fn line(&mut self, ends: [Point<N, D>; 2], color: Color, what: Drawn);

    /// Draws a point; by default as a cross with lines of length `size`.
    fn point(&mut self, at: &Point<N, D>, size: N, color: Color, what: Drawn) {
        for axis in 0..D {
            let mut half = Vector::<N, D>::zeros();
            half[axis] = size * N::HALF;
            self.line([at - half, at + half], color, what);
        }
    }

    /// Draws an arrow; by default a line with a head of a fifth of its length. An arrow without
    /// length is drawn as a line between equal points.
    fn arrow(&mut self, from: &Point<N, D>, to: &Point<N, D>, color: Color, what: Drawn) {
        self.line([*from, *to], color, what);
        let along = to - from;
        let Some((direction, length)) = unit(&along) else { return };
        for side in <N::Algorithms>::tangents(&direction) {
            let wing = side * (length * N::lit(0.1));
            let root = to - along * N::lit(0.2);
            if wing != Vector::<N, D>::zeros() {
                self.line([root + wing, *to], color, what);
                self.line([root - wing, *to], color, what);
            }
        }
    }

    /// Draws a text beside a point; by default nothing.
    fn text(&mut self, at: &Point<N, D>, text: &str, color: Color, what: Drawn) {
        let _ = (at, text, color, what);
    }

    /// Draws a filled triangle; by default its three sides.
    fn triangle(&mut self, corners: [Point<N, D>; 3], color: Color, what: Drawn) {
        let [a, b, c] = corners;
        for ends in [[a, b], [b, c], [c, a]] {
            self.line(ends, color, what);
        }
    }

    /// Draws a shape at a pose; by default the lines of its mesh.
    ///
    /// The mesh of a shape and its [`id`](ShapeMesh::id) do not change. A back end with a mesh
    /// cache can store the mesh on the first call; later it needs only the id and the pose.
    fn mesh(&mut self, mesh: &ShapeMesh<N, D>, pose: &N::Isometry, color: Color, what: Drawn) {
        let pose = N::pose(pose);
        for ends in &mesh.lines {
            let ends = ends.map(|vertex| pose.point(&mesh.vertices[vertex as usize]));
            self.line(ends, color, what);
        }
    }

    /// Begins a frame that shows the state at time `time`; by default does nothing.
    fn begin_frame(&mut self, time: f64) {
        let _ = time;
    }

    /// Ends a frame; by default does nothing.
    fn end_frame(&mut self) {}
}
