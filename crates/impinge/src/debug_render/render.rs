//! What a back end can do.

use super::{Color, ShapeMesh};
use crate::math::{Point, Space, Vector, unit};
use crate::tables::ByDimension;

/// What a line, point or text belongs to, so that a back end can have layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Drawn {
    /// The shape of an object.
    Object,
    /// The box of an object, as small as it can be.
    TightBox,
    /// The box of an object in the broad phase.
    LoosenedBox,
    /// The box of a node of the broad phase's tree.
    TreeNode,
    /// A contact point, on one of the shapes.
    ContactPoint,
    /// The normal of a contact and its depth.
    ContactNormal,
    /// The area that the points of a manifold span.
    Manifold,
    /// Two objects that are near each other.
    Proximity,
    /// What a query asks: a ray, a box, a shape on its way.
    Query,
    /// What a query found.
    QueryHit,
}

/// A back end of debug drawing: a picture, a window, a file, a network.
///
/// Lengths and positions are those of the world. Only [`line`](Self::line) has to be written; the other
/// methods draw with it, and text is left out. The scalar and the dimension are those of what is drawn,
/// so a back end for both dimensions implements the trait twice, or for all `D`.
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
    /// A straight line.
    fn line(&mut self, ends: [Point<N, D>; 2], color: Color, what: Drawn);

    /// A point; `size` is the length of the lines of the cross that it is unless overridden.
    fn point(&mut self, at: &Point<N, D>, size: N, color: Color, what: Drawn) {
        for axis in 0..D {
            let mut half = Vector::<N, D>::zeros();
            half[axis] = size * N::HALF;
            self.line([at - half, at + half], color, what);
        }
    }

    /// An arrow; its head is a fifth of its length. One without length is a point of no size.
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

    /// A text beside a point; nothing unless overridden.
    fn text(&mut self, at: &Point<N, D>, text: &str, color: Color, what: Drawn) {
        let _ = (at, text, color, what);
    }

    /// A filled triangle; its three sides unless overridden.
    fn triangle(&mut self, corners: [Point<N, D>; 3], color: Color, what: Drawn) {
        let [a, b, c] = corners;
        for ends in [[a, b], [b, c], [c, a]] {
            self.line(ends, color, what);
        }
    }

    /// A shape; its lines unless overridden.
    ///
    /// The mesh of a shape is the same each time, and has the same [`id`](ShapeMesh::id): a back end with
    /// memory of its own keeps it at the first call, and needs only the id and the pose afterwards.
    fn mesh(&mut self, mesh: &ShapeMesh<N, D>, pose: &N::Isometry, color: Color, what: Drawn) {
        let pose = N::pose(pose);
        for ends in &mesh.lines {
            let ends = ends.map(|vertex| pose.point(&mesh.vertices[vertex as usize]));
            self.line(ends, color, what);
        }
    }

    /// What is drawn from now on is how things are at a time; nothing unless overridden.
    fn begin_frame(&mut self, time: f64) {
        let _ = time;
    }

    /// A frame is complete; nothing unless overridden.
    fn end_frame(&mut self) {}
}
