//! Searches for pairs of objects of two trees, each tree in its own frame, nearer pairs first.
//!
//! The search is best first over pairs of blocks, one of each tree (Hjaltason and Samet,
//! "Incremental distance join algorithms for spatial databases", 1998). It begins with a descent
//! straight to one object of each tree; their distance is a first limit, which rejects other pairs.
//! The lanes of both blocks are compared with each other, or only the lanes of the wider block if
//! it is much wider. A box of one tree is transformed into the frame of the other, so that the axes
//! of both frames separate blocks. Other directions separate further blocks: along these, the
//! extent of a block is bounded by its box and its slab.
//!
//! ```text
//!  queue: pairs (block1, block2) by distance
//!    pop ──> beyond the limit along a direction?  drop
//!        ──> another pair is nearer now?          push again
//!        ──> two leaf blocks?                     visit near objects
//!        ──> else                                 push near pairs of children
//! ```

use crate::math::order::sort_few;
use core::cmp::Reverse;
use std::collections::BinaryHeap;

use smallvec::SmallVec;

use crate::bounding_volume::Aabb;
use crate::bvh::block_slabs::{SlabBox, in_use};
use crate::bvh::gaps::Gaps;
use crate::bvh::near_first::Open;
use crate::bvh::tree::small;
use crate::bvh::{Bounds, LANES, NONE, Tree};
use crate::math::{Mapped, Point, Real, Vector, filled, max, unit};

/// Initial capacity of the queue: enough for most searches.
const EXPECTED: usize = 64;
/// If the surface of one block is more than this many times the surface of the other block, only
/// the larger block is opened. The factor is about the ratio of the surfaces of blocks in
/// successive layers.
const MUCH_WIDER: f64 = 8.0;

/// The direction from each tree toward the other tree: a unit vector in the frame of the first
/// tree, and one in the frame of the second. Rotated into one frame, the two vectors are opposite.
pub(crate) type Toward<N, const D: usize> = [Vector<N, D>; 2];

/// The relative pose of two trees, and the receiver of pairs of their objects.
pub(crate) trait TreePair<N: Real, const D: usize> {
    /// Transforms a box from the frame of the first (0) or the second (1) tree into the frame of
    /// the other tree; the result encloses the transformed box.
    fn in_other(&self, which: usize, aabb: &Aabb<N, D>) -> Aabb<N, D>;

    /// Returns a box around an object of the first (0) or the second (1) tree, in the frame of the
    /// other tree.
    fn object_in_other(&self, which: usize, id: u32) -> Aabb<N, D>;

    /// Returns the largest distance between boxes of pairs to visit; a negative distance ends the
    /// search. The distance must never grow.
    fn bound(&self) -> N;

    /// Returns the largest signed distance between objects of pairs to visit. It must never grow.
    fn limit(&self) -> N;

    /// Returns a lower bound, zero or more, of the overlap along each axis that the boxes of two
    /// objects have if the objects are within [`Self::limit`]. Boxes that overlap less are skipped.
    fn depth(&self) -> N;

    /// Returns the direction along which the nearest two objects compared so far are separated;
    /// `None` before two objects have been compared.
    fn best(&self) -> Option<Toward<N, D>>;

    /// Takes a unit vector that points from the first (0) or the second (1) tree toward the other
    /// tree, in the frame of the tree that it points from. Returns this vector, and the opposite
    /// vector in the frame of the other tree. `None` if gaps along a direction are not valid
    /// bounds, because the objects move.
    fn toward(&self, which: usize, along: &Vector<N, D>) -> Option<Toward<N, D>>;

    /// Returns the direction from a point of the first tree to a point of the second, each in its
    /// tree's frame; `None` if the points coincide, or if [`Self::toward`] returns `None`.
    fn between(&self, points: [Point<N, D>; 2]) -> Option<Toward<N, D>>;

    /// Returns an upper bound of the extent of an object of the first (0) or the second (1) tree
    /// along a unit vector in the frame of its tree.
    fn extent(&self, which: usize, id: u32, along: &Vector<N, D>) -> N;

    /// Returns a lower bound of the signed distance of two objects that have these extents along
    /// `toward`.
    fn gap(&self, toward: &Toward<N, D>, extents: [N; 2]) -> N;

    /// Receives one object of each tree before the search; the two are probably near each other.
    /// The object is [`NONE`] for a tree in which the descent failed. The search may visit the two
    /// again.
    fn guess(&mut self, objects: [u32; 2]);

    /// Receives pairs whose boxes are within the bound: object `own` of the first (0) or the second
    /// (1) tree with at most [`LANES`] objects of the other tree.
    fn visit(&mut self, which: usize, own: u32, others: &[u32]);
}

/// A pair of blocks, one of each tree. At equal distances, pairs whose first blocks are in lower
/// layers come first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct BlockPair {
    /// Bits of a lower bound of the distance of two objects, one in each block. It is zero or more,
    /// so the bits have the order of the values.
    distance: u64,
    layers: [u8; 2],
    blocks: [u32; 2],
    /// Whether the boxes of the two blocks are disjoint.
    are_apart: bool,
    /// Whether `distance` is only the distance of the boxes or of the parent pair.
    /// [`PairSearch::gap`] may then raise it.
    is_rough: bool,
}

/// A best-first search of two trees.
struct PairSearch<'a, 'q, N: Real, const D: usize> {
    trees: [&'a Tree<D>; 2],
    queue: BinaryHeap<Reverse<BlockPair>>,
    question: &'q mut dyn TreePair<N, D>,
}

/// The near lanes of a block, each as the distance of its box and the index of its child block (its
/// slot, in a leaf block).
type NearLanes<N> = SmallVec<[(N, u32); LANES]>;

/// Visits the pairs of objects of two trees that may be within the bound and limit of `question`,
/// nearer pairs roughly first.
pub(crate) fn visit_pairs<N: Real, const D: usize>(
    trees: [&Tree<D>; 2],
    question: &mut dyn TreePair<N, D>,
) {
    if trees.iter().any(|tree| tree.is_empty()) {
        return;
    }
    debug_assert!(trees.iter().all(|tree| !tree.is_stale), "searches need refitted trees");
    let queue = BinaryHeap::with_capacity(EXPECTED);
    let (distance, layers) = (N::ZERO.bits(), trees.mapped(Tree::top_layer));
    let whole = BlockPair { distance, layers, blocks: [0, 0], are_apart: false, is_rough: true };
    PairSearch { trees, queue, question }.run(whole);
}

impl<N: Real, const D: usize> PairSearch<'_, '_, N, D> {
    /// Searches all pairs of objects, beginning with `whole`, the pair of the top blocks. If
    /// [`TreePair::limit`] is positive and [`Self::near`] finds children of the first top block,
    /// first passes two objects that are probably near each other to [`TreePair::guess`], one of
    /// each tree. Then opens pairs of blocks in the order of their lower bounds. The search ends
    /// when the least lower bound exceeds [`TreePair::bound`], or this bound is negative.
    fn run(&mut self, whole: BlockPair) {
        self.queue.push(Reverse(whole));
        let near = || self.near(0, whole.layers[0], 0, &self.other_box(0, &whole));
        if self.question.limit() > N::ZERO && !near().is_empty() {
            let likely = self.descend(whole);
            self.question.guess(likely);
        }
        while let Some(Reverse(pair)) = self.queue.pop() {
            let bound = self.question.bound();
            // False for NaN, which ends the search.
            let is_within = bound >= N::ZERO && pair.distance <= (bound + N::ZERO).bits();
            if !is_within {
                return;
            }
            if let Some(pair) = self.first(pair) {
                self.open(&pair);
            }
        }
    }

    /// Returns one object of each tree; the two are probably near each other. Descends twice in
    /// each tree, in turn, beginning with the first. Each descent goes toward the centre of the
    /// leaf block that was last reached in the other tree, or of the whole other tree if none was
    /// reached yet. The objects are those of the last successful descents; [`NONE`] for a tree in
    /// which both descents fail.
    fn descend(&self, whole: BlockPair) -> [u32; 2] {
        let (mut pair, mut found) = (whole, [NONE; 2]);
        for which in [0, 1, 0, 1] {
            let (tree, middle) = (self.trees[which], self.other_box(which, &pair).center());
            if let Some(slot) = tree.slot_near(&filled(|axis| middle[axis].as_f32())) {
                (pair.layers[which], pair.blocks[which]) = (0, slot / small(LANES));
                found[which] = tree.ids[slot as usize];
            }
        }
        found
    }

    /// Raises the lower bound of a pair, and returns the pair if it is still first. `None` if the
    /// pair is beyond the limit, or if another pair is now first; in the latter case the pair is
    /// queued again.
    fn first(&mut self, mut pair: BlockPair) -> Option<BlockPair> {
        let gap = if pair.is_rough { self.gap(&pair) } else { self.best_gap(&pair) };
        let is_beyond = gap > self.question.limit();
        if is_beyond {
            return None;
        }
        pair.distance = max(gap, N::ZERO).bits().max(pair.distance);
        pair.is_rough = false;
        if self.queue.peek().is_some_and(|Reverse(other)| *other < pair) {
            self.queue.push(Reverse(pair));
            return None;
        }
        Some(pair)
    }

    /// Returns the box and slab of block `which` of a pair, in the frame of its tree.
    fn slab_box(&self, which: usize, pair: &BlockPair) -> SlabBox<'_, D> {
        self.trees[which].slab_box(pair.layers[which].into(), pair.blocks[which])
    }

    fn bounds(&self, which: usize, pair: &BlockPair) -> Bounds<D> {
        *self.slab_box(which, pair).bounds
    }

    /// Returns a lower bound of the signed distance of the contents of two blocks: the gap along
    /// `toward`.
    fn gap_along(&self, toward: &Toward<N, D>, pair: &BlockPair) -> N {
        let extents = [0, 1].mapped(|which| self.slab_box(which, pair).extent(&toward[which]));
        self.question.gap(toward, extents)
    }

    /// Returns the gap along the direction of [`TreePair::best`], if that is known and the boxes of
    /// the two blocks are disjoint; else minus infinity.
    fn best_gap(&self, pair: &BlockPair) -> N {
        let best = self.question.best().filter(|_| pair.are_apart);
        best.map_or(-N::INFINITY, |toward| self.gap_along(&toward, pair))
    }

    /// Returns the largest gap along directions that are likely to separate the contents of two
    /// blocks. If the boxes of the blocks are disjoint, these are the direction of
    /// [`TreePair::best`] and the direction between the centres of the boxes; else the normals of
    /// the blocks' slabs.
    fn gap(&self, pair: &BlockPair) -> N {
        let gap = self.best_gap(pair);
        if gap > self.question.limit() {
            return gap;
        }
        let boxes = [0, 1].mapped(|which| self.slab_box(which, pair));
        let between = self.question.between(boxes.mapped(|own| own.bounds.as_aabb().center()));
        let toward = if pair.are_apart {
            [between, None]
        } else {
            [0, 1].mapped(|which| {
                let across = unit(&boxes[which].slab?.across::<N>())?.0;
                let is_toward = across.dot(&between.as_ref()?[which]) > N::ZERO;
                self.question.toward(which, &if is_toward { across } else { -across })
            })
        };
        let gaps = toward.into_iter().flatten().map(|toward| self.gap_along(&toward, pair));
        gaps.fold(gap, max)
    }

    /// Opens one block of a pair or both: queues pairs of children, or visits the objects of two
    /// leaf blocks.
    fn open(&mut self, pair: &BlockPair) {
        let widths = [0, 1].mapped(|which| self.bounds(which, pair).half_surface());
        let wider = usize::from(widths[1] >= widths[0]);
        match pair.layers {
            [0, 0] => self.meet(1 - wider, pair),
            [_, 0] => self.open_one(0, pair),
            [0, _] => self.open_one(1, pair),
            _ if widths[wider] > MUCH_WIDER * widths[1 - wider] => self.open_one(wider, pair),
            _ => self.open_both(1 - wider, pair),
        }
    }

    /// Queues the children of block `which` that are near the other block, each paired with the
    /// other block, unless [`Self::best_gap`] of the new pair exceeds the limit.
    fn open_one(&mut self, which: usize, pair: &BlockPair) {
        for below in self.near_below(which, pair) {
            let is_beyond = self.best_gap(&below) > self.question.limit();
            if !is_beyond {
                self.queue.push(Reverse(below));
            }
        }
    }

    /// Queues pairs of children of both blocks: for each child of block `which` within the limit,
    /// the near children of the other block.
    fn open_both(&mut self, which: usize, pair: &BlockPair) {
        for below in self.near_below(which, pair) {
            let is_beyond = self.gap(&below) > self.question.limit();
            if !is_beyond {
                self.open_one(1 - which, &below);
            }
        }
    }

    /// Visits the near pairs of objects of two leaf blocks: each object of block `which` with the
    /// near objects of the other block.
    fn meet(&mut self, which: usize, pair: &BlockPair) {
        let [own, other] = [pair.blocks[which], pair.blocks[1 - which]];
        let sides = self.sides(1 - which, pair);
        for (distance, slot) in self.near(which, 0, own, &self.other_box(which, pair)) {
            let Some(id) = self.trees[which].id_in(slot) else { continue };
            if distance > self.question.bound() {
                return;
            }
            let is_beyond = sides.iter().any(|(toward, of_others)| {
                let mut extents = [*of_others; 2];
                extents[which] = self.question.extent(which, id, &toward[which]);
                self.question.gap(toward, extents) > self.question.limit()
            });
            if is_beyond {
                continue;
            }
            let aabb = self.question.object_in_other(which, id);
            let near = self.near(1 - which, 0, other, &aabb);
            let others: SmallVec<[u32; LANES]> =
                near.iter().filter_map(|&(_, slot)| self.trees[1 - which].id_in(slot)).collect();
            if !others.is_empty() {
                self.question.visit(which, id, &others);
            }
        }
    }

    /// Returns directions that may separate single objects from all of leaf block `which`, each
    /// with an upper bound of the extent of the block's objects along it. If the limit is positive,
    /// the direction of [`TreePair::best`] comes first, with the largest extent of an object. The
    /// two normals of the block's slab follow, with the extent of the block.
    fn sides(&self, which: usize, pair: &BlockPair) -> SmallVec<[(Toward<N, D>, N); 3]> {
        let block = self.slab_box(which, pair);
        let across = block.slab.and_then(|slab| Some(unit(&slab.across::<N>())?.0));
        let across = across.into_iter().flat_map(|across| [across, -across]);
        let across = across.filter_map(|across| self.question.toward(which, &across));
        let mut sides: SmallVec<_> =
            across.map(|toward| (toward, block.extent(&toward[which]))).collect();
        if let Some(toward) = self.question.best().filter(|_| self.question.limit() > N::ZERO) {
            let ids = &self.trees[which].leaves()[pair.blocks[which] as usize];
            let extents = in_use(ids).map(|id| self.question.extent(which, id, &toward[which]));
            sides.insert(0, (toward, extents.fold(-N::INFINITY, max)));
        }
        sides
    }

    /// Returns the box of the block that is not `which`, in the frame of tree `which`.
    fn other_box(&self, which: usize, pair: &BlockPair) -> Aabb<N, D> {
        self.question.in_other(1 - which, &self.bounds(1 - which, pair).as_aabb())
    }

    /// Iterates over the children of block `which` that are near the other block, each paired with
    /// the other block; nearer children first.
    fn near_below(
        &self,
        which: usize,
        pair: &BlockPair,
    ) -> impl Iterator<Item = BlockPair> + use<N, D> {
        let pair = *pair;
        let near =
            self.near(which, pair.layers[which], pair.blocks[which], &self.other_box(which, &pair));
        near.into_iter().map(move |(distance, block)| below(&pair, which, block, distance))
    }

    /// Returns the lanes of a block whose boxes are within the bound of `aabb`, shrunk by
    /// [`TreePair::depth`] on each side. `aabb` is in the frame of the block's tree. Near lanes
    /// come first; at equal distances the lowest lane. Distances are rounded down.
    fn near(&self, which: usize, layer: u8, block: u32, aabb: &Aabb<N, D>) -> NearLanes<N> {
        let (tree, layer) = (self.trees[which], usize::from(layer));
        let gaps = Gaps::new(aabb, tree.size()).within(self.question.depth());
        let Open { keys, mut mask, first } =
            tree.opened_around(&gaps, layer, block, gaps.limit(self.question.bound()));
        let mut near = NearLanes::new();
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let distance = max(gaps.distance(keys[lane as usize]), N::ZERO);
            near.push((distance, first + lane));
        }
        sort_few(&mut near, |one, other| one.0 < other.0 || one.0 == other.0 && one.1 < other.1);
        near
    }
}

/// Returns the pair of a child of block `which` with the other block; `distance` is the distance of
/// their boxes.
fn below<N: Real>(pair: &BlockPair, which: usize, block: u32, distance: N) -> BlockPair {
    let (mut layers, mut blocks) = (pair.layers, pair.blocks);
    (layers[which], blocks[which]) = (layers[which] - 1, block);
    let are_apart = distance > N::ZERO;
    let distance = distance.bits().max(pair.distance);
    BlockPair { distance, layers, blocks, are_apart, is_rough: true }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounding_volume::BoundingVolume;
    use crate::bvh::Lanes;
    use crate::math::xorshift::Xorshift;
    use crate::math::{Point, Vector};

    /// Two lists of boxes; the second list is translated by `shift` along the x axis.
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

        fn limit(&self) -> f64 {
            self.limit
        }

        fn depth(&self) -> f64 {
            0.0
        }

        fn best(&self) -> Option<Toward<f64, 3>> {
            self.toward(0, &Vector::<f64, 3>::new(1.0, 0.0, 0.0))
        }

        fn toward(&self, which: usize, along: &Vector<f64, 3>) -> Option<Toward<f64, 3>> {
            Some(if which == 0 { [*along, -along] } else { [-along, *along] })
        }

        fn between(&self, points: [Point<f64, 3>; 2]) -> Option<Toward<f64, 3>> {
            let shift = Vector::<f64, 3>::new(self.shift, 0.0, 0.0);
            self.toward(0, &unit(&(points[1] + shift - points[0]))?.0)
        }

        fn extent(&self, which: usize, id: u32, along: &Vector<f64, 3>) -> f64 {
            let aabb = &self.boxes[which][id as usize];
            aabb.center().coords.dot(along) + aabb.half_extents().dot(&along.abs())
        }

        fn gap(&self, toward: &Toward<f64, 3>, [one, other]: [f64; 2]) -> f64 {
            self.shift * toward[0].x - one - other - 1e-6
        }

        fn guess(&mut self, objects: [u32; 2]) {
            assert!(!objects.contains(&NONE), "no object is infinite");
        }

        fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
            let pair = |other| if which == 0 { [own, other] } else { [other, own] };
            self.found.extend(others.iter().map(|&other| pair(other)));
        }
    }

    fn boxes(random: &mut Xorshift, count: usize) -> Vec<Aabb<f64, 3>> {
        let each = |_| {
            let corner = Point::from(random.vector::<f64>(20.0));
            Aabb::new(corner, corner + random.vector::<f64>(1.0).abs())
        };
        (0..count).map(each).collect()
    }

    #[test]
    fn no_near_pair_is_missed() {
        let random = &mut Xorshift(4);
        for (count1, count2) in [(0, 9), (1, 1), (5, 300), (700, 12), (400, 900)] {
            let all = [boxes(random, count1), boxes(random, count2)];
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
