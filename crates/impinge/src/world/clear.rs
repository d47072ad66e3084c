//! Worlds without objects, and the removal of all or some objects.

use super::CollisionWorld;
use super::object::CollisionObject;
use crate::math::Space;

/// The default margin of a world.
const DEFAULT_MARGIN: f64 = 0.02;

/// Creates an empty world with margin 0.02, which suits objects of size 1. The margin never affects
/// exact results; [`CollisionWorld::new`] has it as an argument.
impl<N: Space<D>, const D: usize, T> Default for CollisionWorld<N, D, T> {
    fn default() -> Self {
        Self::new(N::lit(DEFAULT_MARGIN))
    }
}

/// Removing many objects at once.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Removes all objects. Each touching or near pair stops, with one event in the next batch, and
    /// no handle is issued again. Filters, phases and the margin stay, and the events of the last
    /// update stay until the next one.
    ///
    /// ```
    /// use impinge::dim2::events::ContactEvent;
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::<f32, ()>::default();
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    /// let [a, b] = [0.0, 1.0].map(|x| {
    ///     world.add(Isometry::translation(x, 0.0), ball.clone(), groups, contacts, ())
    /// });
    /// world.update();
    /// world.clear();
    /// assert!(world.is_empty() && world.collision_object(a).is_none());
    /// world.update();
    /// assert_eq!(world.contact_events(), [ContactEvent::Stopped(a, b)]);
    /// ```
    pub fn clear(&mut self) {
        self.retain(|_| false);
    }

    /// Removes the objects for which `keeps` returns `false`. Each touching or near pair that loses
    /// an object stops, with one event in the next batch. `keeps` is called once for each object,
    /// in order of the handles; if it panics, the world is unchanged.
    ///
    /// ```
    /// use impinge::dim3::math::Isometry;
    /// use impinge::dim3::shape::{Ball, ShapeHandle};
    /// use impinge::dim3::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(0.5)), CollisionGroups::new());
    /// for lives in [3, 0, 1] {
    ///     let query = GeometricQueryType::Proximity(0.0);
    ///     world.add(Isometry::identity(), ball.clone(), groups, query, lives);
    /// }
    /// world.retain(|object| *object.data() > 0);
    /// assert_eq!(world.len(), 2);
    /// ```
    pub fn retain(&mut self, mut keeps: impl FnMut(&CollisionObject<N, D, T>) -> bool) {
        let leaving = self.objects.iter().filter(|object| !keeps(object));
        let leaving: Vec<_> = leaving.map(CollisionObject::handle).collect();
        self.remove(&leaving);
    }
}
