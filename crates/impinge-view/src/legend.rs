//! Computes the positions of the entries of a legend.

use crate::layer::Layer;
use impinge::debug_render::Color;

/// A layer, its colour, and the left end of the line that shows the colour. The name begins
/// [`NAME_AT`] pixels to the right of this end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LegendEntry {
    pub(crate) layer: Layer,
    pub(crate) color: Color,
    pub(crate) at: [f64; 2],
}

/// The length of the line that shows a colour, in pixels.
pub(crate) const SWATCH: f64 = 16.0;
/// The distance from the left end of the line to the name, in pixels.
pub(crate) const NAME_AT: f64 = 22.0;
/// The height of a row, in pixels.
const ROW: f64 = 20.0;
/// The distance from the left side of the picture to the first entry of a row, in pixels.
const MARGIN: f64 = 16.0;
/// The distance from the end of a name to the next entry, in pixels.
const GAP: f64 = 14.0;

/// Returns an entry for each layer, and the height of all rows. Entries that exceed `width`, the
/// width of the picture, begin a new row. `letter` is the width of a character. Lengths are in
/// pixels.
pub(crate) fn legend(
    layers: &[(Layer, Color)],
    width: f64,
    letter: f64,
) -> (Vec<LegendEntry>, f64) {
    let (mut entries, mut at) = (Vec::with_capacity(layers.len()), [MARGIN, ROW * 0.5]);
    for &(layer, color) in layers {
        let own = NAME_AT + letter * layer.name.len() as f64;
        if at[0] > MARGIN && at[0] + own > width - MARGIN * 0.5 {
            at = [MARGIN, at[1] + ROW];
        }
        entries.push(LegendEntry { layer, color, at });
        at[0] += own + GAP;
    }
    let height = if entries.is_empty() { 0.0 } else { at[1] + ROW };
    (entries, height)
}

#[cfg(test)]
mod tests {
    use super::*;
    use impinge::debug_render::Drawn;

    #[test]
    fn entries_are_side_by_side_while_there_is_room() {
        let color = Color::rgb(1, 2, 3);
        let layers =
            [Drawn::Object, Drawn::Query, Drawn::QueryHit].map(|what| (Layer::of(what), color));
        let (wide, height) = legend(&layers, 500.0, 7.0);
        // The names "objects" and "queries" have seven letters each.
        let x: Vec<_> = wide.iter().map(|entry| entry.at[0]).collect();
        assert_eq!(x, [16.0, 101.0, 186.0], "a line, a name and a gap each");
        assert_eq!(height, 30.0, "one row");
        let (narrow, height) = legend(&layers, 190.0, 7.0);
        assert_eq!(narrow[2].at, [16.0, 30.0], "the third begins a row");
        assert_eq!(height, 50.0, "two rows");
        assert_eq!(legend(&[], 190.0, 7.0), (Vec::new(), 0.0), "nothing was drawn");
    }
}
