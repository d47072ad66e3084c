//! What changed between two updates.

use super::CollisionObjectHandle;
use crate::memory::Look;
use crate::query::Proximity;

/// A pair came to have contact points, or lost its last.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ContactEvent {
    /// From none to at least one contact point.
    Started(CollisionObjectHandle, CollisionObjectHandle),
    /// From at least one contact point to none, or the pair is no more.
    Stopped(CollisionObjectHandle, CollisionObjectHandle),
}

impl ContactEvent {
    /// The two objects, in order.
    #[must_use]
    pub const fn handles(&self) -> (CollisionObjectHandle, CollisionObjectHandle) {
        match *self {
            Self::Started(first, second) | Self::Stopped(first, second) => (first, second),
        }
    }
}

/// The proximity of a pair changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ProximityEvent {
    /// The object whose handle comes first.
    pub collider1: CollisionObjectHandle,
    /// The other object.
    pub collider2: CollisionObjectHandle,
    /// How near they were at the update before.
    pub prev_status: Proximity,
    /// How near they are now; never equal to `prev_status`.
    pub new_status: Proximity,
}

/// The events of one update, and those that removals queue for the next.
///
/// Order within a batch: first what removals queued, then all else; each part sorted by handles,
/// events of the same pair in the order in which they happened.
#[derive(Clone, Debug, Default)]
pub struct Events {
    contacts: Vec<ContactEvent>,
    proximities: Vec<ProximityEvent>,
    /// How many events at the front of each list came from removals.
    removed: (usize, usize),
}

impl Events {
    /// Starts the next batch with what the removals since the last one have left in `queued`.
    pub(crate) fn begin_batch(&mut self, queued: &mut Self) {
        queued.sort();
        self.contacts.clear();
        self.contacts.append(&mut queued.contacts);
        self.proximities.clear();
        self.proximities.append(&mut queued.proximities);
        self.removed = (self.contacts.len(), self.proximities.len());
    }

    /// Brings the events after the removals' into canonical order. What a pair was ends before what
    /// it is now begins, so of the two events that a pair may have the one that begins is the later.
    pub(crate) fn sort(&mut self) {
        let begins = |event: &ContactEvent| matches!(event, ContactEvent::Started(..));
        self.contacts[self.removed.0..].sort_unstable_by_key(|e| (e.handles(), begins(e)));
        let begins = |event: &ProximityEvent| event.prev_status == Proximity::Disjoint;
        self.proximities[self.removed.1..]
            .sort_unstable_by_key(|e| (e.collider1, e.collider2, begins(e)));
    }

    /// How many events there are.
    pub(crate) fn len(&self) -> usize {
        self.contacts.len() + self.proximities.len()
    }

    /// Gives back the memory of lists that have been short for some time.
    pub(crate) fn give_back(&mut self, look: Look) {
        look.trim(&mut self.contacts);
        look.trim(&mut self.proximities);
    }

    /// Adds a contact event.
    pub fn push_contact(&mut self, event: ContactEvent) {
        self.contacts.push(event);
    }

    /// Adds a proximity event, unless nothing changed.
    pub fn push_proximity(&mut self, event: ProximityEvent) {
        if event.prev_status != event.new_status {
            self.proximities.push(event);
        }
    }

    /// The contact events of the batch.
    #[must_use]
    pub fn contacts(&self) -> &[ContactEvent] {
        &self.contacts
    }

    /// The proximity events of the batch.
    #[must_use]
    pub fn proximities(&self) -> &[ProximityEvent] {
        &self.proximities
    }
}
