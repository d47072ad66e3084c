//! The changes between two updates.

use super::Handle;

/// The proximity of two objects.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Proximity {
    /// The signed distance is at most zero.
    Intersecting,
    /// The signed distance is positive, and at most the sum of the margins.
    WithinMargin,
    /// The objects are farther apart than the sum of the margins, or may not interact.
    #[default]
    Disjoint,
}

/// A change of a pair of objects that both query contacts. The smaller handle comes first.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ContactEvent {
    /// The pair got its first contact point.
    Started(Handle, Handle),
    /// The pair lost its last contact point.
    Stopped(Handle, Handle),
}

impl ContactEvent {
    /// Returns the two handles, the smaller first.
    #[must_use]
    pub fn pair(self) -> (Handle, Handle) {
        match self {
            Self::Started(handle1, handle2) | Self::Stopped(handle1, handle2) => (handle1, handle2),
        }
    }
}

/// A change of the proximity of a pair, at least one object of which queries proximity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ProximityEvent {
    /// The smaller handle.
    pub collider1: Handle,
    /// The greater handle.
    pub collider2: Handle,
    /// The proximity at the previous update.
    pub previous: Proximity,
    /// The new proximity, which differs from `previous`.
    pub new: Proximity,
}

/// All events of one update. In both lists the events of removals come first, then those of living
/// objects; each of the two groups is sorted by pair. Events of pairs computed between updates
/// belong to the first group. Only such a pair can have several events in a list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Events {
    /// Starts and stops of contacts.
    pub contacts: Vec<ContactEvent>,
    /// Changes of proximity.
    pub proximities: Vec<ProximityEvent>,
    /// The number of events at the start of `contacts` that removals, or pairs computed between
    /// updates, caused.
    pub removed_contacts: usize,
    /// The number of events at the start of `proximities` that removals, or pairs computed between
    /// updates, caused.
    pub removed_proximities: usize,
}

/// The state of a pair as of an update. Pairs that neither touch nor are near have the default
/// state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct PairState {
    /// Whether the pair has contact points.
    pub(super) touching: bool,
    pub(super) proximity: Proximity,
}

impl Events {
    /// Adds the events of the change from one state of a pair to another.
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

    /// Appends the events of a later update. The counts of removals are unchanged.
    pub fn append(&mut self, later: &Self) {
        self.contacts.extend(&later.contacts);
        self.proximities.extend(&later.proximities);
    }

    /// Sorts the events collected so far by pair, and stores their number as that of the removals.
    pub(super) fn close_removals(&mut self) {
        // The sorts are stable: events of one pair stay in the order in which they occurred.
        self.contacts.sort_by_key(|event| event.pair());
        self.proximities.sort_by_key(|event| (event.collider1, event.collider2));
        self.removed_contacts = self.contacts.len();
        self.removed_proximities = self.proximities.len();
    }
}
