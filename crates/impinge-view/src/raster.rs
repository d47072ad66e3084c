//! Rasterizes triangles and lines, with a depth buffer.

use crate::lens::{OnScreen, larger};

/// Pixels with depths, row by row from the top. The background has an infinite depth.
#[derive(Clone, Debug)]
pub(crate) struct Raster {
    size: [usize; 2],
    depth: Vec<f64>,
    color: Vec<[u8; 3]>,
}

/// The operation with which a triangle is drawn, and the pixels that it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ink {
    /// Changes pixels that are not nearer than the triangle; they get its colour and its depth.
    Solid,
    /// Changes pixels that are not nearer than the triangle: its colour is blended with this alpha.
    /// Depths stay.
    Blend(u8),
    /// Changes pixels that hide the triangle: its colour is blended with this alpha. Depths stay.
    Ghost(u8),
}

/// A triangle whose corners are clockwise on the screen, with y downwards.
struct Oriented {
    corners: [OnScreen; 3],
    area: f64,
    /// For each corner, whether pixel centres exactly on the edge to the next corner are inside the
    /// triangle. This holds for left and top edges.
    owns_edge: [bool; 3],
}

impl Raster {
    pub(crate) fn new(size: [usize; 2], background: [u8; 3]) -> Self {
        let count = size[0] * size[1];
        Self { size, depth: vec![f64::INFINITY; count], color: vec![background; count] }
    }

    /// Returns the depth of the pixel that contains a point; `None` outside the picture.
    pub(crate) fn depth_at(&self, x: f64, y: f64) -> Option<f64> {
        let [width, height] = self.size;
        let is_inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
        is_inside.then(|| self.depth[whole(y, height) * width + whole(x, width)])
    }

    /// Returns the mean colours of squares of `side` by `side` pixels, row by row.
    pub(crate) fn reduced(&self, side: usize) -> Vec<[u8; 3]> {
        let size = self.size.map(|length| length / side);
        let mut pixels = Vec::with_capacity(size[0] * size[1]);
        for y in 0..size[1] {
            pixels.extend((0..size[0]).map(|x| self.mean([x * side, y * side], side)));
        }
        pixels
    }

    fn mean(&self, corner: [usize; 2], side: usize) -> [u8; 3] {
        let mut sums = [0_u32; 3];
        for y in corner[1]..corner[1] + side {
            for x in corner[0]..corner[0] + side {
                let color = self.color[y * self.size[0] + x];
                for (sum, channel) in sums.iter_mut().zip(color) {
                    *sum += u32::from(channel);
                }
            }
        }
        let count = u32::try_from(side * side).expect("a few samples for a pixel");
        sums.map(|sum| u8::try_from((sum + count / 2) / count).expect("a mean of bytes"))
    }

    /// Fills a triangle. `color_at` gets the barycentric coordinates of a pixel centre and returns
    /// the colour of the pixel.
    ///
    /// Corners are rounded to 1/256 pixel. So the tests of pixel centres are exact up to 65536
    /// pixels from the corner of the picture, and a pixel on a common edge of two triangles is
    /// covered by exactly one of them.
    pub(crate) fn fill(
        &mut self,
        corners: &[OnScreen; 3],
        ink: Ink,
        color_at: impl Fn(&[f64; 3]) -> [u8; 3],
    ) {
        let Some(triangle) = Oriented::new(corners) else { return };
        let [top, bottom] = triangle.rows(self.size[1]);
        for y in top..bottom {
            let [left, right] = triangle.columns(y, self.size[0]);
            for x in left..right {
                let Some(weights) = triangle.weights(x, y) else { continue };
                let index = y * self.size[0] + x;
                self.touch(index, triangle.depth(&weights), ink, || color_at(&weights));
            }
        }
    }

    fn touch(&mut self, index: usize, depth: f64, ink: Ink, color: impl Fn() -> [u8; 3]) {
        let is_hidden = depth > self.depth[index];
        match ink {
            Ink::Solid if !is_hidden => {
                self.depth[index] = depth;
                self.color[index] = color();
            }
            Ink::Blend(alpha) if !is_hidden => self.blend(index, color(), alpha),
            Ink::Ghost(alpha) if is_hidden => self.blend(index, color(), alpha),
            _ => {}
        }
    }

    fn blend(&mut self, index: usize, color: [u8; 3], alpha: u8) {
        let alpha = u32::from(alpha);
        for (below, above) in self.color[index].iter_mut().zip(color) {
            let sum = u32::from(above) * alpha + u32::from(*below) * (255 - alpha);
            *below = u8::try_from((sum + 127) / 255).expect("a mean of bytes");
        }
    }
}

impl Oriented {
    /// Orients a triangle; `None` if its area is zero or its coordinates are not finite.
    fn new(corners: &[OnScreen; 3]) -> Option<Self> {
        let snap = |x: f64| (x * 256.0 + 0.5).floor() / 256.0;
        let [a, b, c] = corners.map(|p| OnScreen { x: snap(p.x), y: snap(p.y), depth: p.depth });
        let area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
        let depths = a.depth + b.depth + c.depth;
        if area == 0.0 || !area.is_finite() || !depths.is_finite() {
            return None;
        }
        let corners = if area > 0.0 { [a, b, c] } else { [a, c, b] };
        let owns =
            |from: OnScreen, to: OnScreen| to.y < from.y || (to.y == from.y && to.x > from.x);
        let [a, b, c] = corners;
        Some(Self { corners, area: area.abs(), owns_edge: [owns(a, b), owns(b, c), owns(c, a)] })
    }

    fn edges(&self) -> [[OnScreen; 2]; 3] {
        let [a, b, c] = self.corners;
        [[a, b], [b, c], [c, a]]
    }

    fn rows(&self, height: usize) -> [usize; 2] {
        let [a, b, c] = self.corners.map(|corner| corner.y);
        let top = -larger(-a, larger(-b, -c));
        let bottom = larger(a, larger(b, c));
        [whole(top, height), whole(bottom + 1.0, height)]
    }

    /// Returns a range of pixel columns in row `y` that contains all pixels inside the triangle,
    /// and about one more on each side.
    fn columns(&self, y: usize, width: usize) -> [usize; 2] {
        let y = y as f64 + 0.5;
        let (mut left, mut right) = (0.0, width as f64);
        for [from, to] in self.edges() {
            let rise = from.y - to.y;
            let crossing = from.x + (to.x - from.x) * (y - from.y) / (to.y - from.y);
            if rise > 0.0 {
                left = larger(left, crossing - 1.5);
            } else if rise < 0.0 {
                right = -larger(-right, -(crossing + 1.5));
            }
        }
        [whole(left, width), whole(right, width)]
    }

    /// Returns the barycentric coordinates of the centre of a pixel; `None` if the centre is
    /// outside the triangle.
    fn weights(&self, x: usize, y: usize) -> Option<[f64; 3]> {
        let (x, y) = (x as f64 + 0.5, y as f64 + 0.5);
        let mut areas = [0.0; 3];
        for (index, [from, to]) in self.edges().into_iter().enumerate() {
            let area = (to.x - from.x) * (y - from.y) - (to.y - from.y) * (x - from.x);
            let is_inside = area > 0.0 || (area == 0.0 && self.owns_edge[index]);
            // The edge from a corner is opposite to the previous corner.
            areas[(index + 2) % 3] = area;
            if !is_inside {
                return None;
            }
        }
        Some(areas.map(|area| area / self.area))
    }

    /// Interpolates the depth between the corners. If the corners have equal depths, returns
    /// exactly this depth.
    fn depth(&self, weights: &[f64; 3]) -> f64 {
        let [a, b, c] = self.corners.map(|corner| corner.depth);
        a + weights[1] * (b - a) + weights[2] * (c - a)
    }
}

/// Returns the two triangles of a line with a width in pixels. They are slightly longer than the
/// line, which closes the corners between connected lines.
pub(crate) fn ribbon(ends: &[OnScreen; 2], width: f64) -> [[OnScreen; 3]; 2] {
    let [start, end] = *ends;
    let along = [end.x - start.x, end.y - start.y];
    let length = (along[0] * along[0] + along[1] * along[1]).sqrt();
    let [x, y] = if length > 0.0 { along.map(|x| x / length) } else { [1.0, 0.0] };
    let half = width * 0.5;
    let corner = |end: OnScreen, ahead: f64, aside: f64| OnScreen {
        x: end.x + half * (x * ahead * 0.6 - y * aside),
        y: end.y + half * (y * ahead * 0.6 + x * aside),
        depth: end.depth,
    };
    let [a, b] = [corner(start, -1.0, -1.0), corner(end, 1.0, -1.0)];
    let [c, d] = [corner(end, 1.0, 1.0), corner(start, -1.0, 1.0)];
    [[a, b, c], [a, c, d]]
}

/// Returns the integer part of `x`, clamped to the range from 0 to `limit`; 0 for NaN.
#[expect(clippy::cast_possible_truncation, reason = "clamped to the limit")]
#[expect(clippy::cast_sign_loss, reason = "clamped to zero")]
pub(crate) fn whole(x: f64, limit: usize) -> usize {
    (x.max(0.0) as usize).min(limit)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64, depth: f64) -> OnScreen {
        OnScreen { x, y, depth }
    }

    fn count(raster: &Raster, color: [u8; 3]) -> usize {
        raster.color.iter().filter(|pixel| **pixel == color).count()
    }

    #[test]
    fn triangles_with_a_common_edge_cover_each_pixel_once() {
        // A fan of four triangles around a point with fractional coordinates, in both orientations,
        // blended with half alpha. A pixel that is covered twice is darker, a pixel that is not
        // covered is white.
        let corners =
            [at(2.0, 3.0, 1.0), at(18.0, 3.0, 1.0), at(18.0, 15.0, 1.0), at(2.0, 15.0, 1.0)];
        for center in [at(9.5, 8.5, 1.0), at(10.0, 9.0, 1.0), at(7.3, 11.7, 1.0)] {
            let mut raster = Raster::new([20, 20], [255; 3]);
            for index in 0..4 {
                let [a, b] = [corners[index], corners[(index + 1) % 4]];
                let corners = if index % 2 == 0 { [a, b, center] } else { [b, a, center] };
                raster.fill(&corners, Ink::Blend(128), |_| [0; 3]);
            }
            assert_eq!(count(&raster, [127; 3]), 16 * 12, "covered once");
            assert_eq!(count(&raster, [255; 3]), 400 - 16 * 12, "not covered");
        }
    }

    #[test]
    fn what_is_nearer_hides_and_ghosts_are_what_is_hidden() {
        let square = |depth| [at(0.0, 0.0, depth), at(20.0, 0.0, depth), at(0.0, 20.0, depth)];
        let mut raster = Raster::new([10, 10], [255; 3]);
        raster.fill(&square(2.0), Ink::Solid, |_| [10; 3]);
        raster.fill(&square(3.0), Ink::Solid, |_| [20; 3]);
        assert_eq!(count(&raster, [10; 3]), 100, "the farther one is hidden");
        raster.fill(&square(2.0), Ink::Ghost(255), |_| [30; 3]);
        assert_eq!(count(&raster, [10; 3]), 100, "as near is not hidden");
        raster.fill(&square(3.0), Ink::Ghost(255), |_| [30; 3]);
        assert_eq!(count(&raster, [30; 3]), 100, "hidden");
        raster.fill(&square(1.0), Ink::Blend(0), |_| [40; 3]);
        assert_eq!(
            (count(&raster, [30; 3]), raster.depth_at(5.0, 5.0)),
            (100, Some(2.0)),
            "invisible"
        );
    }

    #[test]
    fn depths_and_colours_are_linear() {
        let mut raster = Raster::new([8, 8], [0; 3]);
        let corners = [at(0.0, 0.0, 0.0), at(16.0, 0.0, 16.0), at(0.0, 16.0, 0.0)];
        raster.fill(&corners, Ink::Solid, |weights| [u8::from(weights[1] > 0.25), 0, 0]);
        assert_eq!(
            raster.depth_at(3.5, 6.2),
            Some(3.5),
            "the depth is x, at the center of the pixel"
        );
        assert_eq!(count(&raster, [1, 0, 0]), 32, "the right half");
        assert_eq!(raster.depth_at(8.0, 0.0), None, "outside");
    }

    #[test]
    fn strokes_have_their_width_and_degenerate_triangles_nothing() {
        let mut raster = Raster::new([20, 20], [255; 3]);
        let ends = [at(3.0, 5.0, 0.0), at(13.0, 5.0, 0.0)];
        for corners in &ribbon(&ends, 2.0) {
            raster.fill(corners, Ink::Solid, |_| [0; 3]);
        }
        assert_eq!(count(&raster, [0; 3]), 24, "two rows of 10, and a pixel more at each end");
        let wild = [f64::NAN, f64::INFINITY, 1e300, -1e300];
        for x in wild {
            let corners = [at(x, 1.0, 0.0), at(5.0, x, 0.0), at(9.0, 9.0, 0.0)];
            raster.fill(&corners, Ink::Solid, |_| [9; 3]);
        }
        assert_eq!(count(&raster, [9; 3]), 0, "no triangle of finite area");
    }

    #[test]
    fn the_mean_of_squares() {
        let mut raster = Raster::new([4, 2], [255; 3]);
        let corners = [at(0.0, 0.0, 0.0), at(2.0, 0.0, 0.0), at(0.0, 2.0, 0.0)];
        raster.fill(&corners, Ink::Solid, |_| [0; 3]);
        // The diagonal is not a left edge: pixel centres on it belong to the other side.
        assert_eq!(raster.reduced(2), [[191; 3], [255; 3]], "one of four pixels");
    }
}
