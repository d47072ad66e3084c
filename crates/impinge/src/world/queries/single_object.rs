//! Queries of a single object. Their generic code is compiled in this crate.

use crate::math::{Point, Space};
use crate::query::point::{holds, is_surely_beyond, project};
use crate::query::{PointProjection, Ray, RayIntersection, cast_on, surely_misses};
use crate::world::WorldBody;

impl<N: Space<D>, const D: usize> WorldBody<N, D> {
    /// Returns the first intersection of a ray and the object, with the normal in the world frame;
    /// `None` if there is none by time `latest`.
    pub(crate) fn cast_ray(
        &self,
        ray: &Ray<N, D>,
        latest: N,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        let pose = N::pose(&self.isometry);
        let local = ray.inverse_transformed_by(&pose);
        let hit = self.ask(
            #[inline(always)]
            |shape| {
                if surely_misses(shape, &local) {
                    return None;
                }
                cast_on(shape, &local, latest, solid)
            },
        )?;
        Some(RayIntersection { normal: pose.vector(&hit.normal), ..hit })
    }

    /// Returns the projection of the point on the object, and its distance. `None` if the shape is
    /// empty; may also be `None` if the distance exceeds `farthest`.
    pub(crate) fn project(
        &self,
        point: &Point<N, D>,
        solid: bool,
        farthest: N,
    ) -> Option<(PointProjection<N, D>, N)> {
        let pose = N::pose(&self.isometry);
        self.ask(
            #[inline(always)]
            |shape| {
                if is_surely_beyond(shape, &pose.inverse_point(point), farthest) {
                    return None;
                }
                project(shape, &pose, point, solid)
            },
        )
    }

    /// Returns `true` if the object contains a point, boundary included.
    pub(crate) fn holds(&self, point: &Point<N, D>) -> bool {
        let local = N::pose(&self.isometry).inverse_point(point);
        self.ask(
            #[inline(always)]
            |shape| holds(shape, &local),
        )
    }
}
