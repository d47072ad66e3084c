//! Pictures of lines, as SVG.

use crate::camera::Camera;
use crate::flatten::{Flat, edge_color, flatten};
use crate::hidden::{depths, runs};
use crate::labels::{Letter, PlacedLabel, placed_labels};
use crate::layer::Layer;
use crate::lens::{OnScreen, View, Window, larger};
use crate::picture::Picture;
use crate::pieces::{LINE_BIAS, MIN_DOT_RADIUS};
use crate::raster::{Raster, whole};
use crate::svg_write::{Body, Key, document};
use impinge::debug_render::Drawn;

/// The format of an [`SvgPicture`].
#[derive(Clone, Debug)]
pub struct Svg {
    width: u32,
    title: String,
    description: String,
    /// Whether surfaces are filled, as in 2D. Otherwise they hide lines, as in 3D.
    fills: bool,
    has_legend: bool,
}

/// A picture of lines.
///
/// Each layer is a group with a class: `object`, `contact-point`, `query-hit` and so on, in the
/// order of [`Drawn`]. A group has filled surfaces first, then hidden lines, visible lines and
/// points, each of them from far to near, then texts. Lengths on the page are in pixels with two
/// decimals. Colours that are too dark for a dark page are lighter there. Texts avoid the sides of
/// the page and each other where possible; texts of points outside the page are omitted. The
/// description mentions the number of [omitted](Picture::left_out) elements.
///
/// ```
/// use impinge::debug_render::{Color, DebugRender, Drawn};
/// use impinge::dim2::math::Point;
/// use impinge_view::SvgPicture;
///
/// let mut picture = SvgPicture::plane(200).with_title("A ray", "It goes to the upper right.");
/// let ends = [Point::origin(), Point::new(2.0_f32, 1.0)];
/// picture.line(ends, Color::rgb(40, 90, 160), Drawn::Query);
/// let svg = picture.to_svg();
/// assert!(svg.contains("<g class=\"query\">") && svg.contains("M16.00 100.00L184.00 16.00"));
/// ```
pub type SvgPicture = Picture<Svg>;

/// The approximate size of characters in pixels; the actual font depends on the reader.
pub(crate) const LETTER: Letter = Letter { width: 8.0, ascent: 10.0, descent: 3.0 };
/// The margin on all sides, in pixels.
const MARGIN: f64 = 16.0;
/// The maximum ratio of the height of the drawing to its width.
const TALLEST: f64 = 1.5;

impl Picture<Svg> {
    /// Creates a picture of a 2D scene, to scale, with y upwards. Shapes and triangles are filled
    /// with a tint. The width in pixels is clamped to the range from 64 to 8192; the height follows
    /// from the content.
    #[must_use]
    pub fn plane(width: u32) -> Self {
        Self::of(Camera::plane(), width, true)
    }

    /// Creates a picture of a 3D scene that consists of lines, including the silhouettes of
    /// surfaces. Lines are fainter and dotted where opaque meshes and triangles hide them. The
    /// width in pixels is clamped to the range from 64 to 8192; the height follows from the
    /// content.
    #[must_use]
    pub fn space(camera: Camera, width: u32) -> Self {
        Self::of(camera, width, false)
    }

    fn of(camera: Camera, width: u32, fills: bool) -> Self {
        let width = width.clamp(64, crate::image::MAX_SIDE);
        let (title, description) = ("Picture".into(), String::new());
        let format = Svg { width, title, description, fills, has_legend: true };
        Self::with_format(camera, format)
    }

    /// Sets a title and a description, for screen readers and tooltips. Characters that XML does
    /// not allow become U+FFFD.
    #[must_use]
    pub fn with_title(mut self, title: &str, description: &str) -> Self {
        self.format.title = title.to_owned();
        self.format.description = description.to_owned();
        self
    }

    /// Omits the legend below the drawing.
    #[must_use]
    pub fn without_legend(mut self) -> Self {
        self.format.has_legend = false;
        self
    }

    /// Returns the text of an SVG file. For a 3D scene, each line is sampled twice per pixel to
    /// find its hidden parts.
    #[must_use]
    pub fn to_svg(&self) -> String {
        let lens = self.lens();
        let flat = flatten(&self.recording, &lens);
        let window = self.format.window(lens.size());
        let view = lens.within(&window);
        let size = window.size.map(|side| side + 2.0 * MARGIN);
        let pixels = size.map(|side| whole(side.ceil(), usize::MAX));
        let depths = (!self.format.fills).then(|| depths(&flat, &view, pixels));
        let page = Page { flat, view, depths };
        let labels = placed_labels(&self.recording, &page.view, size, LETTER);
        let mut body = Body::new(size);
        for layer in self.recording.layers() {
            body.open(Layer::of(layer));
            self.fill_layer(layer, &page, &mut body);
            stroke_layer(layer, &page, &mut body);
            self.dot_layer(layer, &page, &mut body);
            label_layer(layer, &labels, &mut body);
            body.close();
        }
        if self.format.has_legend {
            body.legend(&self.layers());
        }
        document(body, &self.format.title, &self.description())
    }

    fn fill_layer(&self, layer: Drawn, page: &Page, body: &mut Body) {
        if !self.format.fills {
            return;
        }
        for placed in self.recording.placed.iter().filter(|placed| placed.what == layer) {
            let Some(kept) = self.recording.meshes.get(&placed.id) else { continue };
            let vertices = placed.vertices(kept);
            let corners = kept.triangles.iter().map(|indices| indices.map(|i| vertices[i]));
            let corners = corners.map(|corners| page.view.triangle(&corners, 0.0));
            body.fill(placed.color, &corners.collect::<Vec<_>>());
        }
        for triangle in self.recording.triangles.iter().filter(|triangle| triangle.what == layer) {
            body.fill(triangle.color, &[page.view.triangle(&triangle.corners, 0.0)]);
        }
    }

    fn dot_layer(&self, layer: Drawn, page: &Page, body: &mut Body) {
        let mut found: Vec<_> =
            self.recording.dots.iter().filter(|dot| dot.what == layer).collect();
        found.retain(|dot| page.view.point(&dot.at, 0.0).is_some());
        let depth = |at| page.view.point(at, 0.0).map_or(0.0, |on| on.depth);
        found.sort_by(|a, b| depth(&b.at).total_cmp(&depth(&a.at)));
        for dot in found {
            let Some(center) = page.view.point(&dot.at, LINE_BIAS) else { continue };
            let radius = larger(page.view.pixels(dot.size, &dot.at) * 0.5, MIN_DOT_RADIUS);
            let is_hidden = page.runs(&[center, center]).iter().any(|(hidden, _)| *hidden);
            body.dot(center, radius, Key { color: dot.color, is_hidden });
        }
    }

    fn description(&self) -> String {
        let names: Vec<_> = self.layers().into_iter().map(|(layer, _)| layer.name).collect();
        let mut text = self.format.description.clone();
        if text.is_empty() && names.is_empty() {
            text = "Nothing is drawn.".into();
        } else if text.is_empty() {
            text = format!("It shows {}.", names.join(", "));
        }
        if self.left_out() > 0 {
            text.push_str(&format!(
                " {} of the things drawn have no place in it.",
                self.left_out()
            ));
        }
        text
    }
}

impl Svg {
    /// Returns the window for content with this width and height in the image plane: the page
    /// without its margins and legend. The window is at most [`TALLEST`] times as high as wide.
    fn window(&self, [width, height]: [f64; 2]) -> Window {
        let inner = f64::from(self.width) - 2.0 * MARGIN;
        let tallest = inner * TALLEST;
        let wanted = if width > 0.0 { inner * (height / width) } else { tallest };
        let wanted = if width > 0.0 || height > 0.0 { wanted } else { inner * 0.5 };
        Window { low: [MARGIN; 2], size: [inner, -larger(-wanted, -tallest)] }
    }
}

/// A scene projected to the page.
struct Page {
    flat: Flat,
    view: View,
    /// The depths of the surfaces that hide lines; `None` if surfaces are filled.
    depths: Option<Raster>,
}

impl Page {
    /// Splits a line into parts that are completely hidden (`true`) or completely visible. If
    /// surfaces are filled, the whole line is visible.
    fn runs(&self, ends: &[OnScreen; 2]) -> Vec<(bool, [OnScreen; 2])> {
        match &self.depths {
            Some(depths) => {
                runs(ends, depths).into_iter().map(|run| (run.is_hidden, run.ends)).collect()
            }
            None => vec![(false, *ends)],
        }
    }
}

fn label_layer(layer: Drawn, labels: &[PlacedLabel<'_>], body: &mut Body) {
    for placed in labels.iter().filter(|placed| placed.label.what == layer) {
        body.label(placed.at, &placed.label.text, placed.label.color);
    }
}

/// Draws the lines of a layer and the sides of its single triangles: first the hidden parts, then
/// the visible parts, both from far to near.
fn stroke_layer(layer: Drawn, page: &Page, body: &mut Body) {
    let strokes = page.flat.strokes.iter().filter(|stroke| stroke.what == layer);
    let mut lines: Vec<_> = strokes.map(|stroke| (stroke.ends, stroke.color)).collect();
    for face in page.flat.faces.iter().filter(|face| face.is_alone && face.what == layer) {
        let [a, b, c] = face.corners;
        lines.extend([[a, b], [b, c], [c, a]].map(|ends| (ends, edge_color(face.color))));
    }
    let on_screen = |(ends, color)| Some((page.view.line(&ends, LINE_BIAS)?, color));
    let lines = lines.into_iter().filter_map(on_screen);
    let mut parts: Vec<_> = lines
        .flat_map(|(ends, color)| page.runs(&ends).into_iter().map(move |run| (run, color)))
        .collect();
    let depth = |ends: &[OnScreen; 2]| ends[0].depth + ends[1].depth;
    parts.sort_by(|((hidden1, ends1), _), ((hidden2, ends2), _)| {
        hidden2.cmp(hidden1).then(depth(ends2).total_cmp(&depth(ends1)))
    });
    for ((is_hidden, ends), color) in parts {
        body.stroke(&ends, Key { color, is_hidden });
    }
}
