//! Manifolds read where they are kept.

use core::slice;

use super::manifold_build::{Patch, PatchPoint};
use super::{
    Contact, ContactId, ContactManifold, Placement, RawManifold, RawPoint, TrackedContact,
};
use crate::math::{Point, Real, Unit, Vector};
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
        let world = |own: &Vector<N, D>, placement: &Placement<'_, N, D>| {
            let normal = placement.pose1.vector(own);
            Unit::new_unchecked(if placement.is_swapped { -normal } else { normal })
        };
        match self.0 {
            Kept::Convex(raw, placement) => world(&raw.normal, &placement),
            Kept::Patch(patch, placement) => world(&patch.normal, &placement),
            Kept::Made(manifold) => manifold.contacts()[0].contact.normal,
        }
    }

    /// The contacts, in the order in which they began.
    #[inline]
    pub fn contacts(self) -> impl ExactSizeIterator<Item = ContactPoint<N, D>> + 'a {
        match self.0 {
            Kept::Convex(raw, placement) => {
                let from = Seen::new(&raw.normal, &placement);
                Contacts::Convex(from, raw.points.iter())
            }
            Kept::Patch(patch, placement) => {
                let from = Seen::new(&patch.normal, &placement);
                Contacts::Patch(from, patch.points.iter())
            }
            Kept::Made(manifold) => Contacts::Made(manifold.contacts().iter()),
        }
    }

    /// The contact of the largest depth, the first of equals.
    #[must_use]
    pub fn deepest_contact(&self) -> ContactPoint<N, D> {
        let depth = |index: usize| match self.0 {
            Kept::Convex(raw, _) => -raw.points[index].distance,
            Kept::Patch(patch, _) => -patch.points[index].raw.distance,
            Kept::Made(manifold) => manifold.contacts()[index].contact.depth,
        };
        let deeper = |best, index| if depth(index) > depth(best) { index } else { best };
        let deepest = (1..self.len()).fold(0, deeper);
        self.contacts().nth(deepest).expect("one of the contacts")
    }
}

/// The contacts of a view that are still to be given.
enum Contacts<'a, N: Real, const D: usize> {
    Convex(Seen<N, D>, slice::Iter<'a, RawPoint<N, D>>),
    Patch(Seen<N, D>, slice::Iter<'a, PatchPoint<N, D>>),
    Made(slice::Iter<'a, TrackedContact<N, D>>),
}

impl<N: Real, const D: usize> Iterator for Contacts<'_, N, D> {
    type Item = ContactPoint<N, D>;

    #[inline]
    fn next(&mut self) -> Option<ContactPoint<N, D>> {
        match self {
            Self::Convex(seen, points) => Some(seen.point(points.next()?, [0; 2])),
            Self::Patch(seen, points) => {
                let found = points.next()?;
                Some(seen.point(&found.raw, found.parts))
            }
            Self::Made(contacts) => Some(made(contacts.next()?)),
        }
    }

    /// Those before it are not placed.
    fn nth(&mut self, index: usize) -> Option<ContactPoint<N, D>> {
        if let Some(last) = index.checked_sub(1) {
            match self {
                Self::Convex(_, points) => points.nth(last).map(drop)?,
                Self::Patch(_, points) => points.nth(last).map(drop)?,
                Self::Made(contacts) => contacts.nth(last).map(drop)?,
            }
        }
        self.next()
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        match self {
            Self::Convex(_, points) => points.size_hint(),
            Self::Patch(_, points) => points.size_hint(),
            Self::Made(contacts) => contacts.size_hint(),
        }
    }
}

impl<N: Real, const D: usize> ExactSizeIterator for Contacts<'_, N, D> {}

/// How many numbers a vector takes here, those of no meaning included: compilers see vectors of four,
/// which they put in one register; with three they shuffle more than they compute.
const PADDED: usize = 4;

/// What all points of a manifold are placed in the world by.
struct Seen<N: Real, const D: usize> {
    /// The pose of the solid in whose frame the points are kept, the rotation by columns.
    columns: [[N; PADDED]; D],
    translation: [N; PADDED],
    /// The normal as it is kept.
    own: [N; PADDED],
    /// In the world, from the user's first solid to the second.
    normal: Vector<N, D>,
    pair: u64,
    is_swapped: bool,
}

/// The numbers of a vector, then zeros.
#[inline(always)]
fn padded<N: Real, const D: usize>(vector: &Vector<N, D>) -> [N; PADDED] {
    let mut all = [N::ZERO; PADDED];
    for (number, component) in all.iter_mut().zip(vector.iter()) {
        *number = *component;
    }
    all
}

impl<N: Real, const D: usize> Seen<N, D> {
    #[inline]
    fn new(own: &Vector<N, D>, placement: &Placement<'_, N, D>) -> Self {
        let Placement { pose1, pair, is_swapped } = *placement;
        let mut columns = [[N::ZERO; PADDED]; D];
        for (axis, column) in columns.iter_mut().enumerate() {
            *column = padded(&pose1.rotation.column(axis).into_owned());
        }
        let normal = pose1.vector(own);
        Self {
            columns,
            translation: padded(&pose1.translation),
            own: padded(own),
            normal: if is_swapped { -normal } else { normal },
            pair,
            is_swapped,
        }
    }

    /// A point of the frame of the points in the world: the sums of `Pose::point` in its order.
    #[inline(always)]
    fn placed(&self, own: &[N; PADDED]) -> Point<N, D> {
        let mut sums = [N::ZERO; PADDED];
        for (sum, number) in sums.iter_mut().zip(&self.columns[0]) {
            *sum = *number * own[0];
        }
        for (column, &length) in self.columns.iter().zip(own).skip(1) {
            for (sum, number) in sums.iter_mut().zip(column) {
                *sum += *number * length;
            }
        }
        for (sum, number) in sums.iter_mut().zip(&self.translation) {
            *sum += *number;
        }
        Point::from(Vector::<N, D>::from_fn(|axis, _| sums[axis]))
    }

    /// A point in the world, with the parts that it lies on in the order in which they are kept: what
    /// `manifold::placed` says, flipped if the user has the solids the other way round.
    #[inline]
    fn point(&self, raw: &RawPoint<N, D>, [part1, part2]: [u32; 2]) -> ContactPoint<N, D> {
        let point1 = padded(&raw.point1.coords);
        let mut point2 = point1;
        for (number, along) in point2.iter_mut().zip(&self.own) {
            *number += *along * raw.distance;
        }
        let (world1, world2) = (self.placed(&point1), self.placed(&point2));
        let (normal, depth) = (Unit::new_unchecked(self.normal), -raw.distance);
        let id = ContactId { pair: self.pair, number: raw.id };
        let (feature1, feature2) = (raw.feature1, raw.feature2);
        if self.is_swapped {
            let contact = Contact { world1: world2, world2: world1, normal, depth };
            let (feature1, feature2, part1, part2) = (feature2, feature1, part2, part1);
            return ContactPoint { contact, id, feature1, feature2, part1, part2 };
        }
        let contact = Contact { world1, world2, normal, depth };
        ContactPoint { contact, id, feature1, feature2, part1, part2 }
    }
}

/// A contact that an algorithm of the user's own has found.
fn made<N: Real, const D: usize>(made: &TrackedContact<N, D>) -> ContactPoint<N, D> {
    ContactPoint {
        contact: made.contact,
        id: made.id,
        feature1: made.kinematic.feature1(),
        feature2: made.kinematic.feature2(),
        part1: made.part1,
        part2: made.part2,
    }
}
