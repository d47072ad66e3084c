//! Pairs of parts of two composites, both searched by trees, that may be within reach of each
//! other.
//!
//! The trees reject pairs by boxes. The remaining pairs are tested in SIMD lanes ([`pair_lanes`]),
//! along every axis that may separate two triangles.
//!
//! [`pair_lanes`]: super::pair_lanes

use super::between::Between;
use super::bounds::extent;
use super::pair_lanes::PartPairs;
use super::slabs::{corners, range};
use super::solid_bounds::gap_slack;
use crate::bounding_volume::Aabb;
use crate::bvh::{Toward, TreeMeeting, visit_meetings};
use crate::collide::packet::LANES;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::{CompositeShape, TriMesh};
use crate::tables::ByDimension;

/// Receives the pairs of parts that a search finds.
pub(crate) trait MeetingVisitor<N: Real, const D: usize> {
    /// Handles two parts. Returns the reach from now on, which must never grow; `None` ends the
    /// search.
    fn visit(&mut self, parts: [u32; 2]) -> Option<N>;

    /// The unit vector from the first composite to the second between the best parts so far, in the
    /// frame of the first.
    fn normal(&self) -> Option<Vector<N, D>> {
        None
    }
}

/// The pairs of parts that a search looks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meetings {
    /// All within reach, each once.
    Each,
    /// Any pair: one is likely to end the search, so that no pair waits for a full batch of lanes.
    Any,
    /// The nearest: the reach shrinks to the best distance. A pair that is likely to be near comes
    /// first, and may come twice.
    Nearest,
}

/// Visits the pairs of parts that may be within `reach`. Returns false, without a visit, for
/// composites that are not searched by trees or are too far away for boxes of `f32`.
///
/// Cost: O(n + k) for k pairs with boxes within reach in n blocks within reach, as long as the
/// boxes fit tightly.
pub(crate) fn each_meeting<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    reach: N,
    wanted: Meetings,
    visitor: &mut dyn MeetingVisitor<N, D>,
) -> bool {
    let [Some(parts1), Some(parts2)] = between.composites() else { return false };
    let trees = [parts1, parts2].mapped(|parts| parts.search().as_tree()?.packed_whole());
    let [Some(tree1), Some(tree2)] = trees else { return false };
    let ways =
        [&between.pair.pose12, &between.pose21].mapped(|pose| max_component(&pose.translation));
    // Translations beyond `f32` make the boxes infinite.
    if ways.iter().any(|way| !way.as_f32().is_finite()) {
        return false;
    }
    let sizes = [parts1, parts2].mapped(|parts| extent(&parts.search().bounds()));
    let size = sizes[0] + sizes[1] + max(ways[0], ways[1]);
    let mut meeting = PartMeetings {
        between,
        parts: [parts1, parts2],
        meshes: [parts1.as_mesh(), parts2.as_mesh()],
        reach: Some(reach),
        slack: if wanted == Meetings::Nearest { gap_slack(size) } else { N::ZERO },
        wanted,
        own: None,
        kept: [[0; 2]; LANES],
        pairs: PartPairs::new(max(ways[0], ways[1])),
        visitor,
    };
    visit_meetings([tree1, tree2], &mut meeting);
    meeting.flush();
    true
}

/// A search of two trees for pairs of parts, with up to eight pairs waiting for the lanes.
struct PartMeetings<'a, 'q, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    parts: [&'a dyn CompositeShape<N, D>; 2],
    /// The composites that are meshes, for quicker access to corners.
    meshes: [Option<&'a TriMesh<N, D>>; 2],
    reach: Option<N>,
    /// Boxes may be farther apart than the nearest parts by this rounding error.
    slack: N,
    wanted: Meetings,
    /// The corners of the current part in the frame of the other composite; `None` for a shape
    /// without corners.
    own: Option<[Vector<N, D>; 3]>,
    /// The pairs in the lanes, waiting for a full batch.
    kept: [[u32; 2]; LANES],
    pairs: PartPairs<N, D>,
    visitor: &'q mut dyn MeetingVisitor<N, D>,
}

impl<N: Space<D>, const D: usize> PartMeetings<'_, '_, N, D> {
    /// Returns the corners of a part of the first shape (0) or the second (1), in its frame; `None`
    /// for a part without.
    fn corners_of(&self, which: usize, id: u32) -> Option<[Vector<N, D>; 3]> {
        if let Some(mesh) = self.meshes[which] {
            return Some(mesh.corners(id).mapped(|corner| corner.coords));
        }
        let part = self.parts[which].part(id);
        corners(&part.solid, &part.pose)
    }

    /// Whether two parts are beyond reach along the line through their centroids; this rejects most
    /// pairs that boxes do not.
    fn are_beyond(&self, one: &[Vector<N, D>; 3], other: &[Vector<N, D>; 3]) -> bool {
        let Some(reach) = self.reach.filter(|_| self.wanted == Meetings::Nearest) else {
            return false;
        };
        let way = (other[0] + other[1] + other[2]) - (one[0] + one[1] + one[2]);
        let [gap1, gap2] = [range(one, &way)[1], range(other, &way)[0]];
        gap2 - gap1 > (reach + self.slack) * way.norm()
    }

    /// Passes a pair to the visitor, which returns the new reach.
    fn found(&mut self, pair: [u32; 2]) {
        self.reach = self.reach.and_then(|_| self.visitor.visit(pair));
    }

    /// Tests the waiting pairs in lanes and visits those not certainly beyond reach.
    fn flush(&mut self) {
        let (mut looked_at, mut within) = (0, None);
        while let Some(reach) = self.reach.filter(|_| looked_at < self.pairs.count) {
            // The lanes are tested again only after the reach has shrunk.
            if within.is_none_or(|(known, _)| reach < known) {
                let beyond = <N::Algorithms>::part_pairs(&self.pairs, reach).beyond;
                within = Some((reach, !beyond));
            }
            if within.is_some_and(|(_, lanes)| lanes >> looked_at & 1 == 1) {
                self.found(self.kept[looked_at]);
            }
            looked_at += 1;
        }
        self.pairs.count = 0;
    }

    /// Puts a pair into the next lane; the corners of both parts are in one frame.
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

impl<N: Space<D>, const D: usize> TreeMeeting<N, D> for PartMeetings<'_, '_, N, D> {
    fn pose(&self, which: usize) -> &Pose<N, D> {
        self.between.seen_by_other(which).1
    }

    fn reach(&self) -> Option<N> {
        self.reach.map(|reach| reach + self.slack)
    }

    fn is_for_nearest(&self) -> bool {
        self.wanted == Meetings::Nearest
    }

    fn guess(&mut self, parts: [u32; 2]) {
        self.found(parts);
    }

    fn best(&self) -> Option<Toward<N, D>> {
        let normal = self.visitor.normal()?;
        Some([normal, self.pose(0).vector(&-normal)])
    }

    /// Also keeps the transformed corners of the part in `own`.
    fn object_in_other(&mut self, which: usize, id: u32) -> Aabb<N, D> {
        let pose = self.pose(which);
        let own = self.corners_of(which, id);
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

    /// Rejects pairs along the line through their centroids, puts those with corners into the
    /// lanes, and visits all others at once.
    fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
        for &other in others {
            let pair = if which == 0 { [own, other] } else { [other, own] };
            match (self.own, self.corners_of(1 - which, other)) {
                (Some(one), Some(other)) if self.are_beyond(&one, &other) => {}
                (Some(one), Some(other)) => self.keep(pair, &one, &other),
                _ => self.found(pair),
            }
        }
        if self.wanted == Meetings::Any {
            self.flush();
        }
    }
}
