//! When a moving composite first touches another shape: when the first of its parts does.

use core::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

use super::mover::Mover;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::parts::between::{Between, PartPair, by_number};
use crate::collide::parts::bounds::loosened;
use crate::collide::parts::{Wanted, nearest_between};
use crate::convex::Separation;
use crate::math::{Real, Space, Vector};
use crate::query::impact::{Arrival, Path, advance_from};
use crate::shape::{CompositeShape, FeatureId};

/// The arrival of one part at another, in the frame of the first part, and which parts they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartArrival<N: Real, const D: usize> {
    pub(crate) arrival: Arrival<N, D>,
    pub(crate) parts: [u32; 2],
}

/// The first arrival of two parts; of several at one time that of the first parts by number. A contact
/// at the start counts, or does not, for each pair of parts by itself.
///
/// Cost: each part of the first shape, or of the second if that has fewer, searches the other on its
/// way; ways end at the first arrival found so far.
pub(crate) fn first_arrival<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    path: &Path<N, D>,
) -> Option<PartArrival<N, D>> {
    let mut search = PartImpactSearch { between, path, first: None };
    match between.composites() {
        [None, None] => search.hold([0, 0], N::ZERO),
        [Some(parts1), None] => search.each_on_way(1, 0, parts1),
        [None, Some(parts2)] if between.is_half_space_first() => search.of_half_space(parts2),
        [None, Some(parts2)] => search.each_on_way(0, 0, parts2),
        [Some(parts1), Some(parts2)] => search.of_many(parts1, parts2),
    }
    search.first
}

/// Two parts that are not at each other before a time, zero or more.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LaterPair<N> {
    earliest: N,
    parts: [u32; 2],
}

struct PartImpactSearch<'a, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    path: &'a Path<N, D>,
    first: Option<PartArrival<N, D>>,
}

impl<N: Space<D>, const D: usize> PartImpactSearch<'_, N, D> {
    fn of_many(&mut self, parts1: &dyn CompositeShape<N, D>, parts2: &dyn CompositeShape<N, D>) {
        let (which, fewer, more) = by_number(parts1, parts2);
        let aabb = self.grown(&self.between.whole_in_other(1 - which));
        let (velocity, end) = (self.velocity(1 - which), self.end());
        fewer.search().cast(&aabb, &velocity, end, &mut |part, _| {
            self.each_on_way(which, part, more);
            self.end()
        });
    }

    /// A half-space comes nearer to all parts alike, so that the nearest is the first: unless there are some that
    /// it touches from the start, of which each counts for itself.
    fn of_half_space(&mut self, others: &dyn CompositeShape<N, D>) {
        let nearest = nearest_between(self.between, N::INFINITY, Wanted::Deepest, None);
        let Some(nearest) = nearest else { return };
        self.hold(nearest.parts, N::ZERO);
        if self.first.is_some_and(|first| first.arrival.along <= N::ZERO) {
            self.each_on_way(0, 0, others);
        }
    }

    /// One part of one shape and those of the other that its box meets: those that it can be at earlier first, as
    /// far as the boxes' times tell that there are no others.
    fn each_on_way(&mut self, which: usize, part: u32, others: &dyn CompositeShape<N, D>) {
        let aabb = self.grown(&self.between.aabb_in_other(which, part));
        let (velocity, end) = (self.velocity(which), self.end());
        let mover = if which == 0 {
            Mover::of_first(self.between, velocity, self.path.target)
        } else {
            None
        };
        let mut waiting = BinaryHeap::new();
        let by_number = |other| if which == 0 { [part, other] } else { [other, part] };
        others.search().cast(&aabb, &velocity, end, &mut |other, time| {
            let earliest =
                mover.as_ref().map(|mover| mover.earliest(&others.part(other), self.end()));
            if let Some(earliest) = earliest.unwrap_or(Some(N::ZERO)) {
                waiting.push(Reverse(LaterPair { earliest, parts: by_number(other) }));
            }
            self.hold_until(time, &mut waiting);
            self.end()
        });
        self.hold_until(N::INFINITY, &mut waiting);
    }

    /// Holds what waits and can meet by a time.
    fn hold_until(&mut self, time: N, waiting: &mut BinaryHeap<Reverse<LaterPair<N>>>) {
        while let Some(Reverse(next)) = waiting.peek().copied()
            && next.earliest <= time
        {
            waiting.pop();
            if next.earliest <= self.end() {
                self.hold(next.parts, next.earliest);
            }
        }
    }

    /// The convex algorithm for two parts, which are not at each other before a time. Parts of indistinguishable
    /// shapes are so themselves if their numbers agree.
    fn hold(&mut self, parts: [u32; 2], earliest: N) {
        let placed = self.between.parts(parts);
        let path = Path {
            end: self.first.map_or(self.path.end, |first| first.arrival.along),
            mirrored: self.path.mirrored && parts[0] == parts[1],
            ..seen_by(&placed, self.path)
        };
        let Some(arrival) = advance_from(&placed.pair(), &path, earliest) else { return };
        let found = PartArrival { arrival, parts };
        if self.first.is_none_or(|first| found.is_before(&first)) {
            self.first = Some(found);
        }
    }

    /// How a shape moves in the frame of the other.
    fn velocity(&self, which: usize) -> Vector<N, D> {
        let velocity = &self.path.velocity;
        if which == 1 { *velocity } else { -self.between.pose21.vector(velocity) }
    }

    /// A box that meets another when the solids in them are as near as they shall come.
    fn grown(&self, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        let grown = aabb.loosened(self.path.target);
        Aabb::try_new(*grown.mins(), *grown.maxs()).unwrap_or_else(|_| Aabb::unbounded())
    }

    fn end(&self) -> N {
        let end = self.first.map_or(self.path.end, |first| first.arrival.along);
        if end >= N::ZERO { loosened(end) } else { -N::ONE }
    }
}

/// A path in the frame of the first shape, in that of its part.
fn seen_by<N: Real, const D: usize>(placed: &PartPair<'_, N, D>, path: &Path<N, D>) -> Path<N, D> {
    Path { velocity: placed.to_first_part(&path.velocity), ..*path }
}

impl<N: Space<D>, const D: usize> PartArrival<N, D> {
    /// How the parts lie when they touch, in the frame of the first shape, and what touches.
    pub(crate) fn seen_from(
        &self,
        between: &Between<'_, N, D>,
        path: &Path<N, D>,
    ) -> (Separation<N, D>, [FeatureId; 2]) {
        let placed = between.parts(self.parts);
        let features = self.arrival.features(&placed.pair(), &seen_by(&placed, path));
        (placed.in_first(&self.arrival.separation), features)
    }
}

impl<N: Real, const D: usize> PartArrival<N, D> {
    /// Earlier, or at the same time and earlier by number.
    fn is_before(&self, other: &Self) -> bool {
        let (along, others) = (self.arrival.along, other.arrival.along);
        along < others || (along == others && self.parts < other.parts)
    }
}

impl<N: Real> Ord for LaterPair<N> {
    fn cmp(&self, other: &Self) -> Ordering {
        let key = |of: &Self| ((of.earliest + N::ZERO).bits(), of.parts);
        key(self).cmp(&key(other))
    }
}

impl<N: Real> PartialOrd for LaterPair<N> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<N: Real> Eq for LaterPair<N> {}
