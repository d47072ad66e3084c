//! Finds the nearest two parts of two shapes, or the deepest pair if parts overlap.

use super::between::Between;
use super::bounds::loosened;
use super::inside::with_inside;
use super::separation::{PairVisitor, PartSeparation, visit_near_pairs};
use super::touching::{Touching, TouchingVisitor, each_touching};
use crate::collide::separation::separation as of_convex;
use crate::math::{Real, Space, Vector, max, min};

/// The pair of parts that a search looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// The nearest pair, or the deepest if parts overlap; in a tie, the pair with the lowest
    /// indices.
    Deepest,
    /// The nearest pair or, if parts touch or overlap, any pair that does. This suffices for the
    /// distance of shapes that are apart, and for the test whether shapes touch.
    Touching,
}

/// Returns the separation of the pair of parts that `wanted` selects; `None` if no pair is within
/// `limit`. `first` is an optional guess of this pair; its distance then bounds the search. See
/// [`visit_near_pairs`] for the cost.
pub(crate) fn nearest_between<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    limit: N,
    wanted: Wanted,
    first: Option<[u32; 2]>,
) -> Option<PartSeparation<N, D>> {
    let mut nearest = NearestPart { between, limit, wanted, best: None };
    if let Some(parts) = first {
        PairVisitor::visit(&mut nearest, parts);
    }
    let is_decided =
        (wanted == Wanted::Touching && nearest.finds_touching()) || nearest.finds_apart();
    if !is_decided {
        visit_near_pairs(between, &mut nearest);
    }
    if between.has_bodies() {
        return with_inside(between, limit, wanted, nearest.best);
    }
    nearest.best
}

/// State of a search for the pair of parts that `wanted` selects: the largest distance of interest,
/// and the best pair so far.
struct NearestPart<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    limit: N,
    wanted: Wanted,
    best: Option<PartSeparation<N, D>>,
}

impl<N: Space<D>, const D: usize> NearestPart<'_, N, D> {
    /// Searches two composites for one pair of parts that touch, by [`each_touching`]. Returns
    /// `true` if no further search is needed: a touching pair was found, or `limit` admits only
    /// touching pairs. Returns `false` without a search if [`each_touching`] does not support the
    /// shapes.
    fn finds_touching(&mut self) -> bool {
        let (between, max_distance) = (self.between, min(self.limit, N::ZERO));
        let mut touching = TouchingPart { nearest: self, max_distance };
        let is_searched = each_touching(between, max_distance, Touching::Any, &mut touching);
        is_searched && (self.limit <= N::ZERO || self.bound() < N::ZERO)
    }

    /// Searches two composites for their nearest parts, by [`each_touching`]. Returns `true` if no
    /// further search is needed: the nearest parts are apart, or no parts are within the limit.
    /// Returns `false` if parts touch or overlap, because only [`visit_near_pairs`] finds the
    /// deepest pair; also, without a search, if the limit is zero or less or [`each_touching`] does
    /// not support the shapes.
    fn finds_apart(&mut self) -> bool {
        let (between, max_distance) = (self.between, self.limit());
        max_distance > N::ZERO
            && each_touching(between, max_distance, Touching::Nearest, self)
            && self.limit() > N::ZERO
    }
}

/// Visitor of a search for any pair that touches; `max_distance` stays constant.
struct TouchingPart<'a, 'q, N: Real, const D: usize> {
    nearest: &'q mut NearestPart<'a, N, D>,
    max_distance: N,
}

impl<N: Space<D>, const D: usize> TouchingVisitor<N, D> for TouchingPart<'_, '_, N, D> {
    fn visit(&mut self, parts: [u32; 2]) -> Option<N> {
        PairVisitor::visit(self.nearest, parts);
        (self.nearest.bound() >= N::ZERO).then_some(self.max_distance)
    }
}

impl<N: Space<D>, const D: usize> TouchingVisitor<N, D> for NearestPart<'_, N, D> {
    /// Visits a pair. Once a pair touches, returns `None`, which ends the search: only
    /// [`visit_near_pairs`] finds the deepest of several overlapping pairs.
    fn visit(&mut self, parts: [u32; 2]) -> Option<N> {
        PairVisitor::visit(self, parts);
        Some(self.limit()).filter(|max_distance| *max_distance > N::ZERO)
    }

    fn normal(&self) -> Option<Vector<N, D>> {
        PairVisitor::normal(self)
    }
}

impl<N: Space<D>, const D: usize> PairVisitor<N, D> for NearestPart<'_, N, D> {
    fn limit(&self) -> N {
        self.best.map_or(self.limit, |best| best.separation.distance)
    }

    /// Returns a negative bound, which ends the search, once a touching pair is known and
    /// [`Wanted::Touching`] is requested.
    fn bound(&self) -> N {
        let limit = self.limit();
        let is_known = self.best.is_some() && limit <= N::ZERO && self.wanted == Wanted::Touching;
        if is_known { -N::ONE } else { loosened(max(limit, N::ZERO)) }
    }

    fn normal(&self) -> Option<Vector<N, D>> {
        self.best.map(|best| best.separation.normal)
    }

    fn ends_at_touch(&self) -> bool {
        self.wanted == Wanted::Touching
    }

    /// Computes the separation of two parts, unless they already are the best pair.
    fn visit(&mut self, parts: [u32; 2]) {
        if self.best.is_some_and(|best| best.parts == parts) {
            return;
        }
        let placed = self.between.parts(parts);
        let Some(found) = of_convex(&placed.pair(), self.limit()) else { return };
        let found = PartSeparation { separation: placed.in_first(&found), local: found, parts };
        if self.best.is_none_or(|best| found.is_before(&best)) {
            self.best = Some(found);
        }
    }
}
