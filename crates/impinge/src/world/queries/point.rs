//! Point queries among the objects of a world.

use super::ranking::RankRange;
use super::search::WorldProbe;
use super::{NearObject, QueryFilter};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Space};
use crate::query::{ClosestPoints, PointProjection};
use crate::world::bodies::WorldBody;
use crate::world::entries;
use crate::world::{CollisionGroups, CollisionObject, CollisionWorld};

/// Point queries, in the world frame. No object contains a point with a coordinate that is not
/// finite, and none is near it.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the objects that contain a point, boundary included, in order of their handles.
    /// Considers the objects that may interact with `groups`.
    pub fn interferences_with_point<'a>(
        &'a self,
        point: &Point<N, D>,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        self.objects_containing(point, &groups.into())
    }

    /// Returns the objects that contain a point, boundary included, in order of their handles.
    #[doc(alias = "interferences_with_point")]
    pub fn objects_containing<'a>(
        &'a self,
        point: &Point<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        let point = *point;
        let near = near(&point).map(|_| self.overlapping_aabb(&Aabb::at(point), filter));
        near.into_iter().flatten().filter(move |object| entries::holds(&object.body, &point))
    }

    /// Returns the object nearest to `point`, and the projection of `point` on it; at equal
    /// distances the object with the smallest handle. `None` if no object is at most `max_distance`
    /// away, or if `max_distance` is negative or NaN.
    ///
    /// If `solid` is `true`, a point in an object is its own projection, at distance zero.
    /// Otherwise points are projected on the boundary of the object, from inside and from outside.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (ball, contacts) =
    ///     (ShapeHandle::new(Ball::new(2.0)), GeometricQueryType::Contacts(0.0, 0.0));
    /// for x in [0.0, 10.0] {
    ///     let position = Isometry::translation(x, 0.0);
    ///     world.add(position, ball.clone(), CollisionGroups::new(), contacts, x);
    /// }
    ///
    /// let all = QueryFilter::new();
    /// let (object, found) = world.project_point(&Point::new(6.0, 0.0), 4.0, true, &all).expect("near");
    /// assert_eq!((*object.data(), found.point), (10.0, Point::new(8.0, 0.0)));
    /// let (object, found) = world.project_point(&Point::new(0.0, 1.5), 4.0, false, &all).expect("near");
    /// assert_eq!((*object.data(), found.point), (0.0, Point::new(0.0, 2.0)));
    /// assert!(found.is_inside);
    /// assert!(world.project_point(&Point::new(0.0, 9.0), 4.0, true, &all).is_none(), "7 away");
    /// ```
    #[must_use]
    pub fn project_point(
        &self,
        point: &Point<N, D>,
        max_distance: N,
        solid: bool,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Option<(&CollisionObject<N, D, T>, PointProjection<N, D>)> {
        let probe = near(point)?;
        let found = self.best(&probe, max_distance, filter, &|body, farthest| {
            projection(body, point, solid, farthest)
        });
        found.map(|(object, _, projection)| (object, projection))
    }

    /// Returns the `count` objects nearest to a point, at most `max_distance` away, in ascending
    /// order of distance, then of handle.
    ///
    /// An object that contains the point has distance zero and [`ClosestPoints::Intersecting`]. For
    /// other objects, [`ClosestPoints::WithinMargin`] has `point` first, then the nearest point of
    /// the object. The list is empty if `count` is zero, or `max_distance` is negative or NaN.
    ///
    /// [`Self::nearest_objects`] is the query for a solid instead of a point, and has an example.
    #[must_use]
    pub fn nearest_to_point(
        &self,
        point: &Point<N, D>,
        count: usize,
        max_distance: N,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<NearObject<'_, N, D, T>> {
        let range = RankRange { count, limit: max_distance };
        let Some(probe) = near(point) else { return Vec::new() };
        let found = self
            .rank(&probe, range, filter, &|body, farthest| projection(body, point, true, farthest));
        let neighbor = |(object, distance, nearest): (_, _, PointProjection<N, D>)| {
            let apart = ClosestPoints::WithinMargin(*point, nearest.point);
            let points = if nearest.is_inside { ClosestPoints::Intersecting } else { apart };
            NearObject { object, distance, points }
        };
        found.into_iter().map(neighbor).collect()
    }
}

/// Returns the probe of a point; `None` if the point is not finite.
fn near<N: Space<D>, const D: usize>(point: &Point<N, D>) -> Option<WorldProbe<N, D>> {
    let usable = point.iter().all(|x| x.is_finite_number());
    usable.then(|| WorldProbe::Near(Aabb::at(*point)))
}

/// Returns the distance between a point and an object, and the projection of the point. `None` if
/// the distance exceeds `farthest` or the shape is empty.
fn projection<N: Space<D>, const D: usize>(
    body: &WorldBody<N, D>,
    point: &Point<N, D>,
    solid: bool,
    farthest: N,
) -> Option<(N, PointProjection<N, D>)> {
    let (found, distance) = entries::project(body, point, solid, farthest)?;
    (distance <= farthest).then_some((distance, found))
}
