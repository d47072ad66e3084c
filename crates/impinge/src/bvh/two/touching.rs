//! Pairs of objects of two trees that may touch, each tree in its own frame.
//!
//! The search is depth first over pairs of blocks. The box of one block is transformed once into
//! the frame of the other tree, and compared with all boxes in the other block. The boxes are
//! compared along the axes of both frames and along the normal of the transformed block's slab. The
//! axes of both frames separate most disjoint boxes (Gottschalk, Lin and Manocha, "`OBBTree`",
//! 1996, also test the cross products of edges). The larger of two blocks is opened; its children
//! go on a stack, and the child with the deepest overlap comes next.
//!
//! A search for the nearest pair is best first (Hjaltason and Samet, "Incremental distance join
//! algorithms for spatial databases", 1998). Before it begins, a descent straight to one object of
//! each tree gives a first distance. The direction along which the nearest two objects so far are
//! separated, and the direction between the centres of two blocks, separate most blocks that lie
//! beside each other.
//!
//! Boxes are compared in `f32`, with a margin for the rounding errors: every rejected pair is
//! beyond the maximum distance.

use std::collections::BinaryHeap;

use smallvec::SmallVec;

use super::agenda::{Agenda, OpenPair, STACK};
use super::near_pairs::Toward;
use super::regions::{Held, RotatedBox, TreePose};
use crate::bounding_volume::Aabb;
use crate::bvh::tree::small;
use crate::bvh::{Bounds, LANES, NONE, Tree};
use crate::math::ones::Ones;
use crate::math::order::sort_few;
use crate::math::simd::Level;
use crate::math::{Mapped, Pose, Real, Vector, filled, max_component, unit};

/// Rounding error of gaps, as a multiple of the `f32` epsilon times the sum of the sizes of both
/// trees and the components of the translations between their frames: 3 for a rotation, 3 for a
/// scalar product and 2 for directions that are not exactly of unit length, on up to three axes.
/// The rest is reserve.
const ROUNDING: f32 = 64.0;

/// The relative pose of two trees, and the receiver of pairs of their objects.
pub(crate) trait TouchQuery<N: Real, const D: usize> {
    /// Returns the transformation from the frame of the first (0) or the second (1) tree to the
    /// frame of the other.
    fn pose(&self, which: usize) -> &Pose<N, D>;

    /// Returns the largest distance of pairs to visit, which must never grow; `None` ends the
    /// search.
    fn max_distance(&self) -> Option<N>;

    /// Returns `true` if the maximum distance shrinks to the least distance found so far. Pairs of
    /// blocks are then opened by ascending gap, instead of depth first.
    fn is_for_nearest(&self) -> bool {
        false
    }

    /// Receives one object of each tree before the search; the two are probably near each other.
    /// The search may visit them again.
    fn guess(&mut self, _objects: [u32; 2]) {}

    /// Returns the direction along which the nearest two objects compared so far are separated, as
    /// a unit vector toward the other tree in the frame of each tree; `None` if unknown.
    fn best(&self) -> Option<Toward<N, D>> {
        None
    }

    /// Returns a box around an object of the first (0) or the second (1) tree, in the frame of the
    /// other tree, up to rounding errors. If objects of the other tree are near the box, the next
    /// call (after [`Self::corners`]) is [`Self::visit`] for this object.
    fn object_in_other(&mut self, which: usize, id: u32) -> Aabb<N, D>;

    /// Returns the corners of the object of the last call of [`Self::object_in_other`], in the
    /// frame of the other tree; `None` if the object has no corners.
    fn corners(&self) -> Option<[Vector<N, D>; 3]> {
        None
    }

    /// Receives object `own` of the first (0) or the second (1) tree, and the objects in one block
    /// of the other tree whose boxes are within the maximum distance.
    fn visit(&mut self, which: usize, own: u32, others: &[u32]);
}

/// A search of two trees: best first if it is for the nearest pair, else depth first.
struct TouchSearch<'a, 'q, N: Real, const D: usize> {
    trees: [&'a Tree<D>; 2],
    tree_poses: [TreePose<D>; 2],
    level: Level,
    /// Upper bound of the rounding error of a gap in `f32`.
    margin: f32,
    /// Upper bound of the rounding error of a gap in the scalar type.
    slack: N,
    is_for_nearest: bool,
    question: &'q mut dyn TouchQuery<N, D>,
}

/// Visits all pairs of objects of two trees whose boxes are within the maximum distance of
/// `question`. It may also visit pairs that are slightly farther apart.
pub(crate) fn visit_touching<N: Real, const D: usize>(
    trees: [&Tree<D>; 2],
    question: &mut dyn TouchQuery<N, D>,
) {
    if trees.iter().any(|tree| tree.is_empty()) {
        return;
    }
    debug_assert!(trees.iter().all(|tree| !tree.is_stale), "searches need refitted trees");
    let tree_poses = [0, 1].mapped(|which| TreePose::of(question.pose(which)));
    let distances = max_component(&question.pose(0).translation).as_f32()
        + max_component(&question.pose(1).translation).as_f32();
    let size = trees[0].size() + trees[1].size() + distances;
    let margin = ROUNDING * f32::EPSILON * size + f32::MIN_POSITIVE;
    let gap = f32::NEG_INFINITY;
    let whole = OpenPair { layers: trees.mapped(Tree::top_layer), blocks: [0, 0], gap };
    let slack = N::lit(f64::from(ROUNDING) * f64::from(size)) * N::EPSILON;
    let (level, is_for_nearest) = (Level::new(), question.is_for_nearest());
    let mut search =
        TouchSearch { trees, tree_poses, level, margin, slack, is_for_nearest, question };
    if is_for_nearest {
        search.guess(whole);
        search.run(whole, BinaryHeap::new());
    } else {
        search.run(whole, SmallVec::<[OpenPair; STACK]>::new());
    }
}

impl<N: Real, const D: usize> TouchSearch<'_, '_, N, D> {
    /// Opens pairs of blocks until the queue is empty or `question` ends the search. Of two blocks
    /// above the lowest layer, the one with the larger surface is opened.
    fn run(&mut self, whole: OpenPair, mut agenda: impl Agenda) {
        agenda.put(whole);
        while let Some(pair) = agenda.take() {
            let Some(margin) = self.margin() else { return };
            if pair.gap > margin || (self.is_for_nearest && self.is_beyond(&pair)) {
                continue;
            }
            match pair.layers {
                [0, 0] => self.meet(&pair, margin),
                [_, 0] => self.open(0, &pair, margin, &mut agenda),
                [0, _] => self.open(1, &pair, margin, &mut agenda),
                _ => {
                    let [one, other] =
                        [0, 1].mapped(|which| self.bounds(which, &pair).half_surface());
                    self.open(usize::from(other > one), &pair, margin, &mut agenda);
                }
            }
        }
    }

    /// Returns `true` if the contents of two blocks are beyond the maximum distance, along the
    /// direction of [`TouchQuery::best`] or the direction between the centres of the blocks.
    /// Returns `false` if [`TouchQuery::best`] returns `None`. The gaps are computed in the scalar
    /// type, which resolves more than `f32` between distant blocks.
    fn is_beyond(&self, pair: &OpenPair) -> bool {
        let Some((best, max_distance)) = self.question.best().zip(self.question.max_distance())
        else {
            return false;
        };
        let limit = max_distance + self.slack;
        if self.gap_along(&best, pair) > limit {
            return true;
        }
        let poses = [0, 1].mapped(|which| self.question.pose(which));
        let [one, other] = [0, 1].mapped(|which| self.bounds(which, pair).as_aabb().center());
        unit(&(poses[1].point(&other) - one)).is_some_and(|(along, _)| {
            self.gap_along(&[along, poses[0].vector(&-along)], pair) > limit
        })
    }

    /// Returns the gap between the two blocks of a pair along `toward`.
    fn gap_along(&self, toward: &Toward<N, D>, pair: &OpenPair) -> N {
        let extents = [0, 1].mapped(|which| {
            let block = self.trees[which].slab_box(pair.layers[which].into(), pair.blocks[which]);
            block.extent(&toward[which])
        });
        toward[0].dot(&self.question.pose(1).translation) - extents[0] - extents[1]
    }

    /// Returns the maximum distance plus the bound of rounding errors; `None` ends the search.
    fn margin(&self) -> Option<f32> {
        self.question.max_distance().map(|max_distance| self.margin + max_distance.as_f32_above())
    }

    /// Passes one object of each tree to [`TouchQuery::guess`], unless a descent finds none. Each
    /// is the end of a descent toward the centre of the other object's leaf block; the first
    /// descent goes toward the centre of the other tree.
    fn guess(&mut self, whole: OpenPair) {
        let (mut pair, mut found) = (whole, [NONE; 2]);
        for which in [0, 1, 0, 1] {
            let turn = &self.tree_poses[1 - which];
            let center = turn.vector(&self.bounds(1 - which, &pair).center());
            let middle = filled(|row| center[row] + turn.shift[row]);
            let Some(slot) = self.trees[which].slot_near(&middle) else { return };
            (pair.layers[which], pair.blocks[which]) = (0, slot / small(LANES));
            found[which] = self.trees[which].ids[slot as usize];
        }
        if !found.contains(&NONE) {
            self.question.guess(found);
        }
    }

    /// Returns the bounds of block `which` of a pair, in the frame of its tree.
    fn bounds(&self, which: usize, pair: &OpenPair) -> &Bounds<D> {
        &self.trees[which].layers[usize::from(pair.layers[which])].bounds
            [pair.blocks[which] as usize]
    }

    /// Returns the lanes of block `which` whose boxes may be within the maximum distance of the
    /// other block's box and slab.
    fn held(&self, which: usize, pair: &OpenPair, margin: f32) -> Held {
        let own =
            self.trees[1 - which].slab_box(pair.layers[1 - which].into(), pair.blocks[1 - which]);
        let region =
            self.tree_poses[1 - which].region_of(own.bounds, own.slab, margin, self.is_for_nearest);
        let (layer, block) = (usize::from(pair.layers[which]), pair.blocks[which] as usize);
        region.held(self.level, &self.trees[which].layers[layer].blocks[block])
    }

    /// Queues the children of block `which`, each paired with the other block. The child with the
    /// least gap is put last, so that a stack takes it next.
    fn open(&self, which: usize, pair: &OpenPair, margin: f32, agenda: &mut impl Agenda) {
        let Held { mask, gaps } = self.held(which, pair, margin);
        let (layer, first) = (pair.layers[which] - 1, pair.blocks[which] * small(LANES));
        let mut near = SmallVec::<[(f32, u32); LANES]>::new();
        for lane in Ones::<LANES>(mask) {
            let block = first + small(lane);
            // With an infinite margin, no lane is rejected, not even an empty one.
            if self.trees[which].is_block(layer, block) {
                near.push((gaps[lane], block));
            }
        }
        sort_few(&mut near, |one, other| one.0 > other.0);
        for (gap, block) in near {
            let mut below = *pair;
            (below.layers[which], below.blocks[which]) = (layer, block);
            // Subtracts the rounding error of the sum.
            below.gap = gap + margin - margin.abs() * ROUNDING * f32::EPSILON;
            agenda.put(below);
        }
    }

    /// Visits the near objects of two leaf blocks. For each near object of the block with fewer
    /// near objects, finds the near objects of the other block that may be within the maximum
    /// distance of it.
    fn meet(&mut self, pair: &OpenPair, mut margin: f32) {
        let mut masks = [0; 2];
        for which in [0, 1] {
            masks[which] = self.held(which, pair, margin).mask;
            if masks[which] == 0 {
                return;
            }
        }
        let which = usize::from(masks[1].count_ones() < masks[0].count_ones());
        let [tree, other] = [self.trees[which], self.trees[1 - which]];
        let [own, others] = [pair.blocks[which], pair.blocks[1 - which]];
        let block = &other.layers[0].blocks[others as usize];
        for lane in Ones::<LANES>(masks[which]) {
            let Some(id) = tree.id_in(own * small(LANES) + small(lane)) else { continue };
            let aabb = self.question.object_in_other(which, id);
            let corners = self.question.corners().filter(|_| self.is_for_nearest);
            let region = RotatedBox::of_object(&Bounds::enclosing(&aabb), corners, margin);
            let near = region.held(self.level, block);
            let ids = Ones::<LANES>(near.mask & masks[1 - which])
                .filter_map(|lane| other.id_in(others * small(LANES) + small(lane)));
            let ids = ids.collect::<SmallVec<[u32; LANES]>>();
            if !ids.is_empty() {
                self.question.visit(which, id, &ids);
                let Some(shrunk) = self.margin() else { return };
                margin = shrunk;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::Lanes;
    use crate::math::xorshift::Xorshift;
    use crate::math::{Isometry3, Point, Vector};

    /// Segments by their endpoints, in the frame of their tree.
    type Segments = Vec<[Point<f64, 3>; 2]>;

    struct RotatedPairs<'a> {
        segments: &'a [Segments; 2],
        poses: [Pose<f64, 3>; 2],
        max_distance: f64,
        found: Vec<[u32; 2]>,
        is_first_enough: bool,
        is_for_nearest: bool,
        /// Corners of the object of the last call, as a triangle without area.
        own: Option<[Vector<f64, 3>; 3]>,
    }

    impl TouchQuery<f64, 3> for RotatedPairs<'_> {
        fn pose(&self, which: usize) -> &Pose<f64, 3> {
            &self.poses[which]
        }

        fn max_distance(&self) -> Option<f64> {
            (self.found.is_empty() || !self.is_first_enough).then_some(self.max_distance)
        }

        fn is_for_nearest(&self) -> bool {
            self.is_for_nearest
        }

        fn object_in_other(&mut self, which: usize, id: u32) -> Aabb<f64, 3> {
            let ends = self.segments[which][id as usize].map(|end| self.poses[which].point(&end));
            self.own = Some([0, 1, 0].map(|end: usize| ends[end].coords));
            around(&ends)
        }

        fn corners(&self) -> Option<[Vector<f64, 3>; 3]> {
            self.own
        }

        fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
            let pair = |other| if which == 0 { [own, other] } else { [other, own] };
            self.found.extend(others.iter().map(|&other| pair(other)));
        }
    }

    fn around([a, b]: &[Point<f64, 3>; 2]) -> Aabb<f64, 3> {
        Aabb::new(a.inf(b), a.sup(b))
    }

    fn segments(random: &mut Xorshift, count: usize) -> Segments {
        let each = |_| {
            let start = Point::from(random.vector::<f64>(20.0));
            [start, start + random.vector::<f64>(2.0)]
        };
        (0..count).map(each).collect()
    }

    /// Returns the least distance between nine samples of each of two segments.
    fn distance(one: &[Point<f64, 3>; 2], other: &[Point<f64, 3>; 2]) -> f64 {
        let point_at = |[a, b]: &[Point<f64, 3>; 2], at: i32| a + (b - a) * (f64::from(at) / 8.0);
        let pairs = (0..=8).flat_map(|at1| (0..=8).map(move |at2| (at1, at2)));
        pairs
            .map(|(at1, at2)| (point_at(one, at1) - point_at(other, at2)).norm())
            .fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn no_near_pair_is_missed() {
        let random = &mut Xorshift(9);
        for (count1, count2, max_distance) in
            [(0, 9, 1.0), (1, 1, 60.0), (5, 300, 2.0), (700, 12, 1.0), (400, 900, 0.5)]
        {
            let all = [segments(random, count1), segments(random, count2)];
            let tree = |segments: &Segments| {
                let boxes = segments.iter().map(|own| Bounds::enclosing(&around(own)));
                Tree::of_still(Lanes::detect(), (0..).zip(boxes))
            };
            let trees = [tree(&all[0]), tree(&all[1])];
            let turn = random.vector::<f64>(3.0);
            let pose = Pose::from(Isometry3::new(Vector::<f64, 3>::new(9.0, -4.0, 2.0), turn));
            let poses = [pose.inverse(), pose];
            let mut pairs = RotatedPairs {
                segments: &all,
                poses,
                max_distance,
                found: Vec::new(),
                is_first_enough: false,
                is_for_nearest: false,
                own: None,
            };
            let results = [false, true].map(|is_for_nearest| {
                pairs.is_for_nearest = is_for_nearest;
                visit_touching(trees.each_ref(), &mut pairs);
                let mut found = core::mem::take(&mut pairs.found);
                found.sort_unstable();
                assert!(found.windows(2).all(|pair| pair[0] != pair[1]), "each once");
                found
            });
            let [found, nearest] = &results;
            assert!(nearest.len() * 2 < found.len() || found.len() < 100, "{}", nearest.len());
            for (id1, one) in (0..).zip(&all[0]) {
                for (id2, other) in (0..).zip(&all[1]) {
                    let distance = distance(one, &other.map(|end| pose.point(&end)));
                    let is_found =
                        results.iter().all(|result| result.binary_search(&[id1, id2]).is_ok());
                    assert!(is_found || distance > max_distance, "{id1} and {id2}: {distance}");
                }
            }
            let most = count1 * count2;
            assert!(most < 1000 || found.len() * 20 < most, "{} of {most} pairs", found.len());
            (pairs.is_first_enough, pairs.is_for_nearest) = (true, false);
            visit_touching(trees.each_ref(), &mut pairs);
            assert!(pairs.found.len() <= LANES, "the search ends");
        }
    }
}
