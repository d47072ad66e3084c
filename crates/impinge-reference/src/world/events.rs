//! What changed between two updates.

use super::Handle;

/// How close two objects are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Proximity {
    /// They touch or interpenetrate: the signed distance is at most zero.
    Intersecting,
    /// They are apart, by no more than the sum of their margins.
    WithinMargin,
    /// They are farther apart, or may not interact.
    #[default]
    Disjoint,
}

/// A pair of objects with query type contacts got its first contact point or lost its last. The
/// smaller handle comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ContactEvent {
    /// From no contact point to at least one.
    Started(Handle, Handle),
    /// From at least one contact point to none.
    Stopped(Handle, Handle),
}

impl ContactEvent {
    /// The objects, the smaller handle first.
    #[must_use]
    pub fn pair(self) -> (Handle, Handle) {
        match self {
            Self::Started(handle1, handle2) | Self::Stopped(handle1, handle2) => (handle1, handle2),
        }
    }
}

/// The status of a pair of which at least one object has query type proximity changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ProximityEvent {
    /// The smaller handle.
    pub collider1: Handle,
    /// The greater handle.
    pub collider2: Handle,
    /// The status at the update before.
    pub previous: Proximity,
    /// Another status.
    pub new: Proximity,
}

/// All events of one update. In both lists the events of removed objects come first, sorted by
/// pair; then those of living objects, sorted by pair. Pairs computed between updates count to the removals;
/// only such a pair can have several events in a list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Events {
    /// Starts and stops of contacts.
    pub contacts: Vec<ContactEvent>,
    /// Transitions between proximities.
    pub proximities: Vec<ProximityEvent>,
    /// How many of `contacts` are due to removals.
    pub removed_contacts: usize,
    /// How many of `proximities` are due to removals.
    pub removed_proximities: usize,
}

/// What one update found out about a pair; pairs of which nothing is to be said have the default.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PairState {
    /// Whether contact points exist.
    pub(super) touching: bool,
    pub(super) proximity: Proximity,
}

impl Events {
    /// Adds what is different between two states of a pair.
    pub(super) fn push_change(
        &mut self,
        (handle1, handle2): (Handle, Handle),
        before: PairState,
        after: PairState,
    ) {
        if !before.touching && after.touching {
            self.contacts.push(ContactEvent::Started(handle1, handle2));
        }
        if before.touching && !after.touching {
            self.contacts.push(ContactEvent::Stopped(handle1, handle2));
        }
        if before.proximity != after.proximity {
            self.proximities.push(ProximityEvent {
                collider1: handle1,
                collider2: handle2,
                previous: before.proximity,
                new: after.proximity,
            });
        }
    }

    /// Appends the events of a later update.
    pub fn append(&mut self, later: &Self) {
        self.contacts.extend(&later.contacts);
        self.proximities.extend(&later.proximities);
    }

    /// Sorts what was collected while objects were removed, and remembers how much that is.
    pub(super) fn close_removals(&mut self) {
        // Events of one pair stay in the order in which they came.
        self.contacts.sort_by_key(|event| event.pair());
        self.proximities.sort_by_key(|event| (event.collider1, event.collider2));
        self.removed_contacts = self.contacts.len();
        self.removed_proximities = self.proximities.len();
    }
}
