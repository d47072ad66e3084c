//! Removed objects, kept as long as an event names them.

use std::collections::{BTreeMap, BTreeSet};

use super::{CollisionObject, CollisionWorld};
use crate::math::Space;
use crate::memory::clone_fields;
use crate::narrow_phase::{CollisionObjectHandle, Events};

/// The removed objects that events name, and the set of handles named.
///
/// Until an object is removed, nothing is stored and no event is read.
pub(super) struct RemovedObjects<N: Space<D>, const D: usize, T> {
    pub(super) objects: BTreeMap<CollisionObjectHandle, CollisionObject<N, D, T>>,
    /// Handles named by the events that [`Self::note`] has read since the update.
    named: BTreeSet<CollisionObjectHandle>,
    /// Numbers of contact and proximity events already read: of the last update, and queued since.
    noted: [(usize, usize); 2],
}

clone_fields!([N: Space<D>, const D: usize, T: Clone] RemovedObjects<N, D, T> { objects, named, noted });

impl<N: Space<D>, const D: usize, T> RemovedObjects<N, D, T> {
    pub(super) const fn new() -> Self {
        Self { objects: BTreeMap::new(), named: BTreeSet::new(), noted: [(0, 0); 2] }
    }

    /// Reads the events that came since the last call, and notes the handles that they name.
    pub(super) fn note(&mut self, events: &Events, queued: &Events) {
        for (noted, events) in self.noted.iter_mut().zip([events, queued]) {
            self.named.extend(events.named_from(*noted));
            *noted = events.counts();
        }
    }

    /// Keeps a removed object if an event names it, else drops it.
    pub(super) fn keep(&mut self, object: CollisionObject<N, D, T>) {
        let handle = object.handle();
        if self.named.contains(&handle) {
            self.objects.insert(handle, object);
        }
    }

    /// Drops the objects that no event of the new batch names.
    pub(super) fn keep_named(&mut self, events: &Events) {
        self.named.clear();
        self.noted = [(0, 0); 2];
        if !self.objects.is_empty() {
            let is_here = |handle: &CollisionObjectHandle| self.objects.contains_key(handle);
            let named: BTreeSet<_> = events.named_from((0, 0)).filter(is_here).collect();
            self.objects.retain(|handle, _| named.contains(handle));
        }
    }
}

/// Removed objects that events still name.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns a removed object, in its last state, as long as an event names it: one of the last
    /// update, or one that its removal has queued for the next. So every handle in
    /// [`Self::contact_events`] and [`Self::proximity_events`] has its object, here or by
    /// [`Self::collision_object`].
    ///
    /// `None` for objects that are there, for stale handles that no event names, and for objects
    /// taken by [`Self::take_removed`]. A removed object that no event names is dropped at once.
    /// Others are dropped by the update that discards the last event naming them: without
    /// [`Self::keep_events`] that is the second one after the removal at the latest. Until then
    /// their data and shapes take memory.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, ContactQuery};
    ///
    /// let mut world = CollisionWorld::<f32, &str>::new(0.02);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let mut add = |name| {
    ///     world.add(Isometry::identity(), ball.clone(), groups, ContactQuery::default(), name)
    /// };
    /// let [_, coin] = ["player", "coin"].map(|name| add(name));
    /// world.update();
    /// world.remove(&[coin]);
    /// world.update();
    /// let (_, gone) = world.contact_events()[0].handles();
    /// assert!(world.collision_object(gone).is_none());
    /// assert_eq!(world.removed_object(gone).map(|object| *object.data()), Some("coin"));
    /// world.update();
    /// assert!(world.removed_object(gone).is_none(), "no event names it any more");
    /// ```
    #[must_use]
    pub fn removed_object(
        &self,
        handle: CollisionObjectHandle,
    ) -> Option<&CollisionObject<N, D, T>> {
        self.removed.objects.get(&handle)
    }

    /// Takes the data of a removed object, which [`Self::removed_object`] no longer returns
    /// afterwards.
    pub fn take_removed(&mut self, handle: CollisionObjectHandle) -> Option<T> {
        self.removed.objects.remove(&handle).map(|object| object.data)
    }
}
