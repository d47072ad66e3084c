//! Access to the pairs of one object, with that object as the first.

use super::{CollisionObject, CollisionWorld};
use crate::math::Space;
use crate::narrow_phase::{CollisionObjectHandle, ContactPair};
use crate::query::{ContactPoint, ManifoldView, Proximity};

/// The pairs of one object as of the last update, in order of the other objects' handles. Pairs
/// with objects that were removed since are omitted. The cost is one look-up for each pair of the
/// object, and does not depend on the size of the world. For a custom narrow phase see
/// [`NarrowPhase::partners_of`](super::NarrowPhase::partners_of).
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Iterates over the objects that have a pair with this object, touching or not, in order of
    /// their handles. Includes the object itself if it is tested against itself. Empty for a stale
    /// handle.
    ///
    /// These are the objects that groups and filters allow and whose loosened boxes overlap the
    /// loosened box of this object. So the margin of the world decides which pairs without contact
    /// are among them. [`Self::contact_pair`] and [`Self::proximity_pair`] return the contacts or
    /// the proximity of such a pair.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let balls = [(0.0, 0.0), (1.5, 1.5), (9.0, 0.0)].map(|(x, y)| {
    ///     world.add(Isometry::translation(x, y), ball.clone(), groups, ContactQuery::default(), x)
    /// });
    /// world.update();
    /// let near: Vec<_> = world.pairs_with(balls[0]).map(|other| *other.data()).collect();
    /// assert_eq!(near, [1.5], "their boxes overlap");
    /// assert_eq!(world.contacts_with(balls[0]).count(), 0, "but not the balls");
    /// ```
    #[doc(alias = "interactions_with")]
    pub fn pairs_with(
        &self,
        handle: CollisionObjectHandle,
    ) -> impl Iterator<Item = &CollisionObject<N, D, T>> {
        let is_known = self.contains(handle);
        let partners = is_known.then(|| self.narrow_phase.partners_of(&self.objects, handle));
        partners.into_iter().flatten().filter_map(|other| self.objects.get(other))
    }

    /// Iterates over the contact points of an object, each with the other object of its pair.
    ///
    /// The object is the first solid of each contact, whatever the order of the handles: `world1`,
    /// `feature1` and `part1` are on it, and the normal points from it to the other object. If an
    /// object is tested against itself, the first solid is the part with the lower index. Empty for
    /// a stale handle.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Vector};
    /// use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::new(0.02_f64);
    /// let (everybody, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
    /// let slab = ShapeHandle::new(Cuboid::new(Vector::new(4.0, 1.0)));
    /// world.add(Isometry::identity(), slab.clone(), everybody, contacts, "floor");
    /// let ball = ShapeHandle::new(Ball::new(1.0));
    /// let ball = world.add(Isometry::translation(0.0, 1.75), ball, everybody, contacts, "ball");
    /// world.add(Isometry::translation(0.0, 3.5), slab, everybody, contacts, "ceiling");
    /// world.update();
    /// let found = world.contacts_with(ball).map(|(other, point)| (*other.data(), point.contact.normal.y));
    /// assert_eq!(found.collect::<Vec<_>>(), [("floor", -1.0), ("ceiling", 1.0)]);
    /// // The displacement that moves the ball out: against each normal by the depth.
    /// let out = world.contacts_with(ball).map(|(_, point)| *point.contact.normal * -point.contact.depth);
    /// assert_eq!(out.sum::<Vector<f64>>(), Vector::zeros(), "it is stuck");
    /// ```
    pub fn contacts_with(
        &self,
        handle: CollisionObjectHandle,
    ) -> impl Iterator<Item = (&CollisionObject<N, D, T>, ContactPoint<N, D>)> {
        self.pairs_with(handle).flat_map(move |other| {
            let pair = self.contact_pair(handle, other.handle());
            let points =
                pair.into_iter().flat_map(ContactPair::views).flat_map(ManifoldView::contacts);
            let is_second = other.handle() < handle;
            points.map(move |point| (other, if is_second { point.flipped() } else { point }))
        })
    }

    /// Iterates over the objects that touch this object or are within the margin, each with its
    /// proximity, for pairs whose query is for proximity. Omits disjoint pairs, since their
    /// presence depends on the margin of the world. Empty for a stale handle.
    ///
    /// ```
    /// use impinge::dim3::events::Proximity;
    /// use impinge::dim3::math::Isometry;
    /// use impinge::dim3::shape::{Ball, ShapeHandle};
    /// use impinge::dim3::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (ball, everybody) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let near = GeometricQueryType::Proximity(0.5);
    /// let sensors = [0.0, 1.5, 3.0].map(|x| {
    ///     world.add(Isometry::translation(x, 0.0, 0.0), ball.clone(), everybody, near, x)
    /// });
    /// world.update();
    /// let found: Vec<_> = world.proximities_with(sensors[0]).map(|(other, p)| (*other.data(), p)).collect();
    /// assert_eq!(found, [(1.5, Proximity::Intersecting), (3.0, Proximity::WithinMargin)]);
    /// ```
    pub fn proximities_with(
        &self,
        handle: CollisionObjectHandle,
    ) -> impl Iterator<Item = (&CollisionObject<N, D, T>, Proximity)> {
        self.pairs_with(handle).filter_map(move |other| {
            let proximity = self.proximity_pair(handle, other.handle())?.proximity();
            (proximity != Proximity::Disjoint).then_some((other, proximity))
        })
    }
}
