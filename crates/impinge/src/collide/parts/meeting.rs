//! Which parts of two composites that are searched by trees may be within reach of each other.
//!
//! The trees tell by boxes; the pairs that these leave are held against each other in lanes ([`pair_lanes`]), along every
//! direction that may part two triangles.
//!
//! [`pair_lanes`]: super::pair_lanes

use super::between::Between;
use super::pair_lanes::PartPairs;
use super::slabs::corners;
use crate::bounding_volume::Aabb;
use crate::bvh::{TreeMeeting, visit_meetings};
use crate::collide::packet::LANES;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::CompositeShape;
use crate::tables::ByDimension;

/// What is done with pairs of parts; answers whether more are asked for.
type MeetingVisitor<'v> = &'v mut dyn FnMut([u32; 2]) -> bool;

/// Calls `visit` with the pairs of parts that may be within `reach`, as long as it answers true; answers false of
/// composites that are not searched by trees. Where it is likely to end the search, pairs are not kept back for others.
///
/// Cost: O(n + k) for k pairs whose boxes are within reach of n blocks that are, as long as boxes are good ones.
pub(crate) fn each_meeting<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    reach: N,
    is_ending: bool,
    visit: MeetingVisitor<'_>,
) -> bool {
    let [Some(parts1), Some(parts2)] = between.composites() else { return false };
    let trees = [parts1, parts2].mapped(|parts| parts.search().as_tree()?.packed_whole());
    let [Some(tree1), Some(tree2)] = trees else { return false };
    let ways =
        [&between.pair.pose12, &between.pose21].mapped(|pose| max_component(&pose.translation));
    let mut meeting = PartMeetings {
        between,
        parts: [parts1, parts2],
        reach,
        is_ending,
        own: None,
        kept: [[0; 2]; LANES],
        pairs: PartPairs::new(max(ways[0], ways[1])),
        goes_on: true,
        visit,
    };
    visit_meetings([tree1, tree2], &mut meeting);
    meeting.flush();
    true
}

struct PartMeetings<'a, 'q, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    parts: [&'a dyn CompositeShape<N, D>; 2],
    reach: N,
    is_ending: bool,
    /// The corners of the part that is looked at, in the frame of the other composite, if it is given by them.
    own: Option<[Vector<N, D>; 3]>,
    /// The numbers of the pairs that are kept back.
    kept: [[u32; 2]; LANES],
    pairs: PartPairs<N, D>,
    goes_on: bool,
    visit: MeetingVisitor<'q>,
}

impl<N: Space<D>, const D: usize> PartMeetings<'_, '_, N, D> {
    fn found(&mut self, pair: [u32; 2]) {
        self.goes_on = self.goes_on && (self.visit)(pair);
    }

    /// Visits the pairs that are kept back, but for those that are certainly beyond reach.
    fn flush(&mut self) {
        if self.pairs.count == 0 {
            return;
        }
        let beyond = <N::Algorithms>::part_pairs(&self.pairs, self.reach).beyond;
        for lane in 0..self.pairs.count {
            if beyond >> lane & 1 == 0 {
                self.found(self.kept[lane]);
            }
        }
        self.pairs.count = 0;
    }

    /// Keeps a pair back, the corners of both in one frame.
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
        self.goes_on.then_some(self.reach)
    }

    fn object_in_other(&mut self, which: usize, id: u32) -> Aabb<N, D> {
        let part = self.parts[which].part(id);
        let pose = self.pose(which).compose(&part.pose);
        self.own = corners(&part.solid, &pose);
        let Some([a, b, c]) = self.own else { return self.between.aabb_in_other(which, id) };
        let (mut low, mut high) = (a, a);
        for axis in 0..D {
            low[axis] = min(min(a[axis], b[axis]), c[axis]);
            high[axis] = max(max(a[axis], b[axis]), c[axis]);
        }
        Aabb::try_new(low.into(), high.into()).unwrap_or_else(|_| Aabb::unbounded())
    }

    fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
        for &other in others {
            let pair = if which == 0 { [own, other] } else { [other, own] };
            let part = self.parts[1 - which].part(other);
            match (self.own, corners(&part.solid, &part.pose)) {
                (Some(one), Some(other)) => self.keep(pair, &one, &other),
                _ => self.found(pair),
            }
        }
        if self.is_ending {
            self.flush();
        }
    }
}
