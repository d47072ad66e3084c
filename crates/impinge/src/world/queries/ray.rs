//! Ray queries among the objects of a world.

use super::QueryFilter;
use super::ranking::RankRange;
use super::search::WorldProbe;
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;
use crate::query::{Ray, RayBatch, RayIntersection};
use crate::world::bodies::WorldBody;
use crate::world::entries;
use crate::world::{CollisionGroups, CollisionObject, CollisionWorld};

/// Ray queries.
///
/// The point at time `t` is `origin + t * direction`. Normals are in the world frame. Each object
/// is hit at most once: at the point at which the ray first hits it.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the objects that a ray hits, each with its first intersection, in order of their
    /// handles. There is no maximum time, and a ray that starts inside an object hits it at time
    /// zero. Considers the objects that may interact with `groups`.
    pub fn interferences_with_ray<'a>(
        &'a self,
        ray: &Ray<N, D>,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = (&'a CollisionObject<N, D, T>, RayIntersection<N, D>)> + use<'a, N, D, T>
    {
        let ray = *ray;
        self.matching(&WorldProbe::Ray(ray), N::INFINITY, &groups.into())
            .filter_map(move |object| Some((object, cast(&object.body, &ray, N::INFINITY, true)?)))
    }

    /// Returns the object that a ray hits first, and the intersection; `None` if the ray hits none.
    /// See [`Self::first_ray_hit`]. There is no maximum time, and a ray that starts inside an
    /// object hits it at time zero. Considers the objects that may interact with `groups`.
    #[must_use]
    pub fn first_interference_with_ray(
        &self,
        ray: &Ray<N, D>,
        groups: &CollisionGroups,
    ) -> Option<(&CollisionObject<N, D, T>, RayIntersection<N, D>)> {
        self.first_ray_hit(ray, N::INFINITY, true, &groups.into())
    }

    /// Returns the object that a ray hits first, and the intersection; at equal times the object
    /// with the smallest handle. `None` if the ray hits no object at or before `max_time`.
    ///
    /// If `solid` is `true`, a ray that starts inside an object hits it at time zero; otherwise it
    /// hits the object where it leaves the object. A ray with a number that is not finite hits
    /// nothing. Nothing is hit if `max_time` is negative or NaN.
    ///
    /// Costs a tree search, and a ray cast against a few objects.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Point, Vector};
    /// use impinge::dim3::query::Ray;
    /// use impinge::dim3::shape::{Cuboid, ShapeHandle};
    /// use impinge::dim3::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (cube, contacts) =
    ///     (ShapeHandle::new(Cuboid::new(Vector::repeat(1.0))), GeometricQueryType::Contacts(0.0, 0.0));
    /// for (x, name) in [(8.0, "far"), (4.0, "near")] {
    ///     let position = Isometry::translation(x, 0.0, 0.0);
    ///     world.add(position, cube.clone(), CollisionGroups::new(), contacts, name);
    /// }
    ///
    /// let ray = Ray::new(Point::origin(), Vector::new(2.0, 0.0, 0.0));
    /// let hit = world.first_ray_hit(&ray, 10.0, true, &QueryFilter::new());
    /// let (object, hit) = hit.expect("both are in the way");
    /// assert_eq!((*object.data(), hit.toi, hit.normal.x), ("near", 1.5, -1.0));
    /// assert!(world.first_ray_hit(&ray, 1.25, true, &QueryFilter::new()).is_none(), "too short");
    ///
    /// let all = world.ray_hits(&ray, 10.0, true, &QueryFilter::new());
    /// let times: Vec<f32> = all.iter().map(|(_, hit)| hit.toi).collect();
    /// assert_eq!(times, [1.5, 3.5]);
    /// ```
    #[doc(alias = "first_interference_with_ray")]
    #[must_use]
    pub fn first_ray_hit(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Option<(&CollisionObject<N, D, T>, RayIntersection<N, D>)> {
        let found = self.best(&WorldProbe::Ray(*ray), max_time, filter, &|body, latest| {
            let hit = cast(body, ray, latest, solid)?;
            Some((hit.toi, hit))
        });
        found.map(|(object, _, hit)| (object, hit))
    }

    /// Casts many rays: `hits[i]` becomes the handle and the intersection that
    /// [`Self::first_ray_hit`] finds for `batch.rays[i]`, bit for bit. The caller can reuse the
    /// memory of `hits` from frame to frame.
    ///
    /// Runs on the calling thread, also with the feature `parallel`, since the user's data need not
    /// be `Sync`. Several threads may query a world that is `Sync`, each with a part of the rays.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point, Vector};
    /// use impinge::dim2::query::{Ray, RayBatch};
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (ball, contacts) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Contacts(0.0, 0.0));
    /// let position = Isometry::translation(5.0, 0.0);
    /// let target = world.add(position, ball, CollisionGroups::new(), contacts, ());
    ///
    /// let rays = [0.0, 9.0].map(|y| Ray::new(Point::new(0.0, y), Vector::x()));
    /// let mut hits = [None; 2];
    /// world.cast_rays(&RayBatch::new(&rays), &QueryFilter::new(), &mut hits);
    /// assert_eq!(hits[0].map(|(handle, hit)| (handle, hit.toi)), Some((target, 4.0)));
    /// assert_eq!(hits[1], None);
    /// ```
    ///
    /// # Panics
    /// If `hits` is not as long as `batch.rays`.
    #[track_caller]
    pub fn cast_rays(
        &self,
        batch: &RayBatch<'_, N, D>,
        filter: &QueryFilter<'_, N, D, T>,
        hits: &mut [Option<(CollisionObjectHandle, RayIntersection<N, D>)>],
    ) {
        batch.each(hits, |ray| {
            let found = self.first_ray_hit(ray, batch.max_time, batch.solid, filter);
            found.map(|(object, hit)| (object.handle(), hit))
        });
    }

    /// Returns the objects that a ray hits at or before `max_time`, each with its first
    /// intersection, in ascending order of time, then of handle. See [`Self::first_ray_hit`] for
    /// the arguments.
    #[doc(alias = "interferences_with_ray")]
    #[must_use]
    pub fn ray_hits(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        solid: bool,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<(&CollisionObject<N, D, T>, RayIntersection<N, D>)> {
        self.ranked_hits(ray, RankRange::for_all(max_time), solid, filter)
    }

    fn ranked_hits(
        &self,
        ray: &Ray<N, D>,
        range: RankRange<N>,
        solid: bool,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<(&CollisionObject<N, D, T>, RayIntersection<N, D>)> {
        let found = self.rank(&WorldProbe::Ray(*ray), range, filter, &|body, latest| {
            let hit = cast(body, ray, latest, solid)?;
            Some((hit.toi, hit))
        });
        found.into_iter().map(|(object, _, hit)| (object, hit)).collect()
    }
}

/// Returns the first intersection of a ray and an object, with the normal in the world frame.
/// `None` if there is none by time `latest`.
fn cast<N: Space<D>, const D: usize>(
    body: &WorldBody<N, D>,
    ray: &Ray<N, D>,
    latest: N,
    solid: bool,
) -> Option<RayIntersection<N, D>> {
    entries::cast_ray(body, ray, latest, solid)
}
