//! Events: changes of the statuses of pairs between two updates.
//!
//! Each `Started` is followed by exactly one `Stopped`, whatever ends the contact.

use core::fmt;

use super::CollisionObjectHandle;
use crate::memory::{Look, clone_fields};
use crate::query::Proximity;

/// A pair got its first contact point or lost its last.
///
/// ```
/// use impinge::dim2::events::ContactEvent;
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let ball = ShapeHandle::new(Ball::new(1.0));
/// let [a, b] = [0.0, 1.0].map(|x| {
///     let query = GeometricQueryType::Contacts(0.0, 0.0);
///     world.add(Isometry::translation(x, 0.0), ball.clone(), CollisionGroups::new(), query, ())
/// });
/// world.update();
/// assert_eq!(world.contact_events(), [ContactEvent::Started(a, b)]);
/// world.set_position(b, Isometry::translation(9.0, 0.0));
/// world.update();
/// assert_eq!(world.contact_events(), [ContactEvent::Stopped(a, b)]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ContactEvent {
    /// From none to at least one contact point.
    Started(CollisionObjectHandle, CollisionObjectHandle),
    /// From at least one contact point to none, or to the end of the pair.
    Stopped(CollisionObjectHandle, CollisionObjectHandle),
}

impl ContactEvent {
    /// Returns the two objects, the smaller handle first.
    #[must_use]
    pub const fn handles(&self) -> (CollisionObjectHandle, CollisionObjectHandle) {
        match *self {
            Self::Started(first, second) | Self::Stopped(first, second) => (first, second),
        }
    }
}

/// A pair changed its proximity.
///
/// ```
/// use impinge::dim2::events::{Proximity, ProximityEvent};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let ball = ShapeHandle::new(Ball::new(1.0));
/// let [collider1, collider2] = [0.0, 1.0].map(|x| {
///     let query = GeometricQueryType::Proximity(0.0);
///     world.add(Isometry::translation(x, 0.0), ball.clone(), CollisionGroups::new(), query, ())
/// });
/// world.update();
/// let (prev_status, new_status) = (Proximity::Disjoint, Proximity::Intersecting);
/// let enters = ProximityEvent { collider1, collider2, prev_status, new_status };
/// assert_eq!(world.proximity_events(), [enters]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ProximityEvent {
    /// The object with the smaller handle.
    pub collider1: CollisionObjectHandle,
    /// The object with the larger handle.
    pub collider2: CollisionObjectHandle,
    /// Proximity at the previous computation of the pair; `Disjoint` for a new pair.
    pub prev_status: Proximity,
    /// Proximity at this computation, or `Disjoint` if the pair ended; never equal to
    /// `prev_status`.
    pub new_status: Proximity,
}

/// Events of an update, or of several updates if the world keeps events. Removals and updates of
/// single pairs queue events for the next update.
///
/// Order within the batch of an update: first the queued events, then all others. Each part is
/// sorted by handles. Events of the same pair are in the order in which they occurred.
///
/// ```
/// use impinge::dim2::events::Events;
///
/// // A custom narrow phase receives such a list to report in.
/// let events = Events::default();
/// assert!(events.contacts().is_empty() && events.proximities().is_empty());
/// ```
#[derive(Default)]
pub struct Events {
    contacts: Vec<ContactEvent>,
    proximities: Vec<ProximityEvent>,
    /// Number of contact and of proximity events at the front that are already in order: kept and
    /// queued events.
    sorted: (usize, usize),
}

clone_fields!([] Events { contacts, proximities, sorted });

impl fmt::Debug for Events {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Events")
            .field("contacts", &self.contacts)
            .field("proximities", &self.proximities)
            .finish()
    }
}

impl Events {
    /// Removes all events.
    pub(crate) fn clear(&mut self) {
        self.contacts.clear();
        self.proximities.clear();
    }

    /// Begins the next batch behind the present events. It starts with the events of `queued`,
    /// sorted by handles; events of the same pair keep their order. Empties `queued`.
    pub(crate) fn begin_batch(&mut self, queued: &mut Self) {
        queued.contacts.sort_by_key(ContactEvent::handles);
        queued.proximities.sort_by_key(|event| (event.collider1, event.collider2));
        self.contacts.append(&mut queued.contacts);
        self.proximities.append(&mut queued.proximities);
        self.sorted = (self.contacts.len(), self.proximities.len());
    }

    /// Sorts the events of the update into canonical order. If one list has two events of a pair,
    /// the event that ends the old status comes first.
    pub(crate) fn sort(&mut self) {
        let begins = |event: &ContactEvent| matches!(event, ContactEvent::Started(..));
        self.contacts[self.sorted.0..].sort_unstable_by_key(|e| (e.handles(), begins(e)));
        let begins = |event: &ProximityEvent| event.prev_status == Proximity::Disjoint;
        self.proximities[self.sorted.1..]
            .sort_unstable_by_key(|e| (e.collider1, e.collider2, begins(e)));
    }

    /// Iterates over the handles in the contact events from index `contacts` on, and in the
    /// proximity events from index `proximities` on. Handles may repeat.
    pub(crate) fn handles_since(
        &self,
        (contacts, proximities): (usize, usize),
    ) -> impl Iterator<Item = CollisionObjectHandle> + '_ {
        let contacts = self.contacts[contacts..].iter().map(ContactEvent::handles);
        let proximities = self.proximities[proximities..].iter();
        let proximities = proximities.map(|event| (event.collider1, event.collider2));
        contacts.chain(proximities).flat_map(|(first, second)| [first, second])
    }

    /// Returns the number of contact events and the number of proximity events.
    pub(crate) const fn counts(&self) -> (usize, usize) {
        (self.contacts.len(), self.proximities.len())
    }

    /// Returns the number of events of both kinds.
    pub(crate) fn len(&self) -> usize {
        self.contacts.len() + self.proximities.len()
    }

    /// Releases the memory of lists that have been short for some time.
    pub(crate) fn give_back(&mut self, look: Look) {
        look.trim(&mut self.contacts);
        look.trim(&mut self.proximities);
    }

    /// Adds a contact event.
    pub fn push_contact(&mut self, event: ContactEvent) {
        self.contacts.push(event);
    }

    /// Adds a proximity event, unless both statuses are equal.
    pub fn push_proximity(&mut self, event: ProximityEvent) {
        if event.prev_status != event.new_status {
            self.proximities.push(event);
        }
    }

    /// Returns the contact events, in the order that [`Events`] describes.
    #[must_use]
    pub fn contacts(&self) -> &[ContactEvent] {
        &self.contacts
    }

    /// Returns the proximity events, in the order that [`Events`] describes.
    #[must_use]
    pub fn proximities(&self) -> &[ProximityEvent] {
        &self.proximities
    }
}
