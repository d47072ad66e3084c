//! Pictures with shaded surfaces, as PNG.

use crate::camera::Camera;
use crate::flatten::flatten;
use crate::image::{Image, MAX_SIDE};
use crate::labels::placed_labels;
use crate::legend::{LegendEntry, NAME_AT, SWATCH, legend};
use crate::lens::{View, Window, larger};
use crate::letters::{draw_text, letter};
use crate::picture::Picture;
use crate::pieces::{draw, pieces};
use crate::raster::Raster;
use impinge::debug_render::Color;

/// The format of a [`PngPicture`].
#[derive(Clone, Debug)]
pub struct Png {
    size: [u32; 2],
    background: Color,
    margin: Option<f64>,
    has_legend: bool,
    has_texts: bool,
}

/// A picture of surfaces with a depth buffer.
///
/// Faces are shaded on both sides by a soft light from the upper left of the viewer, smoothly where
/// a mesh is smooth. Edges of meshes and silhouettes of their surfaces are in a darker tone of the
/// faces. Colours with an alpha below 255 are blended from far to near, by the centres of triangles
/// and lines. Contacts, proximities and queries are also drawn, fainter, where surfaces hide them.
/// A pixel is the mean of 2 by 2 samples.
///
/// Texts are in front of everything, in Noto Sans Mono, 16 pixels high, with a halo in the colour
/// of the background. They avoid the sides and each other where possible. Texts of points outside
/// the picture are omitted without being counted, and characters beyond Latin-1 become question
/// marks.
///
/// ```
/// use impinge::debug_render::{Color, DebugRender, Drawn};
/// use impinge::dim2::math::Point;
/// use impinge_view::{Camera, PngPicture};
///
/// let mut picture = PngPicture::new(Camera::plane(), [8, 8]).with_margin(0.0);
/// let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(Point::<f64>::from);
/// picture.triangle(corners, Color::rgb(0, 0, 0), Drawn::Object);
/// let image = picture.to_image();
/// assert_eq!(image.pixel(0, 7), [0, 0, 0, 255], "the right angle is at the lower left");
/// assert_ne!(image.pixel(7, 0), [0, 0, 0, 255]);
/// ```
pub type PngPicture = Picture<Png>;

/// The number of samples per pixel along each axis.
const SAMPLES: usize = 2;
/// The number of pixel columns of the line that shows a colour in the legend.
const SWATCH_STEPS: u8 = 16;
/// The colour of the texts of the legend.
const INK: Color = Color::rgb(48, 54, 63);
/// The default background: a warm near white.
const BACKGROUND: Color = Color::rgb(250, 249, 246);

impl Picture<Png> {
    /// Creates a picture with this width and height in pixels. Both are clamped to the range from 1
    /// to 8192.
    #[must_use]
    pub fn new(camera: Camera, size: [u32; 2]) -> Self {
        let size = size.map(|side| side.clamp(1, MAX_SIDE));
        let format =
            Png { size, background: BACKGROUND, margin: None, has_legend: false, has_texts: true };
        Self::with_format(camera, format)
    }

    /// Sets the colour of the background; by default it is near white. The alpha is ignored.
    #[must_use]
    pub fn with_background(mut self, background: Color) -> Self {
        self.format.background = background;
        self
    }

    /// Sets the margin on all sides, in pixels; the default is a sixteenth of the shorter side. It
    /// is clamped to the range from 0 to a third of the shorter side; NaN counts as 0.
    #[must_use]
    pub fn with_margin(mut self, margin: f64) -> Self {
        self.format.margin = Some(margin);
        self
    }

    /// Adds a legend with the names and colours of the layers of the drawing, in rows at the lower
    /// side. The drawing gets the space above the legend. If the legend would need more than half
    /// of the height, it is omitted.
    #[must_use]
    pub fn with_legend(mut self) -> Self {
        self.format.has_legend = true;
        self
    }

    /// Omits the texts, for a scene with too many of them.
    #[must_use]
    pub fn without_texts(mut self) -> Self {
        self.format.has_texts = false;
        self
    }

    /// Renders the drawing.
    ///
    /// Costs 44 bytes of memory for each pixel while it runs, and time in proportion to the pixels
    /// that triangles and lines cover.
    #[must_use]
    pub fn to_image(&self) -> Image {
        let lens = self.lens();
        let flat = flatten(&self.recording, &lens);
        let (entries, height) = self.legend();
        let in_pixels = lens.clone().within(&self.format.window(height, 1.0));
        let view = lens.within(&self.format.window(height, SAMPLES as f64));
        let size = self.format.size.map(|side| side as usize * SAMPLES);
        let mut raster = Raster::new(size, self.format.background.rgb);
        draw(&pieces(&flat, &self.recording.dots, &view, SAMPLES as f64), &mut raster);
        let mut image = Image::opaque(self.format.size, &raster.reduced(SAMPLES));
        self.draw_texts(&in_pixels, &mut image);
        self.draw_legend(&entries, height, &mut image);
        image
    }

    /// Returns the bytes of a PNG file of [`Self::to_image`].
    #[must_use]
    pub fn to_png(&self) -> Vec<u8> {
        self.to_image().to_png()
    }

    /// Returns the entries of the legend and its height in pixels; no entries and 0 if there is no
    /// legend.
    fn legend(&self) -> (Vec<LegendEntry>, f64) {
        let [width, height] = self.format.size.map(f64::from);
        let (entries, own) = legend(&self.layers(), width, letter().width);
        let has_room = own <= height * 0.5;
        if self.format.has_legend && has_room { (entries, own) } else { (Vec::new(), 0.0) }
    }

    fn draw_texts(&self, view: &View, image: &mut Image) {
        if !self.format.has_texts {
            return;
        }
        let page = self.format.size.map(f64::from);
        for placed in placed_labels(&self.recording, view, page, letter()) {
            let (text, color) = (&placed.label.text, placed.label.color);
            draw_text(image, placed.at, text, color, self.format.background.rgb);
        }
    }

    fn draw_legend(&self, entries: &[LegendEntry], height: f64, image: &mut Image) {
        let (top, paper) = (f64::from(self.format.size[1]) - height, self.format.background.rgb);
        for entry in entries {
            let [left, middle] = [entry.at[0], top + entry.at[1]];
            for step in 0..SWATCH_STEPS {
                let x = left + SWATCH * f64::from(step) / f64::from(SWATCH_STEPS);
                for y in [-1.0, 0.0, 1.0] {
                    image.change([x, middle + y], |_| entry.color.rgb);
                }
            }
            let base = middle + letter().ascent * 0.5 - 1.0;
            draw_text(image, [left + NAME_AT, base], entry.layer.name, INK, paper);
        }
    }
}

impl Png {
    /// Returns the window for the drawing: the picture without its margins and without a legend of
    /// height `legend`. Lengths are multiplied by `samples`, the number of samples per pixel along
    /// an axis.
    fn window(&self, legend: f64, samples: f64) -> Window {
        let size = self.size.map(f64::from);
        let shorter = -larger(-size[0], -size[1]);
        let margin = self.margin.unwrap_or(shorter / 16.0);
        let margin = -larger(-larger(0.0, margin), -shorter / 3.0);
        let low = [margin * samples; 2];
        let size = [size[0] - 2.0 * margin, size[1] - 2.0 * margin - legend];
        Window { low, size: size.map(|side| larger(side, 1.0) * samples) }
    }
}
