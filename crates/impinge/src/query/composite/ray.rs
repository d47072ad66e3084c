//! Where a ray meets a composite: where it first meets one of its parts.

use crate::bounding_volume::{Aabb, Ray};
use crate::math::Space;
use crate::query::{RayCast, RayIntersection};
use crate::shape::CompositeShape;

/// The first hit, in the frame of the composite; of several at one time that on the first part.
pub(in crate::query) fn first_hit<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    ray: &Ray<N, D>,
    solid: bool,
) -> Option<RayIntersection<N, D>> {
    let mut first: Option<RayIntersection<N, D>> = None;
    let start = Aabb::try_new(ray.origin, ray.origin).ok()?;
    parts.search().cast(&start, &ray.dir, N::INFINITY, &mut |index, _| {
        let part = parts.part(index);
        let local = ray.inverse_transformed_by(&part.pose);
        if let Some(hit) = part.solid.as_shape().cast_local_ray(&local, solid) {
            let normal = part.pose.vector(&hit.normal);
            let hit = RayIntersection { normal, part: index, ..hit };
            let key = |hit: &RayIntersection<N, D>| (hit.toi, hit.part);
            first = Some(first.filter(|first| key(first) <= key(&hit)).unwrap_or(hit));
        }
        first.map_or(N::INFINITY, |hit| hit.toi)
    });
    first
}
