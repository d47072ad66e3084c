//! Where a point lies to a composite: as it lies to the nearest part.

use crate::bounding_volume::Aabb;
use crate::math::{Point, Space};
use crate::query::PointQuery;
use crate::query::point::{SurfacePoint, length};
use crate::shape::{CompositeShape, FeatureId};

/// The nearest point of the boundaries of the parts, and the part; of several that of the first.
pub(in crate::query) fn surface_point<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    point: &Point<N, D>,
) -> (SurfacePoint<N, D>, u32) {
    let nowhere = SurfacePoint { point: *point, feature: FeatureId::Face(0), is_inside: false };
    let (mut best, mut best_part, mut distance) = (nowhere, 0, N::INFINITY);
    let Ok(start) = Aabb::try_new(*point, *point) else { return (nowhere, 0) };
    parts.search().nearest(&start, N::INFINITY, &mut |index, _| {
        let part = parts.part(index);
        let shape = part.solid.as_shape();
        let (found, feature) = shape.project_local_point(&part.pose.inverse_point(point));
        let nearest = part.pose.point(&found.point);
        let apart = if found.is_inside { N::ZERO } else { length(&(point - nearest)) };
        if apart < distance || (apart == distance && index < best_part) {
            (best_part, distance) = (index, apart);
            best = SurfacePoint { point: nearest, feature, is_inside: found.is_inside };
        }
        distance
    });
    (best, best_part)
}
