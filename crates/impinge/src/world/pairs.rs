//! Access to the results of the last update: pairs, contacts, proximities, events.

use super::step::in_order;
use super::{CollisionObject, CollisionObjects, CollisionWorld};
use crate::math::Space;
use crate::narrow_phase::{
    CollisionObjectHandle, ContactEvent, ContactPair, ContactStream, ProximityEvent, ProximityPair,
};
use crate::query::{ContactManifold, ManifoldView};

type Object<N, const D: usize, T> = CollisionObject<N, D, T>;

/// Two objects and a manifold of their pair.
type PairView<'a, N, const D: usize, T> =
    (&'a Object<N, D, T>, &'a Object<N, D, T>, ManifoldView<'a, N, D>);

/// Iterator over manifolds with their objects, without manifolds of removed objects. It is a type
/// of its own, because the closure of an adapter such as `filter_map` is not inlined here and costs
/// a call for each manifold.
struct PairViews<'a, N: Space<D>, const D: usize, T, I> {
    objects: &'a CollisionObjects<N, D, T>,
    views: I,
}

/// The handles of two objects and a manifold of their pair.
type HandleView<'a, N, const D: usize> =
    (CollisionObjectHandle, CollisionObjectHandle, ManifoldView<'a, N, D>);

impl<'a, N: Space<D>, const D: usize, T, I> Iterator for PairViews<'a, N, D, T, I>
where
    I: Iterator<Item = HandleView<'a, N, D>>,
{
    type Item = PairView<'a, N, D, T>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let (handle1, handle2, view) = self.views.next()?;
            if let (Some(object1), Some(object2)) =
                (self.objects.get(handle1), self.objects.get(handle2))
            {
                return Some((object1, object2, view));
            }
        }
    }
}

/// Pairs, contacts and events of the last update. Pairs of objects that were removed since are
/// omitted.
///
/// In every pair the object with the smaller handle comes first; normals point from it to the
/// second object.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the contacts of two objects, given in either order. `None` for a stale handle, for
    /// objects without a pair in the broad phase, and for a pair whose query is for proximity.
    #[must_use]
    pub fn contact_pair(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'_, N, D>> {
        let (first, second) = self.pair(handle1, handle2)?;
        self.narrow_phase.contact_pair(&self.objects, first, second)
    }

    /// Returns the proximity of two objects, given in either order. `None` for a stale handle, for
    /// objects without a pair in the broad phase, and for a pair whose query is for contacts.
    #[must_use]
    pub fn proximity_pair(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair> {
        let (first, second) = self.pair(handle1, handle2)?;
        self.narrow_phase.proximity_pair(&self.objects, first, second)
    }

    /// Returns two handles in canonical order; `None` if one is stale.
    fn pair(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<(CollisionObjectHandle, CollisionObjectHandle)> {
        let alive = self.contains(handle1) && self.contains(handle2);
        alive.then(|| in_order(handle1, handle2))
    }

    /// Iterates over all pairs of the broad phase whose query is for contacts, with or without
    /// contact points. The margin of the world decides which pairs without points are included.
    pub fn contact_pairs(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, ContactPair<'_, N, D>)> {
        let pairs = self.narrow_phase.contact_pairs(&self.objects);
        pairs.filter_map(|(handle1, handle2, pair)| {
            Some((self.objects.get(handle1)?, self.objects.get(handle2)?, pair))
        })
    }

    /// Iterates over all pairs of the broad phase whose query is for proximity. The margin of the
    /// world decides which disjoint pairs are included.
    pub fn proximity_pairs(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, ProximityPair)> {
        let pairs = self.narrow_phase.proximity_pairs(&self.objects);
        pairs.filter_map(|(handle1, handle2, pair)| {
            Some((self.objects.get(handle1)?, self.objects.get(handle2)?, pair))
        })
    }

    /// Iterates over all manifolds with at least one contact, in the canonical order of their
    /// pairs. The contacts are those of [`Self::contact_views`]. Each manifold is built on first
    /// access.
    pub fn contact_manifolds(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, &ContactManifold<N, D>)> {
        let manifolds = self.narrow_phase.contact_manifolds(&self.objects);
        manifolds.filter_map(|(handle1, handle2, manifold)| {
            Some((self.objects.get(handle1)?, self.objects.get(handle2)?, manifold))
        })
    }

    /// Iterates over all manifolds with at least one contact, read in place if possible; see
    /// [`ManifoldView`].
    ///
    /// Manifolds come in memory order. The order is unspecified, but the same sequence of calls
    /// gives the same order on every machine and with any number of threads.
    ///
    /// ```
    /// use impinge::math::{Isometry2, Vector};
    /// use impinge::narrow_phase::GeometricQueryType;
    /// use impinge::shape::{Ball, ShapeHandle};
    /// use impinge::world::{CollisionGroups, CollisionWorld};
    ///
    /// let mut world = CollisionWorld::<f64, 2, &str>::new(0.02);
    /// let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    /// for (x, name) in [(0.0, "left"), (1.5, "right")] {
    ///     let ball = ShapeHandle::new(Ball::new(1.0));
    ///     world.add(Isometry2::translation(x, 0.0), ball, CollisionGroups::new(), contacts, name);
    /// }
    /// world.update();
    /// for (first, second, manifold) in world.contact_views() {
    ///     assert_eq!((*first.data(), *second.data()), ("left", "right"));
    ///     let depths: Vec<_> = manifold.contacts().map(|point| point.contact.depth).collect();
    ///     assert_eq!(depths, [0.5]);
    /// }
    /// # assert_eq!(world.contact_views().count(), 1);
    /// ```
    #[doc(alias = "contact_manifolds")]
    pub fn contact_views(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, ManifoldView<'_, N, D>)> {
        let views = self.narrow_phase.contact_views(&self.objects);
        PairViews { objects: &self.objects, views }
    }

    /// Splits the sequence of [`Self::contact_views`] into consecutive iterators over about equally
    /// many pairs: at least one iterator, and at most `pieces`. Each iterator can be sent to
    /// another thread.
    ///
    /// The cuts depend only on `pieces` and the pairs. Pairs that touch a mesh cost more than
    /// others, so some pieces take longer. With four pieces for each thread, idle threads can take
    /// over work.
    ///
    /// ```
    /// use impinge::math::{Isometry3, Vector};
    /// use impinge::narrow_phase::GeometricQueryType;
    /// use impinge::shape::{Ball, ShapeHandle};
    /// use impinge::world::{CollisionGroups, CollisionWorld};
    ///
    /// let mut world = CollisionWorld::<f32, 3, ()>::new(0.02);
    /// let ball = ShapeHandle::new(Ball::new(0.6));
    /// let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    /// for n in 0..1000 {
    ///     let position = Isometry3::translation(n as f32, 0.0, 0.0);
    ///     world.add(position, ball.clone(), CollisionGroups::new(), contacts, ());
    /// }
    /// world.update();
    /// let pieces = world.contact_view_pieces(4);
    /// assert_eq!(pieces.len(), 4);
    /// // With rayon: `pieces.into_par_iter().map(…).sum()`.
    /// let points: usize = std::thread::scope(|scope| {
    ///     let reading = pieces.into_iter().map(|views| {
    ///         let counts = views.map(|(_, _, manifold)| manifold.len());
    ///         scope.spawn(move || counts.sum::<usize>())
    ///     });
    ///     let threads: Vec<_> = reading.collect();
    ///     threads.into_iter().map(|thread| thread.join().expect("counting does not fail")).sum()
    /// });
    /// assert_eq!(points, 999);
    /// ```
    pub fn contact_view_pieces(
        &self,
        pieces: usize,
    ) -> Vec<impl Iterator<Item = PairView<'_, N, D, T>> + Send>
    where
        T: Sync,
    {
        let pieces = self.narrow_phase.contact_view_pieces(&self.objects, pieces);
        let views = pieces.into_iter().map(|views| PairViews { objects: &self.objects, views });
        views.collect()
    }

    /// Replaces the contents of `stream` by all contacts of the last update, in dense lists. Each
    /// contact also has its index in the previous contents of `stream`, if it was there. The
    /// contacts and their order are those of [`Self::contact_views`]; see [`ContactStream`] for an
    /// example.
    pub fn read_contacts(&self, stream: &mut ContactStream<N, D>) {
        self.narrow_phase.read_contacts(&self.objects, stream);
    }

    /// Returns the contact events of the last update: pairs that got their first contact point or
    /// lost their last one.
    #[must_use]
    pub fn contact_events(&self) -> &[ContactEvent] {
        self.events.contacts()
    }

    /// Returns the proximity events of the last update: pairs whose proximity changed.
    #[must_use]
    pub fn proximity_events(&self) -> &[ProximityEvent] {
        self.events.proximities()
    }
}
