//! Manifolds read where they are kept.

use core::slice;

use super::manifold::Placing;
use super::manifold_build::{Patch, PatchPoint};
use super::{
    Contact, ContactId, ContactManifold, Placement, RawManifold, RawPoint, TrackedContact,
};
use crate::math::{Real, Unit, Vector};
use crate::shape::FeatureId;

/// A contact as [`ManifoldView`] gives it: a [`TrackedContact`](super::TrackedContact) without its
/// kinematic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint<N: Real, const D: usize> {
    /// The geometry at the last update, in the world frame.
    pub contact: Contact<N, D>,
    /// The name, kept while the contact lives.
    pub id: ContactId,
    /// The feature of the first solid that touches.
    pub feature1: FeatureId,
    /// The feature of the second solid that touches.
    pub feature2: FeatureId,
    /// The part of the first shape that touches; 0 if the shape is not a composite.
    pub part1: u32,
    /// The part of the second shape that touches; 0 if the shape is not a composite.
    pub part2: u32,
}

/// A [`ContactManifold`] read where the narrow phase keeps it: each contact is placed in the world
/// when it is asked for, and nothing is stored.
///
/// It gives the same contacts, to the bit and in the same order, as the manifold that it stands for,
/// but not their kinematics. To read every contact of a world once, as a solver does, it is
/// several times faster: it moves a fifth of the memory. It always holds a contact.
#[derive(Clone, Copy, Debug)]
pub struct ManifoldView<'a, N: Real, const D: usize>(Kept<'a, N, D>);

/// What a view looks at.
#[derive(Clone, Copy, Debug)]
enum Kept<'a, N: Real, const D: usize> {
    /// The contacts of two convex solids.
    Convex(&'a RawManifold<N, D>, Placement<'a, N, D>),
    /// Some of the contacts of a composite.
    Patch(&'a Patch<N, D>, Placement<'a, N, D>),
    /// What an algorithm of the user's own has found.
    Made(&'a ContactManifold<N, D>),
}

impl<'a, N: Real, const D: usize> ManifoldView<'a, N, D> {
    pub(crate) fn of_convex(raw: &'a RawManifold<N, D>, placement: Placement<'a, N, D>) -> Self {
        Self(Kept::Convex(raw, placement))
    }

    pub(super) fn of_patch(patch: &'a Patch<N, D>, placement: Placement<'a, N, D>) -> Self {
        Self(Kept::Patch(patch, placement))
    }

    /// A view of a manifold; `None` if it is empty.
    #[must_use]
    pub fn of_manifold(manifold: &'a ContactManifold<N, D>) -> Option<Self> {
        (!manifold.is_empty()).then_some(Self(Kept::Made(manifold)))
    }

    /// How many contacts it holds: at least one.
    #[inline]
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a view is never empty")]
    pub fn len(&self) -> usize {
        match self.0 {
            Kept::Convex(raw, _) => raw.points.len(),
            Kept::Patch(patch, _) => patch.points.len(),
            Kept::Made(manifold) => manifold.len(),
        }
    }

    /// The unit vector from the first solid to the second, in the world frame: that of the first
    /// contact, which all contacts of a manifold share.
    #[must_use]
    pub fn normal(&self) -> Unit<Vector<N, D>> {
        match self.points() {
            Points::Convex(_, placing) | Points::Patch(_, placing) => placing.normal(),
            Points::Made(contacts) => contacts.as_slice()[0].contact.normal,
        }
    }

    /// The contacts, in the order in which they began.
    #[inline]
    pub fn contacts(self) -> impl ExactSizeIterator<Item = ContactPoint<N, D>> + 'a {
        self.points()
    }

    /// The contact of the largest depth, the first of equals.
    #[must_use]
    #[expect(clippy::missing_panics_doc, reason = "a view is never empty")]
    pub fn deepest_contact(&self) -> ContactPoint<N, D> {
        let deeper = |best: ContactPoint<N, D>, other: ContactPoint<N, D>| {
            if other.contact.depth > best.contact.depth { other } else { best }
        };
        self.points().reduce(deeper).expect("a view is never empty")
    }

    #[inline]
    fn points(self) -> Points<'a, N, D> {
        match self.0 {
            Kept::Convex(raw, placement) => {
                Points::Convex(raw.points.iter(), Placing::new(&raw.normal, placement))
            }
            Kept::Patch(patch, placement) => {
                Points::Patch(patch.points.iter(), Placing::new(&patch.normal, placement))
            }
            Kept::Made(manifold) => Points::Made(manifold.contacts().iter()),
        }
    }
}

/// The contacts of a [`ManifoldView`] that are yet to be read.
enum Points<'a, N: Real, const D: usize> {
    Convex(slice::Iter<'a, RawPoint<N, D>>, Placing<'a, N, D>),
    Patch(slice::Iter<'a, PatchPoint<N, D>>, Placing<'a, N, D>),
    Made(slice::Iter<'a, TrackedContact<N, D>>),
}

impl<N: Real, const D: usize> Iterator for Points<'_, N, D> {
    type Item = ContactPoint<N, D>;

    #[inline]
    fn next(&mut self) -> Option<ContactPoint<N, D>> {
        Some(match self {
            Self::Convex(points, placing) => placing.point(points.next()?, [0; 2]),
            Self::Patch(points, placing) => {
                let point = points.next()?;
                placing.point(&point.raw, point.parts)
            }
            Self::Made(contacts) => {
                let TrackedContact { contact, kinematic, id, part1, part2 } = *contacts.next()?;
                let (feature1, feature2) = (kinematic.feature1(), kinematic.feature2());
                ContactPoint { contact, id, feature1, feature2, part1, part2 }
            }
        })
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        let len = match self {
            Self::Convex(points, _) => points.len(),
            Self::Patch(points, _) => points.len(),
            Self::Made(contacts) => contacts.len(),
        };
        (len, Some(len))
    }
}

impl<N: Real, const D: usize> ExactSizeIterator for Points<'_, N, D> {}
