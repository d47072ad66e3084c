//! Reading what the last update found: pairs, contacts, proximities, events.

use super::step::in_order;
use super::{CollisionObject, CollisionWorld};
use crate::math::Space;
use crate::narrow_phase::{
    CollisionObjectHandle, ContactEvent, ContactPair, ProximityEvent, ProximityPair,
};
use crate::query::ContactManifold;

type Object<N, const D: usize, T> = CollisionObject<N, D, T>;

/// Pairs, contacts and events of the last update; pairs of objects that were removed since are gone.
///
/// Everywhere the object whose handle comes first is the first of its pair: normals point from it.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// The contacts of two objects, whichever is named first; `None` for a stale handle, and for a
    /// pair that the broad phase does not keep or that is asked for proximity only.
    #[must_use]
    pub fn contact_pair(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'_, N, D>> {
        let (first, second) = self.pair(handle1, handle2)?;
        self.narrow_phase.contact_pair(&self.objects, first, second)
    }

    /// The proximity of two objects, whichever is named first; `None` for a stale handle, and for a
    /// pair that the broad phase does not keep or that is asked for contacts.
    #[must_use]
    pub fn proximity_pair(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair> {
        let (first, second) = self.pair(handle1, handle2)?;
        self.narrow_phase.proximity_pair(&self.objects, first, second)
    }

    /// Two living objects in order.
    fn pair(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<(CollisionObjectHandle, CollisionObjectHandle)> {
        let alive = self.contains(handle1) && self.contains(handle2);
        alive.then(|| in_order(handle1, handle2))
    }

    /// All pairs that the broad phase keeps and that are asked for contacts, with or without
    /// contacts; which ones without depends on the margin.
    pub fn contact_pairs(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, ContactPair<'_, N, D>)> {
        let pairs = self.narrow_phase.contact_pairs(&self.objects);
        pairs.filter_map(|(handle1, handle2, pair)| {
            Some((self.objects.get(handle1)?, self.objects.get(handle2)?, pair))
        })
    }

    /// All pairs that the broad phase keeps and that are asked for proximity; which of the disjoint
    /// ones depends on the margin.
    pub fn proximity_pairs(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, ProximityPair)> {
        let pairs = self.narrow_phase.proximity_pairs(&self.objects);
        pairs.filter_map(|(handle1, handle2, pair)| {
            Some((self.objects.get(handle1)?, self.objects.get(handle2)?, pair))
        })
    }

    /// All manifolds that hold a contact.
    pub fn contact_manifolds(
        &self,
    ) -> impl Iterator<Item = (&Object<N, D, T>, &Object<N, D, T>, &ContactManifold<N, D>)> {
        let manifolds = self.narrow_phase.contact_manifolds(&self.objects);
        manifolds.filter_map(|(handle1, handle2, manifold)| {
            Some((self.objects.get(handle1)?, self.objects.get(handle2)?, manifold))
        })
    }

    /// Which pairs came to have contact points at the last update, and which lost their last.
    #[must_use]
    pub fn contact_events(&self) -> &[ContactEvent] {
        self.events.contacts()
    }

    /// Which pairs changed their proximity at the last update.
    #[must_use]
    pub fn proximity_events(&self) -> &[ProximityEvent] {
        self.events.proximities()
    }
}
