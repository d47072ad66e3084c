//! Writes the text of an SVG file.

use crate::layer::Layer;
use crate::legend::{LegendEntry, NAME_AT, SWATCH, legend};
use crate::lens::OnScreen;
use crate::shade::mixed;
use crate::svg_picture::LETTER;
use impinge::debug_render::Color;
use std::fmt::Write;

/// The elements of a document, and the colours that they use.
#[derive(Clone, Debug)]
pub(crate) struct Body {
    size: [f64; 2],
    text: String,
    /// The distinct colours. The colour with index N has the classes `sN` for strokes and `fN` for
    /// fills.
    colors: Vec<[u8; 3]>,
    layers: Vec<Layer>,
    open: Option<Open>,
    legend: String,
    legend_height: f64,
}

/// The colour of an element, and whether surfaces hide the element.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Key {
    pub(crate) color: Color,
    pub(crate) is_hidden: bool,
}

/// A path element that is still being written: a following line with the same key extends the path.
/// `last` is the text of the path's end point.
#[derive(Clone, Debug)]
struct Open {
    key: Key,
    last: String,
}

impl Body {
    pub(crate) fn new(size: [f64; 2]) -> Self {
        let (text, legend) = (String::new(), String::new());
        let (colors, layers) = (Vec::new(), Vec::new());
        Self { size, text, colors, layers, open: None, legend, legend_height: 0.0 }
    }

    /// Begins the group of a layer.
    pub(crate) fn open(&mut self, layer: Layer) {
        self.push(&format!("<g class=\"{}\"><title>{}</title>\n", layer.class, layer.name));
        self.layers.push(layer);
    }

    /// Ends the group of a layer.
    pub(crate) fn close(&mut self) {
        self.push("</g>\n");
    }

    pub(crate) fn stroke(&mut self, ends: &[OnScreen; 2], key: Key) {
        let [start, end] = ends.map(|end| format!("{} {}", number(end.x), number(end.y)));
        match &mut self.open {
            Some(open) if open.key == key => {
                if open.last != start {
                    self.text.push_str(&format!("M{start}"));
                }
            }
            _ => {
                let class = self.class('s', key);
                self.push(&format!("<path {class} d=\"M{start}"));
            }
        }
        self.text.push_str(&format!("L{end}"));
        self.open = Some(Open { key, last: end });
    }

    /// Writes polygons as one filled path, so that no gaps are visible between them.
    pub(crate) fn fill(&mut self, color: Color, polygons: &[Vec<OnScreen>]) {
        let mut path = String::new();
        for polygon in polygons.iter().filter(|polygon| polygon.len() > 2) {
            for (index, corner) in polygon.iter().enumerate() {
                let step = if index == 0 { 'M' } else { 'L' };
                path.push_str(&format!("{step}{} {}", number(corner.x), number(corner.y)));
            }
            path.push('Z');
        }
        if !path.is_empty() {
            let class = self.class('f', Key { color, is_hidden: false });
            self.push(&format!("<path {class} fill-opacity=\"0.25\" d=\"{path}\"/>\n"));
        }
    }

    pub(crate) fn dot(&mut self, center: OnScreen, radius: f64, key: Key) {
        let class = self.class('f', key);
        let [x, y, radius] = [center.x, center.y, radius].map(number);
        self.push(&format!("<circle {class} cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>\n"));
    }

    /// Writes a text whose base line begins at `at`, with a halo that separates it from the
    /// background.
    pub(crate) fn label(&mut self, at: [f64; 2], text: &str, color: Color) {
        let class = self.class('f', Key { color, is_hidden: false });
        let ([x, y], text) = (at.map(number), escaped(text));
        self.push(&format!("<text {class} x=\"{x}\" y=\"{y}\">{text}</text>\n"));
    }

    /// Writes the legend: the names and colours of the layers, below the drawing.
    pub(crate) fn legend(&mut self, layers: &[(Layer, Color)]) {
        let (entries, height) = legend(layers, self.size[0], LETTER.width);
        for LegendEntry { layer, color, at: [left, middle] } in entries {
            let class = self.class('s', Key { color: color.with_alpha(255), is_hidden: false });
            let [x, y, to] = [left, middle, left + SWATCH].map(number);
            let [name_at, base] = [left + NAME_AT, middle + 4.0].map(number);
            self.legend.push_str(&format!(
                "<path {class} stroke-width=\"3.00\" d=\"M{x} {y}L{to} {y}\"/>\
                 <text class=\"ink\" x=\"{name_at}\" y=\"{base}\">{}</text>\n",
                layer.name
            ));
        }
        self.legend_height = height;
    }

    fn push(&mut self, text: &str) {
        if self.open.take().is_some() {
            self.text.push_str("\"/>\n");
        }
        self.text.push_str(text);
    }

    /// Returns the attributes of an element with this key, stroked (`kind` is `s`) or filled (`f`).
    fn class(&mut self, kind: char, key: Key) -> String {
        let found = self.colors.iter().position(|color| *color == key.color.rgb);
        let index = found.unwrap_or_else(|| {
            self.colors.push(key.color.rgb);
            self.colors.len() - 1
        });
        let hidden = if key.is_hidden { " hidden" } else { "" };
        let mut attributes = format!("class=\"{kind}{index}{hidden}\"");
        if key.color.alpha < u8::MAX {
            let opacity = number(f64::from(key.color.alpha) / 255.0);
            attributes.push_str(&format!(" opacity=\"{opacity}\""));
        }
        attributes
    }

    /// Returns the style sheet for the document with this id, for light and dark pages.
    fn style(&self, id: &str) -> String {
        let mut light = format!(
            "#{id} .paper{{fill:#fbfaf7}}#{id} .ink{{fill:#30363f}}#{id} text{{stroke:#fbfaf7}}\n"
        );
        let mut dark = format!(
            "#{id} .paper{{fill:#16191e}}#{id} .ink{{fill:#d5d9e0}}#{id} text{{stroke:#16191e}}\n"
        );
        for layer in &self.layers {
            let (class, width) = (layer.class, number(layer.width));
            light.push_str(&format!("#{id} .{class}{{stroke-width:{width}}}\n"));
        }
        for (index, color) in self.colors.iter().enumerate() {
            light.push_str(&rule(id, index, *color));
            dark.push_str(&rule(id, index, on_dark(*color)));
        }
        format!(
            "#{id} path{{stroke-linecap:round;fill:none}}\n\
             #{id} text{{font:13px system-ui,sans-serif;paint-order:stroke;stroke-width:3;stroke-linejoin:round}}\n\
             #{id} .hidden{{stroke-dasharray:0.5 3;opacity:.45}}\n\
             {light}@media (prefers-color-scheme:dark){{\n{dark}}}\n"
        )
    }
}

fn rule(id: &str, index: usize, [red, green, blue]: [u8; 3]) -> String {
    let color = format!("#{red:02x}{green:02x}{blue:02x}");
    format!("#{id} .s{index}{{stroke:{color}}}#{id} .f{index}{{fill:{color}}}\n")
}

/// Returns the colour to use on a dark page: a lighter colour if `rgb` is dark, else `rgb`.
fn on_dark(rgb: [u8; 3]) -> [u8; 3] {
    let [red, green, blue] = rgb.map(u32::from);
    // The integer weights are those of the luminance of sRGB, in percent.
    let luminance = (21 * red + 72 * green + 7 * blue) / 100;
    if luminance < 150 { mixed(rgb, [238, 242, 250], 0.5) } else { rgb }
}

/// Returns the text of the whole file.
pub(crate) fn document(body: Body, title: &str, description: &str) -> String {
    let id = format!("impinge-{:016x}", hash(&[&body.text, &body.legend, title, description]));
    let [width, height] = body.size.map(number);
    let total = number(body.size[1] + body.legend_height);
    let (title, description, style) = (escaped(title), escaped(description), body.style(&id));
    let mut svg = String::new();
    // Writing to a string does not fail.
    let _ = write!(
        svg,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" id=\"{id}\" role=\"img\" \
         aria-labelledby=\"{id}-title {id}-desc\" width=\"{width}\" height=\"{total}\" \
         viewBox=\"0 0 {width} {total}\">\n\
         <title id=\"{id}-title\">{title}</title>\n<desc id=\"{id}-desc\">{description}</desc>\n\
         <style>\n{style}</style>\n\
         <rect class=\"paper\" width=\"{width}\" height=\"{total}\"/>\n\
         <svg width=\"{width}\" height=\"{height}\" class=\"scene\">\n{}</svg>\n",
        body.text
    );
    if !body.legend.is_empty() {
        let _ = write!(
            svg,
            "<g class=\"legend\" transform=\"translate(0 {height})\">\n{}</g>\n",
            body.legend
        );
    }
    svg.push_str("</svg>\n");
    svg
}

/// Returns the hash FNV-1a (Fowler, Noll, Vo) of some texts. The hash becomes the id of a document,
/// which keeps the styles of several documents on one page apart.
fn hash(texts: &[&str]) -> u64 {
    let bytes = texts.iter().flat_map(|text| text.bytes().chain([0]));
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    })
}

/// Formats a number with two decimals; zero has no sign.
fn number(x: f64) -> String {
    let text = format!("{x:.2}");
    if text == "-0.00" { "0.00".into() } else { text }
}

/// Escapes a text for XML.
fn escaped(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '\t' | '\n' => escaped.push(' '),
            '\0'..='\x1f' | '\u{fffe}' | '\u{ffff}' => escaped.push('\u{fffd}'),
            other => escaped.push(other),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_texts() {
        assert_eq!([-0.001, 0.005, 12.0, -7.126].map(number), ["0.00", "0.01", "12.00", "-7.13"]);
        assert_eq!(escaped("a<b & c\u{1}\n"), "a&lt;b &amp; c\u{fffd} ", "XML 1.0");
    }

    #[test]
    fn dark_colours_are_lighter_on_a_dark_page() {
        assert_eq!(on_dark([0; 3]), [119, 121, 125], "halfway to near white");
        assert_eq!(on_dark([250, 220, 90]), [250, 220, 90], "light enough");
    }

    #[test]
    fn lines_with_one_key_are_one_path() {
        let at = |x: f64| OnScreen { x, y: 1.0, depth: 0.0 };
        let mut body = Body::new([64.0, 64.0]);
        let key = Key { color: Color::rgb(1, 2, 3), is_hidden: false };
        body.stroke(&[at(0.0), at(1.0)], key);
        body.stroke(&[at(1.0), at(2.0)], key);
        body.stroke(&[at(5.0), at(6.0)], key);
        body.stroke(&[at(7.0), at(8.0)], Key { is_hidden: true, ..key });
        body.close();
        let expected = "<path class=\"s0\" d=\"M0.00 1.00L1.00 1.00L2.00 1.00M5.00 1.00L6.00 1.00\"/>\n\
                        <path class=\"s0 hidden\" d=\"M7.00 1.00L8.00 1.00\"/>\n</g>\n";
        assert_eq!(body.text, expected, "three lines, then a hidden one");
    }
}
