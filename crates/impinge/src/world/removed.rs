//! Removed objects, which are kept as long as an event contains their handle, so that readers of
//! events can access them.

use std::collections::{BTreeMap, BTreeSet};

use super::{CollisionObject, CollisionWorld};
use crate::math::Space;
use crate::memory::clone_fields;
use crate::narrow_phase::{CollisionObjectHandle, Events};

/// The removed objects whose handles are in events, and the set of all handles in events.
///
/// As long as no object is removed, nothing is stored and no event is read.
pub(super) struct RemovedObjects<N: Space<D>, const D: usize, T> {
    pub(super) objects: BTreeMap<CollisionObjectHandle, CollisionObject<N, D, T>>,
    /// The handles in the events that [`Self::note`] has read since the last update.
    referenced: BTreeSet<CollisionObjectHandle>,
    /// Numbers of contact and proximity events that have been read: first of the events of the last
    /// update, then of the events queued since.
    num_read: [(usize, usize); 2],
}

clone_fields!([N: Space<D>, const D: usize, T: Clone] RemovedObjects<N, D, T> { objects, referenced, num_read });

impl<N: Space<D>, const D: usize, T> RemovedObjects<N, D, T> {
    pub(super) const fn new() -> Self {
        Self { objects: BTreeMap::new(), referenced: BTreeSet::new(), num_read: [(0, 0); 2] }
    }

    /// Reads the events that were added since the last call, and stores the handles in them.
    pub(super) fn note(&mut self, events: &Events, queued: &Events) {
        for (num_read, events) in self.num_read.iter_mut().zip([events, queued]) {
            self.referenced.extend(events.handles_since(*num_read));
            *num_read = events.counts();
        }
    }

    /// Keeps a removed object if an event has its handle; otherwise drops it.
    pub(super) fn keep(&mut self, object: CollisionObject<N, D, T>) {
        let handle = object.handle();
        if self.referenced.contains(&handle) {
            self.objects.insert(handle, object);
        }
    }

    /// Starts a new set of handles, and drops the objects whose handles are in none of `events`.
    pub(super) fn keep_referenced(&mut self, events: &Events) {
        self.referenced.clear();
        self.num_read = [(0, 0); 2];
        if !self.objects.is_empty() {
            let is_kept = |handle: &CollisionObjectHandle| self.objects.contains_key(handle);
            let referenced: BTreeSet<_> = events.handles_since((0, 0)).filter(is_kept).collect();
            self.objects.retain(|handle, _| referenced.contains(handle));
        }
    }
}

/// Access to removed objects whose handles are still in events.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns a removed object, in its last state, as long as an event contains its handle: an
    /// event of the last update, or an event that the removal has queued for the next update. So
    /// every handle in [`Self::contact_events`] and [`Self::proximity_events`] has an object, which
    /// this method or [`Self::collision_object`] returns.
    ///
    /// `None` for an object that has not been removed, for a stale handle in no event, and for an
    /// object taken by [`Self::take_removed`]. A removed object whose handle is in no event is
    /// dropped at once. Otherwise it is dropped by the update that discards the last event with its
    /// handle: without [`Self::keep_events`], at the latest the second update after the removal.
    /// Until then its data and shape take memory.
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

    /// Takes the data of a removed object, which [`Self::removed_object`] then no longer returns.
    /// `None` if that method returns `None` for this handle.
    pub fn take_removed(&mut self, handle: CollisionObjectHandle) -> Option<T> {
        self.removed.objects.remove(&handle).map(|object| object.data)
    }
}
