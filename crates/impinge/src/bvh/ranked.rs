//! Objects of a tree by lower bounds of the caller's, least first.
//!
//! Best first (Hjaltason and Samet, "Distance browsing in spatial databases", 1999). The bounds may be negative, which
//! ranks what overlaps, and they are dear: those of what is apart from a box around all that is asked about are made when
//! its turn comes, since most of it never has one.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::Tree;
use super::gaps::Gaps;
use super::near_first::Open;
use crate::bounding_volume::Aabb;
use crate::math::{Real, max};

/// Entries made room for at the start: enough for most searches.
const EXPECTED: usize = 128;

/// What is asked about the objects of a tree.
pub(crate) trait BoxRanking<N: Real, const D: usize> {
    /// A number that the rank of nothing in the box is below.
    fn of_box(&self, aabb: &Aabb<N, D>) -> N;

    /// A number that the rank of the object is not below, and not less than that of its box.
    fn of_object(&self, id: u32) -> N;

    /// The largest rank that matters; never grows. `None` ends the search.
    fn limit(&self) -> Option<N>;

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
    /// The bound is no more than the distance from the box.
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
            match (entry.is_rough, entry.height) {
                (true, _) => self.refine(entry, limit),
                (false, 0) => self.visit(entry.at),
                _ => self.open(entry, limit),
            }
        }
    }

    fn visit(&mut self, slot: u32) {
        if let Some(id) = self.tree.id_in(slot) {
            self.question.visit(id);
        }
    }

    /// Puts what has a bound within the limit back into the queue by that.
    fn refine(&mut self, entry: RankedNode, limit: N) {
        let RankedNode { height, at, rank, .. } = entry;
        let bound = match height.checked_sub(1) {
            Some(layer) => {
                let bounds = self.tree.layers[usize::from(layer)].bounds[at as usize];
                self.question.of_box(&bounds.as_aabb())
            }
            None => match self.tree.id_in(at) {
                Some(id) => self.question.of_object(id),
                None => return,
            },
        };
        let is_beyond = bound > limit;
        if !is_beyond {
            let rank = rank_of(bound).max(rank);
            self.queue.push(Reverse(RankedNode { rank, is_rough: false, ..entry }));
        }
    }

    /// Puts what is in a block into the queue.
    fn open(&mut self, RankedNode { rank, height, at, .. }: RankedNode, limit: N) {
        let layer = usize::from(height - 1);
        let within = self.gaps.limit(max(limit, N::ZERO));
        let Open { keys, mut mask, first } = self.tree.opened_around(&self.gaps, layer, at, within);
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let distance: N = self.gaps.distance(keys[lane as usize]);
            let entry = RankedNode { rank, height: height - 1, at: first + lane, is_rough: true };
            if distance > N::ZERO {
                self.queue.push(Reverse(RankedNode { rank: rank_of(distance).max(rank), ..entry }));
            } else {
                self.refine(entry, limit);
            }
        }
    }
}

/// A number in the order of the values; the greatest for NaN.
fn rank_of<N: Real>(value: N) -> i64 {
    // Adding zero takes the sign off a zero. Bits below the sign are turned round in negative numbers.
    let bits = (value.as_f64() + 0.0).to_bits().cast_signed();
    if bits < 0 { bits ^ i64::MAX } else { bits }
}

#[cfg(all(test, feature = "f64"))]
mod tests {
    use super::*;
    use crate::bvh::{Bounds, Lanes};
    use crate::math::Point;
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
        fn of_box(&self, aabb: &Aabb<f64, 3>) -> f64 {
            let apart = aabb.distance_to_aabb(&self.place);
            if apart > 0.0 { apart } else { aabb.mins().x - 100.0 }
        }

        fn of_object(&self, id: u32) -> f64 {
            self.of_box(&self.boxes[id as usize])
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
