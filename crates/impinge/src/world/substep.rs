//! The computation of a single pair between two updates, for continuous collision detection.

use super::error::or_panic;
use super::step::in_order;
use super::{CollisionWorld, WorldError};
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;

/// Continuous collision: single pairs at new positions.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Computes the contacts or the proximity of two objects at their present positions, without an
    /// update. The handles may be in either order. A solver can use it in substeps that move a fast
    /// body to the position of its impact.
    ///
    /// Returns `false`, without a change, if the two objects had no pair at the last update. The
    /// broad phase is not searched: if two bodies may meet within a step, their volumes must cover
    /// that step ([`Self::set_position_with_prediction`]). The pair is computed as in an update:
    /// contacts that only moved keep their ids. Until the next update this pair is read at the new
    /// positions, and every other pair as of the last update. Shapes, query types and groups are
    /// those of the last update.
    ///
    /// If the pair began or ceased to touch, or its proximity changed, the event is queued. The
    /// next update delivers it first, together with the events of removals, in the order in which
    /// they occurred for the pair. Each `Started` still has one `Stopped`: if a pair touches in a
    /// substep and has separated by the update, both events are delivered.
    ///
    /// Costs one query and two look-ups. A custom narrow phase must implement
    /// [`NarrowPhase::update_pair`](super::NarrowPhase::update_pair).
    ///
    /// ```
    /// use impinge::dim2::events::ContactEvent;
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f64, ()>::new(0.02);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let [post, bullet] = [0.0, -8.0].map(|x| {
    ///     let position = Isometry::translation(x, 0.0);
    ///     world.add(position, ball.clone(), groups, ContactQuery::default(), ())
    /// });
    /// let at = |x| Isometry::translation(x, 0.0);
    /// world.set_position_with_prediction(bullet, at(-8.0), at(8.0));
    /// world.update();
    /// assert!(world.contact_events().is_empty(), "a pair without contact");
    ///
    /// world.set_position(bullet, at(-1.75));
    /// assert!(world.update_pair(post, bullet));
    /// let (_, point) = world.contacts_with(post).next().expect("they touch");
    /// assert_eq!((point.contact.depth, point.contact.normal.x), (0.25, -1.0));
    ///
    /// world.set_position(bullet, at(-3.0));
    /// world.update();
    /// let both = [ContactEvent::Started(post, bullet), ContactEvent::Stopped(post, bullet)];
    /// assert_eq!(world.contact_events(), both, "it has bounced off");
    /// ```
    ///
    /// # Panics
    /// If a handle is stale; [`Self::try_update_pair`] returns an error instead.
    #[doc(alias = "update_contact")]
    #[track_caller]
    pub fn update_pair(
        &mut self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> bool {
        or_panic(self.try_update_pair(handle1, handle2))
    }

    /// Computes a pair at the present positions; see [`Self::update_pair`].
    ///
    /// # Errors
    /// If a handle is stale. The world is unchanged then.
    pub fn try_update_pair(
        &mut self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Result<bool, WorldError> {
        for handle in [handle1, handle2] {
            self.objects.checked_body(handle)?;
        }
        let (first, second) = in_order(handle1, handle2);
        let key = [first.index(), second.index()];
        let [one, other] = key.map(|index| self.objects.body(index).map(|body| body.isometry));
        let Some(positions) = one.zip(other).map(<[_; 2]>::from) else { return Ok(false) };
        let Some(substep) = self.objects.table.begin_substep(key, positions) else {
            return Ok(false);
        };
        let (events, objects) = (&mut self.queued, &self.objects);
        let is_kept = self.narrow_phase.update_pair(events, objects, first, second);
        self.objects.table.end_substep(&substep, is_kept);
        Ok(is_kept)
    }
}
