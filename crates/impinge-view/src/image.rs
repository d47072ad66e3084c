//! Images in memory, and their conversion from and to PNG.

use crate::palette::{MAX_COLORS, Palette};
use crate::raster::whole;
use std::error::Error;
use std::fmt;
use std::io::Cursor;

/// Pixels of 8 bits for red, green, blue and alpha in sRGB, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Image {
    size: [u32; 2],
    pixels: Vec<[u8; 4]>,
}

/// The largest width and height of an image.
pub(crate) const MAX_SIDE: u32 = 8192;

impl Image {
    /// Returns an image of one colour. Width and height are clamped to the range from 1 to 8192.
    ///
    /// ```
    /// let image = impinge_view::Image::filled([3, 0], [255, 0, 0, 255]);
    /// assert_eq!(image.size(), [3, 1]);
    /// assert_eq!(image.pixel(2, 0), [255, 0, 0, 255]);
    /// let again = impinge_view::Image::from_png(&image.to_png());
    /// assert_eq!(again, Ok(image));
    /// ```
    #[must_use]
    pub fn filled(size: [u32; 2], pixel: [u8; 4]) -> Self {
        let size = size.map(|side| side.clamp(1, MAX_SIDE));
        let count = size[0] as usize * size[1] as usize;
        Self { size, pixels: vec![pixel; count] }
    }

    /// Returns an opaque image; the number of pixels must be the product of `size`.
    pub(crate) fn opaque(size: [u32; 2], pixels: &[[u8; 3]]) -> Self {
        let pixels = pixels.iter().map(|[red, green, blue]| [*red, *green, *blue, 255]);
        Self { size, pixels: pixels.collect() }
    }

    /// Returns the width and the height.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Returns all pixels, row by row from the top, each row from the left.
    #[must_use]
    pub fn pixels(&self) -> &[[u8; 4]] {
        &self.pixels
    }

    /// Returns the pixel in a column and a row, counted from 0 at the upper left.
    ///
    /// # Panics
    ///
    /// If there is no such pixel.
    #[must_use]
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 4] {
        assert!(x < self.size[0] && y < self.size[1], "no pixel {x}, {y} in {:?}", self.size);
        self.pixels[y as usize * self.size[0] as usize + x as usize]
    }

    /// Changes a pixel, which must be inside the image.
    pub(crate) fn set_pixel(&mut self, x: u32, y: u32, pixel: [u8; 4]) {
        self.pixels[y as usize * self.size[0] as usize + x as usize] = pixel;
    }

    /// Changes the colour of the pixel that contains the point `at`. A point outside the image has
    /// no effect.
    pub(crate) fn change(&mut self, at: [f64; 2], color: impl Fn([u8; 3]) -> [u8; 3]) {
        let is_inside = (0..2).all(|axis| at[axis] >= 0.0 && at[axis] < f64::from(self.size[axis]));
        if is_inside {
            let [x, y] = at.map(|x| whole(x, MAX_SIDE as usize));
            let pixel = &mut self.pixels[y * self.size[0] as usize + x];
            let [red, green, blue, alpha] = *pixel;
            let [red, green, blue] = color([red, green, blue]);
            *pixel = [red, green, blue, alpha];
        }
    }

    /// Returns the image reduced to at most `count` colours, which makes its file smaller. `count`
    /// is clamped to the range from 2 to 256.
    ///
    /// The colours are the means of boxes in colour space, which are split into halves repeatedly
    /// (P. Heckbert, *Color Image Quantization for Frame Buffer Display*, 1982). Opaque images stay
    /// opaque.
    ///
    /// ```
    /// use impinge::debug_render::{Color, DebugRender, Drawn};
    /// use impinge::dim2::math::Point;
    /// use impinge_view::{Camera, PngPicture};
    /// use std::collections::BTreeSet;
    ///
    /// let mut picture = PngPicture::new(Camera::plane(), [60, 40]);
    /// picture.point(&Point::new(0.0_f32, 0.0), 1.0, Color::rgb(200, 40, 40), Drawn::Query);
    /// let image = picture.to_image();
    /// let reduced = image.with_colors(4);
    /// let colors: BTreeSet<_> = reduced.pixels().iter().collect();
    /// assert!(colors.len() <= 4 && reduced.size() == image.size());
    /// assert_eq!(image.with_colors(256), image, "so few are kept");
    /// ```
    #[must_use]
    pub fn with_colors(&self, count: usize) -> Self {
        let palette = Palette::of(&self.pixels, count.clamp(2, MAX_COLORS));
        let pixels = self.pixels.iter().map(|pixel| palette.nearest(*pixel)).collect();
        Self { size: self.size, pixels }
    }

    /// Returns the bytes of a PNG file. The file has a palette if the image has at most 256
    /// colours, and all of them are opaque.
    ///
    /// # Panics
    ///
    /// Never: an image has a size that PNG allows, and writing to memory does not fail.
    #[must_use]
    pub fn to_png(&self) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.size[0], self.size[1]);
        let palette = Palette::exactly(&self.pixels);
        let data = match &palette {
            Some(palette) => {
                encoder.set_palette(palette.rgb());
                self.pixels.iter().map(|pixel| palette.index(*pixel)).collect()
            }
            None => self.pixels.as_flattened().to_vec(),
        };
        let kind = if palette.is_some() { png::ColorType::Indexed } else { png::ColorType::Rgba };
        encoder.set_color(kind);
        encoder.set_depth(png::BitDepth::Eight);
        if palette.is_some() {
            // The filters of PNG encode differences of neighbouring values, which are meaningless
            // for palette indices.
            encoder.set_filter(png::Filter::NoFilter);
        }
        encoder.set_compression(png::Compression::High);
        encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        let mut writer = encoder.write_header().expect("sizes from 1 to 8192 are allowed");
        writer.write_image_data(&data).expect("as many bytes as announced");
        writer.finish().expect("a vector can be written");
        bytes
    }

    /// Reads a PNG file. Files with 16 bits per channel or with a palette are converted.
    ///
    /// # Errors
    ///
    /// If the bytes are not a PNG or are truncated, or if the image is grayscale, or wider or
    /// higher than 8192 pixels.
    pub fn from_png(bytes: &[u8]) -> Result<Self, ImageError> {
        let mut decoder = png::Decoder::new(Cursor::new(bytes));
        decoder.set_transformations(
            png::Transformations::normalize_to_color8() | png::Transformations::ALPHA,
        );
        let mut reader = decoder.read_info().map_err(|error| ImageError::new(&error))?;
        let size = [reader.info().width, reader.info().height];
        if size.iter().any(|side| *side > MAX_SIDE) {
            return Err(ImageError::new(&format!("{size:?} is larger than {MAX_SIDE}")));
        }
        let mut image = Self::filled(size, [0; 4]);
        let needed = image.pixels.as_flattened().len();
        if reader.output_buffer_size() != Some(needed) {
            return Err(ImageError::new(&"not red, green and blue"));
        }
        let bytes = image.pixels.as_flattened_mut();
        reader.next_frame(bytes).map_err(|error| ImageError::new(&error))?;
        Ok(image)
    }
}

/// The reason why bytes are not a valid image.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImageError {
    message: String,
}

impl ImageError {
    fn new(message: &dyn fmt::Display) -> Self {
        Self { message: message.to_string() }
    }
}

impl fmt::Display for ImageError {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "no image: {}", self.message)
    }
}

impl Error for ImageError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_bytes_are_errors() {
        let good = Image::filled([20, 10], [1, 2, 3, 4]).to_png();
        assert!(Image::from_png(&[]).is_err(), "empty");
        assert!(Image::from_png(&good[..good.len() / 2]).is_err(), "cut off");
        let error = Image::from_png(b"GIF89a").expect_err("another format");
        assert!(error.to_string().starts_with("no image: "), "{error}");
    }
}
