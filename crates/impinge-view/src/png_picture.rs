//! Pictures of surfaces.

use crate::camera::Camera;
use crate::flatten::flatten;
use crate::image::{Image, MAX_SIDE};
use crate::lens::{Window, larger};
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
}

/// A picture of surfaces with a depth buffer.
///
/// Faces are shaded on both sides by a soft light from the upper left of the viewer, smoothly where a
/// mesh is so. Edges of meshes and the outlines of their surfaces are in a darker tone of the faces.
/// Colours with an alpha below 255 are mixed in from far to near, by the middles of triangles and
/// lines. Contacts, proximities and queries show through what hides them, fainter. A pixel is the mean
/// of 2 by 2 samples. Texts are left out without being counted.
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

/// The sides of the square of samples for a pixel.
const SAMPLES: usize = 2;
/// Near white, a little warm.
const BACKGROUND: Color = Color::rgb(250, 249, 246);

impl Picture<Png> {
    /// A picture with a width and a height in pixels, which are clamped to 1 to 8192.
    #[must_use]
    pub fn new(camera: Camera, size: [u32; 2]) -> Self {
        let size = size.map(|side| side.clamp(1, MAX_SIDE));
        Self::with_format(camera, Png { size, background: BACKGROUND, margin: None })
    }

    /// Another background than near white. Its alpha is not used.
    #[must_use]
    pub fn with_background(mut self, background: Color) -> Self {
        self.format.background = background;
        self
    }

    /// A margin in pixels, on all sides; without, it is a sixteenth of the shorter side. What is not
    /// between 0 and a third of the shorter side is clamped to it; NaN counts as 0.
    #[must_use]
    pub fn with_margin(mut self, margin: f64) -> Self {
        self.format.margin = Some(margin);
        self
    }

    /// Renders what was drawn.
    ///
    /// Costs 44 bytes of memory for each pixel while it runs, and time in proportion to the pixels that
    /// triangles and lines cover.
    #[must_use]
    pub fn to_image(&self) -> Image {
        let lens = self.lens();
        let flat = flatten(&self.recording, &lens);
        let view = lens.within(&self.format.window());
        let size = self.format.size.map(|side| side as usize * SAMPLES);
        let mut raster = Raster::new(size, self.format.background.rgb);
        draw(&pieces(&flat, &self.recording.dots, &view, SAMPLES as f64), &mut raster);
        Image::opaque(self.format.size, &raster.reduced(SAMPLES))
    }

    /// The bytes of a PNG file, of [`Self::to_image`].
    #[must_use]
    pub fn to_png(&self) -> Vec<u8> {
        self.to_image().to_png()
    }
}

impl Png {
    /// The picture without its margins, in samples.
    fn window(&self) -> Window {
        let size = self.size.map(f64::from);
        let shorter = -larger(-size[0], -size[1]);
        let margin = self.margin.unwrap_or(shorter / 16.0);
        let margin = -larger(-larger(0.0, margin), -shorter / 3.0);
        let samples = SAMPLES as f64;
        let low = [margin * samples; 2];
        Window { low, size: size.map(|side| (side - 2.0 * margin) * samples) }
    }
}
