//! Visibility of lines: finds the parts that surfaces hide.

use crate::flatten::{Face, Flat};
use crate::lens::{OnScreen, View};
use crate::raster::{Ink, Raster, whole};

/// A part of a line that is completely visible or completely hidden.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Run {
    pub(crate) is_hidden: bool,
    pub(crate) ends: [OnScreen; 2],
}

/// The maximum number of samples along a line.
const MAX_SAMPLES: usize = 4096;
/// The minimum number of samples of all runs but the first. Shorter runs are merged with the
/// previous run.
const MIN_RUN: usize = 3;
/// The number of samples along a line per pixel of length.
const FINENESS: f64 = 2.0;

/// Rasterizes all opaque faces; only the depths of the result are used.
pub(crate) fn depths(flat: &Flat, view: &View, size: [usize; 2]) -> Raster {
    let mut raster = Raster::new(size, [0; 3]);
    let is_opaque = |face: &&Face| face.color.alpha == u8::MAX;
    for face in flat.faces.iter().filter(is_opaque) {
        match view.triangle(&face.corners, 0.0)[..] {
            [a, b, c] => raster.fill(&[a, b, c], Ink::Solid, |_| [0; 3]),
            [a, b, c, d] => {
                raster.fill(&[a, b, c], Ink::Solid, |_| [0; 3]);
                raster.fill(&[a, c, d], Ink::Solid, |_| [0; 3]);
            }
            _ => {}
        }
    }
    raster
}

/// Returns the runs of a line, from its start to its end. Costs at most nine depth look-ups for
/// each sample; there are [`FINENESS`] samples per pixel, up to [`MAX_SAMPLES`].
pub(crate) fn runs(ends: &[OnScreen; 2], depths: &Raster) -> Vec<Run> {
    let [start, end] = *ends;
    let (dx, dy) = (end.x - start.x, end.y - start.y);
    let count = 1 + whole((dx * dx + dy * dy).sqrt() * FINENESS, MAX_SAMPLES - 1);
    let at = |part: f64| OnScreen {
        x: start.x + dx * part,
        y: start.y + dy * part,
        depth: start.depth + (end.depth - start.depth) * part,
    };
    let hidden =
        (0..count).map(|index| is_hidden(&at((index as f64 + 0.5) / count as f64), depths));
    let turns = turns(&hidden.collect::<Vec<_>>());
    let ends = turns.iter().map(|(index, _)| *index).skip(1).chain([count]);
    let run = |(&(from, is_hidden), to): (&(usize, bool), usize)| Run {
        is_hidden,
        ends: [at(from as f64 / count as f64), at(to as f64 / count as f64)],
    };
    turns.iter().zip(ends).map(run).collect()
}

/// Returns `true` if the surfaces at the pixel of a point and at its eight neighbours are all
/// nearer than the point. A visible line may lie on a surface that is steep near a silhouette. Then
/// the surface at the pixel is often nearer than the line, but not at a neighbour beyond the
/// silhouette.
fn is_hidden(at: &OnScreen, depths: &Raster) -> bool {
    const STEPS: [f64; 3] = [-1.0, 0.0, 1.0];
    let hides = |dx: f64, dy: f64| {
        depths.depth_at(at.x + dx, at.y + dy).is_some_and(|depth| at.depth > depth)
    };
    STEPS.iter().all(|dy| STEPS.iter().all(|dx| hides(*dx, *dy)))
}

/// Returns, for each run, the index of its first sample and whether the run is hidden. `hidden` has
/// at least one sample.
fn turns(hidden: &[bool]) -> Vec<(usize, bool)> {
    let mut found: Vec<(usize, bool)> = Vec::new();
    let mut index = 0;
    for run in hidden.chunk_by(|a, b| a == b) {
        let goes_on = found.last().is_some_and(|(_, before)| *before == run[0]);
        let is_long = run.len() >= MIN_RUN || found.is_empty();
        if is_long && !goes_on {
            found.push((index, run[0]));
        }
        index += run.len();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(x: f64, y: f64, depth: f64) -> OnScreen {
        OnScreen { x, y, depth }
    }

    #[test]
    fn a_line_behind_a_square_has_three_runs() {
        let mut depths = Raster::new([40, 40], [0; 3]);
        let [a, b] = [at(10.0, 10.0, 1.0), at(30.0, 10.0, 1.0)];
        let [c, d] = [at(30.0, 30.0, 1.0), at(10.0, 30.0, 1.0)];
        depths.fill(&[a, b, c], Ink::Solid, |_| [0; 3]);
        depths.fill(&[a, c, d], Ink::Solid, |_| [0; 3]);
        let found = runs(&[at(0.0, 20.0, 2.0), at(40.0, 20.0, 2.0)], &depths);
        let hidden: Vec<_> = found.iter().map(|run| run.is_hidden).collect();
        assert_eq!(hidden, [false, true, false], "{found:?}");
        let [start, end] = found[1].ends;
        let is_near = (start.x - 11.0).abs() < 0.5 && (end.x - 29.0).abs() < 0.5;
        assert!(is_near, "a pixel inside of the square: {found:?}");
        assert_eq!(found[0].ends[1], found[1].ends[0], "without a gap");
        let before = runs(&[at(0.0, 20.0, 0.5), at(40.0, 20.0, 0.5)], &depths);
        assert_eq!(before.len(), 1, "in front of the square");
    }

    #[test]
    fn short_runs_are_no_runs() {
        let flicker = [false, false, true, false, false, true, true, true, false];
        assert_eq!(turns(&flicker), [(0, false), (5, true)], "one sample and the last one");
        assert_eq!(turns(&[true]), [(0, true)], "a point");
    }
}
