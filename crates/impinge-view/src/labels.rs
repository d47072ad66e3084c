//! Places texts beside their points.

use crate::lens::{View, larger};
use crate::recording::{Label, Recording};

/// The size of a character, in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Letter {
    pub(crate) width: f64,
    /// The height above the base line.
    pub(crate) ascent: f64,
    /// The depth below the base line.
    pub(crate) descent: f64,
}

/// A text and the left end of its base line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedLabel<'a> {
    pub(crate) label: &'a Label,
    pub(crate) at: [f64; 2],
}

/// A rectangle, given by its upper left and its lower right corner in pixels, with y downwards.
#[derive(Clone, Copy, Debug)]
struct Frame {
    low: [f64; 2],
    high: [f64; 2],
}

/// The horizontal and the vertical distance from a point to its text, in pixels.
const GAP: f64 = 5.0;

/// Places the texts of a recording on a page whose size is in pixels. Texts are in drawing order;
/// those whose points are not on the page are omitted.
///
/// A text is placed to the upper right of its point. If it would leave the page or overlap an
/// earlier text there, it is placed to the lower right, upper left or lower left. If none of these
/// four places is free, it is placed to the upper right, shifted onto the page. Costs O(n^2)
/// comparisons for n texts.
pub(crate) fn placed_labels<'a>(
    recording: &'a Recording,
    view: &View,
    page: [f64; 2],
    letter: Letter,
) -> Vec<PlacedLabel<'a>> {
    let (mut placed, mut taken) = (Vec::new(), Vec::new());
    for label in &recording.labels {
        let Some(on) = view.point(&label.at, 0.0) else { continue };
        let point = [on.x, on.y];
        if !(0..2).all(|axis| (0.0..=page[axis]).contains(&point[axis])) {
            continue;
        }
        let size =
            [letter.width * label.text.chars().count() as f64, letter.ascent + letter.descent];
        let frame = free_frame(point, size, page, &taken);
        placed.push(PlacedLabel { label, at: [frame.low[0], frame.low[1] + letter.ascent] });
        taken.push(frame);
    }
    placed
}

/// Returns the first frame beside a point that is inside the page and overlaps no earlier frame. If
/// there is none, returns the frame to the upper right, shifted onto the page.
fn free_frame(point: [f64; 2], size: [f64; 2], page: [f64; 2], taken: &[Frame]) -> Frame {
    let [right, above] = [point[0] + GAP, point[1] - GAP - size[1]];
    let [left, below] = [point[0] - GAP - size[0], point[1] + GAP];
    let corners = [[right, above], [right, below], [left, above], [left, below]];
    let mut frames = corners.map(|low| Frame { low, high: [low[0] + size[0], low[1] + size[1]] });
    let free = frames.iter().find(|frame| frame.is_on(page) && !frame.overlaps_any(taken));
    free.copied().unwrap_or_else(|| {
        frames[0].push_onto(page);
        frames[0]
    })
}

impl Frame {
    fn is_on(&self, page: [f64; 2]) -> bool {
        (0..2).all(|axis| self.low[axis] >= 0.0 && self.high[axis] <= page[axis])
    }

    fn overlaps_any(&self, others: &[Self]) -> bool {
        let overlaps = |other: &Self| {
            (0..2)
                .all(|axis| self.low[axis] < other.high[axis] && other.low[axis] < self.high[axis])
        };
        others.iter().any(overlaps)
    }

    /// Shifts the frame onto a page. If the frame is larger than the page, its upper left corner
    /// stays on the page.
    fn push_onto(&mut self, page: [f64; 2]) {
        for (axis, end) in page.into_iter().enumerate() {
            let beyond = larger(self.high[axis] - end, 0.0);
            let low = larger(self.low[axis] - beyond, 0.0);
            self.high[axis] += low - self.low[axis];
            self.low[axis] = low;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: [f64; 2] = [100.0, 50.0];

    #[test]
    fn texts_avoid_the_sides_and_each_other() {
        let size = [30.0, 10.0];
        let mut taken = Vec::new();
        let expected = [[55.0, 10.0], [55.0, 30.0], [15.0, 10.0], [15.0, 30.0], [55.0, 10.0]];
        for low in expected {
            let frame = free_frame([50.0, 25.0], size, PAGE, &taken);
            assert_eq!(frame.low, low, "the next side, and the first one when none is free");
            taken.push(frame);
        }
        let at_corner = free_frame([100.0, 0.0], size, PAGE, &[]);
        assert_eq!(at_corner.low, [65.0, 5.0], "to the lower left of the upper right corner");
    }

    #[test]
    fn texts_too_long_for_the_page_begin_at_its_left_side() {
        let frame = free_frame([50.0, 25.0], [300.0, 10.0], PAGE, &[]);
        assert_eq!((frame.low, frame.high), ([0.0, 10.0], [300.0, 20.0]));
    }
}
