//! Finds the pairs of parts that may touch.

use smallvec::SmallVec;

use super::cull::LowerBoundQuery;
use super::faces::has_faces;
use super::part_cache::PartCache;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::packet::LANES;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::{aabb_of, enclosing, loosened};
use crate::collide::parts::{MeetingVisitor, Meetings, each_meeting};
use crate::math::ones::Ones;
use crate::math::{Point, Pose, Real, Space, min};
use crate::shape::{CompositeShape, Part};

/// Pairs of part indices; 0 stands for a convex shape.
pub(super) type PartPairs = SmallVec<[[u32; 2]; 24]>;

/// For each tile a byte with a bit for each of its eight parts.
pub(super) type NearBits = SmallVec<[u8; 8]>;

/// The pairs of parts that may be within a distance.
pub(crate) struct Nearby<N: Real> {
    /// Sorted.
    pub(super) parts: PartPairs,
    /// The parts of the second shape in `parts`, as bits of the cached tiles; empty without tiles.
    pub(super) near: NearBits,
    /// Lower bound of the distance from the centre of a convex first shape to the second shape;
    /// zero if unknown.
    pub(super) clearance: N,
}

/// Finds the parts of a convex solid and a composite, or of two composites, that may be within
/// `reach`. Parts that a separating plane proves to be farther are culled.
///
/// `around` must belong to the same composite. It is refilled if its box is too small.
pub(super) fn nearby<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    is_self: bool,
    reach: N,
    around: &mut PartCache<N, D>,
) -> Nearby<N> {
    if let [None, Some(parts2)] = between.composites() {
        let aabb = search_box(between, reach);
        if around.reaches(parts2, &aabb)
            && let Some(query) = LowerBoundQuery::new(between, reach, around, &aabb)
        {
            let nearby = near_kept(&query, parts2, around, &aabb);
            if has_faces(between.pair.first) {
                around.learn_seams(parts2, &nearby.near);
            }
            return nearby;
        }
    }
    let parts = candidates(between, is_self, reach);
    Nearby { parts, near: NearBits::new(), clearance: N::ZERO }
}

/// Culls the cached parts by lower bounds, or by their boxes if parts have no cached corners.
fn near_kept<N: Space<D>, const D: usize>(
    query: &LowerBoundQuery<N, D>,
    composite: &dyn CompositeShape<N, D>,
    around: &PartCache<N, D>,
    aabb: &Aabb<N, D>,
) -> Nearby<N> {
    let (mut parts, mut near) = (PartPairs::new(), NearBits::new());
    let mut clearance = depth_in(aabb, &query.middle());
    for (kept, tiles) in around.parts().chunks(LANES).zip(around.tiles()) {
        let bounds = query.bounds(tiles);
        clearance = min(clearance, bounds.from_middle);
        // The lanes beyond the last part hold copies of it.
        let bits = bounds.near & (u8::MAX >> (LANES - kept.len()));
        near.push(bits);
        parts.extend(Ones::<LANES>(bits.into()).map(|lane| [0, kept[lane]]));
    }
    if around.tiles().is_empty() {
        clearance = N::ZERO;
        parts.extend(around.parts().iter().filter_map(|&part2| {
            let Part { pose, solid } = composite.part(part2);
            aabb.intersects(&solid.as_shape().aabb(&pose)).then_some([0, part2])
        }));
    }
    Nearby { parts, near, clearance }
}

/// Returns a box in the frame of the second shape that encloses all points within `reach` of the
/// first.
pub(super) fn search_box<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    reach: N,
) -> Aabb<N, D> {
    let aabb = aabb_of(between.pair.first, &between.pose21).loosened(reach);
    enclosing(&aabb, &between.pose21)
}

/// The distance of a point from the boundary of a box that holds it; negative outside.
pub(super) fn depth_in<N: Real, const D: usize>(aabb: &Aabb<N, D>, point: &Point<N, D>) -> N {
    let mut least = N::INFINITY;
    for axis in 0..D {
        let at = point[axis];
        least = min(aabb.maxs()[axis] - at, min(at - aabb.mins()[axis], least));
    }
    least
}

/// Returns the pairs of parts whose boxes are within `reach` of each other, sorted; 0 stands for a
/// convex shape.
///
/// For a shape with itself: the pairs of parts that are not adjacent, each once.
pub(super) fn candidates<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    is_self: bool,
    reach: N,
) -> PartPairs {
    let mut found = PartPairs::new();
    match between.composites() {
        [Some(parts), Some(_)] if is_self => of_one(parts, reach, &mut found),
        [Some(parts1), Some(parts2)] => of_two(between, parts1, parts2, reach, &mut found),
        [None, Some(parts2)] => {
            let aabb = search_box(between, reach);
            parts2.search().overlapping(&aabb, &mut |part2| found.push([0, part2]));
        }
        // In the order of kinds, composites come last.
        [_, None] => {}
    }
    found.sort_unstable();
    found
}

/// Collects all pairs, with a constant limit.
struct NearPairs<'a, N> {
    reach: N,
    found: &'a mut PartPairs,
}

impl<N: Real, const D: usize> MeetingVisitor<N, D> for NearPairs<'_, N> {
    fn visit(&mut self, parts: [u32; 2]) -> Option<N> {
        self.found.push(parts);
        Some(self.reach)
    }
}

/// Finds the parts of two composites that may be within `reach`: by their trees, which test the
/// parts too. Without trees, each part of the composite with fewer parts that is near the other
/// composite is looked up there.
fn of_two<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    parts1: &dyn CompositeShape<N, D>,
    parts2: &dyn CompositeShape<N, D>,
    reach: N,
    found: &mut PartPairs,
) {
    if between.are_boxes_beyond(loosened(reach)) {
        return;
    }
    let mut near = NearPairs { reach, found };
    if each_meeting(between, reach, Meetings::Each, &mut near) {
        return;
    }
    let NearPairs { found, .. } = near;
    let poses = [&between.pose21, &between.pair.pose12];
    let is_first = parts1.num_parts() <= parts2.num_parts();
    let (fewer, more) = if is_first { (parts1, parts2) } else { (parts2, parts1) };
    let (to_more, to_fewer) = if is_first { (poses[0], poses[1]) } else { (poses[1], poses[0]) };
    let whole = more.search().bounds().transformed_by(to_fewer).loosened(reach);
    fewer.search().overlapping(&enclosing(&whole, to_fewer), &mut |part| {
        let aabb = box_of_part(fewer, part, to_more, reach);
        more.search().overlapping(&aabb, &mut |other| {
            found.push(if is_first { [part, other] } else { [other, part] });
        });
    });
}

/// Finds the pairs of parts of one composite, the smaller index first.
fn of_one<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    reach: N,
    found: &mut PartPairs,
) {
    for part1 in 0..parts.num_parts() {
        let aabb = box_of_part(parts, part1, &Pose::identity(), reach);
        parts.search().overlapping(&aabb, &mut |part2| {
            if part1 < part2 && !parts.are_adjacent(part1, part2) {
                found.push([part1, part2]);
            }
        });
    }
}

/// The box of a part, loosened by `reach`, in the frame that `pose` maps to.
fn box_of_part<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    index: u32,
    pose: &Pose<N, D>,
    reach: N,
) -> Aabb<N, D> {
    let part = parts.part(index);
    enclosing(&part.solid.as_shape().aabb(&pose.compose(&part.pose)).loosened(reach), pose)
}
