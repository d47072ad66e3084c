//! Groups of pairs by algorithm, and the location of each pair's state in them.

use super::entry::{
    Change, ContactEntry, ContactView, CustomContactEntry, CustomProximityEntry, ProximityEntry,
    Status,
};
use super::group::{Group, PairKey, Taken};
use super::kind_groups::KindGroups;
use super::reuse::Reference;
use super::state::{CompositeState, ContactState, has_composite};
use crate::math::{Real, Space};
use crate::memory::{Look, clone_fields};
use crate::query::{ContactManifold, Proximity};
use crate::shape::{Shape, ShapeKind};

/// The group of a pair, which defines the algorithm that serves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Lane {
    /// Built-in contacts of two convex solids; the value is the index of their kinds
    /// ([`kind_pair`]).
    Contacts(u8),
    /// Built-in contacts with a composite.
    Composites,
    /// Built-in proximity; the value is the index of the kinds ([`kind_pair`]).
    Proximity(u8),
    CustomContacts,
    CustomProximity,
    /// No group: the dispatcher has no algorithm for the pair.
    Nothing,
}

/// A group and the index of a pair in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Location {
    pub(crate) lane: Lane,
    pub(crate) place: u32,
}

/// The status of a pair while its algorithm is replaced, from which events follow.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Carried {
    Contacts { is_touching: bool },
    Proximity(Status),
    Nothing,
}

impl Carried {
    /// Returns the change that ends the status; `None` if there is nothing to end.
    pub(crate) fn end(self) -> Option<Change> {
        match self {
            Self::Contacts { is_touching } => {
                is_touching.then_some(Change::Contact { touching: false })
            }
            Self::Proximity(status) => status.end(),
            Self::Nothing => None,
        }
    }

    /// Returns whether the pair was touching, and the change that ends the status of another kind
    /// of query.
    pub(crate) fn into_touching(self) -> (bool, Option<Change>) {
        match self {
            Self::Contacts { is_touching } => (is_touching, None),
            other => (false, other.end()),
        }
    }

    /// Returns the proximity to continue with, and the change that ends the status of another kind
    /// of query.
    pub(crate) fn into_status(self) -> (Status, Option<Change>) {
        match self {
            Self::Proximity(status) => (status, None),
            other => (Status(Proximity::Disjoint), other.end()),
        }
    }
}

/// Contacts of pairs of convex solids.
pub(crate) type ContactGroup<N, const D: usize> =
    Group<ContactEntry<N, ContactState<N, D>>, ContactView<ContactManifold<N, D>>, Reference<N, D>>;

/// Contacts of pairs with composites.
pub(crate) type CompositeGroup<N, const D: usize> = Group<
    ContactEntry<N, CompositeState<N, D>>,
    ContactView<Vec<ContactManifold<N, D>>>,
    Reference<N, D>,
>;

/// The states of all pairs, grouped by algorithm in dense arrays.
#[derive(Debug)]
pub(crate) struct PairLanes<N: Space<D>, const D: usize> {
    pub(crate) contacts: KindGroups<ContactGroup<N, D>>,
    pub(crate) composites: CompositeGroup<N, D>,
    pub(crate) proximity: KindGroups<Group<ProximityEntry<N>>>,
    pub(crate) custom_contacts: Group<CustomContactEntry<N, D>>,
    pub(crate) custom_proximity: Group<CustomProximityEntry<N, D>>,
}

clone_fields!([N: Space<D>, const D: usize] PairLanes<N, D> {
    contacts, composites, proximity, custom_contacts, custom_proximity,
});

impl<N: Space<D>, const D: usize> Default for PairLanes<N, D> {
    fn default() -> Self {
        Self {
            contacts: KindGroups::new(Group::default),
            composites: Group::default(),
            proximity: KindGroups::new(Group::default),
            custom_contacts: Group::default(),
            custom_proximity: Group::default(),
        }
    }
}

/// Returns the index of the unordered pair of kinds of two shapes.
pub(crate) fn kind_pair<N: Real, const D: usize>(
    shape1: &dyn Shape<N, D>,
    shape2: &dyn Shape<N, D>,
) -> u8 {
    let (kind1, kind2) = (shape1.geometry().kind(), shape2.geometry().kind());
    let (low, high) = if kind1 <= kind2 { (kind1, kind2) } else { (kind2, kind1) };
    let number = low as usize * ShapeKind::COUNT + high as usize;
    u8::try_from(number).expect("there are fewer than 16 kinds")
}

/// Returns the group of the built-in contacts of two shapes.
pub(crate) fn contact_lane<N: Real, const D: usize>(
    shape1: &dyn Shape<N, D>,
    shape2: &dyn Shape<N, D>,
) -> Lane {
    if has_composite(shape1, shape2) {
        return Lane::Composites;
    }
    Lane::Contacts(kind_pair(shape1, shape2))
}

impl<N: Space<D>, const D: usize> PairLanes<N, D> {
    /// Creates groups without pairs that store references, for contact reuse.
    pub(crate) fn with_references() -> Self {
        let contacts = KindGroups::new(Group::with_references);
        Self { contacts, composites: Group::with_references(), ..Self::default() }
    }

    /// Removes the state of a pair. Returns its status, and the pair that moved to its index.
    pub(crate) fn take(&mut self, location: Location) -> (Carried, Option<PairKey>) {
        let place = location.place;
        match location.lane {
            Lane::Contacts(lane) => contacts_of(self.contacts.of_mut(lane).swap_remove(place)),
            Lane::Composites => contacts_of(self.composites.swap_remove(place)),
            Lane::Proximity(lane) => {
                let Taken { state, moved, .. } = self.proximity.of_mut(lane).swap_remove(place);
                (Carried::Proximity(state.status), moved)
            }
            Lane::CustomContacts => contacts_of(self.custom_contacts.swap_remove(place)),
            Lane::CustomProximity => {
                let Taken { state, moved, .. } = self.custom_proximity.swap_remove(place);
                (Carried::Proximity(state.status), moved)
            }
            Lane::Nothing => (Carried::Nothing, None),
        }
    }

    /// Returns `true` if the pair has contact points.
    pub(crate) fn is_touching(&self, Location { lane, place }: Location) -> bool {
        match lane {
            Lane::Contacts(lane) => self.contacts.of(lane).is_touching(place),
            Lane::Composites => self.composites.is_touching(place),
            Lane::CustomContacts => self.custom_contacts.is_touching(place),
            Lane::Proximity(_) | Lane::CustomProximity | Lane::Nothing => false,
        }
    }

    /// Releases surplus memory of groups that have stopped growing.
    pub(crate) fn fit(&mut self, look: Look) {
        self.contacts.all_mut().iter_mut().for_each(|group| group.fit(look));
        self.composites.fit(look);
        self.proximity.all_mut().iter_mut().for_each(|group| group.fit(look));
    }

    /// Marks a pair as due even if neither object moves.
    pub(crate) fn make_due(&mut self, location: Location) {
        let place = location.place;
        match location.lane {
            Lane::Contacts(lane) => self.contacts.of_mut(lane).make_due(place),
            Lane::Composites => self.composites.make_due(place),
            Lane::Proximity(lane) => self.proximity.of_mut(lane).make_due(place),
            Lane::CustomContacts => self.custom_contacts.make_due(place),
            Lane::CustomProximity => self.custom_proximity.make_due(place),
            Lane::Nothing => {}
        }
    }
}

/// Returns the status of a removed pair, and the pair that moved to its index; `None` if there is
/// none.
fn contacts_of<S>(taken: Taken<S>) -> (Carried, Option<PairKey>) {
    (Carried::Contacts { is_touching: taken.is_touching }, taken.moved)
}
