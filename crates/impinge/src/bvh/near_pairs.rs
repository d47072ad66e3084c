//! Pairs of objects of two trees, each in a frame of its own, near ones first.
//!
//! Best first over pairs of blocks, one of each tree (Hjaltason and Samet, "Incremental distance join algorithms
//! for spatial databases", 1998): of the nearest pair the wider block is opened and its lanes are held against the
//! other block's box, seen from the frame of the lanes. So the axes of both frames part blocks in turn. Of two leaf
//! blocks each object of the narrower one that is near the other is held against the objects of that one.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use smallvec::SmallVec;

use super::gaps::Gaps;
use super::near_first::Open;
use super::{Bounds, LANES, Tree};
use crate::bounding_volume::Aabb;
use crate::math::{Real, max};

/// Entries made room for at the start: enough for most searches.
const EXPECTED: usize = 64;

/// How the trees lie to each other, and what is asked about pairs of their objects.
pub(crate) trait TreePair<N: Real, const D: usize> {
    /// A box in the frame of the first (0) or the second (1) tree as one in the frame of the other, around all that
    /// it holds.
    fn in_other(&self, which: usize, aabb: &Aabb<N, D>) -> Aabb<N, D>;

    /// A box around an object of the first (0) or the second (1) tree, in the frame of the other.
    fn object_in_other(&self, which: usize, id: u32) -> Aabb<N, D>;

    /// The largest distance at which boxes still matter, negative to end the search; never grows.
    fn bound(&self) -> N;

    /// Nothing in the boxes, of the first and of the second tree, is near enough to matter; false says nothing.
    fn are_beyond(&self, boxes: &[Aabb<N, D>; 2]) -> bool;

    /// Gets the pairs whose boxes are within the bound: an object of the first (0) or the second (1) tree and at most
    /// [`LANES`] of the other.
    fn visit(&mut self, which: usize, own: u32, others: &[u32]);
}

/// A block of each tree. Of pairs at one distance those in low layers come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct BlockPair {
    /// The bits of a distance that the boxes have at least: zero or more, so that they order as it does.
    distance: u64,
    layers: [u8; 2],
    blocks: [u32; 2],
}

struct PairSearch<'a, 'q, N: Real, const D: usize> {
    trees: [&'a Tree<D>; 2],
    queue: BinaryHeap<Reverse<BlockPair>>,
    question: &'q mut dyn TreePair<N, D>,
}

/// Lanes by their distances, as slots or numbers of blocks below.
type NearLanes<N> = SmallVec<[(N, u32); LANES]>;

/// Visits the pairs of objects of two trees that are within the bound of the question, near ones first but in no
/// exact order.
pub(crate) fn visit_pairs<N: Real, const D: usize>(
    trees: [&Tree<D>; 2],
    question: &mut dyn TreePair<N, D>,
) {
    if trees.iter().any(|tree| tree.is_empty()) {
        return;
    }
    debug_assert!(trees.iter().all(|tree| !tree.is_stale), "searches need refitted trees");
    let mut search = PairSearch { trees, queue: BinaryHeap::with_capacity(EXPECTED), question };
    let (distance, layers) = (N::ZERO.bits(), trees.map(Tree::top_layer));
    search.queue.push(Reverse(BlockPair { distance, layers, blocks: [0, 0] }));
    search.run();
}

impl<N: Real, const D: usize> PairSearch<'_, '_, N, D> {
    fn run(&mut self) {
        while let Some(Reverse(pair)) = self.queue.pop() {
            let bound = self.question.bound();
            // Also false for NaN, which ends the search.
            let is_within = bound >= N::ZERO && pair.distance <= (bound + N::ZERO).bits();
            if !is_within {
                return;
            }
            if self.question.are_beyond(&[0, 1].map(|which| self.bounds(which, &pair).as_aabb())) {
                continue;
            }
            match self.wider(&pair) {
                Some(which) => self.open(which, &pair),
                None => self.meet(&pair),
            }
        }
    }

    /// Which of the blocks is opened next: the wider one above the lowest layer; `None` for leaf blocks.
    fn wider(&self, pair: &BlockPair) -> Option<usize> {
        match pair.layers {
            [0, 0] => None,
            [_, 0] => Some(0),
            [0, _] => Some(1),
            _ => {
                let widths = [0, 1].map(|which| self.bounds(which, pair).half_surface());
                Some(usize::from(widths[1] > widths[0]))
            }
        }
    }

    fn bounds(&self, which: usize, pair: &BlockPair) -> Bounds<D> {
        let layer = &self.trees[which].layers[usize::from(pair.layers[which])];
        layer.bounds[pair.blocks[which] as usize]
    }

    /// Puts the blocks below one of two into the queue, each with the other.
    fn open(&mut self, which: usize, pair: &BlockPair) {
        let aabb = self.question.in_other(1 - which, &self.bounds(1 - which, pair).as_aabb());
        for (distance, block) in self.near(which, pair.layers[which], pair.blocks[which], &aabb) {
            let (mut layers, mut blocks) = (pair.layers, pair.blocks);
            (layers[which], blocks[which]) = (layers[which] - 1, block);
            let distance = distance.bits().max(pair.distance);
            self.queue.push(Reverse(BlockPair { distance, layers, blocks }));
        }
    }

    /// Visits the near pairs of objects of two leaf blocks: each object of the narrower block with those of the other.
    fn meet(&mut self, pair: &BlockPair) {
        let bounds = [0, 1].map(|which| self.bounds(which, pair));
        let which = usize::from(bounds[1].half_surface() < bounds[0].half_surface());
        let trees = [self.trees[which], self.trees[1 - which]];
        let [own, other] = [pair.blocks[which], pair.blocks[1 - which]];
        let aabb = self.question.in_other(1 - which, &bounds[1 - which].as_aabb());
        for (distance, slot) in self.near(which, 0, own, &aabb) {
            let Some(id) = trees[0].id_in(slot) else { continue };
            if distance > self.question.bound() {
                return;
            }
            let aabb = self.question.object_in_other(which, id);
            let near = self.near(1 - which, 0, other, &aabb);
            let others: SmallVec<[u32; LANES]> =
                near.iter().filter_map(|&(_, slot)| trees[1].id_in(slot)).collect();
            if !others.is_empty() {
                self.question.visit(which, id, &others);
            }
        }
    }

    /// The lanes of a block of one tree that are within the bound of a box in its frame, near ones first, of several
    /// at one distance the first. A distance is a little less than the exact one.
    fn near(&self, which: usize, layer: u8, block: u32, aabb: &Aabb<N, D>) -> NearLanes<N> {
        let (tree, layer) = (self.trees[which], usize::from(layer));
        let gaps = Gaps::new(aabb, tree.size());
        let Open { keys, mut mask, first } =
            tree.opened_around(&gaps, layer, block, gaps.limit(self.question.bound()));
        let mut near = NearLanes::new();
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let distance = max(gaps.distance(keys[lane as usize]), N::ZERO);
            near.push((distance, first + lane));
        }
        near.sort_unstable_by_key(|(distance, at)| (distance.bits(), *at));
        near
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounding_volume::BoundingVolume;
    use crate::bvh::Lanes;
    use crate::math::noise::Noise;
    use crate::math::{Point, Vector};

    /// The second tree lies farther along the first axis.
    struct Shifted<'a> {
        boxes: &'a [Vec<Aabb<f64, 3>>; 2],
        shift: f64,
        limit: f64,
        found: Vec<[u32; 2]>,
    }

    fn moved(aabb: &Aabb<f64, 3>, by: f64) -> Aabb<f64, 3> {
        let by = Vector::<f64, 3>::new(by, 0.0, 0.0);
        Aabb::new(aabb.mins() + by, aabb.maxs() + by).loosened(1e-9)
    }

    impl TreePair<f64, 3> for Shifted<'_> {
        fn in_other(&self, which: usize, aabb: &Aabb<f64, 3>) -> Aabb<f64, 3> {
            moved(aabb, if which == 0 { -self.shift } else { self.shift })
        }

        fn object_in_other(&self, which: usize, id: u32) -> Aabb<f64, 3> {
            self.in_other(which, &self.boxes[which][id as usize])
        }

        fn bound(&self) -> f64 {
            self.limit
        }

        fn are_beyond(&self, [one, other]: &[Aabb<f64, 3>; 2]) -> bool {
            one.mins().x - self.shift > other.maxs().x + self.limit + 1e-6
        }

        fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
            let pair = |other| if which == 0 { [own, other] } else { [other, own] };
            self.found.extend(others.iter().map(|&other| pair(other)));
        }
    }

    fn boxes(noise: &mut Noise, count: usize) -> Vec<Aabb<f64, 3>> {
        let each = |_| {
            let corner = Point::from(noise.vector::<f64>(20.0));
            Aabb::new(corner, corner + noise.vector::<f64>(1.0).abs())
        };
        (0..count).map(each).collect()
    }

    #[test]
    fn no_near_pair_is_missed() {
        let noise = &mut Noise(4);
        for (count1, count2) in [(0, 9), (1, 1), (5, 300), (700, 12), (400, 900)] {
            let all = [boxes(noise, count1), boxes(noise, count2)];
            let tree = |boxes: &[Aabb<f64, 3>]| {
                Tree::of_still(Lanes::detect(), (0..).zip(boxes.iter().map(Bounds::enclosing)))
            };
            let trees = [tree(&all[0]), tree(&all[1])];
            for (shift, limit) in [(0.0, 0.0), (7.0, 0.5), (45.0, 6.0), (0.0, -1.0)] {
                let mut pairs = Shifted { boxes: &all, shift, limit, found: Vec::new() };
                visit_pairs(trees.each_ref(), &mut pairs);
                let mut found = pairs.found;
                found.sort_unstable();
                assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "each once");
                let second =
                    |id1: u32| (0..).zip(&all[1]).map(move |(id2, other)| (id1, id2, other));
                let pairs =
                    (0..).zip(&all[0]).flat_map(|(id1, one)| second(id1).map(move |of| (one, of)));
                for (one, (id1, id2, other)) in pairs {
                    let distance = moved(one, -shift).distance_to_aabb(other);
                    let is_found = found.binary_search(&[id1, id2]).is_ok();
                    assert!(is_found || distance > limit, "{id1} and {id2}: {distance}");
                    assert!(!is_found || distance < limit + 0.01, "not that far: {distance}");
                }
            }
        }
    }
}
