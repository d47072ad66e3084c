//! Names and line widths of layers.

use impinge::debug_render::Drawn;

/// The name and style of a layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Layer {
    /// The class of the SVG group that contains the layer.
    pub(crate) class: &'static str,
    /// The name of the layer in legends.
    pub(crate) name: &'static str,
    /// The width of lines, in pixels.
    pub(crate) width: f64,
    /// Whether the layer is also drawn, fainter, where surfaces hide it.
    pub(crate) shows_through: bool,
}

impl Layer {
    pub(crate) fn of(what: Drawn) -> Self {
        let thin = |class, name| Self { class, name, width: 1.0, shows_through: false };
        let bold = |class, name| Self { class, name, width: 1.8, shows_through: true };
        match what {
            Drawn::Object => Self { width: 1.25, ..thin("object", "objects") },
            Drawn::TightBox => thin("tight-box", "tight boxes"),
            Drawn::LoosenedBox => thin("loosened-box", "loosened boxes"),
            Drawn::TreeNode => thin("tree-node", "nodes of the tree"),
            Drawn::ContactPoint => bold("contact-point", "contact points"),
            Drawn::ContactNormal => bold("contact-normal", "contact normals"),
            Drawn::Manifold => bold("manifold", "manifolds"),
            Drawn::Proximity => bold("proximity", "proximities"),
            Drawn::Query => bold("query", "queries"),
            Drawn::QueryHit => bold("query-hit", "hits of queries"),
            _ => bold("other", "other"),
        }
    }
}
