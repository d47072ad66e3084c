//! The interface of back ends.

use super::{Color, ShapeMesh};
use crate::math::{Point, Space, Vector, unit};
use crate::tables::ByDimension;

/// The kind of object that a line, point or text belongs to, so that a back end can have layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Drawn {
    /// The shape of an object.
    Object,
    /// The smallest box of an object.
    TightBox,
    /// The box of an object in the broad phase.
    LoosenedBox,
    /// The box of a node of the broad phase's tree.
    TreeNode,
    /// A contact point, on one of the shapes.
    ContactPoint,
    /// The normal of a contact and its depth.
    ContactNormal,
    /// The area spanned by the points of a manifold.
    Manifold,
    /// Two objects that are near each other.
    Proximity,
    /// The input of a query: a ray, a box, a moving shape.
    Query,
    /// The result of a query.
    QueryHit,
}

/// A back end of debug drawing: a picture, a window, a file, a network.
///
/// Lengths and positions are in world coordinates. Only [`line`](Self::line) is required; by
/// default the other methods use it, and text is not drawn. The scalar and the dimension are those
/// of the drawing, so a back end for both dimensions implements the trait twice, or for all `D`.
///
/// ```
/// use impinge::debug_render::{Color, DebugRender, Drawn};
/// use impinge::dim2::math::Point;
///
/// /// Counts lines by what they belong to.
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

    /// Draws an arrow. By default its head is a fifth of its length; an arrow without length is a
    /// line between equal points.
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

    /// Draws a shape; by default its lines.
    ///
    /// The mesh of a shape does not change, and keeps its [`id`](ShapeMesh::id). A back end with a
    /// mesh cache stores the mesh on the first call, and then needs only the id and the pose.
    fn mesh(&mut self, mesh: &ShapeMesh<N, D>, pose: &N::Isometry, color: Color, what: Drawn) {
        let pose = N::pose(pose);
        for ends in &mesh.lines {
            let ends = ends.map(|vertex| pose.point(&mesh.vertices[vertex as usize]));
            self.line(ends, color, what);
        }
    }

    /// Begins a frame that shows the state at a time; by default does nothing.
    fn begin_frame(&mut self, time: f64) {
        let _ = time;
    }

    /// Ends a frame; by default does nothing.
    fn end_frame(&mut self) {}
}
