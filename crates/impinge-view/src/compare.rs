//! The difference of two images.

use crate::image::Image;

/// The result of a comparison of two images.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The width and height of each image.
    pub sizes: [[u32; 2]; 2],
    /// The number of pixels that differ by more than the tolerance. Pixels of [`Self::picture`]
    /// that are not in both images are included.
    pub pixels: u64,
    /// The largest difference of a channel, among the pixels that both images have.
    pub largest: u8,
    /// The first image, faded, with the differing pixels in magenta. It is large enough for both
    /// images.
    pub picture: Image,
}

impl Difference {
    /// Returns `true` if no pixel differs by more than the tolerance.
    #[must_use]
    pub fn is_none(&self) -> bool {
        self.pixels == 0
    }
}

/// Compares two images pixel by pixel. Two pixels count as equal if each of their four channels
/// differs by at most `tolerance`.
///
/// ```
/// use impinge_view::{Image, compare};
///
/// let image = Image::filled([4, 3], [100, 100, 100, 255]);
/// let other = Image::filled([4, 3], [100, 103, 100, 255]);
/// let difference = compare(&image, &other, 2);
/// assert_eq!((difference.pixels, difference.largest), (12, 3));
/// assert!(compare(&image, &other, 3).is_none());
/// ```
#[must_use]
pub fn compare(image: &Image, golden: &Image, tolerance: u8) -> Difference {
    let sizes = [image.size(), golden.size()];
    let size = [0, 1].map(|axis| sizes[0][axis].max(sizes[1][axis]));
    let picture = Image::filled(size, MAGENTA);
    let mut difference = Difference { sizes, pixels: 0, largest: 0, picture };
    for y in 0..size[1] {
        for x in 0..size[0] {
            difference.look_at(x, y, [image, golden], tolerance);
        }
    }
    difference
}

const MAGENTA: [u8; 4] = [208, 0, 160, 255];

impl Difference {
    fn look_at(&mut self, x: u32, y: u32, images: [&Image; 2], tolerance: u8) {
        if self.sizes.iter().any(|size| x >= size[0] || y >= size[1]) {
            self.pixels += 1;
            return;
        }
        let [pixel, golden] = images.map(|image| image.pixel(x, y));
        let apart = pixel.iter().zip(golden).map(|(a, b)| a.abs_diff(b)).fold(0, u8::max);
        self.largest = self.largest.max(apart);
        if apart > tolerance {
            self.pixels += 1;
        } else {
            let [red, green, blue, _] = pixel.map(|channel| 192 + channel / 4);
            self.picture.set_pixel(x, y, [red, green, blue, 255]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pixel_and_another_size() {
        let image = Image::filled([4, 3], [10, 20, 30, 255]);
        let mut other = image.clone();
        other.set_pixel(2, 1, [10, 20, 30, 0]);
        let difference = compare(&image, &other, 254);
        assert_eq!((difference.pixels, difference.largest), (1, 255), "alpha counts");
        assert_eq!(difference.picture.pixel(2, 1), MAGENTA, "marked");
        assert_eq!(difference.picture.pixel(0, 0), [194, 197, 199, 255], "faint");
        let wider = compare(&image, &Image::filled([6, 2], [10, 20, 30, 255]), 0);
        assert_eq!(wider.picture.size(), [6, 3], "holds both");
        assert_eq!(wider.pixels, 4 + 4 + 2, "a row, two columns and a corner of neither");
    }
}
