//! Reduces images to few colours.

use std::collections::BTreeMap;

/// Red, green, blue and alpha.
type Pixel = [u8; 4];

/// A list of colours, and the colour that represents each pixel value of an image.
#[derive(Clone, Debug)]
pub(crate) struct Palette {
    colors: Vec<Pixel>,
    /// The index of the colour for each pixel value.
    index: BTreeMap<Pixel, u8>,
}

/// The largest number of colours of a PNG file with a palette.
pub(crate) const MAX_COLORS: usize = 256;

impl Palette {
    /// Returns the palette of all colours of the pixels; `None` if there are more than 256 colours
    /// or some pixels are not opaque.
    pub(crate) fn exactly(pixels: &[Pixel]) -> Option<Self> {
        let mut index = BTreeMap::new();
        for pixel in pixels {
            index.insert(*pixel, 0);
            if index.len() > MAX_COLORS || pixel[3] < u8::MAX {
                return None;
            }
        }
        for (number, entry) in (0..=u8::MAX).zip(index.values_mut()) {
            *entry = number;
        }
        Some(Self { colors: index.keys().copied().collect(), index })
    }

    /// Returns a palette of at most `count` colours, 1 to 256, that represent all pixels. Boxes of
    /// colours are split at the median until there are enough. The next box to split is the one
    /// with the largest product of its longest side and the square root of its number of pixels.
    pub(crate) fn of(pixels: &[Pixel], count: usize) -> Self {
        // The pixels are counted in an ordered map, so the colours do not depend on the positions
        // of the pixels.
        let mut counts = BTreeMap::new();
        for pixel in pixels {
            *counts.entry(*pixel).or_insert(0_u32) += 1;
        }
        let mut boxes: Vec<Vec<(Pixel, u32)>> = vec![counts.into_iter().collect()];
        while boxes.len() < count {
            let widest = boxes
                .iter()
                .enumerate()
                .max_by(|(_, a), (_, b)| extent(a).1.total_cmp(&extent(b).1));
            let Some((number, (channel, size))) = widest.map(|(number, own)| (number, extent(own)))
            else {
                break;
            };
            // If every box has a single colour, no box can be split.
            if size == 0.0 {
                break;
            }
            let upper = cut(&mut boxes[number], channel);
            boxes.push(upper);
        }
        let colors: Vec<_> = boxes.iter().map(|own| mean(own)).collect();
        let of_box = |(number, own): (u8, Vec<(Pixel, u32)>)| {
            own.into_iter().map(move |(pixel, _)| (pixel, number))
        };
        Self { colors, index: (0..=u8::MAX).zip(boxes).flat_map(of_box).collect() }
    }

    /// Returns the index of the colour of a pixel of the image; 0 for other pixels.
    pub(crate) fn index(&self, pixel: Pixel) -> u8 {
        self.index.get(&pixel).copied().unwrap_or_default()
    }

    /// Returns the colour that represents a pixel of the image.
    pub(crate) fn nearest(&self, pixel: Pixel) -> Pixel {
        self.colors[usize::from(self.index(pixel))]
    }

    /// Returns red, green and blue of each colour.
    pub(crate) fn rgb(&self) -> Vec<u8> {
        self.colors.iter().flat_map(|[red, green, blue, _]| [*red, *green, *blue]).collect()
    }
}

/// Returns the channel with the largest range in a box, and this range times the square root of the
/// number of pixels.
fn extent(pixels: &[(Pixel, u32)]) -> (usize, f64) {
    let range = |channel: usize| {
        let values = pixels.iter().map(|(pixel, _)| pixel[channel]);
        let (low, high) = values.fold((u8::MAX, 0), |(low, high), x| (low.min(x), high.max(x)));
        high.saturating_sub(low)
    };
    let (channel, range) = (0..4)
        .map(|channel| (channel, range(channel)))
        .fold((0, 0), |best, own| if own.1 > best.1 { own } else { best });
    let count: u32 = pixels.iter().map(|(_, count)| count).sum();
    (channel, f64::from(range) * f64::from(count).sqrt())
}

/// Splits a box with at least two colours at the median of a channel, and returns the upper part.
/// Neither part is empty.
fn cut(pixels: &mut Vec<(Pixel, u32)>, channel: usize) -> Vec<(Pixel, u32)> {
    pixels.sort_by_key(|(pixel, _)| (pixel[channel], *pixel));
    // This is the median of the pixels, not of the different colours: large areas get more colours
    // of the palette.
    let half = pixels.iter().map(|(_, count)| count).sum::<u32>() / 2;
    let mut below = 0;
    let median = pixels.iter().position(|(_, count)| {
        below += count;
        below > half
    });
    pixels.split_off(median.unwrap_or_default().clamp(1, pixels.len() - 1))
}

/// Returns the mean of the pixels of a box that is not empty.
fn mean(pixels: &[(Pixel, u32)]) -> Pixel {
    let count: u64 = pixels.iter().map(|(_, count)| u64::from(*count)).sum();
    [0, 1, 2, 3].map(|channel| {
        let sum: u64 =
            pixels.iter().map(|(pixel, n)| u64::from(pixel[channel]) * u64::from(*n)).sum();
        u8::try_from((sum + count / 2) / count).expect("a mean of bytes")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_as_they_are() {
        let pixels = [[9, 0, 0, 255], [0, 9, 0, 255], [9, 0, 0, 255], [0, 0, 9, 255]];
        let palette = Palette::of(&pixels, 8);
        assert!(pixels.iter().all(|pixel| palette.nearest(*pixel) == *pixel), "{palette:?}");
        let exact = Palette::exactly(&pixels).expect("three opaque colours");
        assert_eq!(exact.rgb(), [0, 0, 9, 0, 9, 0, 9, 0, 0], "in order");
        assert_eq!(pixels.map(|pixel| exact.index(pixel)), [2, 1, 2, 0]);
        assert!(Palette::exactly(&[[0; 4]]).is_none(), "not opaque");
    }

    #[test]
    fn many_colours_are_the_means_of_halves() {
        let ramp: Vec<_> = (0..=255).map(|x| [x, 7, 7, 255]).collect();
        let palette = Palette::of(&ramp, 2);
        assert_eq!(palette.rgb(), [64, 7, 7, 192, 7, 7], "of 0 to 127 and of 128 to 255, rounded");
        let palette = Palette::of(&ramp, 32);
        let apart = ramp.iter().map(|pixel| palette.nearest(*pixel)[0].abs_diff(pixel[0]));
        assert!(apart.max() <= Some(4), "eight values for each colour");
    }
}
