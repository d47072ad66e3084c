//! The pairs of a chunk that may be within a limit, with their placed shapes. Convex pairs are
//! computed together in SIMD lanes.

use crate::collide::separation::distance_in_world;
use crate::tables::ByDimension;
use core::ops::Range;

use super::side::{PlacedSide, PreparedSide, pair_at};
use crate::collide::pair::canonical;
use crate::collide::separation::placed;
use crate::collide::{ConvexPair, Placed};
use crate::convex::Separation;
use crate::math::{Real, Space};

/// The pairs of a chunk that may be at most `limit` apart, with their placed shapes.
pub(super) struct PlacedPairs<'a, N: Real, const D: usize> {
    /// The slot of each pair in the output columns of the chunk.
    slots: Vec<usize>,
    /// For each side, the placed elements of the pairs, in the order of `slots`.
    sides: [PlacedSide<'a, N, D>; 2],
    limit: N,
}

/// The result of a pair of convex solids, or the shapes of a pair that the caller must compute.
pub(super) enum PairAnswer<'p, 'a, N: Real, const D: usize> {
    /// The separation of two convex solids, in the world frame and in the caller's order.
    Convex(&'p Separation<N, D>),
    /// The placed shapes of a pair that the caller must compute by a single query: a pair with a
    /// composite, or the only pair of a batch.
    Alone([&'p Placed<'a, N, D>; 2]),
}

impl<'a, N: Space<D>, const D: usize> PlacedPairs<'a, N, D> {
    /// Collects the pairs of a range of elements. If `limit` is infinite, all poses are read in
    /// bulk. Otherwise only translations are read first, and then the poses of the pairs that may
    /// be within the limit.
    pub(super) fn new(sides: &[PreparedSide<'a, N, D>; 2], range: Range<usize>, limit: N) -> Self {
        if limit == N::INFINITY {
            let slots = (0..range.len()).collect();
            let sides = [sides[0].placed(range.clone()), sides[1].placed(range)];
            return Self { slots, sides, limit };
        }
        let len = range.len();
        let mut slots = Vec::with_capacity(len);
        let mut near = [PlacedSide::with_capacity(len), PlacedSide::with_capacity(len)];
        for (slot, index) in range.enumerate() {
            let [one, other] = pair_at(sides, index);
            if let Some([placed1, placed2]) = Placed::within(&one, &other, limit) {
                slots.push(slot);
                near[0].push(&placed1);
                near[1].push(&placed2);
            }
        }
        Self { slots, sides: near, limit }
    }

    /// Returns the pairs of convex solids; the `slot` of each is its index in `self.slots`, not its
    /// slot in the chunk. Leaves out pairs whose relative pose is not finite. For each pair with a
    /// composite, calls `of_composites` with its slot in the chunk and its shapes.
    fn convex(
        &self,
        mut of_composites: impl FnMut(usize, [&Placed<'a, N, D>; 2]),
    ) -> Vec<ConvexPair<'a, N, D>> {
        let [side1, side2] = &self.sides;
        let mut convex = Vec::with_capacity(self.slots.len());
        for (index, &slot) in self.slots.iter().enumerate() {
            let (shape1, shape2) = (side1.shape(index), side2.shape(index));
            if shape1.as_composite().is_some() || shape2.as_composite().is_some() {
                of_composites(slot, [&side1.placed(index), &side2.placed(index)]);
                continue;
            }
            let (pose1, pose2) = (side1.pose(index), side2.pose(index));
            let (pair, swapped) = canonical(pose1, shape1, pose2, shape2);
            if pair.pose12.is_finite() {
                convex.push(ConvexPair { slot: index, swapped, pair });
            }
        }
        convex
    }

    /// Calls `put` with the chunk slot and the distance of each pair that is at most `limit` apart.
    /// The distance is zero or negative where the shapes touch or overlap.
    pub(super) fn distances(&self, mut put: impl FnMut(usize, N)) {
        let mut convex = self.convex(|slot, [placed1, placed2]| {
            if let Some(found) = distance_in_world(placed1, placed2, self.limit) {
                put(slot, found);
            }
        });
        let mut found = vec![None; self.slots.len()];
        <N::Algorithms>::distances(&mut convex, self.limit, &mut found);
        for (&slot, found) in self.slots.iter().zip(found) {
            if let Some(distance) = found {
                put(slot, distance);
            }
        }
    }

    /// Calls `put` with the chunk slot of each pair that may be at most `limit` apart. Passes the
    /// separation of two convex solids within the limit, or the shapes of a pair with a composite,
    /// whose distance may exceed the limit.
    pub(super) fn separations(&self, mut put: impl FnMut(usize, PairAnswer<'_, 'a, N, D>)) {
        let mut convex = self.convex(|slot, placed| put(slot, PairAnswer::Alone(placed)));
        let mut found = vec![None; self.slots.len()];
        <N::Algorithms>::separations(&mut convex, self.limit, &mut found);
        for ConvexPair { slot: index, swapped, .. } in convex {
            if let Some(found) = &found[index] {
                let first = self.sides[usize::from(swapped)].placed(index);
                put(self.slots[index], PairAnswer::Convex(&placed(found, &first, swapped)));
            }
        }
    }
}
