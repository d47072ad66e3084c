//! Finds the pairs of parts of two shapes that may be within the prediction.

use smallvec::SmallVec;

use super::cull::LowerBoundQuery;
use super::faces::has_faces;
use super::part_cache::PartCache;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::packet::LANES;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::{aabb_of, enclosing, loosened};
use crate::collide::parts::{Touching, TouchingVisitor, each_touching};
use crate::math::ones::Ones;
use crate::math::{Point, Pose, Real, Space, min};
use crate::shape::{CompositeShape, Part};

/// Pairs of part indices; 0 stands for a convex shape.
pub(super) type PartPairs = SmallVec<[[u32; 2]; 24]>;

/// Masks of the packets of the cache, one for each packet: bit `i` is set if part `i` of the packet
/// is a candidate.
pub(super) type CandidateMasks = SmallVec<[u8; 8]>;

/// Result of [`culled`]: the pairs of parts that may be within a distance.
pub(crate) struct CulledParts<N: Real> {
    /// Pairs in ascending order.
    pub(super) parts: PartPairs,
    /// The second parts of `parts`, as bits of the cached packets; empty if the cache holds no
    /// corners or was not used.
    pub(super) masks: CandidateMasks,
    /// Lower bound of the distance from the centre of a convex first shape to the second shape;
    /// zero if unknown.
    pub(super) clearance: N,
}

/// Finds the parts of a convex solid and a composite, or of two composites, that may be within
/// `max_distance`. A part of the composite with cached corners is culled if a separating plane
/// proves that it is farther from the solid.
///
/// `around` must be the cache of the second shape. It is refilled if its box is too small.
pub(super) fn culled<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    is_self: bool,
    max_distance: N,
    around: &mut PartCache<N, D>,
) -> CulledParts<N> {
    if let [None, Some(parts2)] = between.composites() {
        let aabb = search_box(between, max_distance);
        if around.covers(parts2, &aabb)
            && let Some(query) = LowerBoundQuery::new(between, max_distance, around, &aabb)
        {
            let culled = cull_kept(&query, parts2, around, &aabb);
            if has_faces(between.pair.first) {
                around.learn_seams(parts2, &culled.masks);
            }
            return culled;
        }
    }
    let parts = candidates(between, is_self, max_distance);
    CulledParts { parts, masks: CandidateMasks::new(), clearance: N::ZERO }
}

/// Returns the cached parts that lower bounds do not cull or, if no corners are cached, the parts
/// whose boxes overlap `aabb`.
fn cull_kept<N: Space<D>, const D: usize>(
    query: &LowerBoundQuery<N, D>,
    composite: &dyn CompositeShape<N, D>,
    around: &PartCache<N, D>,
    aabb: &Aabb<N, D>,
) -> CulledParts<N> {
    let (mut parts, mut masks) = (PartPairs::new(), CandidateMasks::new());
    let mut clearance = depth_in(aabb, &query.middle());
    for (kept, tiles) in around.parts().chunks(LANES).zip(around.tiles()) {
        let bounds = query.bounds(tiles);
        clearance = min(clearance, bounds.from_middle);
        // Lanes beyond the last part hold copies of that part.
        let bits = bounds.mask & (u8::MAX >> (LANES - kept.len()));
        masks.push(bits);
        parts.extend(Ones::<LANES>(bits.into()).map(|lane| [0, kept[lane]]));
    }
    if around.tiles().is_empty() {
        clearance = N::ZERO;
        parts.extend(around.parts().iter().filter_map(|&part2| {
            let Part { pose, solid } = composite.part(part2);
            aabb.intersects(&solid.as_shape().aabb(&pose)).then_some([0, part2])
        }));
    }
    CulledParts { parts, masks, clearance }
}

/// Returns a box, in the frame of the second shape, that encloses all points within `max_distance`
/// of the first.
pub(super) fn search_box<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    max_distance: N,
) -> Aabb<N, D> {
    let aabb = aabb_of(between.pair.first, &between.pose21).loosened(max_distance);
    enclosing(&aabb, &between.pose21)
}

/// Returns the distance of a point inside a box from the box's boundary; negative if it is outside.
pub(super) fn depth_in<N: Real, const D: usize>(aabb: &Aabb<N, D>, point: &Point<N, D>) -> N {
    let mut least = N::INFINITY;
    for axis in 0..D {
        let at = point[axis];
        least = min(aabb.maxs()[axis] - at, min(at - aabb.mins()[axis], least));
    }
    least
}

/// Returns the pairs of parts that may be within `max_distance` of each other, by their boxes or by
/// [`each_touching`], in ascending order. Index 0 stands for a convex shape.
///
/// For a shape with itself (`is_self`), returns the pairs of parts that are not adjacent, each
/// once.
pub(super) fn candidates<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    is_self: bool,
    max_distance: N,
) -> PartPairs {
    let mut found = PartPairs::new();
    match between.composites() {
        [Some(parts), Some(_)] if is_self => of_one(parts, max_distance, &mut found),
        [Some(parts1), Some(parts2)] => of_two(between, parts1, parts2, max_distance, &mut found),
        [None, Some(parts2)] => {
            let aabb = search_box(between, max_distance);
            parts2.search().overlapping(&aabb, &mut |part2| found.push([0, part2]));
        }
        // In the order of kinds a composite comes second: if the second shape is not a composite,
        // neither is the first.
        [_, None] => {}
    }
    found.sort_unstable();
    found
}

/// Visitor that collects all pairs, with the constant limit `max_distance`.
struct FoundPairs<'a, N> {
    max_distance: N,
    found: &'a mut PartPairs,
}

impl<N: Real, const D: usize> TouchingVisitor<N, D> for FoundPairs<'_, N> {
    fn visit(&mut self, parts: [u32; 2]) -> Option<N> {
        self.found.push(parts);
        Some(self.max_distance)
    }
}

/// Appends the pairs of parts of two composites that may be within `max_distance`. If both
/// composites have trees, [`each_touching`] finds the pairs by a simultaneous descent of the trees
/// and tests the two parts of each pair. Otherwise, each part of the composite with fewer parts
/// that is near the larger composite searches the larger composite.
fn of_two<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    parts1: &dyn CompositeShape<N, D>,
    parts2: &dyn CompositeShape<N, D>,
    max_distance: N,
    found: &mut PartPairs,
) {
    if between.are_boxes_beyond(loosened(max_distance)) {
        return;
    }
    let mut found_pairs = FoundPairs { max_distance, found };
    if each_touching(between, max_distance, Touching::Each, &mut found_pairs) {
        return;
    }
    let FoundPairs { found, .. } = found_pairs;
    let poses = [&between.pose21, &between.pair.pose12];
    let is_first = parts1.num_parts() <= parts2.num_parts();
    let (fewer, more) = if is_first { (parts1, parts2) } else { (parts2, parts1) };
    let (to_more, to_fewer) = if is_first { (poses[0], poses[1]) } else { (poses[1], poses[0]) };
    let whole = more.search().bounds().transformed_by(to_fewer).loosened(max_distance);
    fewer.search().overlapping(&enclosing(&whole, to_fewer), &mut |part| {
        let aabb = box_of_part(fewer, part, to_more, max_distance);
        more.search().overlapping(&aabb, &mut |other| {
            found.push(if is_first { [part, other] } else { [other, part] });
        });
    });
}

/// Appends the pairs of parts of one composite whose boxes are within `max_distance` and that are
/// not adjacent, the smaller index first.
fn of_one<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    max_distance: N,
    found: &mut PartPairs,
) {
    for part1 in 0..parts.num_parts() {
        let aabb = box_of_part(parts, part1, &Pose::identity(), max_distance);
        parts.search().overlapping(&aabb, &mut |part2| {
            if part1 < part2 && !parts.are_adjacent(part1, part2) {
                found.push([part1, part2]);
            }
        });
    }
}

/// Returns the box of the part `index`, loosened by `max_distance`, in the frame to which `pose`
/// transforms the composite.
fn box_of_part<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    index: u32,
    pose: &Pose<N, D>,
    max_distance: N,
) -> Aabb<N, D> {
    let part = parts.part(index);
    enclosing(&part.solid.as_shape().aabb(&pose.compose(&part.pose)).loosened(max_distance), pose)
}
