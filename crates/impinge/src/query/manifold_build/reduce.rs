//! The few points that delimit the area of all.

use smallvec::SmallVec;

use super::frame::Candidate;
use crate::math::{Real, Vector, cross2};

/// A new point must span this much more than one that the previous manifold held.
pub(super) const NEW_POINT_WEIGHT: f64 = 0.95;
/// Of points that span almost the same, the deeper one wins.
pub(super) const ALMOST: f64 = 1.0 + 1.0 / 1024.0;

/// The indices of at most `limit` candidates: the deepest, which is given, then the farthest from it,
/// then whatever adds most to the area seen along the normal, for as long as it adds anything.
///
/// Points of the previous manifold are preferred, so that rounding does not exchange the points of a
/// solid at rest.
pub(super) fn chosen<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    deepest: usize,
    limit: usize,
    tolerance: N,
) -> SmallVec<[usize; 8]> {
    if candidates.len() <= limit {
        let mut all = SmallVec::new();
        for index in 0..candidates.len() {
            all.push(index);
        }
        return all;
    }
    // From a point to a segment to a triangle and on: each addition keeps the outline convex enough
    // for the area that a further point adds to be that beyond one side.
    let mut outline = Outline { candidates, corners: SmallVec::from_slice(&[deepest]) };
    let order = by_depth(candidates);
    while outline.corners.len() < limit {
        let Some((index, place)) = outline.best_addition(&order, tolerance) else { break };
        outline.corners.insert(place, index);
    }
    outline.corners
}

fn by_depth<N: Real, const D: usize>(candidates: &[Candidate<N, D>]) -> SmallVec<[usize; 16]> {
    let mut order: SmallVec<[usize; 16]> = (0..candidates.len()).collect();
    order.sort_by(|&a, &b| {
        candidates[a].distance.as_f64().total_cmp(&candidates[b].distance.as_f64())
    });
    order
}

/// The points chosen so far, counter-clockwise.
struct Outline<'a, N: Real, const D: usize> {
    candidates: &'a [Candidate<N, D>],
    corners: SmallVec<[usize; 8]>,
}

impl<N: Real, const D: usize> Outline<'_, N, D> {
    /// The candidate that adds most and its place in the outline; `None` if none adds more than
    /// rounding errors.
    fn best_addition(&self, order: &[usize], tolerance: N) -> Option<(usize, usize)> {
        let (mut best, mut best_gain) = (None, N::ZERO);
        let sides = self.sides(tolerance);
        for &index in order.iter().filter(|index| !self.corners.contains(index)) {
            let candidate = &self.candidates[index];
            let (gain, place) = self.gain(&candidate.flat, &sides, tolerance);
            let is_new = candidate.kept_id.is_none();
            let gain = if is_new { gain * N::lit(NEW_POINT_WEIGHT) } else { gain };
            if gain > best_gain * N::lit(ALMOST) {
                (best, best_gain) = (Some((index, place)), gain);
            }
        }
        best
    }

    /// The sides of the outline; a point has none.
    fn sides(&self, tolerance: N) -> SmallVec<[Side<N>; 8]> {
        let mut sides = SmallVec::new();
        let corners = self.corners.as_slice();
        let place = |at: usize| self.candidates[corners[at]].flat;
        for at in 0..if corners.len() > 1 { corners.len() } else { 0 } {
            let from = place(at);
            let along = place(if at + 1 < corners.len() { at + 1 } else { 0 }) - from;
            sides.push(Side { from, along, least: tolerance * along.norm() });
        }
        sides
    }

    /// What a place adds: its distance from a single point, else the largest area (doubled) that it
    /// spans with a side of the outline from outside.
    fn gain(&self, flat: &Vector<N, 2>, sides: &[Side<N>], tolerance: N) -> (N, usize) {
        if sides.is_empty() {
            let distance = (flat - self.candidates[self.corners[0]].flat).norm();
            return (if distance > tolerance { distance } else { N::ZERO }, 1);
        }
        let (mut gain, mut best) = (N::ZERO, 0);
        for (at, side) in sides.iter().enumerate() {
            let area = -cross2(&side.along, &(flat - side.from));
            if area > gain && area > side.least {
                (gain, best) = (area, at + 1);
            }
        }
        (gain, best)
    }
}

/// A side of the outline.
struct Side<N: Real> {
    from: Vector<N, 2>,
    along: Vector<N, 2>,
    /// Areas up to this are rounding errors.
    least: N,
}
