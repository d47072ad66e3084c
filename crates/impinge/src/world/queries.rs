//! Questions about everything in a world: rays, points, boxes.
//!
//! The broad phase answers as of the last update. Objects that it does not know where they are now
//! are few and tested one by one, so every change is seen at once; what it proposes is tested again
//! exactly.

use super::bodies::Body;
use super::{CollisionGroups, CollisionObject, CollisionWorld};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::{Point, Real, Space, max};
use crate::narrow_phase::CollisionObjectHandle;
use crate::query::{PointQuery, Ray, RayCast, RayIntersection};

type Object<N, const D: usize, T> = CollisionObject<N, D, T>;

/// World-scale queries. They see every change at once and answer in order of the handles.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// The objects that a ray meets, among those able to interact with `groups`, and where it enters
    /// each of them.
    ///
    /// Solids are solid: a ray that starts inside one meets it at time zero. A ray that is not finite
    /// meets nothing.
    pub fn interferences_with_ray<'a>(
        &'a self,
        ray: &Ray<N, D>,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = (&'a Object<N, D, T>, RayIntersection<N, D>)> + use<'a, N, D, T> {
        let (ray, mut found) = (*ray, Vec::new());
        self.broad_phase.interferences_with_ray(&ray, &mut found);
        let meets = |body: &Body<N, D>| body.aabb.intersects_ray(&ray);
        self.candidates(found, &meets, groups)
            .filter_map(move |object| Some((object, cast(self.body(object.handle), &ray)?)))
    }

    /// The objects that hold a point, on their surface at least, among those able to interact with
    /// `groups`.
    pub fn interferences_with_point<'a>(
        &'a self,
        point: &Point<N, D>,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = &'a Object<N, D, T>> + use<'a, N, D, T> {
        let (point, mut found) = (*point, Vec::new());
        self.broad_phase.interferences_with_point(&point, &mut found);
        self.candidates(found, &|_| true, groups)
            .filter(move |object| holds(self.body(object.handle), &point))
    }

    /// The objects whose boxes meet or touch a box, among those able to interact with `groups`. The
    /// boxes are those of the shapes where the objects are now, without any margin.
    pub fn interferences_with_aabb<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = &'a Object<N, D, T>> + use<'a, N, D, T> {
        let (aabb, mut found) = (*aabb, Vec::new());
        self.broad_phase.interferences_with_bounding_volume(&aabb, &mut found);
        self.candidates(found, &|_| true, groups)
            .filter(move |object| self.body(object.handle).aabb.intersects(&aabb))
    }

    /// The object that a ray meets first, among those able to interact with `groups`, and where; of
    /// several at the same time the one whose handle comes first.
    ///
    /// The first of [`Self::interferences_with_ray`] by time, at the cost of a few objects.
    #[must_use]
    pub fn first_interference_with_ray(
        &self,
        ray: &Ray<N, D>,
        groups: &CollisionGroups,
    ) -> Option<(&CollisionObject<N, D, T>, RayIntersection<N, D>)> {
        let mut first: Option<(CollisionObjectHandle, RayIntersection<N, D>)> = None;
        let mut meet = |body: &Body<N, D>| {
            if body.groups.can_interact_with_groups(groups) {
                let hit = cast(body, ray).map(|hit| (body.handle, hit));
                first = sooner(first, hit);
            }
            first.map_or(N::INFINITY, |(_, hit)| latest_entry(hit.toi))
        };
        let mut latest = N::INFINITY;
        for body in self.objects.bodies.astray() {
            latest = meet(body);
        }
        self.broad_phase.visit_ray(ray, latest, &mut |&handle| {
            if let Some(body) = self.settled(handle) {
                latest = meet(body);
            }
            latest
        });
        let (handle, hit) = first?;
        Some((self.objects.get(handle)?, hit))
    }

    /// The objects that the broad phase found and has not lost track of, and those that it has and
    /// that `may` meet the question; able to interact with `groups`, in order, each once.
    fn candidates<'a>(
        &'a self,
        found: Vec<&CollisionObjectHandle>,
        may: &dyn Fn(&Body<N, D>) -> bool,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = &'a Object<N, D, T>> + use<'a, N, D, T> + 'a {
        let settled = found.into_iter().filter_map(|&handle| self.settled(handle));
        let astray = self.objects.bodies.astray().filter(|body| may(body));
        let mut handles: Vec<_> = settled
            .chain(astray)
            .filter(|body| body.groups.can_interact_with_groups(groups))
            .map(|body| body.handle)
            .collect();
        handles.sort_unstable();
        handles.into_iter().filter_map(|handle| self.objects.get(handle))
    }

    /// The object of a handle of the broad phase, if it lives and is where it was at the last update.
    fn settled(&self, handle: CollisionObjectHandle) -> Option<&Body<N, D>> {
        let body = self.body(handle);
        (body.alive && body.handle == handle && !body.is_astray()).then_some(body)
    }

    fn body(&self, handle: CollisionObjectHandle) -> &Body<N, D> {
        self.objects.bodies.at(handle.index())
    }
}

/// Where a ray enters an object.
fn cast<N: Space<D>, const D: usize>(
    body: &Body<N, D>,
    ray: &Ray<N, D>,
) -> Option<RayIntersection<N, D>> {
    let pose = N::pose(&body.isometry);
    let local = body.shape.cast_local_ray(&ray.inverse_transformed_by(&pose), true)?;
    Some(RayIntersection { normal: pose.vector(&local.normal), ..local })
}

/// An object holds a point.
fn holds<N: Space<D>, const D: usize>(body: &Body<N, D>, point: &Point<N, D>) -> bool {
    let pose = N::pose(&body.isometry);
    body.shape.project_local_point(&pose.inverse_point(point)).0.is_inside
}

/// The hit that comes first; of two at the same time the one on the object that comes first.
fn sooner<N: Space<D>, const D: usize>(
    a: Option<(CollisionObjectHandle, RayIntersection<N, D>)>,
    b: Option<(CollisionObjectHandle, RayIntersection<N, D>)>,
) -> Option<(CollisionObjectHandle, RayIntersection<N, D>)> {
    let (Some((handle1, hit1)), Some((handle2, hit2))) = (a, b) else { return a.or(b) };
    let second = hit2.toi < hit1.toi || (hit2.toi == hit1.toi && handle2 < handle1);
    if second { b } else { a }
}

/// The latest time at which a ray may enter the box of an object that is met at `toi`: times are
/// differences divided, wrong by a few units in the last place.
fn latest_entry<N: Real>(toi: N) -> N {
    max(toi + toi * N::lit(8.0) * N::EPSILON, N::MIN_POSITIVE)
}
