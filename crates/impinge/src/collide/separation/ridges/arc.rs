//! Least depth along an arc of normals, with a proof that it is the least.
//!
//! Along a circle of unit vectors, the height of each point of a convex solid is a sinusoid, and
//! the depth is the largest of these. The two sinusoids that are largest at the ends of an arc
//! bound the depth from below on the whole arc: at their crossing, or at the minimum of one. If the
//! bound is below the least depth known, the depth at that direction is computed, and the arc is
//! split there.
//!
//! ```text
//!    depth   \         /
//!             \  .-.  /       . the depth: the largest of all sinusoids
//!              \'   '/        \ and /: those of the points that are highest at `from` and at `to`
//!               \   /
//!                \ /
//!                 v           bound: where these two cross
//!         from         to
//! ```
//!
//! Growing a polygon by its side nearest to the origin, as `epa2` does, is the special case of
//! sinusoids without a `base`.

use smallvec::SmallVec;

use crate::math::{Mapped, Real, Vector, cross2, min, perp, unit};

/// The maximum number of arcs, the given arc and parts of it, that one search examines. For each
/// arc it computes the depth in at most one direction, at which it may split the arc. About 20
/// directions are enough in `f32`, and 40 in `f64`: the splits approach the best direction from
/// both sides, until the bounds are good enough.
const STEPS: usize = 256;

/// Height of a point along the unit vectors `u` of a circle: `base + toward · u`.
#[derive(Clone, Copy)]
pub(super) struct RidgeLine<N: Real> {
    pub(super) base: N,
    pub(super) toward: Vector<N, 2>,
}

impl<N: Real> RidgeLine<N> {
    fn at(&self, u: &Vector<N, 2>) -> N {
        self.base + self.toward.dot(u)
    }

    /// Returns the direction of the smallest height, and that height; `None` if the height is
    /// constant.
    fn bottom(&self) -> Option<(Vector<N, 2>, N)> {
        let (toward, length) = unit(&self.toward)?;
        Some((-toward, self.base - length))
    }
}

/// An arc of at most half a circle, counter-clockwise, and the lines that are highest at its ends.
/// The two lines are equal if one point is highest at both ends; otherwise each line is lower at
/// the end of the other line, so that they cross. An arc may have no length: if an arc is split at
/// one of its ends, one of the two parts has none.
#[derive(Clone, Copy)]
pub(super) struct Arc<N: Real> {
    pub(super) ends: [Vector<N, 2>; 2],
    pub(super) lines: [RidgeLine<N>; 2],
}

impl<N: Real> Arc<N> {
    /// Returns whether a direction is on the arc, ends included. For an arc without length, the two
    /// products alone would also be zero at the opposite direction.
    fn holds(&self, u: &Vector<N, 2>) -> bool {
        let [from, to] = &self.ends;
        let is_between = cross2(from, u) >= N::ZERO && cross2(u, to) >= N::ZERO;
        is_between && u.dot(&(from + to)) >= N::ZERO
    }

    /// Returns the direction of the arc at which both lines are equally high. `None` if there is no
    /// such direction, or if the lines differ by a constant.
    fn crossing(&self) -> Option<Vector<N, 2>> {
        let [first, second] = &self.lines;
        let (along, length) = unit(&(first.toward - second.toward))?;
        let cosine = (second.base - first.base) / length;
        let squared = N::ONE - cosine * cosine;
        let is_met = squared >= N::ZERO;
        if !is_met {
            return None;
        }
        let (middle, aside) = (along * cosine, perp(&along) * squared.sqrt());
        [middle + aside, middle - aside].into_iter().find(|u| self.holds(u))
    }

    /// Returns the direction and the height of a line's minimum on the arc; if the minimum is at an
    /// end, the direction halfway between the ends instead of the end.
    fn least_of(&self, line: &RidgeLine<N>) -> (Vector<N, 2>, N) {
        let halfway = unit(&(self.ends[0] + self.ends[1]));
        let ends = min(line.at(&self.ends[0]), line.at(&self.ends[1]));
        match line.bottom() {
            Some(bottom) if self.holds(&bottom.0) => bottom,
            _ => (halfway.map_or(perp(&self.ends[0]), |(u, _)| u), ends),
        }
    }

    /// Returns whether the depth is certainly at least `least` everywhere on the arc, by
    /// [`are_above`]; `false` if a line has a positive `base`.
    fn is_above(&self, least: N) -> bool {
        let [from, to] = &self.ends;
        let has_base = self.lines.iter().any(|line| line.base > N::ZERO);
        let heights = self.lines.mapped(|line| [line.at(from), line.at(to)]);
        !has_base && are_above(&heights, least)
    }

    /// Returns a direction of the arc at which to split it, and a lower bound of the depth on the
    /// arc.
    fn bound(&self) -> (Vector<N, 2>, N) {
        let Some(crossing) = self.crossing() else {
            let [first, second] = self.lines.mapped(|line| self.least_of(&line));
            return if second.1 > first.1 { second } else { first };
        };
        let height = min(self.lines[0].at(&crossing), self.lines[1].at(&crossing));
        let mut bound = (crossing, height);
        let halves = [[self.ends[0], crossing], [crossing, self.ends[1]]];
        for (ends, line) in halves.into_iter().zip(self.lines) {
            let half = Self { ends, lines: self.lines };
            if let Some(bottom) = line.bottom().filter(|(u, low)| *low < bound.1 && half.holds(u)) {
                bound = bottom;
            }
        }
        bound
    }
}

/// Returns whether the depth is certainly at least `least`, a positive number, everywhere on an
/// arc. It computes products only, unlike [`Arc::bound`], and returns `false` in close cases.
/// `heights` are those of two points at both ends of the arc. Preconditions: the first point is the
/// highest at the first end, the second at the second end, both are at least `least` there, and
/// neither point has a positive `base`.
///
/// A direction of the arc is a convex combination of the ends divided by its length, which is at
/// most 1. With no positive `base`, a height of at least `least` at the combination is no less at
/// the direction. So if some convex combination of the points is at least `least` high at every
/// combination of the ends, the depth is at least `least` on the arc. Such a combination of the
/// points exists if the matrix game with the two by two heights has a value of at least `least`.
pub(super) fn are_above<N: Real>(heights: &[[N; 2]; 2], least: N) -> bool {
    let [first, second] = heights.mapped(|[from, to]| [from - least, to - least]);
    let is_one = first[1] >= N::ZERO || second[0] >= N::ZERO;
    least > N::ZERO && (is_one || first[0] * second[1] >= first[1] * second[0])
}

/// State of a search along arcs.
pub(super) struct ArcSearch<N: Real> {
    /// Least depth so far, found by this or by another search.
    pub(super) least: N,
    /// Direction of the least depth; `None` if this search has not improved on the initial depth.
    pub(super) best: Option<Vector<N, 2>>,
    /// Improvements smaller than this are not searched for.
    gap: N,
}

impl<N: Real> ArcSearch<N> {
    pub(super) fn new(least: N, gap: N) -> Self {
        Self { least, best: None, gap }
    }

    /// Records the depth along `u`; `highest` is the highest line in this direction.
    pub(super) fn note(&mut self, u: &Vector<N, 2>, highest: &RidgeLine<N>) {
        let depth = highest.at(u);
        if depth < self.least {
            (self.least, self.best) = (depth, Some(*u));
        }
    }

    /// Searches an arc for a depth below [`Self::least`]. Precondition: the depths at the ends of
    /// the arc are not below it. `highest` returns the highest line in a direction. `None` if arcs
    /// are left after [`STEPS`] arcs have been examined.
    pub(super) fn run(
        &mut self,
        arc: Arc<N>,
        highest: impl Fn(&Vector<N, 2>) -> RidgeLine<N>,
    ) -> Option<()> {
        let mut open = SmallVec::<[Arc<N>; 16]>::from_slice(&[arc]);
        for _ in 0..STEPS {
            let Some(arc) = open.pop() else { return Some(()) };
            if arc.is_above(self.least - self.gap) {
                continue;
            }
            let (u, bound) = arc.bound();
            if bound >= self.least - self.gap {
                continue;
            }
            let line = highest(&u);
            self.note(&u, &line);
            if line.at(&u) - bound > self.gap {
                let [from, to] = arc.ends;
                let [first, second] = arc.lines;
                open.push(Arc { ends: [from, u], lines: [first, line] });
                open.push(Arc { ends: [u, to], lines: [line, second] });
            }
        }
        open.is_empty().then_some(())
    }
}
