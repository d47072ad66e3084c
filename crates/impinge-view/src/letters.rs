//! Draws texts into images.

use crate::image::Image;
use crate::labels::Letter;
use crate::shade::mixed;
use impinge::debug_render::Color;
use noto_sans_mono_bitmap::{FontWeight, RasterHeight, get_raster, get_raster_width};

/// The height of the font, in pixels; other heights are not compiled in.
const HEIGHT: RasterHeight = RasterHeight::Size16;
const WEIGHT: FontWeight = FontWeight::Regular;
/// The number of rows of a character above its base line.
const ASCENT: u8 = 13;
/// The opacity of the halo behind characters, from 0 to 1.
const HALO: f64 = 0.75;

/// Returns the size of a character; all characters have the same width.
pub(crate) fn letter() -> Letter {
    let ascent = f64::from(ASCENT);
    let width = get_raster_width(WEIGHT, HEIGHT) as f64;
    Letter { width, ascent, descent: HEIGHT.val() as f64 - ascent }
}

/// A rasterized text: the coverage of each pixel by the characters, from 0 to 255. There is an
/// empty border of one pixel on each side.
struct Coverage {
    size: [usize; 2],
    pixels: Vec<u8>,
}

impl Coverage {
    /// Rasterizes a text. Characters that the font lacks become question marks.
    fn of(text: &str) -> Self {
        let advance = get_raster_width(WEIGHT, HEIGHT);
        let size = [text.chars().count() * advance + 2, HEIGHT.val() + 2];
        let mut coverage = Self { size, pixels: vec![0; size[0] * size[1]] };
        for (index, character) in text.chars().enumerate() {
            let known = get_raster(character, WEIGHT, HEIGHT);
            let Some(raster) = known.or_else(|| get_raster('?', WEIGHT, HEIGHT)) else { continue };
            // The offsets of 1 are the border above and to the left.
            for (y, row) in raster.rows().enumerate() {
                let start = (y + 1) * size[0] + 1 + index * advance;
                coverage.pixels[start..start + row.len()].copy_from_slice(row);
            }
        }
        coverage
    }

    /// Returns the coverage of the pixel in column `x` and row `y`.
    fn at(&self, x: usize, y: usize) -> u8 {
        self.pixels[y * self.size[0] + x]
    }

    /// Returns the largest coverage of a pixel and its eight neighbours.
    fn around(&self, x: usize, y: usize) -> u8 {
        let [width, height] = self.size;
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let columns = x.saturating_sub(1)..(x + 2).min(width);
        rows.flat_map(|y| columns.clone().map(move |x| self.at(x, y))).fold(0, u8::max)
    }
}

/// Draws a text with the left end of its base line at `at`, in pixels, and with a halo in the
/// colour of the background, `paper`. Pixels outside the image are clipped.
pub(crate) fn draw_text(image: &mut Image, at: [f64; 2], text: &str, color: Color, paper: [u8; 3]) {
    let coverage = Coverage::of(text);
    let [left, base] = at.map(|x| (x + 0.5).floor());
    let low = [left - 1.0, base - f64::from(ASCENT) - 1.0];
    let part = |covered: u8| f64::from(covered) / 255.0;
    for y in 0..coverage.size[1] {
        for x in 0..coverage.size[0] {
            let on = [low[0] + x as f64, low[1] + y as f64];
            let halo = HALO * part(coverage.around(x, y));
            let ink = part(coverage.at(x, y)) * part(color.alpha);
            image.change(on, |rgb| mixed(mixed(rgb, paper, halo), color.rgb, ink));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAPER: [u8; 3] = [250; 3];
    const BLACK: Color = Color::rgb(0, 0, 0);

    fn is_dark(pixel: [u8; 4]) -> bool {
        pixel[0] < 128
    }

    #[test]
    fn a_bar_stands_on_its_base_line() {
        let mut image = Image::filled([7, 20], [250, 250, 250, 255]);
        draw_text(&mut image, [0.0, 14.0], "l", BLACK, PAPER);
        let dark: Vec<_> =
            (0..20).filter(|y| (0..7).any(|x| is_dark(image.pixel(x, *y)))).collect();
        assert_eq!(dark.last(), Some(&13), "the last row above the base line");
        assert!(dark.len() >= 9, "as high as an ascender: {dark:?}");
    }

    #[test]
    fn letters_are_side_by_side_and_blanks_are_empty() {
        let mut image = Image::filled([21, 16], [250, 250, 250, 255]);
        draw_text(&mut image, [0.0, 13.0], "M M", BLACK, PAPER);
        let column = |x: u32| (0..16).filter(|y| is_dark(image.pixel(x, *y))).count();
        assert_eq!((7..14).map(column).sum::<usize>(), 0, "the blank");
        let [first, last]: [usize; 2] = [0, 14].map(|from| (from..from + 7).map(column).sum());
        assert!(first > 20 && first == last, "the same letter twice: {first}, {last}");
    }

    #[test]
    fn a_halo_separates_letters_from_what_is_behind() {
        let mut image = Image::filled([9, 18], [40, 40, 40, 255]);
        draw_text(&mut image, [1.0, 14.0], "l", BLACK, PAPER);
        let light = image.pixels().iter().filter(|pixel| pixel[0] > 128).count();
        assert!(light > 15, "beside the bar: {light}");
        assert_eq!(image.pixel(0, 0), [40, 40, 40, 255], "not farther away");
    }

    #[test]
    fn what_is_outside_the_image_is_cut_off() {
        let blank = Image::filled([5, 5], [250, 250, 250, 255]);
        for at in [[-1e9, 0.0], [1e9, 3.0], [0.0, f64::NAN], [3.0, -40.0]] {
            let mut image = blank.clone();
            draw_text(&mut image, at, "MM", BLACK, PAPER);
            assert_eq!(image, blank, "{at:?}");
        }
        let mut image = blank.clone();
        draw_text(&mut image, [-3.0, 6.0], "MM", BLACK, PAPER);
        assert_ne!(image, blank, "a part is inside");
    }
}
