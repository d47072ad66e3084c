//! An object of a world, with the user's data.

use super::CollisionGroups;
use super::bodies::WorldBody;
use crate::broad_phase::ProxyHandle;
use crate::math::Space;
use crate::memory::clone_fields;
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use crate::shape::ShapeHandle;

/// An object of a world, with the user's data.
///
/// Only the user's data can be changed through a reference to an object. Everything else is changed
/// through the world, by handle.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::new(0.02_f32);
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// let position = Isometry::translation(3.0, 0.0);
/// let handle = world.add(position, ball, CollisionGroups::new(), query, String::from("coin"));
/// let object = world.collision_object_mut(handle).expect("just added");
/// object.data_mut().push('s');
/// assert_eq!((object.data().as_str(), object.position()), ("coins", &position));
/// assert!(object.shape().is_shape::<Ball<f32>>());
/// ```
pub struct CollisionObject<N: Space<D>, const D: usize, T> {
    pub(super) body: WorldBody<N, D>,
    pub(super) data: T,
}

clone_fields!([N: Space<D>, const D: usize, T: Clone] CollisionObject<N, D, T> { body, data });

impl<N: Space<D>, const D: usize, T> CollisionObject<N, D, T> {
    /// Returns the object's handle in its world.
    #[must_use]
    pub const fn handle(&self) -> CollisionObjectHandle {
        self.body.handle
    }

    /// Returns the handle of the object's volume in the broad phase. The handle changes when the
    /// broad phase or the narrow phase of the world is replaced.
    #[must_use]
    pub const fn proxy_handle(&self) -> ProxyHandle {
        self.body.proxy
    }

    /// Returns the position of the object, as the user set it.
    #[must_use]
    pub const fn position(&self) -> &N::Isometry {
        &self.body.isometry
    }

    /// Returns the shape.
    #[must_use]
    pub const fn shape(&self) -> &ShapeHandle<N, D> {
        &self.body.shape
    }

    /// Returns the groups.
    #[must_use]
    pub const fn collision_groups(&self) -> &CollisionGroups {
        &self.body.groups
    }

    /// Returns `true` if the object is fixed. It then has no pairs with other fixed objects; see
    /// [`CollisionWorld::set_fixed`](super::CollisionWorld::set_fixed).
    #[must_use]
    pub const fn is_fixed(&self) -> bool {
        self.body.is_fixed()
    }

    /// Returns the query type: whether contacts or proximities are computed for the object's pairs.
    #[must_use]
    pub fn query_type(&self) -> GeometricQueryType<N> {
        self.body.query.get()
    }

    /// Returns the user's data.
    #[must_use]
    pub const fn data(&self) -> &T {
        &self.data
    }

    /// Returns the user's data, for changes.
    #[must_use]
    pub const fn data_mut(&mut self) -> &mut T {
        &mut self.data
    }
}
