//! Which parts may touch.

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::{Point, Pose, Real, Space, max};
use crate::query::Pair;
use crate::query::composite::separation::aabb_of;
use crate::shape::{CompositeShape, Geometry, SupportMap};

/// The pairs of parts whose boxes are within `reach` of each other, in order; 0 stands for a shape
/// that is not a composite.
///
/// Of a shape with itself: the pairs of parts that do not hang together, each once.
pub(super) fn candidates<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    is_self: bool,
    reach: N,
) -> Vec<[u32; 2]> {
    let mut found = Vec::new();
    match (Geometry(pair.first).as_composite(), Geometry(pair.second).as_composite()) {
        (Some(parts), Some(_)) if is_self => of_one(parts, reach, &mut found),
        (Some(parts1), Some(parts2)) => of_two(pair, (parts1, parts2), reach, &mut found),
        (_, Some(parts2)) => {
            let aabb = aabb_of(pair.first, &pair.pose12.inverse());
            let aabb = grown(&aabb, reach);
            parts2.search().overlapping(&aabb, &mut |part2| found.push([0, part2]));
        }
        // Composites come last among the kinds.
        (_, None) => {}
    }
    found.sort_unstable();
    found
}

/// The parts of one of two composites, each looked up in the other: of the one with fewer parts.
fn of_two<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    (parts1, parts2): (&dyn CompositeShape<N, D>, &dyn CompositeShape<N, D>),
    reach: N,
    found: &mut Vec<[u32; 2]>,
) {
    if parts1.num_parts() <= parts2.num_parts() {
        let pose21 = pair.pose12.inverse();
        for part1 in 0..parts1.num_parts() {
            let aabb = box_of_part(parts1, part1, &pose21, reach);
            parts2.search().overlapping(&aabb, &mut |part2| found.push([part1, part2]));
        }
        return;
    }
    for part2 in 0..parts2.num_parts() {
        let aabb = box_of_part(parts2, part2, &pair.pose12, reach);
        parts1.search().overlapping(&aabb, &mut |part1| found.push([part1, part2]));
    }
}

/// The parts of one composite, each with those of larger numbers.
fn of_one<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    reach: N,
    found: &mut Vec<[u32; 2]>,
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

/// The box of a part seen from the frame that `pose` leads to.
fn box_of_part<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    index: u32,
    pose: &Pose<N, D>,
    reach: N,
) -> Aabb<N, D> {
    let part = parts.part(index);
    grown(&part.solid.as_shape().aabb(&pose.compose(&part.pose)), reach)
}

/// The box grown by a length, and by a few units in the last place for the rounding of its faces.
fn grown<N: Real, const D: usize>(aabb: &Aabb<N, D>, reach: N) -> Aabb<N, D> {
    let faces = aabb.mins().iter().chain(aabb.maxs().iter());
    let finite = faces.filter(|x| x.is_finite_number());
    let farthest = finite.fold(reach, |farthest, x| max(farthest, x.abs()));
    aabb.loosened(reach + N::lit(16.0) * N::EPSILON * farthest)
}

/// A point of the first shape's frame near which the parts lie: what all is computed from.
pub(super) fn middle<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    found: &[[u32; 2]],
) -> Point<N, D> {
    let Some(parts) = Geometry(pair.first).as_composite() else {
        let map = Geometry(pair.first).as_support_map();
        return map.map_or_else(Point::origin, SupportMap::center);
    };
    let one = |&[part1, _]: &[u32; 2]| {
        let part = parts.part(part1);
        part.solid.as_shape().aabb(&part.pose)
    };
    let all = found.iter().map(one).reduce(|all, aabb| all.merged(&aabb));
    all.filter(Aabb::is_bounded).map_or_else(Point::origin, |all| all.center())
}
