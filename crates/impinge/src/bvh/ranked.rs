//! Objects of a tree by lower bounds of the caller's, least first.
//!
//! Best first (Hjaltason and Samet, "Distance browsing in spatial databases", 1999). The bounds may be negative, which
//! ranks what overlaps, and they are dear: each is made when its turn comes, since most never have one. Until then the
//! distance of the boxes counts, and the gap along one direction, which is made for all children of a block at once.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::gaps::Gaps;
use super::near_first::Open;
use super::tree::small;
use super::{LANES, Tree};
use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Real, Vector, filled, max};

/// Entries made room for at the start: enough for most searches.
const EXPECTED: usize = 128;

/// What heights lose to rounding, in units of `f32` of the coordinates.
const ROUNDING: f32 = 16.0;

/// What is asked about the objects of a tree.
pub(crate) trait BoxRanking<N: Real, const D: usize> {
    /// A unit vector along which a gap is likely to part what is in a box from what is asked about, and how far that reaches
    /// along it, or more: a rank is not below the gap. `None` if no gap is known.
    fn toward(&self, aabb: &Aabb<N, D>) -> Option<(Vector<N, D>, N)>;

    /// A number that the rank of the object is not below.
    fn of_object(&self, id: u32) -> N;

    /// The largest rank that matters; never grows. `None` ends the search.
    fn limit(&self) -> Option<N>;

    /// A point near which one object may be all that is asked for: such a one is visited first, and may be again.
    fn guess_near(&self) -> Option<Point<N, D>> {
        None
    }

    /// Gets each object whose bound is within the limit.
    fn visit(&mut self, id: u32);
}

/// A block or an object by its bound. Of equal ones objects come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct RankedNode {
    /// In the order of the bounds.
    rank: i64,
    /// Zero of an object, one more than its layer of a block.
    height: u8,
    /// The number of the block, or the slot of the object.
    at: u32,
    /// The bound is not that of the question yet.
    is_rough: bool,
}

struct RankedSearch<'a, 'q, N: Real, const D: usize> {
    tree: &'a Tree<D>,
    gaps: Gaps<D>,
    queue: BinaryHeap<Reverse<RankedNode>>,
    question: &'q mut dyn BoxRanking<N, D>,
}

/// Visits the objects of a tree whose ranks may be within the limit of the question, those of least bound first.
/// Positive ranks are not below the distance of an object's box from one that is `around` what is asked about.
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
    /// Ends: each block is opened once, and each entry refined once.
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

    /// Visits an object that may be all that is asked for, if its box is within a distance of the gaps.
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

    fn visit(&mut self, slot: u32) {
        if let Some(id) = self.tree.id_in(slot) {
            self.question.visit(id);
        }
    }

    /// Puts an object into the queue by its own bound.
    fn refine(&mut self, entry: RankedNode, limit: N) {
        let Some(id) = self.tree.id_in(entry.at) else { return };
        let bound = self.question.of_object(id);
        let is_beyond = bound > limit;
        if !is_beyond {
            self.queue.push(Reverse(entry.refined(bound)));
        }
    }

    /// Puts what is in a block into the queue; or the block, if others come before it by its own bound.
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

    /// A block with a bound of its own, if that is within the limit and no other block or object comes before it; it goes
    /// back into the queue if one does.
    fn first(&mut self, entry: RankedNode, bound: N, limit: N) -> Option<RankedNode> {
        let (entry, is_beyond) = (entry.refined(bound), bound > limit);
        let is_first = self.queue.peek().is_none_or(|Reverse(other)| entry <= *other);
        if !is_beyond && !is_first {
            self.queue.push(Reverse(entry));
        }
        (!is_beyond && is_first).then_some(entry)
    }

    /// The gaps that a direction leaves to what is in a block, or less.
    fn gaps_along(&self, layer: usize, block: u32, along: &Vector<N, D>, reach: N) -> [N; LANES] {
        let along = filled(|axis| along[axis].as_f32());
        let reach = reach + N::lit(f64::from(self.tree.size() * f32::EPSILON * ROUNDING));
        let block = &self.tree.layers[layer].blocks[block as usize];
        block.lowest_along(&along).mapped(|lowest| {
            let is_known = lowest.is_finite();
            if is_known { N::lit(lowest.into()) - reach } else { -N::INFINITY }
        })
    }

    /// Puts what is in an open block into the queue, by distances and gaps.
    fn push_all(&mut self, above: &RankedNode, open: Open, gaps: &[N; LANES], limit: N) {
        let Open { keys, mut mask, first } = open;
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let (gap, distance) = (gaps[lane as usize], self.gaps.distance(keys[lane as usize]));
            // Boxes that overlap have the distance zero, however deep.
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
    /// With a bound of its own, which does not take it before what it lies in.
    fn refined<N: Real>(self, bound: N) -> Self {
        Self { rank: rank_of(bound).max(self.rank), is_rough: false, ..self }
    }
}

/// A number in the order of the values; the greatest for NaN.
fn rank_of<N: Real>(value: N) -> i64 {
    // Adding zero takes the sign off a zero. Bits below the sign are turned round in negative numbers.
    let bits = (value.as_f64() + 0.0).to_bits().cast_signed();
    if bits < 0 { bits ^ i64::MAX } else { bits }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Bounds, Lanes};
    use crate::math::noise::Noise;

    /// Ranks are the least of the first coordinates of a box, as far as they are near a place.
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
