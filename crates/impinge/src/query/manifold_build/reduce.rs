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
    let mut outline = Outline::new(candidates, deepest, tolerance);
    let mut rest = by_depth(candidates, deepest);
    while outline.corners.len() < limit {
        let Some((at, place)) = outline.best_addition(&rest) else { break };
        outline.insert(place, rest.remove(at));
    }
    outline.corners
}

/// The candidates but for one, the deepest first, as they come where they are as deep.
fn by_depth<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    without: usize,
) -> SmallVec<[usize; 16]> {
    let mut order: SmallVec<[usize; 16]> = SmallVec::new();
    for index in 0..candidates.len() {
        if index == without {
            continue;
        }
        // There are few, mostly less than ten: each is put where it belongs at once.
        order.push(index);
        let depth = candidates[index].distance.as_f64();
        let order = order.as_mut_slice();
        let mut at = order.len() - 1;
        while at > 0 && depth.total_cmp(&candidates[order[at - 1]].distance.as_f64()).is_lt() {
            order.swap(at, at - 1);
            at -= 1;
        }
    }
    order
}

/// The points chosen so far, counter-clockwise.
struct Outline<'a, N: Real, const D: usize> {
    candidates: &'a [Candidate<N, D>],
    corners: SmallVec<[usize; 8]>,
    /// From each corner to the next; a point has none.
    sides: SmallVec<[Side<N>; 8]>,
    tolerance: N,
}

impl<'a, N: Real, const D: usize> Outline<'a, N, D> {
    fn new(candidates: &'a [Candidate<N, D>], first: usize, tolerance: N) -> Self {
        let mut corners = SmallVec::new();
        corners.push(first);
        Self { candidates, corners, sides: SmallVec::new(), tolerance }
    }

    /// Of the rest the place of the candidate that adds most and its place in the outline; `None` if none adds
    /// more than rounding errors.
    fn best_addition(&self, rest: &[usize]) -> Option<(usize, usize)> {
        let (mut best, mut best_gain) = (None, N::ZERO);
        let sides = self.sides.as_slice();
        let only = self.candidates[self.corners[0]].flat;
        for (at, &index) in rest.iter().enumerate() {
            let candidate = &self.candidates[index];
            let (gain, place) = if sides.is_empty() {
                let distance = (candidate.flat - only).norm();
                (if distance > self.tolerance { distance } else { N::ZERO }, 1)
            } else {
                gain(&candidate.flat, sides)
            };
            let is_new = candidate.kept_id.is_none();
            let gain = if is_new { gain * N::lit(NEW_POINT_WEIGHT) } else { gain };
            if gain > best_gain * N::lit(ALMOST) {
                (best, best_gain) = (Some((at, place)), gain);
            }
        }
        best
    }

    /// Puts a candidate between two corners: of the sides only those beside it are others then.
    fn insert(&mut self, place: usize, index: usize) {
        let before = self.corners[place - 1];
        let after = self.corners[if place < self.corners.len() { place } else { 0 }];
        let [to, from] = [self.side(before, index), self.side(index, after)];
        insert(&mut self.corners, place, index);
        if let Some(side) = self.sides.get_mut(place - 1) {
            *side = to;
        } else {
            self.sides.push(to);
        }
        insert(&mut self.sides, place, from);
    }

    fn side(&self, from: usize, to: usize) -> Side<N> {
        let from = self.candidates[from].flat;
        let along = self.candidates[to].flat - from;
        Side { from, along, least: self.tolerance * along.norm() }
    }
}

/// Puts an item at a place of a short list: by pushes and swaps, which are inlined.
#[inline]
fn insert<T>(list: &mut SmallVec<[T; 8]>, place: usize, item: T) {
    list.push(item);
    let list = list.as_mut_slice();
    for at in (place + 1..list.len()).rev() {
        list.swap(at, at - 1);
    }
}

/// What a place adds: the largest area (doubled) that it spans with a side of the outline from outside, and
/// which place in the outline is its own.
#[inline]
fn gain<N: Real>(flat: &Vector<N, 2>, sides: &[Side<N>]) -> (N, usize) {
    let (mut gain, mut best) = (N::ZERO, 0);
    for (at, side) in sides.iter().enumerate() {
        let area = -cross2(&side.along, &(flat - side.from));
        if area > gain && area > side.least {
            (gain, best) = (area, at + 1);
        }
    }
    (gain, best)
}

/// A side of the outline.
struct Side<N: Real> {
    from: Vector<N, 2>,
    along: Vector<N, 2>,
    /// Areas up to this are rounding errors.
    least: N,
}
