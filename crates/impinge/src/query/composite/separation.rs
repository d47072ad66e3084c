//! How far a composite is from another shape: as far as the nearest of its parts.

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::convex::Separation;
use crate::math::{Pose, Real, Space, max};
use crate::query::Pair;
use crate::shape::{CompositeShape, Geometry, Kind, Shape};

/// The separation of two parts, and which parts they are.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PartSeparation<N: Real, const D: usize> {
    pub(crate) separation: Separation<N, D>,
    /// The part of the first and of the second; 0 of a solid that is no composite.
    pub(crate) parts: [u32; 2],
}

/// The entry of the pair table.
pub(in crate::query) fn separation<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    nearest(pair, limit).map(|found| found.separation)
}

/// The separation of the two parts that are nearest to each other, or deepest in each other; of
/// several the first by number.
pub(crate) fn nearest<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<PartSeparation<N, D>> {
    match (Geometry(pair.first).as_composite(), Geometry(pair.second).as_composite()) {
        (_, Some(parts2)) => nearest_of_second(pair, parts2, limit),
        (Some(_), None) => {
            let pose12 = pair.pose12.inverse();
            let turned = Pair { first: pair.second, second: pair.first, pose12 };
            nearest(&turned, limit).map(|found| PartSeparation {
                separation: found.separation.flipped(&pose12),
                parts: [found.parts[1], found.parts[0]],
            })
        }
        (None, None) => {
            let separation = super::super::separation::separation(pair, limit)?;
            Some(PartSeparation { separation, parts: [0, 0] })
        }
    }
}

/// The nearest of the parts of the second shape.
fn nearest_of_second<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    parts2: &dyn CompositeShape<N, D>,
    limit: N,
) -> Option<PartSeparation<N, D>> {
    let mut best: Option<PartSeparation<N, D>> = None;
    let aabb = aabb_of(pair.first, &pair.pose12.inverse());
    parts2.search().nearest(&aabb, max(limit, N::ZERO), &mut |part2, _| {
        let part = parts2.part(part2);
        let pose12 = pair.pose12.compose(&part.pose);
        let with_part = Pair { first: pair.first, second: part.solid.geometry().0, pose12 };
        let reach = best.map_or(limit, |best| best.separation.distance);
        if let Some(found) = nearest(&with_part, reach) {
            let found = PartSeparation { parts: [found.parts[0], part2], ..found };
            best = Some(best.filter(|best| is_before(best, &found)).unwrap_or(found));
        }
        max(best.map_or(limit, |best| best.separation.distance), N::ZERO)
    });
    best
}

/// Nearer, or as near and earlier by number.
fn is_before<N: Real, const D: usize>(a: &PartSeparation<N, D>, b: &PartSeparation<N, D>) -> bool {
    let (distance1, distance2) = (a.separation.distance, b.separation.distance);
    distance1 < distance2 || (distance1 == distance2 && a.parts <= b.parts)
}

/// The box of a solid of any kind placed at `pose`.
pub(in crate::query) fn aabb_of<N: Space<D>, const D: usize>(
    kind: Kind<'_, N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    match kind {
        Kind::Ball(ball) => Shape::<N, D>::aabb(ball, pose),
        Kind::Segment(segment) => segment.aabb(pose),
        Kind::Capsule(capsule) => capsule.aabb(pose),
        Kind::Triangle(triangle) => triangle.aabb(pose),
        Kind::Cuboid(cuboid) => cuboid.aabb(pose),
        Kind::Plane(plane) => plane.aabb(pose),
        Kind::Ellipsoid(ellipsoid) => ellipsoid.aabb(pose),
        Kind::TaperedCapsule(capsule) => capsule.aabb(pose),
        Kind::Rounded(solid) => aabb_of(solid.inner().0, pose).loosened(solid.swelling()),
        Kind::Polytope(map) => aabb_of_map(map, pose),
        Kind::Cylinder(_, map) | Kind::Cone(_, map) | Kind::SupportMap(map) => {
            aabb_of_map(map, pose)
        }
        Kind::Composite(parts) => aabb_of_parts(parts, pose),
    }
}

/// The box of a support map: of its farthest points along the axes.
fn aabb_of_map<N: Real, const D: usize>(
    map: &dyn crate::shape::SupportMap<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let (mut mins, mut maxs) = (pose.point(&map.center()), pose.point(&map.center()));
    for axis in 0..D {
        let mut outward = crate::math::Vector::<N, D>::zeros();
        outward[axis] = N::ONE;
        let local = pose.inverse_vector(&outward);
        maxs[axis] = pose.point(&map.core_support(&local))[axis] + map.rounding();
        mins[axis] = pose.point(&map.core_support(&-local))[axis] - map.rounding();
    }
    Aabb::try_new(mins, maxs).unwrap_or_else(|_| Aabb::unbounded())
}

/// The box of all parts.
fn aabb_of_parts<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let one = |index| {
        let part = parts.part(index);
        part.solid.as_shape().aabb(&pose.compose(&part.pose))
    };
    let boxes = (0..parts.num_parts()).map(one);
    boxes.reduce(|all, aabb| all.merged(&aabb)).unwrap_or_else(Aabb::unbounded)
}
