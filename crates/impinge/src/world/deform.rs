//! Changing the shape of an object: a copy of the shape is changed and replaces the shape.

use super::error::or_panic;
use super::{CollisionWorld, WorldError};
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;
use crate::shape::{Shape, ShapeHandle};

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Changes a copy of an object's shape, which must be of type `S`, and returns the result of
    /// `change`.
    ///
    /// The object gets the copy as its new shape, and other objects that share the old shape keep
    /// it. The contacts of the last update remain those of the old shape, until the next update
    /// replaces them. Queries use the new shape at once, and pairs follow at the next update, as
    /// after [`Self::set_shape`]. Contacts whose features or positions stay the same keep their
    /// ids. Costs a copy of the shape, and the call of `change`.
    ///
    /// # Panics
    /// If the handle is stale or the shape is of another type; [`Self::try_deform`] returns an
    /// error instead.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point, Vector};
    /// use impinge::dim2::shape::{Ball, Polyline, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (everybody, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
    /// let rope = [-1.0, 0.0, 1.0].map(|x| Point::new(x, 0.0)).to_vec();
    /// let rope = ShapeHandle::new(Polyline::<f32>::open(rope));
    /// let rope = world.add(Isometry::identity(), rope, everybody, contacts, ());
    /// let ball = ShapeHandle::new(Ball::new(0.5));
    /// world.add(Isometry::translation(0.0, 1.0), ball, everybody, contacts, ());
    /// world.update();
    /// assert!(world.contact_events().is_empty());
    ///
    /// let raised = [Point::new(-1.0, 0.0), Point::new(0.0, 0.75), Point::new(1.0, 0.0)];
    /// world.deform(rope, |rope: &mut Polyline<f32>| rope.set_vertices(&raised));
    /// world.update();
    /// assert_eq!(world.contact_events().len(), 1);
    /// ```
    #[track_caller]
    pub fn deform<S: Shape<N, D> + Clone, R>(
        &mut self,
        handle: CollisionObjectHandle,
        change: impl FnOnce(&mut S) -> R,
    ) -> R {
        or_panic(self.try_deform(handle, change))
    }

    /// Changes the shape of an object; see [`Self::deform`].
    ///
    /// # Errors
    /// If the handle is stale or the shape is of another type. Then `change` is not called, and the
    /// world is unchanged.
    pub fn try_deform<S: Shape<N, D> + Clone, R>(
        &mut self,
        handle: CollisionObjectHandle,
        change: impl FnOnce(&mut S) -> R,
    ) -> Result<R, WorldError> {
        let body = self.objects.checked_body(handle)?;
        let shape = body.shape.as_shape::<S>().ok_or(WorldError::ShapeType(handle))?;
        let mut shape = shape.clone();
        let result = change(&mut shape);
        self.try_set_shape(handle, ShapeHandle::new(shape))?;
        Ok(result)
    }
}
