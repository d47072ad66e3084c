//! Signed distance of a composite and another shape: the distance of their nearest parts or, if
//! parts overlap, minus the depth of the deepest pair. A piece of one shape inside a body of the
//! other also counts as an overlap (see `inside`).

use crate::math::order::sort_few;
use crate::tables::ByDimension;
use smallvec::SmallVec;

use super::between::{Between, by_number};
use super::bounds::{extent, loosened};
use super::nearest::{Wanted, nearest_between};
use super::slabs::{AxisSlabs, corners_of, range};
use super::solid_bounds::{SolidBounds, gap_slack};
use super::sweep::PartSweep;
use crate::bounding_volume::Aabb;
use crate::bvh::{BoxRanking, NONE, Toward, TreePair, visit_pairs, visit_ranked};
use crate::collide::Pair;
use crate::collide::packet::{LANES, PartPacket};
use crate::convex::Separation;
use crate::math::{Mapped, Point, Real, Space, Vector, max, max_component, unit};
use crate::partitioning::BoxTree;
use crate::shape::{CompositeShape, Kind};

/// Separation of two parts, in the frame of the first shape, and their indices.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartSeparation<N: Real, const D: usize> {
    pub(crate) separation: Separation<N, D>,
    /// The separation in the frame of the first part of the pair made by [`Between::parts`].
    pub(crate) local: Separation<N, D>,
    /// Index of the part of the first shape, and of the second; 0 for a convex solid.
    pub(crate) parts: [u32; 2],
}

/// Computes the separation of two shapes, at least one of them a composite: the separation of their
/// nearest parts, or of the deepest pair if parts overlap or a piece of one shape is inside a body
/// of the other. `None` if the distance exceeds `limit`.
pub(crate) fn separation<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let found = nearest_between(&Between::of_pair(pair), limit, Wanted::Deepest, None);
    found.map(|found| found.separation)
}

/// Receives the pairs of parts that [`visit_near_pairs`] finds, near pairs first, and limits that
/// search.
pub(crate) trait PairVisitor<N: Real, const D: usize> {
    /// Returns the largest distance at which a pair of parts is still needed; it may shrink but
    /// must not grow.
    fn limit(&self) -> N;

    /// Returns the largest distance at which a pair of boxes must be descended; negative to end the
    /// search.
    fn bound(&self) -> N {
        loosened(max(self.limit(), N::ZERO))
    }

    /// Returns the sweep of the first shape (0) or the second (1) in the frame of the other shape;
    /// boxes and slabs then contain its parts during the whole motion. `None` if the shape does not
    /// move.
    fn sweep(&self, _which: usize) -> Option<PartSweep<N, D>> {
        None
    }

    /// Returns the normal of the best pair so far: a unit vector from the first shape to the
    /// second, in the frame of the first shape. `None` before a pair is found, and if one of the
    /// shapes moves.
    fn normal(&self) -> Option<Vector<N, D>> {
        None
    }

    /// Returns whether the first pair that touches ends the search.
    fn ends_at_touch(&self) -> bool {
        false
    }

    /// Handles a pair of parts. A guessed pair may be passed twice.
    fn visit(&mut self, parts: [u32; 2]);
}

/// Visits all pairs of parts of two shapes that are within the limit of `visitor`, near pairs
/// first, until [`PairVisitor::bound`] is negative. Also visits pairs beyond the limit that the
/// bounds do not reject.
///
/// Cost: for a convex solid, only the parts near it are searched. Two composites with trees are
/// descended together where their boxes are near each other. Otherwise each part of the composite
/// with fewer parts, near parts first, searches the other composite: at most n log m for n parts in
/// the smaller and m in the larger, as long as parts do not all overlap. A half-space that is not
/// aligned to an axis has no box and is compared with every part.
pub(crate) fn visit_near_pairs<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    visitor: &mut dyn PairVisitor<N, D>,
) {
    let mut search = NearestSearch { between, visitor };
    match between.composites() {
        [None, None] => search.visitor.visit([0, 0]),
        [Some(parts1), None] => search.of_solid(1, parts1),
        [None, Some(parts2)] => match between.pair.first {
            Kind::Plane(plane) => {
                search
                    .outside(0, 0, parts2, |sweep| AxisSlabs::of_half_space(between, plane, sweep));
            }
            _ => search.of_solid(0, parts2),
        },
        [Some(parts1), Some(parts2)] => {
            let trees = [parts1, parts2].mapped(|parts| parts.search().as_tree()?.packed_whole());
            let [Some(tree1), Some(tree2)] = trees else { return search.of_many(parts1, parts2) };
            let NearestSearch { visitor, .. } = search;
            let mut pairs = TreeParts::new(between, [parts1, parts2], visitor);
            visit_pairs([tree1, tree2], &mut pairs);
        }
    }
}

/// Search of two composites that both have trees.
struct TreeParts<'a, 'q, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    visitor: &'q mut dyn PairVisitor<N, D>,
    parts: [&'a dyn CompositeShape<N, D>; 2],
    /// Rounding error of gaps along a direction; infinite if such gaps cannot be used, because a
    /// shape moves or the size of the shapes is too large.
    slack: N,
    /// Slabs around the part that was visited last.
    slabs: Option<PartSlabs<N, D>>,
}

/// Slabs around a part of the first (0) or the second (1) composite.
struct PartSlabs<N: Real, const D: usize> {
    which: usize,
    part: u32,
    slabs: AxisSlabs<N, D>,
}

impl<'a, 'q, N: Space<D>, const D: usize> TreeParts<'a, 'q, N, D> {
    /// Creates the search. Gaps along directions are used only if neither shape moves and their
    /// rounding error is finite.
    fn new(
        between: &'a Between<'a, N, D>,
        parts: [&'a dyn CompositeShape<N, D>; 2],
        visitor: &'q mut dyn PairVisitor<N, D>,
    ) -> Self {
        let sizes = parts.mapped(|parts| extent(&parts.search().bounds()));
        let size = sizes[0] + sizes[1] + max_component(&between.pair.pose12.translation);
        let is_at_rest = [0, 1].iter().all(|&which| visitor.sweep(which).is_none());
        let is_known = is_at_rest && (size / N::EPSILON).is_finite_number();
        let slack = if is_known { gap_slack(size) } else { N::INFINITY };
        Self { between, visitor, parts, slack, slabs: None }
    }

    /// Returns a box, in the frame of the other composite, around the parts in `aabb` during their
    /// motion.
    fn swept(&self, which: usize, aabb: Aabb<N, D>) -> Aabb<N, D> {
        self.visitor.sweep(which).map_or(aabb, |sweep| sweep.of_box(&aabb))
    }
}

impl<N: Space<D>, const D: usize> TreePair<N, D> for TreeParts<'_, '_, N, D> {
    fn in_other(&self, which: usize, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        self.swept(which, self.between.box_in_other(which, aabb))
    }

    fn object_in_other(&self, which: usize, id: u32) -> Aabb<N, D> {
        self.swept(which, self.between.aabb_in_other(which, id))
    }

    fn bound(&self) -> N {
        self.visitor.bound()
    }

    fn limit(&self) -> N {
        self.visitor.limit()
    }

    /// Returns the depth by which boxes must overlap to be descended: parts deeper than a negative
    /// limit have boxes that overlap at least as deeply, up to rounding error.
    fn depth(&self) -> N {
        max(-self.visitor.limit() - self.slack, N::ZERO)
    }

    fn best(&self) -> Option<Toward<N, D>> {
        self.toward(0, &self.visitor.normal()?)
    }

    /// Returns a direction in the frames of both shapes: for the first shape, toward the second;
    /// for the second, toward the first. `along` is this vector for shape `which`. `None` if gaps
    /// along directions cannot be used.
    fn toward(&self, which: usize, along: &Vector<N, D>) -> Option<Toward<N, D>> {
        let pose12 = &self.between.pair.pose12;
        let toward = match which {
            0 => [*along, pose12.inverse_vector(&-along)],
            _ => [pose12.vector(&-along), *along],
        };
        self.slack.is_finite_number().then_some(toward)
    }

    fn between(&self, points: [Point<N, D>; 2]) -> Option<Toward<N, D>> {
        let offset = self.between.pair.pose12.point(&points[1]) - points[0];
        self.toward(0, &unit(&offset)?.0)
    }

    /// Returns the largest coordinate of part `id` along `along`, both in the frame of composite
    /// `which`; infinite for parts without corners.
    fn extent(&self, which: usize, id: u32, along: &Vector<N, D>) -> N {
        let Some(corners) = corners_of(self.parts[which], id) else { return N::INFINITY };
        range(&corners, along)[1]
    }

    /// Returns a lower bound of the distance of two parts with these extents along `toward`: the
    /// gap between the parts minus the rounding error.
    fn gap(&self, toward: &Toward<N, D>, [extent1, extent2]: [N; 2]) -> N {
        let offset = toward[0].dot(&self.between.pair.pose12.translation);
        offset - extent1 - extent2 - self.slack
    }

    fn guess(&mut self, parts: [u32; 2]) {
        if self.slack.is_finite_number() && !parts.contains(&NONE) {
            self.visitor.visit(parts);
        }
    }

    /// Rejects parts by the gaps along the normal of the best pair, along the line through the
    /// means of the three corners of each part, and along slabs and separating axes. Visits the
    /// remaining parts in the order of their lower bounds.
    fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
        let pair = |other: u32| if which == 0 { [own, other] } else { [other, own] };
        let (best, mut near) = (self.best(), PartGaps::new());
        for &other in others {
            let gap =
                best.as_ref().map_or(-N::INFINITY, |toward| self.gap_along(toward, pair(other)));
            let is_apart = self.visitor.limit() > N::ZERO && gap <= self.visitor.limit();
            let gap = if is_apart { max(self.gap_between(pair(other)), gap) } else { gap };
            let is_beyond = gap > self.visitor.limit();
            if !is_beyond {
                near.push((gap, other));
            }
        }
        if near.is_empty() {
            return;
        }
        let slabs = self.slabs_of(which, own);
        self.add_gaps(&slabs, self.parts[1 - which], &mut near);
        self.slabs = Some(slabs);
        sort_few(&mut near, |(one, part1), (other, part2)| {
            one.as_f64().total_cmp(&other.as_f64()).then(part1.cmp(part2)).is_lt()
        });
        for (gap, other) in near {
            let is_beyond = gap > self.visitor.limit() || self.visitor.bound() < N::ZERO;
            if is_beyond {
                return;
            }
            let best = self.best().map(|toward| self.gap_along(&toward, pair(other)));
            let is_beyond = best.is_some_and(|gap| gap > self.visitor.limit());
            if !is_beyond {
                self.visitor.visit(pair(other));
            }
        }
    }
}

/// Parts with lower bounds of their distances, as pairs (bound, index of the part). A part with a
/// negative bound may overlap.
type PartGaps<N> = SmallVec<[(N, u32); 2 * LANES]>;

impl<N: Space<D>, const D: usize> TreeParts<'_, '_, N, D> {
    /// Returns a lower bound of the gap between two parts along a direction; minus infinity if a
    /// part has no corners.
    fn gap_along(&self, toward: &Toward<N, D>, parts: [u32; 2]) -> N {
        self.gap(toward, [0, 1].mapped(|which| self.extent(which, parts[which], &toward[which])))
    }

    /// Returns a lower bound of the gap along the line through the means of the three corners of
    /// each part (the first end of a segment counts twice). Minus infinity if a part has no corners
    /// or the means coincide.
    fn gap_between(&self, parts: [u32; 2]) -> N {
        let middles = [0, 1].mapped(|which| {
            let [a, b, c] = corners_of(self.parts[which], parts[which])?;
            Some(Point::from((a + b + c) * N::lit(1.0 / 3.0)))
        });
        let [Some(middle1), Some(middle2)] = middles else { return -N::INFINITY };
        let toward = self.between([middle1, middle2]);
        toward.map_or(-N::INFINITY, |toward| self.gap_along(&toward, parts))
    }

    /// Returns the slabs around a part of the first shape (0) or the second (1); takes the slabs
    /// from `self.slabs` if that field holds this part.
    fn slabs_of(&mut self, which: usize, part: u32) -> PartSlabs<N, D> {
        // Sweeps only get shorter, so old slabs are still wide enough.
        let is_own = |kept: &PartSlabs<N, D>| kept.which == which && kept.part == part;
        if let Some(kept) = self.slabs.take().filter(is_own) {
            return kept;
        }
        let sweep = self.visitor.sweep(which);
        let slabs = AxisSlabs::of_part(self.between, which, part, sweep.as_ref());
        PartSlabs { which, part, slabs }
    }

    /// Raises the lower bounds in `near` to the gaps that [`part_gaps3`](super::part_gaps3), or its
    /// counterpart in 2D, computes along the slabs and the separating axes. The bounds of parts
    /// without corners stay unchanged.
    fn add_gaps(
        &self,
        around: &PartSlabs<N, D>,
        parts: &dyn CompositeShape<N, D>,
        near: &mut PartGaps<N>,
    ) {
        for group in near.chunks_mut(LANES) {
            let (mut tiles, mut is_known) = (PartPacket::blank(), [false; LANES]);
            for (lane, (_, other)) in group.iter().enumerate() {
                if let Some(corners) = corners_of(parts, *other) {
                    tiles.put(lane, &corners.mapped(Point::from));
                    is_known[lane] = true;
                }
            }
            let gaps = <N::Algorithms>::part_gaps(&around.slabs, &tiles, self.visitor.limit());
            for (((own, _), gap), is_known) in group.iter_mut().zip(gaps).zip(is_known) {
                *own = if is_known { max(gap, *own) } else { *own };
            }
        }
    }
}

/// Search of [`visit_near_pairs`] for pairs other than two composites that both have trees.
struct NearestSearch<'a, 'q, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    visitor: &'q mut dyn PairVisitor<N, D>,
}

impl<N: Space<D>, const D: usize> NearestSearch<'_, '_, N, D> {
    /// Visits the parts of a composite near a convex solid, which is the first shape (0) or the
    /// second (1).
    fn of_solid(&mut self, which: usize, parts: &dyn CompositeShape<N, D>) {
        let (between, is_at_rest) = (self.between, self.visitor.sweep(which).is_none());
        let tree =
            parts.search().as_tree().filter(|tree| is_at_rest && tree.packed_whole().is_some());
        match tree.zip(SolidBounds::of(between, which)) {
            Some((tree, bounds)) => {
                let aabb = between.whole_in_other(which);
                let visitor = &mut *self.visitor;
                let mut ranked = RankedParts { bounds, parts, boxes: tree, which, visitor };
                visit_ranked(tree.packed(), &aabb, &mut ranked);
            }
            None => self.of_one(which, 0, parts),
        }
    }

    /// Visits the parts of `others` near one part of the first shape (0) or the second (1).
    fn of_one(&mut self, which: usize, part: u32, others: &dyn CompositeShape<N, D>) {
        let between = self.between;
        self.outside(which, part, others, |sweep| AxisSlabs::of_part(between, which, part, sweep));
    }

    /// Visits the parts of `others` near one part, except those that the slabs around this part
    /// reject. The slabs are computed when the first candidate is found.
    fn outside(
        &mut self,
        which: usize,
        part: u32,
        others: &dyn CompositeShape<N, D>,
        slabs: impl Fn(Option<&PartSweep<N, D>>) -> AxisSlabs<N, D>,
    ) {
        let (sweep, mut made) = (self.visitor.sweep(which), None);
        let aabb = self.between.aabb_in_other(which, part);
        let aabb = sweep.map_or(aabb, |sweep| sweep.of_box(&aabb));
        others.search().nearest(&aabb, self.visitor.bound(), &mut |other, _| {
            let slabs = made.get_or_insert_with(|| slabs(sweep.as_ref()));
            if !slabs.are_beyond(&others.part(other), self.visitor.limit()) {
                self.visitor.visit(if which == 0 { [part, other] } else { [other, part] });
            }
            self.visitor.bound()
        });
    }

    /// Visits the near pairs of two composites: each part of the composite with fewer parts
    /// searches the larger composite.
    fn of_many(&mut self, parts1: &dyn CompositeShape<N, D>, parts2: &dyn CompositeShape<N, D>) {
        let (which, fewer, more) = by_number(parts1, parts2);
        let (sweep, bound) = (self.visitor.sweep(1 - which), self.visitor.bound());
        let aabb = self.between.whole_in_other(1 - which);
        let aabb = sweep.map_or(aabb, |sweep| sweep.of_box(&aabb));
        if sweep.is_none() && self.between.are_boxes_beyond(bound) {
            return;
        }
        fewer.search().nearest(&aabb, bound, &mut |part, _| {
            self.of_one(which, part, more);
            self.visitor.bound()
        });
    }
}

/// Ranking of the parts of a composite by lower bounds of their distances from a convex solid,
/// which is the first shape (0) or the second (1).
struct RankedParts<'a, 'q, N: Real, const D: usize> {
    bounds: SolidBounds<'a, N, D>,
    parts: &'a dyn CompositeShape<N, D>,
    boxes: &'a BoxTree<N, D>,
    which: usize,
    visitor: &'q mut dyn PairVisitor<N, D>,
}

impl<N: Space<D>, const D: usize> BoxRanking<N, D> for RankedParts<'_, '_, N, D> {
    fn toward(&self, aabb: &Aabb<N, D>) -> Option<(Vector<N, D>, N)> {
        self.bounds.toward(aabb)
    }

    fn of_object(&self, id: u32) -> N {
        self.bounds.of_part(&self.parts.part(id), &self.boxes.boxes()[id as usize])
    }

    fn limit(&self) -> Option<N> {
        let ends = self.visitor.bound() < N::ZERO;
        let limit = self.visitor.limit();
        // The comparison is false for a NaN limit, within which no part lies.
        (!ends && limit <= N::INFINITY).then_some(limit)
    }

    fn guess_near(&self) -> Option<Point<N, D>> {
        self.visitor.ends_at_touch().then(|| self.bounds.center())
    }

    fn visit(&mut self, id: u32) {
        self.visitor.visit(if self.which == 0 { [0, id] } else { [id, 0] });
    }
}

impl<N: Real, const D: usize> PartSeparation<N, D> {
    /// Returns whether this pair is nearer than `other`, or equally near with lower indices.
    pub(super) fn is_before(&self, other: &Self) -> bool {
        let (distance, others) = (self.separation.distance, other.separation.distance);
        distance < others || (distance == others && self.parts < other.parts)
    }
}
