//! The nearest two parts of two shapes, or those that overlap deepest.

use super::between::Between;
use super::bounds::loosened;
use super::inside::with_inside;
use super::meeting::{MeetingVisitor, Meetings, each_meeting};
use super::separation::{PairVisitor, PartSeparation, visit_near_pairs};
use crate::collide::separation::separation as of_convex;
use crate::math::{Real, Space, Vector, max, min};

/// Which of the pairs of parts is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// The nearest, or where parts overlap the deepest; of several the first by numbers.
    Deepest,
    /// The nearest, or any that touches or overlaps: enough to know the distance.
    Touching,
}

/// The separation of the two parts that [`Wanted`] asks for; `None` if none are within the limit. Parts that are
/// likely to be these can be asked `first`: they bound the search. See [`visit_near_pairs`] for the cost.
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
    let is_settled =
        (wanted == Wanted::Touching && nearest.settles_touching()) || nearest.settles_apart();
    if !is_settled {
        visit_near_pairs(between, &mut nearest);
    }
    if between.has_bodies() {
        return with_inside(between, limit, wanted, nearest.best);
    }
    nearest.best
}

/// The best pair of parts so far.
struct NearestPart<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    limit: N,
    wanted: Wanted,
    best: Option<PartSeparation<N, D>>,
}

impl<N: Space<D>, const D: usize> NearestPart<'_, N, D> {
    /// Looks for parts of two composites that touch, for which it is enough to see that boxes overlap; answers whether
    /// nothing more is asked.
    fn settles_touching(&mut self) -> bool {
        let (between, reach) = (self.between, min(self.limit, N::ZERO));
        let mut touching = TouchingPart { nearest: self, reach };
        let is_searched = each_meeting(between, reach, Meetings::Any, &mut touching);
        is_searched && (self.limit <= N::ZERO || self.bound() < N::ZERO)
    }

    /// Looks for the nearest parts of two composites; answers whether these are apart, and so the ones that are wanted.
    fn settles_apart(&mut self) -> bool {
        let (between, reach) = (self.between, self.limit());
        reach > N::ZERO
            && each_meeting(between, reach, Meetings::Nearest, self)
            && self.limit() > N::ZERO
    }
}

/// Any parts that touch.
struct TouchingPart<'a, 'q, N: Real, const D: usize> {
    nearest: &'q mut NearestPart<'a, N, D>,
    reach: N,
}

impl<N: Space<D>, const D: usize> MeetingVisitor<N, D> for TouchingPart<'_, '_, N, D> {
    fn visit(&mut self, parts: [u32; 2]) -> Option<N> {
        PairVisitor::visit(self.nearest, parts);
        (self.nearest.bound() >= N::ZERO).then_some(self.reach)
    }
}

impl<N: Space<D>, const D: usize> MeetingVisitor<N, D> for NearestPart<'_, N, D> {
    fn visit(&mut self, parts: [u32; 2]) -> Option<N> {
        PairVisitor::visit(self, parts);
        Some(self.limit()).filter(|reach| *reach > N::ZERO)
    }

    fn normal(&self) -> Option<Vector<N, D>> {
        PairVisitor::normal(self)
    }
}

impl<N: Space<D>, const D: usize> PairVisitor<N, D> for NearestPart<'_, N, D> {
    fn limit(&self) -> N {
        self.best.map_or(self.limit, |best| best.separation.distance)
    }

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
