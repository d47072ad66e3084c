//! The colours of objects: a muted palette by the kind of shape, legible on a light and on a dark
//! page.

use impinge::debug_render::{Color, DebugOptions, Drawn, MeshOptions, Style};
use impinge::math::Real;
use impinge::shape::ShapeKind;

/// The flag of an instance whose object has a contact or intersects another object.
pub(crate) const TOUCHES: u32 = 1;
/// The flag of an instance whose object has a proximity query.
pub(crate) const SENSOR: u32 = 2;
/// The flag of an instance whose object is selected.
pub(crate) const SELECTED: u32 = 4;
/// The flag of an instance that shows the shape of a query, not an object.
pub(crate) const ASKED: u32 = 8;

/// The colour of selected objects.
const SELECTION: Color = Color::rgb(242, 153, 46);
/// The colour of sensors, which are objects with proximity queries.
const SENSORS: Color = Color::rgb(150, 120, 200).with_alpha(88);
/// The colour towards which touching objects are mixed.
const WARM: Color = Color::rgb(255, 140, 110);
/// The share of the colour `WARM` in the mixture, in 256ths.
const WARMTH: u16 = 40;

/// Returns the colour of a kind of shape.
const fn of_kind(kind: ShapeKind) -> Color {
    match kind {
        ShapeKind::Ball | ShapeKind::Ellipsoid => Color::rgb(70, 150, 206),
        ShapeKind::Capsule | ShapeKind::TaperedCapsule => Color::rgb(52, 166, 142),
        ShapeKind::Cuboid => Color::rgb(116, 144, 182),
        ShapeKind::Polytope | ShapeKind::Rounded => Color::rgb(142, 124, 204),
        ShapeKind::Cylinder | ShapeKind::Cone => Color::rgb(196, 158, 92),
        ShapeKind::Segment | ShapeKind::Triangle => Color::rgb(98, 118, 146),
        ShapeKind::SupportMap => Color::rgb(200, 120, 160),
        ShapeKind::Plane => Color::rgb(158, 164, 174),
        _ => Color::rgb(152, 166, 152),
    }
}

/// The properties of an object that determine its colour.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Look {
    pub(crate) kind: ShapeKind,
    /// The index of the object's handle. It varies the tone of the colour, so that neighbours in a
    /// pile can be distinguished.
    pub(crate) object: usize,
    /// The flags: a combination of [`TOUCHES`], [`SENSOR`] and [`SELECTED`].
    pub(crate) flags: u32,
}

impl Look {
    /// Returns the colour of the object as a word; see [`word`].
    pub(crate) fn color(&self) -> u32 {
        let base = if self.flags & SENSOR == 0 { self.shaded() } else { SENSORS };
        if self.flags & SELECTED != 0 {
            return word(SELECTION.with_alpha(base.alpha.max(160)));
        }
        // Half-spaces are not highlighted: as floors they touch objects nearly always, and they
        // fill much of the picture.
        let is_warm = self.flags & TOUCHES != 0 && self.kind != ShapeKind::Plane;
        word(if is_warm { mixed(base, WARM, WARMTH) } else { base })
    }

    /// Returns one of four tones of the colour of the shape's kind.
    fn shaded(&self) -> Color {
        let base = of_kind(self.kind);
        // The tones are not in order of lightness, so that consecutive objects differ more.
        let tone = [0, 32, 16, 48][self.object % 4];
        mixed(base, Color::rgb(225, 228, 230), tone)
    }
}

/// Converts a colour to a word, whose bytes from the lowest to the highest are red, green, blue and
/// alpha.
pub(crate) const fn word(color: Color) -> u32 {
    let [red, green, blue] = color.rgb;
    u32::from_le_bytes([red, green, blue, color.alpha])
}

/// Mixes two colours: `part` is the share of `to` in 256ths. The alpha is that of `from`.
fn mixed(from: Color, to: Color, part: u16) -> Color {
    let mut rgb = from.rgb;
    for (byte, goal) in rgb.iter_mut().zip(to.rgb) {
        let sum = u16::from(*byte) * (256 - part) + u16::from(goal) * part;
        *byte = sum.to_be_bytes()[0];
    }
    Color { rgb, ..from }
}

/// The layers of a frame in the order of their indices: the name of each layer, and the kind of
/// element that it contains.
pub(crate) const LAYERS: [(&str, Drawn); 10] = [
    ("object", Drawn::Object),
    ("tight box", Drawn::TightBox),
    ("loosened box", Drawn::LoosenedBox),
    ("tree", Drawn::TreeNode),
    ("contact", Drawn::ContactPoint),
    ("normal", Drawn::ContactNormal),
    ("manifold", Drawn::Manifold),
    ("proximity", Drawn::Proximity),
    ("query", Drawn::Query),
    ("query hit", Drawn::QueryHit),
];

/// Returns the index of the layer for a kind of element.
pub(crate) fn layer_of(what: Drawn) -> usize {
    LAYERS.iter().position(|(_, drawn)| *drawn == what).unwrap_or(0)
}

/// Returns the styles of the visible layers. The sizes of their elements are proportional to
/// `size`, the size of a typical object. Objects themselves are drawn as instances and have no
/// style. Queries always have styles, since samples read these styles.
pub(crate) fn options<N: Real>(
    mesh: MeshOptions<N>,
    size: N,
    is_shown: &[bool; LAYERS.len()],
) -> DebugOptions<N> {
    let style = |what, color, factor: f64| {
        let style = Style { color, size: size * N::lit(factor) };
        is_shown[layer_of(what)].then_some(style)
    };
    let always = |color, factor: f64| Some(Style { color, size: size * N::lit(factor) });
    DebugOptions {
        object: None,
        tight_box: style(Drawn::TightBox, Color::rgb(96, 160, 104), 0.1),
        loosened_box: style(Drawn::LoosenedBox, Color::rgb(128, 150, 112), 0.1),
        tree_node: style(Drawn::TreeNode, Color::rgb(126, 132, 186), 0.1),
        contact_point: style(Drawn::ContactPoint, Color::rgb(214, 72, 56), 0.1),
        contact_normal: style(Drawn::ContactNormal, Color::rgb(222, 146, 42), 0.4),
        manifold: style(Drawn::Manifold, Color::rgb(228, 110, 64).with_alpha(110), 0.1),
        proximity: style(Drawn::Proximity, Color::rgb(146, 96, 200), 0.1),
        query: always(Color::rgb(46, 134, 190), 0.1),
        query_hit: always(Color::rgb(200, 62, 152), 0.4),
        mesh,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_found_by_what_they_are_of() {
        for (number, (_, what)) in LAYERS.iter().enumerate() {
            assert_eq!(layer_of(*what), number, "{what:?}");
        }
    }

    #[test]
    fn what_is_mixed_lies_between() {
        let (black, white) = (Color::rgb(0, 0, 0), Color::rgb(255, 255, 255));
        assert_eq!(mixed(black, white, 0), black, "none of it");
        assert_eq!(mixed(black, white, 128), Color::rgb(127, 127, 127), "the half");
        let selected = Look { kind: ShapeKind::Ball, object: 0, flags: SELECTED | SENSOR };
        assert_eq!(selected.color().to_le_bytes(), [242, 153, 46, 160], "and half transparent");
    }
}
