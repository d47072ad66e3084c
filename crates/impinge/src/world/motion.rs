//! Fixed objects, which have no pairs with each other, and predicted positions, which extend the
//! volume of a fast object over its path.

use super::entries;
use super::error::or_panic;
use super::{CollisionWorld, WorldError};
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;

/// Fixed objects and predicted positions.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Marks an object as fixed, or clears the mark. Two fixed objects have no pair. So the walls
    /// and floors of a level, which overlap each other, cost nothing in the narrow phase and cause
    /// no events.
    ///
    /// A new object is not fixed. Takes effect at the next update: pairs of two objects that are
    /// both fixed by then stop, with their events, and pairs of two objects that are no longer both
    /// fixed start. A fixed object can still be moved. It has pairs with all objects that are not
    /// fixed, and with itself if its groups enable that
    /// ([`CollisionGroups::enable_self_collision`]); queries treat it like any other object. The
    /// mark is tested before groups and filters, when the boxes of two objects begin to overlap and
    /// when their pair is filtered again.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Vector};
    /// use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (groups, contacts) = (CollisionGroups::new(), ContactQuery::default());
    /// let slab = ShapeHandle::new(Cuboid::new(Vector::new(4.0, 1.0)));
    /// let walls = [0.0, 3.0].map(|x| {
    ///     let wall = world.add(Isometry::translation(x, 0.0), slab.clone(), groups, contacts, "wall");
    ///     world.set_fixed(wall, true);
    ///     wall
    /// });
    /// let ball = ShapeHandle::new(Ball::new(1.0));
    /// world.add(Isometry::translation(1.5, 1.75), ball, groups, contacts, "ball");
    /// world.update();
    /// assert_eq!(world.contact_pairs().count(), 2, "the ball with each wall");
    /// world.set_fixed(walls[0], false);
    /// world.update();
    /// assert_eq!(world.contact_events().len(), 1, "the walls overlap");
    /// ```
    ///
    /// # Panics
    /// If the handle is stale; [`Self::try_set_fixed`] returns an error instead.
    ///
    /// [`CollisionGroups::enable_self_collision`]: super::CollisionGroups::enable_self_collision
    #[track_caller]
    pub fn set_fixed(&mut self, handle: CollisionObjectHandle, is_fixed: bool) {
        or_panic(self.try_set_fixed(handle, is_fixed));
    }

    /// Marks an object as fixed, or clears the mark; see [`Self::set_fixed`].
    ///
    /// # Errors
    /// If the handle is stale. The world is unchanged then.
    pub fn try_set_fixed(
        &mut self,
        handle: CollisionObjectHandle,
        is_fixed: bool,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        body.set_fixed(changes, is_fixed);
        Ok(())
    }

    /// Moves an object and predicts its next position. The volume in the broad phase covers the box
    /// of the object at both positions. So the object has a pair with each object whose box it may
    /// meet in between, and two fast bodies have a pair although their boxes never overlap at an
    /// update.
    ///
    /// Such pairs are meant for a continuous test by
    /// [`nonlinear_time_of_impact`](crate::query::nonlinear_time_of_impact) and
    /// [`Self::update_pair`]. Their contacts and proximities are computed at `position`, and so are
    /// the results of all queries. The prediction holds until the object is moved again, by
    /// [`Self::set_position`] (even to the same position) or with another prediction; other changes
    /// keep it. As with any change, queries use the position at once, and pairs follow at the next
    /// update.
    ///
    /// The volume covers the whole path of a translation. The surface of a body that rotates on the
    /// way can leave both boxes, and therefore the volume; a larger margin of the world, or a
    /// larger prediction of the query type, allows for that. A pair costs memory and time even if
    /// it does not touch, so predict only for bodies that move by more than about their size in a
    /// step.
    ///
    /// ```
    /// use impinge::dim3::math::Isometry;
    /// use impinge::dim3::shape::{Ball, ShapeHandle};
    /// use impinge::dim3::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f32, ()>::new(0.02);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(0.1)), CollisionGroups::new());
    /// let at = |x| Isometry::translation(x, 0.0, 0.0);
    /// let bullets = [-5.0, 5.0].map(|x| {
    ///     let bullet = world.add(at(x), ball.clone(), groups, ContactQuery::default(), ());
    ///     world.set_position_with_prediction(bullet, at(x), at(-x));
    ///     bullet
    /// });
    /// world.update();
    /// assert!(world.pairs_with(bullets[0]).map(|other| other.handle()).eq([bullets[1]]));
    /// assert_eq!(world.predicted_position(bullets[0]), Some(&at(5.0)));
    /// ```
    ///
    /// # Panics
    /// If the handle is stale, a number of a position is not finite, or a rotation is not of unit
    /// length; [`Self::try_set_position_with_prediction`] returns an error instead.
    #[track_caller]
    pub fn set_position_with_prediction(
        &mut self,
        handle: CollisionObjectHandle,
        position: N::Isometry,
        predicted: N::Isometry,
    ) {
        or_panic(self.try_set_position_with_prediction(handle, position, predicted));
    }

    /// Moves an object and predicts its next position; see [`Self::set_position_with_prediction`].
    ///
    /// # Errors
    /// If the handle is stale, a number of a position is not finite, or a rotation is not of unit
    /// length. Then the world is unchanged.
    pub fn try_set_position_with_prediction(
        &mut self,
        handle: CollisionObjectHandle,
        position: N::Isometry,
        predicted: N::Isometry,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        entries::set_predicted(body, changes, position, predicted)
    }

    /// Returns the position that [`Self::set_position_with_prediction`] predicted. `None` for a
    /// stale handle, for an object that never had a prediction, and if the object was moved without
    /// a prediction since.
    #[must_use]
    pub fn predicted_position(&self, handle: CollisionObjectHandle) -> Option<&N::Isometry> {
        let object = self.objects.get(handle)?;
        self.objects.changes.prediction(&object.body)
    }
}
