//! Contact manifolds as users see them: world frame, kinematics, ids.

use smallvec::SmallVec;

use super::{Contact, ContactKinematic};
use crate::math::Real;

/// The name of a contact: no two contacts of a world, at any time, share one.
///
/// A contact that moved between two updates keeps its id. The id says nothing else; its order is
/// that of creation within one pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactId {
    /// The number of the pair, never given twice.
    pub(crate) pair: u64,
    /// The number of the contact within the pair, never given twice.
    pub(crate) number: u32,
}

/// A contact, how it moves, and its name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackedContact<N: Real, const D: usize> {
    /// The geometry at the last update, in the world frame.
    pub contact: Contact<N, D>,
    /// What it takes to move the contact with its solids.
    pub kinematic: ContactKinematic<N, D>,
    /// The name, kept while the contact lives.
    pub id: ContactId,
}

/// Points that delimit a flat area of contact, with one common normal.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactManifold<N: Real, const D: usize> {
    pub(crate) contacts: SmallVec<[TrackedContact<N, D>; 4]>,
    pub(crate) deepest: usize,
}

impl<N: Real, const D: usize> ContactManifold<N, D> {
    /// How many contacts it holds.
    #[must_use]
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// It holds no contact.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// The contacts.
    #[must_use]
    pub fn contacts(&self) -> &[TrackedContact<N, D>] {
        &self.contacts
    }

    /// The index of the deepest contact, the first of equals; 0 for an empty manifold.
    #[must_use]
    pub fn deepest_contact_id(&self) -> usize {
        self.deepest
    }

    /// The deepest contact.
    #[must_use]
    pub fn deepest_contact(&self) -> Option<&TrackedContact<N, D>> {
        self.contacts.get(self.deepest)
    }
}
