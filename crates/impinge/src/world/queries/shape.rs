//! Queries for the objects that are near a solid or overlap it.

use super::ranking::RankRange;
use super::search::WorldProbe;
use super::{NearObject, QueryFilter};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::Placed;
use crate::convex::Separation;
use crate::math::{Space, max};
use crate::query::ClosestPoints;
use crate::shape::Shape;
use crate::tables::entries::{distance_in_world, separation_in_world};
use crate::world::bodies::{WorldBody, aabb_at, grown};
use crate::world::entries;
use crate::world::{CollisionGroups, CollisionObject, CollisionWorld};

/// Queries with solids and boxes, in the world frame.
///
/// The solid of a query is not an object of the world: it may be any shape at any position. `&*`
/// converts a [`ShapeHandle`](crate::shape::ShapeHandle) to its shape. If a number of the position
/// is not finite, nothing is near. Distances are those of [`crate::query::distance`]: zero for
/// solids that touch or overlap.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the objects whose boxes overlap or touch `aabb`, in order of their handles; see
    /// [`Self::objects_in_aabb`]. Considers the objects that may interact with `groups`.
    pub fn interferences_with_aabb<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        groups: &CollisionGroups,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        self.objects_in_aabb(aabb, &groups.into())
    }

    /// Returns the objects whose boxes overlap or touch `aabb`, in order of their handles. Tests
    /// the exact boxes of the shapes at their present positions, without margin;
    /// [`Self::objects_overlapping`] with a cuboid tests the shapes themselves.
    #[doc(alias = "interferences_with_aabb")]
    pub fn objects_in_aabb<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        let aabb = *aabb;
        self.overlapping_aabb(&aabb, filter)
            .filter(move |object| entries::overlaps_aabb(&object.body, &aabb))
    }

    /// Returns the objects that touch or overlap a solid, in order of their handles.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Vector};
    /// use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (ball, contacts) =
    ///     (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Contacts(0.0, 0.0));
    /// for y in [0.0, 1.75] {
    ///     let position = Isometry::translation(1.75, y);
    ///     world.add(position, ball.clone(), CollisionGroups::new(), contacts, y);
    /// }
    ///
    /// let square = Cuboid::new(Vector::new(1.0, 1.0));
    /// let here = Isometry::identity();
    /// let found: Vec<f32> = world
    ///     .objects_overlapping(&here, &square, &QueryFilter::new())
    ///     .map(|object| *object.data())
    ///     .collect();
    /// assert_eq!(found, [0.0], "the other one's box meets the square, but the ball itself does not");
    /// ```
    pub fn objects_overlapping<'a, 's>(
        &'a self,
        position: &N::Isometry,
        shape: &'s dyn Shape<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, 's, N, D, T> {
        let placed = entries::placed_at(position, shape.geometry());
        let near =
            entries::placed_aabb(position, shape).map(|aabb| self.overlapping_aabb(&aabb, filter));
        near.into_iter().flatten().filter(move |object| entries::touches(&placed, &object.body))
    }

    /// Returns `true` if at least one object touches or overlaps a solid. The search ends at the
    /// first such object.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Vector};
    /// use impinge::dim3::shape::{Ball, Cuboid, ShapeHandle};
    /// use impinge::dim3::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (tree, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// let position = Isometry::translation(3.0, 0.0, 0.0);
    /// let tree = world.add(position, tree, CollisionGroups::new(), query, "tree");
    ///
    /// let car = Cuboid::new(Vector::new(2.0, 1.0, 1.0));
    /// let at = |x| Isometry::translation(x, 0.0, 0.0);
    /// assert!(world.overlaps_any(&at(0.0), &car, &QueryFilter::new()), "touching counts");
    /// assert!(!world.overlaps_any(&at(-1.0), &car, &QueryFilter::new()));
    /// assert!(!world.overlaps_any(&at(0.0), &car, &QueryFilter::new().exclude(tree)));
    /// ```
    #[must_use]
    pub fn overlaps_any(
        &self,
        position: &N::Isometry,
        shape: &dyn Shape<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> bool {
        let placed = entries::placed_at(position, shape.geometry());
        entries::placed_aabb(position, shape).is_some_and(|aabb| {
            self.any_matching(&WorldProbe::Near(aabb), N::ZERO, |object| {
                self.allows(object, filter) && entries::touches(&placed, &object.body)
            })
        })
    }

    /// Returns the object nearest to a solid, with its distance and nearest points; at equal
    /// distances the object with the smallest handle. `None` if no object is at most `max_distance`
    /// away. See [`Self::nearest_objects`].
    #[must_use]
    pub fn closest_object(
        &self,
        position: &N::Isometry,
        shape: &dyn Shape<N, D>,
        max_distance: N,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Option<NearObject<'_, N, D, T>> {
        self.nearest_objects(position, shape, 1, max_distance, filter).pop()
    }

    /// Returns all objects at most `distance` from a solid, in ascending order of distance, then of
    /// handle. [`Self::nearest_objects`] describes the fields.
    #[must_use]
    pub fn objects_within(
        &self,
        position: &N::Isometry,
        shape: &dyn Shape<N, D>,
        distance: N,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<NearObject<'_, N, D, T>> {
        self.nearest_objects(position, shape, usize::MAX, distance, filter)
    }

    /// Returns the `count` objects nearest to a solid, at most `max_distance` away, in ascending
    /// order of distance, then of handle.
    ///
    /// Objects that touch or overlap the solid have distance zero and
    /// [`ClosestPoints::Intersecting`]. For other objects, [`ClosestPoints::WithinMargin`] has the
    /// point on the solid first, then the point on the object. The list is empty if `count` is
    /// zero, or `max_distance` is negative or NaN.
    ///
    /// Costs a tree search, and a distance computation for each object found and for a few objects
    /// with boxes about as near as the last object found.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::query::ClosestPoints;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (ball, contacts) =
    ///     (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Contacts(0.0, 0.0));
    /// for x in [20.0, 5.0, 10.0, 1.0] {
    ///     let position = Isometry::translation(x, 0.0);
    ///     world.add(position, ball.clone(), CollisionGroups::new(), contacts, x);
    /// }
    ///
    /// let (here, small) = (Isometry::identity(), Ball::new(0.5));
    /// let found = world.nearest_objects(&here, &small, 3, f64::INFINITY, &QueryFilter::new());
    /// let distances: Vec<f64> = found.iter().map(|neighbor| neighbor.distance).collect();
    /// assert_eq!(distances, [0.0, 3.5, 8.5]);
    /// assert_eq!(*found[1].object.data(), 5.0);
    /// let points = ClosestPoints::WithinMargin(Point::new(0.5, 0.0), Point::new(4.0, 0.0));
    /// assert_eq!(found[1].points, points);
    ///
    /// let near = world.objects_within(&here, &small, 3.5, &QueryFilter::new());
    /// assert_eq!(near.len(), 2, "all up to 3.5");
    /// let from_point = world.nearest_to_point(&Point::origin(), 2, f64::INFINITY, &QueryFilter::new());
    /// assert_eq!(from_point[1].distance, 4.0);
    /// ```
    #[doc(alias = "closest_object")]
    #[must_use]
    pub fn nearest_objects(
        &self,
        position: &N::Isometry,
        shape: &dyn Shape<N, D>,
        count: usize,
        max_distance: N,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> Vec<NearObject<'_, N, D, T>> {
        let Some(aabb) = entries::placed_aabb(position, shape) else { return Vec::new() };
        let placed = entries::placed_at(position, shape.geometry());
        let range = RankRange { count, limit: max_distance };
        let found = self.rank(&WorldProbe::Near(aabb), range, filter, &|body, farthest| {
            let found = entries::separation_from(&placed, body, farthest)?;
            Some((max(found.distance, N::ZERO), found))
        });
        let neighbor = |(object, distance, found): (_, _, Separation<N, D>)| {
            let apart = ClosestPoints::WithinMargin(found.point1, found.point2);
            let points = if distance > N::ZERO { apart } else { ClosestPoints::Intersecting };
            NearObject { object, distance, points }
        };
        found.into_iter().map(neighbor).collect()
    }
}

/// Returns the box of a placed solid, grown by its rounding errors; `None` if the position is not
/// finite.
pub(crate) fn placed_aabb<N: Space<D>, const D: usize>(
    position: &N::Isometry,
    shape: &dyn Shape<N, D>,
) -> Option<Aabb<N, D>> {
    let pose = N::pose(position);
    pose.is_finite().then(|| grown(&aabb_at(shape, &pose), N::ZERO))
}

/// Returns `true` if a solid touches or overlaps an object: their distance is zero or negative.
pub(crate) fn touches<N: Space<D>, const D: usize>(
    placed: &Placed<'_, N, D>,
    body: &WorldBody<N, D>,
) -> bool {
    body.ask(|shape| {
        let object = Placed::of_isometry(&body.isometry, shape);
        distance_in_world(placed, &object, N::ZERO).is_some()
    })
}

/// Returns the separation of a solid and an object; `None` if their distance exceeds `limit`.
pub(crate) fn separation_from<N: Space<D>, const D: usize>(
    placed: &Placed<'_, N, D>,
    body: &WorldBody<N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    body.ask(|shape| {
        let object = Placed::of_isometry(&body.isometry, shape);
        separation_in_world(placed, &object, limit)
    })
}

/// Returns `true` if the exact box of an object overlaps or touches `aabb`.
#[inline]
pub(crate) fn overlaps_aabb<N: Space<D>, const D: usize>(
    body: &WorldBody<N, D>,
    aabb: &Aabb<N, D>,
) -> bool {
    body.aabb().intersects(aabb)
}
