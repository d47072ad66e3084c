//! Best-first search with lower bounds computed by the caller.
//!
//! Objects leave the queue by ascending bound (Hjaltason and Samet, "Distance browsing in spatial
//! databases", 1999). Bounds may be negative, which ranks overlaps by depth. A bound is expensive,
//! so it is computed only when its entry reaches the front of the queue; most entries never do.
//! Until then the rank is the larger of two rough bounds: the distance of the boxes and the gap
//! along the direction of [`BoxRanking::toward`]. Both are computed for all children of a block at
//! once.

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

/// Error bound of a dot product of a direction and a corner, in `f32` rounding units of the largest
/// coordinate.
const ROUNDING: f32 = 16.0;

/// The caller's part of a search. Each object has a rank: its distance from the query's solid, or a
/// negative number for an overlap.
pub(crate) trait BoxRanking<N: Real, const D: usize> {
    /// Returns a unit vector along which the contents of `aabb` are probably separated from the
    /// query's solid, and an upper bound of that solid's extent along the vector. The gap along the
    /// vector must be a lower bound of the ranks in the box. `None` if no such direction is known.
    fn toward(&self, aabb: &Aabb<N, D>) -> Option<(Vector<N, D>, N)>;

    /// Returns a lower bound of the rank of the object.
    fn of_object(&self, id: u32) -> N;

    /// Returns the largest rank of interest, which must not increase during the search. `None` ends
    /// the search.
    fn limit(&self) -> Option<N>;

    /// Returns a point whose nearest object may end the search early. The search first visits an
    /// object near the point, if the object's box is within the limit; it may visit the object
    /// again. `None` if no such point is known.
    fn guess_near(&self) -> Option<Point<N, D>> {
        None
    }

    /// Receives each object whose bound is within the limit.
    fn visit(&mut self, id: u32);
}

/// A block or an object in the queue, with a lower bound of its rank. At equal bounds objects come
/// first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct RankedNode {
    /// The bound as an integer; see [`rank_of`].
    rank: i64,
    /// Zero for an object; for a block, its layer plus one.
    height: u8,
    /// Index of the block, or slot of the object.
    at: u32,
    /// Whether the bound is rough: the caller's own bound has not been computed yet.
    is_rough: bool,
}

/// The state of a search.
struct RankedSearch<'a, 'q, N: Real, const D: usize> {
    tree: &'a Tree<D>,
    gaps: Gaps<D>,
    queue: BinaryHeap<Reverse<RankedNode>>,
    question: &'q mut dyn BoxRanking<N, D>,
}

/// Visits the objects of a tree whose ranks may be within the limit of `question`, by ascending
/// bound. `around` is a box around the query's solid: a positive rank must not be below the
/// distance between an object's box and `around`. Visits nothing if `around` has no finite point.
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
    /// Runs the search. It ends, since each block and each object is queued at most twice: with a
    /// rough bound and with a refined bound.
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

    /// Visits the object near [`BoxRanking::guess_near`] if the square of its box's distance, in
    /// squared units of the gaps, is at most `within`.
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

    /// Passes the object in a slot to the question; does nothing for a free slot.
    fn visit(&mut self, slot: u32) {
        if let Some(id) = self.tree.id_in(slot) {
            self.question.visit(id);
        }
    }

    /// Queues an object again, now with the caller's bound, unless that exceeds `limit`.
    fn refine(&mut self, entry: RankedNode, limit: N) {
        let Some(id) = self.tree.id_in(entry.at) else { return };
        let bound = self.question.of_object(id);
        let is_beyond = bound > limit;
        if !is_beyond {
            self.queue.push(Reverse(entry.refined(bound)));
        }
    }

    /// Opens a block: queues its children. If other entries come before the block's refined bound,
    /// queues the block again instead.
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
        if let Some((along, extent)) = self.question.toward(&around.bounds.as_aabb()) {
            let Some(first) = self.first(entry, -around.extent(&-along) - extent, limit) else {
                return;
            };
            entry = first;
            gaps = self.gaps_along(layer, block, &along, extent);
        }
        self.push_all(&entry, open, &gaps, limit);
    }

    /// Raises the bound of an entry to `bound` and returns the entry if none in the queue is before
    /// it. `None` if the bound exceeds `limit`, or if an entry in the queue is before it; in the
    /// second case the entry is queued again.
    fn first(&mut self, entry: RankedNode, bound: N, limit: N) -> Option<RankedNode> {
        let (entry, is_beyond) = (entry.refined(bound), bound > limit);
        let is_first = self.queue.peek().is_none_or(|Reverse(other)| entry <= *other);
        if !is_beyond && !is_first {
            self.queue.push(Reverse(entry));
        }
        (!is_beyond && is_first).then_some(entry)
    }

    /// Returns, by lane, a lower bound of the gap along `along` between the query's solid and the
    /// child. `extent` is an upper bound of the solid's extent.
    fn gaps_along(&self, layer: usize, block: u32, along: &Vector<N, D>, extent: N) -> [N; LANES] {
        let along = filled(|axis| along[axis].as_f32());
        let extent = extent + N::lit(f64::from(self.tree.size() * f32::EPSILON * ROUNDING));
        let block = &self.tree.layers[layer].blocks[block as usize];
        block.lowest_along(&along).mapped(|lowest| {
            let is_known = lowest.is_finite();
            if is_known { N::lit(lowest.into()) - extent } else { -N::INFINITY }
        })
    }

    /// Queues those children of an open block whose rough bound, from distance and gap, is at most
    /// `limit`.
    fn push_all(&mut self, above: &RankedNode, open: Open, gaps: &[N; LANES], limit: N) {
        let Open { keys, mut mask, first } = open;
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let (gap, distance) = (gaps[lane as usize], self.gaps.distance(keys[lane as usize]));
            // Overlapping boxes have distance zero at any depth, so for these only the gap bounds
            // the rank.
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
    /// Returns the entry with the larger of `bound` and its previous bound, marked as not rough.
    fn refined<N: Real>(self, bound: N) -> Self {
        Self { rank: rank_of(bound).max(self.rank), is_rough: false, ..self }
    }
}

/// Returns an integer with the order of the values; the greatest for a positive NaN.
fn rank_of<N: Real>(value: N) -> i64 {
    // Adding zero removes the sign of a negative zero. The bits of negative numbers are in
    // descending order, so all but the sign are inverted.
    let bits = (value.as_f64() + 0.0).to_bits().cast_signed();
    if bits < 0 { bits ^ i64::MAX } else { bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Bounds, Lanes};
    use crate::math::xorshift::Xorshift;

    /// A ranking in which the rank of an object whose box overlaps `target` is the box's least x
    /// coordinate minus 100; the rank of any other object is its distance from `target`.
    struct ByFirst<'a> {
        boxes: &'a [Aabb<f64, 3>],
        target: Aabb<f64, 3>,
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
            let apart = aabb.distance_to_aabb(&self.target);
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
        let random = &mut Xorshift(9);
        for count in [0, 1, 16, 17, 700, 5000] {
            let each = |_| {
                let corner = Point::from(random.vector::<f64>(20.0));
                Aabb::new(corner, corner + random.vector::<f64>(1.0).abs())
            };
            let boxes: Vec<_> = (0..count).map(each).collect();
            let tree =
                Tree::of_still(Lanes::detect(), (0..).zip(boxes.iter().map(Bounds::enclosing)));
            let target = Aabb::new(Point::from([-1.0, -2.0, -3.0]), Point::from([5.0, 4.0, 3.0]));
            for (limit, most) in [(-90.0, 9999), (0.0, 9999), (5.0, 9999), (f64::INFINITY, 40)] {
                let mut question =
                    ByFirst { boxes: &boxes, target, limit, most, found: Vec::new() };
                let rank = |question: &ByFirst<'_>, id: u32| question.of_object(id);
                let mut all: Vec<_> = (0..count).collect();
                all.retain(|&id| rank(&question, id) <= limit);
                all.sort_by(|&a, &b| rank(&question, a).total_cmp(&rank(&question, b)));
                all.truncate(most);
                visit_ranked(&tree, &target, &mut question);
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
