//! Groups of pairs by algorithm, and the location of each pair's state in them.

use super::entry::{
    Change, ContactEntry, ContactView, CustomContactEntry, CustomProximityEntry, ProximityEntry,
    Status,
};
use super::group::{Group, PairKey, RemovedRow};
use super::kind_groups::KindGroups;
use super::reuse::Reference;
use super::state::{CompositeState, ContactState, has_composite};
use crate::math::{Real, Space};
use crate::memory::{Look, clone_fields};
use crate::query::{ContactManifold, Proximity};
use crate::shape::{Shape, ShapeKind};

/// The group of a pair, which defines the algorithm that serves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum GroupId {
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

/// A group and the row of a pair in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Location {
    pub(crate) group: GroupId,
    pub(crate) row: u32,
}

/// The status that a pair keeps while its algorithm is replaced. It determines the events of the
/// replacement.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Carried {
    Contacts { is_touching: bool },
    Proximity(Status),
    Nothing,
}

impl Carried {
    /// Returns the change that ends the status; `None` for a status that has no event at its end.
    pub(crate) fn end(self) -> Option<Change> {
        match self {
            Self::Contacts { is_touching } => {
                is_touching.then_some(Change::Contact { touching: false })
            }
            Self::Proximity(status) => status.end(),
            Self::Nothing => None,
        }
    }

    /// Returns whether the pair is touching, for a new contact algorithm. If the status belongs to
    /// a proximity query, returns `false` and the change that ends the status.
    pub(crate) fn into_touching(self) -> (bool, Option<Change>) {
        match self {
            Self::Contacts { is_touching } => (is_touching, None),
            other => (false, other.end()),
        }
    }

    /// Returns the proximity of the pair, for a new proximity algorithm. If the status belongs to a
    /// contact query, returns `Disjoint` and the change that ends the status.
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
pub(crate) struct PairGroups<N: Space<D>, const D: usize> {
    pub(crate) contacts: KindGroups<ContactGroup<N, D>>,
    pub(crate) composites: CompositeGroup<N, D>,
    pub(crate) proximity: KindGroups<Group<ProximityEntry<N>>>,
    pub(crate) custom_contacts: Group<CustomContactEntry<N, D>>,
    pub(crate) custom_proximity: Group<CustomProximityEntry<N, D>>,
}

clone_fields!([N: Space<D>, const D: usize] PairGroups<N, D> {
    contacts, composites, proximity, custom_contacts, custom_proximity,
});

impl<N: Space<D>, const D: usize> Default for PairGroups<N, D> {
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

/// Returns the index of the unordered pair of kinds of two shapes: the same index for both orders.
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
pub(crate) fn contact_group<N: Real, const D: usize>(
    shape1: &dyn Shape<N, D>,
    shape2: &dyn Shape<N, D>,
) -> GroupId {
    if has_composite(shape1, shape2) {
        return GroupId::Composites;
    }
    GroupId::Contacts(kind_pair(shape1, shape2))
}

impl<N: Space<D>, const D: usize> PairGroups<N, D> {
    /// Creates groups without pairs that store references, for contact reuse.
    pub(crate) fn with_references() -> Self {
        let contacts = KindGroups::new(Group::with_references);
        Self { contacts, composites: Group::with_references(), ..Self::default() }
    }

    /// Removes the state of a pair. Returns its status, and the pair that moved to its row; `None`
    /// if no pair moved.
    pub(crate) fn take(&mut self, location: Location) -> (Carried, Option<PairKey>) {
        let row = location.row;
        match location.group {
            GroupId::Contacts(kinds) => {
                removed_contacts(self.contacts.of_mut(kinds).swap_remove(row))
            }
            GroupId::Composites => removed_contacts(self.composites.swap_remove(row)),
            GroupId::Proximity(kinds) => {
                let RemovedRow { state, moved, .. } = self.proximity.of_mut(kinds).swap_remove(row);
                (Carried::Proximity(state.status), moved)
            }
            GroupId::CustomContacts => removed_contacts(self.custom_contacts.swap_remove(row)),
            GroupId::CustomProximity => {
                let RemovedRow { state, moved, .. } = self.custom_proximity.swap_remove(row);
                (Carried::Proximity(state.status), moved)
            }
            GroupId::Nothing => (Carried::Nothing, None),
        }
    }

    /// Returns `true` if the pair has contact points.
    pub(crate) fn is_touching(&self, Location { group, row }: Location) -> bool {
        match group {
            GroupId::Contacts(kinds) => self.contacts.of(kinds).is_touching(row),
            GroupId::Composites => self.composites.is_touching(row),
            GroupId::CustomContacts => self.custom_contacts.is_touching(row),
            GroupId::Proximity(_) | GroupId::CustomProximity | GroupId::Nothing => false,
        }
    }

    /// Releases surplus memory of groups that have stopped growing.
    pub(crate) fn fit(&mut self, look: Look) {
        self.contacts.all_mut().iter_mut().for_each(|group| group.fit(look));
        self.composites.fit(look);
        self.proximity.all_mut().iter_mut().for_each(|group| group.fit(look));
    }

    /// Marks a pair as dirty, so that the next update computes it even if neither object moves.
    pub(crate) fn mark_dirty(&mut self, location: Location) {
        let row = location.row;
        match location.group {
            GroupId::Contacts(kinds) => self.contacts.of_mut(kinds).mark_dirty(row),
            GroupId::Composites => self.composites.mark_dirty(row),
            GroupId::Proximity(kinds) => self.proximity.of_mut(kinds).mark_dirty(row),
            GroupId::CustomContacts => self.custom_contacts.mark_dirty(row),
            GroupId::CustomProximity => self.custom_proximity.mark_dirty(row),
            GroupId::Nothing => {}
        }
    }
}

/// Returns the status of a removed pair of a contact query, and the pair that moved to its row;
/// `None` if no pair moved.
fn removed_contacts<S>(removed: RemovedRow<S>) -> (Carried, Option<PairKey>) {
    (Carried::Contacts { is_touching: removed.is_touching }, removed.moved)
}
