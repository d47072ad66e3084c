//! Finds pairs of parts of two composites that may be within a distance of each other. Both
//! composites must have trees.
//!
//! The trees reject pairs by boxes. The remaining pairs are tested 8 at a time in SIMD lanes
//! ([`pair_lanes`]), along every axis that may separate two triangles.
//!
//! [`pair_lanes`]: super::pair_lanes

use super::between::Between;
use super::bounds::extent;
use super::pair_lanes::PartPairs;
use super::slabs::{corners_of, range};
use super::solid_bounds::gap_slack;
use crate::bounding_volume::Aabb;
use crate::bvh::{TouchQuery, Toward, visit_touching};
use crate::collide::packet::LANES;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::CompositeShape;
use crate::tables::ByDimension;

/// Receives the pairs of parts that [`each_touching`] finds.
pub(crate) trait TouchingVisitor<N: Real, const D: usize> {
    /// Handles two parts. Returns the `max_distance` for the rest of the search, which must not
    /// exceed the previous one; `None` ends the search.
    fn visit(&mut self, parts: [u32; 2]) -> Option<N>;

    /// Returns the normal of the best pair so far: a unit vector from the first composite to the
    /// second, in the frame of the first. `None` if no pair is known.
    fn normal(&self) -> Option<Vector<N, D>> {
        None
    }
}

/// The pairs of parts that a search visits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Touching {
    /// All pairs that may be within `max_distance`, each once.
    Each,
    /// Any pair that may be within `max_distance`: the first pair found is likely to end the
    /// search, so no pair waits for a full batch of lanes.
    Any,
    /// The nearest pair: `max_distance` shrinks to the best distance. A pair that is likely to be
    /// near is visited first, and may be visited twice.
    Nearest,
}

/// Visits the pairs of parts within `max_distance` that `wanted` selects, and possibly pairs that
/// are farther apart. Returns `false`, without a visit, if one shape is not a composite with a
/// tree, or if the translation between them overflows `f32`, the type of the boxes.
///
/// Cost: O(n + k) for k pairs of parts and n pairs of blocks with boxes within `max_distance`, as
/// long as the boxes fit tightly.
pub(crate) fn each_touching<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    max_distance: N,
    wanted: Touching,
    visitor: &mut dyn TouchingVisitor<N, D>,
) -> bool {
    let [Some(parts1), Some(parts2)] = between.composites() else { return false };
    let trees = [parts1, parts2].mapped(|parts| parts.search().as_tree()?.packed_whole());
    let [Some(tree1), Some(tree2)] = trees else { return false };
    let distances =
        [&between.pair.pose12, &between.pose21].mapped(|pose| max_component(&pose.translation));
    // Translations beyond `f32` make the boxes infinite.
    if distances.iter().any(|distance| !distance.as_f32().is_finite()) {
        return false;
    }
    let sizes = [parts1, parts2].mapped(|parts| extent(&parts.search().bounds()));
    let size = sizes[0] + sizes[1] + max(distances[0], distances[1]);
    let mut search = TouchingSearch {
        between,
        parts: [parts1, parts2],
        max_distance: Some(max_distance),
        slack: if wanted == Touching::Nearest { gap_slack(size) } else { N::ZERO },
        wanted,
        own: None,
        kept: [[0; 2]; LANES],
        pairs: PartPairs::new(max(distances[0], distances[1])),
        visitor,
    };
    visit_touching([tree1, tree2], &mut search);
    search.flush();
    true
}

/// Search of two trees for pairs of parts, with up to 8 pairs waiting for the lanes.
struct TouchingSearch<'a, 'q, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    parts: [&'a dyn CompositeShape<N, D>; 2],
    max_distance: Option<N>,
    /// Rounding error by which the computed distance of boxes may exceed the distance of the parts
    /// in them; zero unless the nearest pair is wanted.
    slack: N,
    wanted: Touching,
    /// Corners of the current part in the frame of the other composite; `None` for a part without
    /// corners.
    own: Option<[Vector<N, D>; 3]>,
    /// Pairs in the lanes, waiting for a full batch.
    kept: [[u32; 2]; LANES],
    pairs: PartPairs<N, D>,
    visitor: &'q mut dyn TouchingVisitor<N, D>,
}

impl<N: Space<D>, const D: usize> TouchingSearch<'_, '_, N, D> {
    /// Returns whether two parts are farther apart than `max_distance` along the line through the
    /// means of their three corners (the first end of a segment counts twice); always `false`
    /// unless the nearest pair is wanted. This rejects most pairs whose boxes are near.
    fn are_beyond(&self, one: &[Vector<N, D>; 3], other: &[Vector<N, D>; 3]) -> bool {
        let Some(max_distance) = self.max_distance.filter(|_| self.wanted == Touching::Nearest)
        else {
            return false;
        };
        let axis = (other[0] + other[1] + other[2]) - (one[0] + one[1] + one[2]);
        let [gap1, gap2] = [range(one, &axis)[1], range(other, &axis)[0]];
        gap2 - gap1 > (max_distance + self.slack) * axis.norm()
    }

    /// Passes a pair to the visitor and stores the returned distance as `max_distance`. Does
    /// nothing after the search has ended.
    fn found(&mut self, pair: [u32; 2]) {
        self.max_distance = self.max_distance.and_then(|_| self.visitor.visit(pair));
    }

    /// Tests the waiting pairs in lanes, and visits the pairs that are not certainly beyond
    /// `max_distance`.
    fn flush(&mut self) {
        let (mut looked_at, mut within) = (0, None);
        while let Some(max_distance) = self.max_distance.filter(|_| looked_at < self.pairs.count) {
            // The lanes are tested again only after the distance has shrunk.
            if within.is_none_or(|(known, _)| max_distance < known) {
                let beyond = <N::Algorithms>::part_pairs(&self.pairs, max_distance).beyond;
                within = Some((max_distance, !beyond));
            }
            if within.is_some_and(|(_, lanes)| lanes >> looked_at & 1 == 1) {
                self.found(self.kept[looked_at]);
            }
            looked_at += 1;
        }
        self.pairs.count = 0;
    }

    /// Puts a pair into the next lane, and flushes the lanes if all are full. The corners of both
    /// parts must be in one frame.
    fn keep(&mut self, pair: [u32; 2], one: &[Vector<N, D>; 3], other: &[Vector<N, D>; 3]) {
        let lane = self.pairs.count;
        self.kept[lane] = pair;
        self.pairs.ones.put(lane, &one.mapped(Point::from));
        self.pairs.others.put(lane, &other.mapped(Point::from));
        self.pairs.count += 1;
        if self.pairs.count == LANES {
            self.flush();
        }
    }
}

impl<N: Space<D>, const D: usize> TouchQuery<N, D> for TouchingSearch<'_, '_, N, D> {
    fn pose(&self, which: usize) -> &Pose<N, D> {
        self.between.in_frame_of_other(which).1
    }

    fn max_distance(&self) -> Option<N> {
        self.max_distance.map(|max_distance| max_distance + self.slack)
    }

    fn is_for_nearest(&self) -> bool {
        self.wanted == Touching::Nearest
    }

    fn guess(&mut self, parts: [u32; 2]) {
        self.found(parts);
    }

    fn best(&self) -> Option<Toward<N, D>> {
        let normal = self.visitor.normal()?;
        Some([normal, self.pose(0).vector(&-normal)])
    }

    /// Returns the box of a part in the frame of the other composite; also stores the transformed
    /// corners in `own`.
    fn object_in_other(&mut self, which: usize, id: u32) -> Aabb<N, D> {
        let pose = self.pose(which);
        let own = corners_of(self.parts[which], id);
        self.own = own.map(|own| own.mapped(|corner| pose.point(&Point::from(corner)).coords));
        let Some([a, b, c]) = self.own else { return self.between.aabb_in_other(which, id) };
        let (mut low, mut high) = (a, a);
        for axis in 0..D {
            low[axis] = min(min(a[axis], b[axis]), c[axis]);
            high[axis] = max(max(a[axis], b[axis]), c[axis]);
        }
        Aabb::try_new(low.into(), high.into()).unwrap_or_else(|_| Aabb::unbounded())
    }

    fn corners(&self) -> Option<[Vector<N, D>; 3]> {
        self.own
    }

    /// Drops each pair for which [`Self::are_beyond`] returns `true`. Puts the other pairs into the
    /// lanes, except that a pair with a part without corners is visited directly.
    fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
        for &other in others {
            let pair = if which == 0 { [own, other] } else { [other, own] };
            match (self.own, corners_of(self.parts[1 - which], other)) {
                (Some(one), Some(other)) if self.are_beyond(&one, &other) => {}
                (Some(one), Some(other)) => self.keep(pair, &one, &other),
                _ => self.found(pair),
            }
        }
        if self.wanted == Touching::Any {
            self.flush();
        }
    }
}
