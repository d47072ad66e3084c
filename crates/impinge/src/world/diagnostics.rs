//! Reasons why two objects have no pair: pair filters that refuse it, and loosened boxes that do
//! not overlap.

use super::CollisionWorld;
use super::step::in_order;
#[cfg(feature = "debug_render")]
use crate::bounding_volume::Aabb;
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;

/// Explanations of pairs. An update tests loosened boxes first, then fixed marks and
/// [`CollisionGroups`](super::CollisionGroups), then filters.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the names, sorted, of the pair filters that refuse two objects. Empty for an object
    /// and itself, and for a stale handle. Ignores groups and boxes.
    ///
    /// Calls each pair filter of the world once.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionObject, CollisionWorld, GeometricQueryType,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// let [a, b, c] = [1, 1, 2].map(|team| {
    ///     world.add(Isometry::identity(), ball.clone(), CollisionGroups::new(), query, team)
    /// });
    /// type Object = CollisionObject<f32, i32>;
    /// world.register_broad_phase_pair_filter("teams", |a: &Object, b: &Object| a.data() != b.data());
    /// assert_eq!(world.refusing_pair_filters(b, a), ["teams"]);
    /// assert!(world.refusing_pair_filters(a, c).is_empty());
    /// ```
    #[must_use]
    pub fn refusing_pair_filters(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Vec<&str> {
        let (first, second) = in_order(handle1, handle2);
        let objects = self.collision_object(first).zip(self.collision_object(second));
        match objects {
            Some((co1, co2)) if first != second => self.filters.refusing(co1, co2),
            _ => Vec::new(),
        }
    }

    /// Returns the loosened box of an object in the broad phase, as of the last update; two objects
    /// whose loosened boxes overlap are proposed as a pair. `None` for a stale handle, for an
    /// object added since the last update, and for a custom broad phase without such boxes.
    ///
    /// ```
    /// use impinge::dim2::bounding_volume::BoundingVolume;
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::new(0.25_f64);
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// let ball = world.add(Isometry::identity(), ball, CollisionGroups::new(), query, ());
    /// assert!(world.loosened_aabb(ball).is_none(), "there was no update");
    /// world.update();
    /// let loosened = world.loosened_aabb(ball).expect("the update has seen it");
    /// assert!(loosened.contains_point(&Point::new(1.2, 0.0)), "by the margin: {loosened:?}");
    /// assert!(!loosened.contains_point(&Point::new(1.3, 0.0)), "by no more: {loosened:?}");
    /// ```
    #[cfg(feature = "debug_render")]
    #[must_use]
    pub fn loosened_aabb(&self, handle: CollisionObjectHandle) -> Option<Aabb<N, D>> {
        let object = self.collision_object(handle)?;
        self.broad_phase.loosened(object.proxy_handle())
    }
}
