//! Options of a drawing: which kinds of objects are drawn, in which colours and sizes.

use super::{Color, MeshOptions};
use crate::math::Real;

/// The style of one kind of object.
///
/// ```
/// use impinge::debug_render::{Color, Style};
///
/// let red = Style { color: Color::rgb(255, 0, 0), size: 0.25_f32 };
/// assert_eq!(red.with_size(0.5).size, 2.0 * red.size);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Style<N: Real> {
    /// The colour of lines, points and texts.
    pub color: Color,
    /// The size of points and normals, as a length in the world. Other kinds of objects ignore it.
    pub size: N,
}

impl<N: Real> Style<N> {
    /// Returns the style with the size `size`.
    #[must_use]
    pub const fn with_size(self, size: N) -> Self {
        Self { size, ..self }
    }
}

/// The style of each kind of object. Kinds with `None` are not drawn and cost no time.
///
/// Each field is named after the variant of [`Drawn`](super::Drawn) that the back end receives. By
/// default shapes, contact points and normals, and queries are drawn. Sizes suit objects of size 1;
/// [`Self::scaled`] adapts them.
///
/// ```
/// use impinge::debug_render::DebugOptions;
///
/// let mut options = DebugOptions::<f64>::default().scaled(100.0);
/// assert!(options.object.is_some() && options.tight_box.is_none());
/// assert_eq!(options.contact_point.map(|style| style.size), Some(10.0));
/// options.tight_box = DebugOptions::all().tight_box;
/// assert!(options.tight_box.is_some());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DebugOptions<N: Real> {
    /// The shapes of objects.
    pub object: Option<Style<N>>,
    /// The smallest boxes around the objects.
    pub tight_box: Option<Style<N>>,
    /// The loosened boxes of the objects in the broad phase, if the broad phase has such boxes.
    pub loosened_box: Option<Style<N>>,
    /// The boxes of the nodes of the broad phase's trees, if it has trees.
    pub tree_node: Option<Style<N>>,
    /// Contact points, on both shapes.
    pub contact_point: Option<Style<N>>,
    /// For each contact, the depth and the normal. The depth is drawn as a line from the point on
    /// the first shape to the point on the second, and as text; the normal as an arrow whose length
    /// is the style's size.
    pub contact_normal: Option<Style<N>>,
    /// The area between the points of a manifold that has at least three points.
    pub manifold: Option<Style<N>>,
    /// Lines between the objects of pairs with proximity, and between closest points.
    pub proximity: Option<Style<N>>,
    /// Rays, boxes and shapes of queries, and the path of a moving shape.
    pub query: Option<Style<N>>,
    /// The hits of queries: points and normals.
    pub query_hit: Option<Style<N>>,
    /// The resolution and extent of the meshes of shapes.
    pub mesh: MeshOptions<N>,
}

impl<N: Real> DebugOptions<N> {
    /// Returns options that draw nothing.
    #[must_use]
    pub fn none() -> Self {
        Self {
            object: None,
            tight_box: None,
            loosened_box: None,
            tree_node: None,
            contact_point: None,
            contact_normal: None,
            manifold: None,
            proximity: None,
            query: None,
            query_hit: None,
            mesh: MeshOptions::default(),
        }
    }

    /// Returns options that draw everything.
    #[must_use]
    pub fn all() -> Self {
        let style = |color, size| Some(Style { color, size: N::lit(size) });
        Self {
            object: style(Color::rgb(210, 210, 210), 0.1),
            tight_box: style(Color::rgb(90, 160, 90), 0.1),
            loosened_box: style(Color::rgb(60, 100, 60), 0.1),
            tree_node: style(Color::rgb(70, 70, 130), 0.1),
            contact_point: style(Color::rgb(255, 80, 60), 0.1),
            contact_normal: style(Color::rgb(255, 200, 60), 0.4),
            manifold: style(Color::rgb(255, 120, 60).with_alpha(96), 0.1),
            proximity: style(Color::rgb(180, 110, 255), 0.1),
            query: style(Color::rgb(80, 200, 255), 0.1),
            query_hit: style(Color::rgb(255, 90, 220), 0.4),
            mesh: MeshOptions::default(),
        }
    }

    /// Returns the options with all sizes, and the extent of half-spaces, multiplied by a factor.
    #[must_use]
    pub fn scaled(mut self, factor: N) -> Self {
        let styles = [
            &mut self.object,
            &mut self.tight_box,
            &mut self.loosened_box,
            &mut self.tree_node,
            &mut self.contact_point,
            &mut self.contact_normal,
            &mut self.manifold,
            &mut self.proximity,
            &mut self.query,
            &mut self.query_hit,
        ];
        for style in styles.into_iter().flatten() {
            style.size *= factor;
        }
        self.mesh.half_space_extent *= factor;
        self
    }
}

impl<N: Real> Default for DebugOptions<N> {
    fn default() -> Self {
        let Self { object, contact_point, contact_normal, query, query_hit, .. } = Self::all();
        Self { object, contact_point, contact_normal, query, query_hit, ..Self::none() }
    }
}
