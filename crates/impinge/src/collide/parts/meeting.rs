//! Which parts of two composites that are searched by trees may be within reach of each other.
//!
//! The trees tell by boxes; what these leave is held against each other in lanes, one part against eight
//! ([`slab_lanes`](super::slab_lanes)), along every direction that may part two triangles.

use super::between::Between;
use super::slabs::{AxisSlabs, corners};
use crate::bounding_volume::Aabb;
use crate::bvh::{TreeMeeting, visit_meetings};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::{Mapped, Point, Pose, Real, Space};
use crate::shape::CompositeShape;
use crate::tables::ByDimension;

/// Calls `visit` with the pairs of parts that may be within `reach`, as long as it answers true, those whose boxes are
/// deep in each other first; answers false of composites that are not searched by trees.
pub(crate) fn each_meeting<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    reach: N,
    visit: &mut dyn FnMut([u32; 2]) -> bool,
) -> bool {
    let [Some(parts1), Some(parts2)] = between.composites() else { return false };
    let trees = [parts1, parts2].mapped(|parts| parts.search().as_tree()?.packed_whole());
    let [Some(tree1), Some(tree2)] = trees else { return false };
    let parts = [parts1, parts2];
    let mut meeting = PartMeetings { between, parts, reach, goes_on: true, visit };
    visit_meetings([tree1, tree2], &mut meeting);
    true
}

struct PartMeetings<'a, 'q, N: Real, const D: usize> {
    between: &'a Between<'a, N, D>,
    parts: [&'a dyn CompositeShape<N, D>; 2],
    reach: N,
    goes_on: bool,
    visit: &'q mut dyn FnMut([u32; 2]) -> bool,
}

impl<N: Space<D>, const D: usize> TreeMeeting<N, D> for PartMeetings<'_, '_, N, D> {
    fn pose(&self, which: usize) -> &Pose<N, D> {
        self.between.seen_by_other(which).1
    }

    fn reach(&self) -> Option<N> {
        self.goes_on.then_some(self.reach)
    }

    fn object_in_other(&self, which: usize, id: u32) -> Aabb<N, D> {
        self.between.aabb_in_other(which, id)
    }

    fn visit(&mut self, which: usize, own: u32, others: &[u32]) {
        let slabs = AxisSlabs::of_part(self.between, which, own, None);
        for group in others.chunks(LANES) {
            let (mut tiles, mut known) = (PartPacket::blank(), [false; LANES]);
            for (lane, &other) in group.iter().enumerate() {
                let part = self.parts[1 - which].part(other);
                if let Some(corners) = corners(&part.solid, &part.pose) {
                    tiles.put(lane, &corners.mapped(Point::from));
                    known[lane] = true;
                }
            }
            let gaps = <N::Algorithms>::part_gaps(&slabs, &tiles, self.reach);
            for ((&other, gap), is_known) in group.iter().zip(gaps).zip(known) {
                let is_beyond = is_known && gap > self.reach;
                if !is_beyond {
                    let pair = if which == 0 { [own, other] } else { [other, own] };
                    self.goes_on = self.goes_on && (self.visit)(pair);
                }
            }
        }
    }
}
