//! Best-first search with lower bounds computed by the caller.
//!
//! Objects leave the queue by ascending bound (Hjaltason and Samet, "Distance browsing in spatial databases", 1999).
//! Bounds may be negative, which ranks overlaps. They are expensive, so each is computed when its entry comes up; most
//! never do. Until then the rank is the larger of the distance of the boxes and the gap along one direction, which is
//! computed for all children of a block at once.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::gaps::Gaps;
use super::near_first::Open;
use super::tree::small;
use super::{LANES, Tree};
use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Real, Vector, filled, max};

/// Initial capacity of the queue: enough for most searches.
const EXPECTED: usize = 128;

/// Error bound of heights, in `f32` rounding units of the coordinates.
const ROUNDING: f32 = 16.0;

/// A search, as the caller defines it.
pub(crate) trait BoxRanking<N: Real, const D: usize> {
    /// Returns a unit vector along which the contents of a box are probably separated from the query's solid, and an
    /// upper bound of that solid's extent along it. A rank is not below the gap. `None` if no such direction is known.
    fn toward(&self, aabb: &Aabb<N, D>) -> Option<(Vector<N, D>, N)>;

    /// Returns a lower bound of the rank of the object.
    fn of_object(&self, id: u32) -> N;

    /// Returns the largest rank that matters, which must not increase. `None` ends the search.
    fn limit(&self) -> Option<N>;

    /// Returns a point near which a single object may settle the search. That object is visited first, and may be
    /// visited again.
    fn guess_near(&self) -> Option<Point<N, D>> {
        None
    }

    /// Receives each object whose bound is within the limit.
    fn visit(&mut self, id: u32);
}

/// A block or an object with its bound. At equal bounds objects come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct RankedNode {
    /// The bound, as an integer in the same order.
    rank: i64,
    /// Zero for an object; for a block, its layer plus one.
    height: u8,
    /// Index of the block, or slot of the object.
    at: u32,
    /// The bound is a rough one: the caller has not computed its own yet.
    is_rough: bool,
}

/// A search under way.
struct RankedSearch<'a, 'q, N: Real, const D: usize> {
    tree: &'a Tree<D>,
    gaps: Gaps<D>,
    queue: BinaryHeap<Reverse<RankedNode>>,
    question: &'q mut dyn BoxRanking<N, D>,
}

/// Visits the objects of a tree whose ranks may be within the limit of the question, by ascending bound. `around` is a
/// box of the query's solid: a positive rank must not be below the distance of an object's box from it.
pub(crate) fn visit_ranked<N: Real, const D: usize>(
    tree: &Tree<D>,
    around: &Aabb<N, D>,
    question: &mut dyn BoxRanking<N, D>,
) {
    if tree.is_empty() || !around.holds_finite_point() {
        return;
    }
    debug_assert!(!tree.is_stale, "searches need refitted trees");
    let (gaps, queue) = (Gaps::new(around, tree.size()), BinaryHeap::with_capacity(EXPECTED));
    let mut search = RankedSearch { tree, gaps, queue, question };
    let height = tree.top_layer() + 1;
    search.queue.push(Reverse(RankedNode { rank: i64::MIN, height, at: 0, is_rough: false }));
    search.run();
}

impl<N: Real, const D: usize> RankedSearch<'_, '_, N, D> {
    /// Runs the search. It ends, since each block is opened once and each entry refined once.
    fn run(&mut self) {
        while let Some(Reverse(entry)) = self.queue.pop() {
            let Some(limit) = self.question.limit() else { return };
            if entry.rank > rank_of(limit) {
                return;
            }
            match (entry.height, entry.is_rough) {
                (0, true) => self.refine(entry, limit),
                (0, false) => self.visit(entry.at),
                _ => self.open(entry, limit),
            }
        }
    }

    /// Visits the object that may settle the search, if its box is within the distance `within`, in the units of the
    /// gaps.
    fn guess(&mut self, within: f32) {
        let likely = self
            .question
            .guess_near()
            .and_then(|point| self.tree.slot_near(&filled(|axis| point[axis].as_f32())));
        let Some(slot) = likely else { return };
        let (block, lane) = (slot / small(LANES), slot % small(LANES));
        let near = self.tree.opened_around(&self.gaps, 0, block, within);
        if near.mask & (1 << lane) != 0 {
            self.visit(slot);
        }
    }

    /// Passes the object in a slot to the question, if there is one.
    fn visit(&mut self, slot: u32) {
        if let Some(id) = self.tree.id_in(slot) {
            self.question.visit(id);
        }
    }

    /// Queues an object by the caller's bound.
    fn refine(&mut self, entry: RankedNode, limit: N) {
        let Some(id) = self.tree.id_in(entry.at) else { return };
        let bound = self.question.of_object(id);
        let is_beyond = bound > limit;
        if !is_beyond {
            self.queue.push(Reverse(entry.refined(bound)));
        }
    }

    /// Queues the children of a block, or the block again if other entries come before its refined bound.
    fn open(&mut self, mut entry: RankedNode, limit: N) {
        let (layer, block) = (usize::from(entry.height - 1), entry.at);
        let within = self.gaps.limit(max(limit, N::ZERO));
        let open = self.tree.opened_around(&self.gaps, layer, block, within);
        if open.mask == 0 {
            return;
        }
        if entry.height > self.tree.top_layer() {
            self.guess(within);
            if self.question.limit().is_none() {
                return;
            }
        }
        let (around, mut gaps) = (self.tree.slab_box(layer, block), [-N::INFINITY; LANES]);
        if let Some((along, reach)) = self.question.toward(&around.bounds.as_aabb()) {
            let Some(first) = self.first(entry, -around.reach(&-along) - reach, limit) else {
                return;
            };
            entry = first;
            gaps = self.gaps_along(layer, block, &along, reach);
        }
        self.push_all(&entry, open, &gaps, limit);
    }

    /// Refines the bound of a block. Returns the block if the bound is within the limit and no other entry comes before
    /// it; queues it again if one does.
    fn first(&mut self, entry: RankedNode, bound: N, limit: N) -> Option<RankedNode> {
        let (entry, is_beyond) = (entry.refined(bound), bound > limit);
        let is_first = self.queue.peek().is_none_or(|Reverse(other)| entry <= *other);
        if !is_beyond && !is_first {
            self.queue.push(Reverse(entry));
        }
        (!is_beyond && is_first).then_some(entry)
    }

    /// Returns lower bounds of the gaps along a direction between the query's solid and the children of a block.
    fn gaps_along(&self, layer: usize, block: u32, along: &Vector<N, D>, reach: N) -> [N; LANES] {
        let along = filled(|axis| along[axis].as_f32());
        let reach = reach + N::lit(f64::from(self.tree.size() * f32::EPSILON * ROUNDING));
        let block = &self.tree.layers[layer].blocks[block as usize];
        block.lowest_along(&along).mapped(|lowest| {
            let is_known = lowest.is_finite();
            if is_known { N::lit(lowest.into()) - reach } else { -N::INFINITY }
        })
    }

    /// Queues the children of an open block, by distances and gaps.
    fn push_all(&mut self, above: &RankedNode, open: Open, gaps: &[N; LANES], limit: N) {
        let Open { keys, mut mask, first } = open;
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let (gap, distance) = (gaps[lane as usize], self.gaps.distance(keys[lane as usize]));
            // Overlapping boxes have distance zero, whatever the depth.
            let bound = if distance > N::ZERO { max(gap, distance) } else { gap };
            let is_beyond = bound > limit;
            if !is_beyond {
                let below = RankedNode { height: above.height - 1, at: first + lane, ..*above };
                self.queue.push(Reverse(RankedNode { is_rough: true, ..below.refined(bound) }));
            }
        }
    }
}

impl RankedNode {
    /// Returns the entry with a refined bound, which is not less than its old one.
    fn refined<N: Real>(self, bound: N) -> Self {
        Self { rank: rank_of(bound).max(self.rank), is_rough: false, ..self }
    }
}

/// Returns an integer that orders as the values do; the greatest for a positive NaN.
fn rank_of<N: Real>(value: N) -> i64 {
    // Adding zero removes the sign of a negative zero. In negative numbers the bits below the sign are inverted.
    let bits = (value.as_f64() + 0.0).to_bits().cast_signed();
    if bits < 0 { bits ^ i64::MAX } else { bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Bounds, Lanes};
    use crate::math::noise::Noise;

    /// A ranking in which an object near `place` has the rank of its least x coordinate, any other its distance.
    struct ByFirst<'a> {
        boxes: &'a [Aabb<f64, 3>],
        place: Aabb<f64, 3>,
        limit: f64,
        most: usize,
        found: Vec<u32>,
    }

    impl BoxRanking<f64, 3> for ByFirst<'_> {
        fn toward(&self, _aabb: &Aabb<f64, 3>) -> Option<(Vector<f64, 3>, f64)> {
            Some((Vector::x(), 100.0))
        }

        fn of_object(&self, id: u32) -> f64 {
            let aabb = &self.boxes[id as usize];
            let apart = aabb.distance_to_aabb(&self.place);
            if apart > 0.0 { apart } else { aabb.mins().x - 100.0 }
        }

        fn limit(&self) -> Option<f64> {
            (self.found.len() < self.most).then_some(self.limit)
        }

        fn visit(&mut self, id: u32) {
            self.found.push(id);
        }
    }

    #[test]
    fn objects_come_by_rank_up_to_the_limit() {
        let noise = &mut Noise(9);
        for count in [0, 1, 16, 17, 700, 5000] {
            let each = |_| {
                let corner = Point::from(noise.vector::<f64>(20.0));
                Aabb::new(corner, corner + noise.vector::<f64>(1.0).abs())
            };
            let boxes: Vec<_> = (0..count).map(each).collect();
            let tree =
                Tree::of_still(Lanes::detect(), (0..).zip(boxes.iter().map(Bounds::enclosing)));
            let place = Aabb::new(Point::from([-1.0, -2.0, -3.0]), Point::from([5.0, 4.0, 3.0]));
            for (limit, most) in [(-90.0, 9999), (0.0, 9999), (5.0, 9999), (f64::INFINITY, 40)] {
                let mut question = ByFirst { boxes: &boxes, place, limit, most, found: Vec::new() };
                let rank = |question: &ByFirst<'_>, id: u32| question.of_object(id);
                let mut all: Vec<_> = (0..count).collect();
                all.retain(|&id| rank(&question, id) <= limit);
                all.sort_by(|&a, &b| rank(&question, a).total_cmp(&rank(&question, b)));
                all.truncate(most);
                visit_ranked(&tree, &place, &mut question);
                let ranks =
                    |ids: &[u32]| ids.iter().map(|&id| rank(&question, id)).collect::<Vec<_>>();
                assert_eq!(ranks(&question.found), ranks(&all), "{count} up to {limit}");
            }
        }
    }

    #[test]
    fn ranks_order_as_numbers_do() {
        let values =
            [-f64::INFINITY, -1e300, -1.0, -1e-320, 0.0, 1e-320, 1.0, 1e300, f64::INFINITY];
        assert!(values.windows(2).all(|pair| rank_of(pair[0]) < rank_of(pair[1])));
        assert_eq!(rank_of(-0.0), rank_of(0.0), "zeros are equal");
    }
}
