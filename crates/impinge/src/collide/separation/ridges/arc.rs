//! The least depth along an arc of normals, with its proof.
//!
//! Along a circle of unit vectors each point of a convex solid has a height that is a sinusoid, and the
//! depth is the largest of them. Two of them, those that are largest at the ends of an arc, bound it from
//! below on the whole arc: by where they cross, or by the bottom of one. If that is less than is known, the
//! depth there is asked for, and the arc is two. Growing a polygon by its side nearest to the origin, as
//! `epa2` does, is this where the sinusoids have no base.

use smallvec::SmallVec;

use crate::math::{Mapped, Real, Vector, cross2, min, perp, unit};

/// Cap on the directions asked for along one arc. About twenty are enough in `f32`, forty in `f64`: the part
/// of the arc around the best direction is halved until the bound is good enough, and to each side of it there
/// are as many parts.
const STEPS: usize = 256;

/// The height of a point along the unit vectors of a circle: `base + toward · u`.
#[derive(Clone, Copy)]
pub(super) struct RidgeLine<N: Real> {
    pub(super) base: N,
    pub(super) toward: Vector<N, 2>,
}

impl<N: Real> RidgeLine<N> {
    fn at(&self, u: &Vector<N, 2>) -> N {
        self.base + self.toward.dot(u)
    }

    /// Where the height is least, and how low it is there.
    fn bottom(&self) -> Option<(Vector<N, 2>, N)> {
        let (toward, length) = unit(&self.toward)?;
        Some((-toward, self.base - length))
    }
}

/// Half a circle or less, counter-clockwise, and what is highest at its ends. That is one point where it is
/// a corner of both solids; else each of the two lines is the lower one at the other's end, so that they
/// cross. An arc may have no length: where a bound is taken at an end, one of the halves has none.
#[derive(Clone, Copy)]
pub(super) struct Arc<N: Real> {
    pub(super) ends: [Vector<N, 2>; 2],
    pub(super) lines: [RidgeLine<N>; 2],
}

impl<N: Real> Arc<N> {
    /// Whether a direction is on the arc, ends included. The two products alone are zero for the direction
    /// opposite to both ends of an arc without length.
    fn holds(&self, u: &Vector<N, 2>) -> bool {
        let [from, to] = &self.ends;
        let is_between = cross2(from, u) >= N::ZERO && cross2(u, to) >= N::ZERO;
        is_between && u.dot(&(from + to)) >= N::ZERO
    }

    /// Where both lines are equally high; `None` if that is nowhere on the arc, up to rounding.
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

    /// Where a line is lowest on the arc, and how low; of an end the direction halfway stands for it.
    fn least_of(&self, line: &RidgeLine<N>) -> (Vector<N, 2>, N) {
        let halfway = unit(&(self.ends[0] + self.ends[1]));
        let ends = min(line.at(&self.ends[0]), line.at(&self.ends[1]));
        match line.bottom() {
            Some(bottom) if self.holds(&bottom.0) => bottom,
            _ => (halfway.map_or(perp(&self.ends[0]), |(u, _)| u), ends),
        }
    }

    /// Whether it is certain that the depth is nowhere on the arc less than `least`, by [`are_above`].
    fn is_above(&self, least: N) -> bool {
        let [from, to] = &self.ends;
        let has_base = self.lines.iter().any(|line| line.base > N::ZERO);
        let heights = self.lines.mapped(|line| [line.at(from), line.at(to)]);
        !has_base && are_above(&heights, least)
    }

    /// A direction of the arc and a lower bound of the depth on all of it, but for its ends. The bound is the
    /// larger height of the two lines there, if there is one.
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

/// Whether the heights of two points, each at both ends of an arc, tell that the depth is nowhere on the arc less
/// than a positive `least`: by products alone, unlike [`Arc::bound`], and not where that is close. The first is the
/// highest at the first end, the second at the second; both heights there are no less.
///
/// A direction of the arc is a mix of the ends, over its length, which is at most 1. So if some mix of the points
/// is high enough in every mix of the ends, and is no higher than its height in the middle of the circle, it is
/// high enough on the arc. Whether there is one is the value of a game of two by two heights.
pub(super) fn are_above<N: Real>(heights: &[[N; 2]; 2], least: N) -> bool {
    let [first, second] = heights.mapped(|[from, to]| [from - least, to - least]);
    let is_one = first[1] >= N::ZERO || second[0] >= N::ZERO;
    least > N::ZERO && (is_one || first[0] * second[1] >= first[1] * second[0])
}

/// A search along arcs.
pub(super) struct ArcSearch<N: Real> {
    /// The least depth so far, of this or another search.
    pub(super) least: N,
    /// Where it is, if it was found here.
    pub(super) best: Option<Vector<N, 2>>,
    /// Less is not looked for.
    gap: N,
}

impl<N: Real> ArcSearch<N> {
    pub(super) fn new(least: N, gap: N) -> Self {
        Self { least, best: None, gap }
    }

    pub(super) fn note(&mut self, u: &Vector<N, 2>, highest: &RidgeLine<N>) {
        let depth = highest.at(u);
        if depth < self.least {
            (self.least, self.best) = (depth, Some(*u));
        }
    }

    /// Looks for less along an arc, at whose ends the depth is no less than the least so far; `highest` tells
    /// which line is the highest in a direction. `None` if it takes too many.
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
