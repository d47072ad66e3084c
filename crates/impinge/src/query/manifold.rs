//! Contact manifolds as users see them: world frame, kinematics, ids.

use super::kinematic::Sides;
use super::{Contact, ContactKinematic, ContactPoint, Pair, RawManifold, RawPoint};
use crate::math::{Pose, Real, Unit, Vector};

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

impl ContactId {
    /// The name of a contact by an algorithm of one's own: `pair` is a number that
    /// [`IdAllocator`](crate::narrow_phase::IdAllocator) gave to the pair, `number` one that the
    /// pair gives to no other contact.
    #[must_use]
    pub const fn new(pair: u64, number: u32) -> Self {
        Self { pair, number }
    }
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
    /// The part of the first shape that touches; 0 if the shape is not a composite.
    pub part1: u32,
    /// The part of the second shape that touches; 0 if the shape is not a composite.
    pub part2: u32,
}

/// Points that delimit a flat area of contact, with one common normal.
///
/// Two convex solids have one manifold, composites one for each flat patch that they touch in. A box
/// that rests on a plane is one manifold of four points in space and two in the plane; a ball gives
/// one point. The deepest pair of points of the two solids is always among them, so that
/// [`Self::deepest_contact`] is the answer of the query for one contact. Empty means that the solids
/// are farther apart than the prediction.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactManifold<N: Real, const D: usize> {
    /// On the heap: most pairs have fewer contacts than the most that there may be.
    contacts: Vec<TrackedContact<N, D>>,
}

impl<N: Real, const D: usize> ContactManifold<N, D> {
    /// The manifold that an algorithm of one's own has found; the order of the contacts is kept.
    #[must_use]
    pub fn from_contacts(contacts: impl IntoIterator<Item = TrackedContact<N, D>>) -> Self {
        Self { contacts: contacts.into_iter().collect() }
    }

    /// Holds other contacts from now on, in the same memory.
    pub(super) fn refill(&mut self, contacts: impl Iterator<Item = TrackedContact<N, D>>) {
        self.contacts.clear();
        self.contacts.extend(contacts);
    }

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

    /// The contacts, in the order in which they began.
    #[must_use]
    pub fn contacts(&self) -> &[TrackedContact<N, D>] {
        &self.contacts
    }

    /// The index of the deepest contact, the first of equals; 0 for an empty manifold.
    #[must_use]
    pub fn deepest_contact_id(&self) -> usize {
        let depth = |index: usize| self.contacts[index].contact.depth;
        let deeper = |best, index| if depth(index) > depth(best) { index } else { best };
        (1..self.contacts.len()).fold(0, deeper)
    }

    /// The contact of the largest depth, the first of equals; `None` for an empty manifold.
    #[must_use]
    pub fn deepest_contact(&self) -> Option<&TrackedContact<N, D>> {
        self.contacts.get(self.deepest_contact_id())
    }
}

/// What turns a raw manifold into one of a world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement<'a, N: Real, const D: usize> {
    /// The pose of the first solid of the raw pair in the world.
    pub(crate) pose1: &'a Pose<N, D>,
    /// The number of the pair, for the ids.
    pub(crate) pair: u64,
    /// The user's first solid is the second of the raw pair: all comes out flipped.
    pub(crate) is_swapped: bool,
}

impl<'a, N: Real, const D: usize> Placement<'a, N, D> {
    /// Of a pair whose solids have these poses in the user's order.
    #[inline]
    pub(crate) fn new(poses: [&'a Pose<N, D>; 2], pair: u64, is_swapped: bool) -> Self {
        Self { pose1: poses[usize::from(is_swapped)], pair, is_swapped }
    }
}

/// The manifold as users see it; `pair` is the one that `raw` was built for. It is written over the
/// memory of a manifold that is no longer needed.
pub(crate) fn materialise<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    raw: &RawManifold<N, D>,
    placement: &Placement<'_, N, D>,
    old: ContactManifold<N, D>,
) -> ContactManifold<N, D> {
    let mut sides = Sides::new(pair, &raw.normal);
    let placing = Placing::new(&raw.normal, *placement);
    let mut manifold = old;
    manifold.refill(raw.points.iter().map(|point| {
        let kinematic = sides.kinematic(point);
        placing.tracked(point, kinematic, [0; 2])
    }));
    manifold
}

/// What the contacts of a manifold have in common on their way to the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placing<'a, N: Real, const D: usize> {
    placement: Placement<'a, N, D>,
    /// Unit, in the world, from the user's first solid to the second.
    normal: Vector<N, D>,
    /// By how much a distance leads from the point that is kept to those of the user's first and second
    /// solid: not at all, and along the normal that is kept.
    ways: [Vector<N, D>; 2],
}

impl<'a, N: Real, const D: usize> Placing<'a, N, D> {
    /// Of a manifold whose normal, as it is kept, is `own`.
    #[inline]
    pub(super) fn new(own: &Vector<N, D>, placement: Placement<'a, N, D>) -> Self {
        let turned = placement.pose1.vector(own);
        // Which solid comes first is a toss: looked up, not branched on.
        let (first, second) =
            (usize::from(placement.is_swapped), usize::from(!placement.is_swapped));
        let ways = [Vector::<N, D>::zeros(), turned];
        let normal = turned * [N::ONE, -N::ONE][first];
        Self { placement, normal, ways: [ways[first], ways[second]] }
    }

    /// The unit vector from the user's first solid to the second.
    pub(super) fn normal(&self) -> Unit<Vector<N, D>> {
        Unit::new_unchecked(self.normal)
    }

    /// A contact as the user's order of the solids has it.
    #[inline]
    pub(super) fn contact(&self, point: &RawPoint<N, D>) -> Contact<N, D> {
        let (place, distance) = (self.placement.pose1.point(&point.point1), point.distance);
        Contact {
            world1: place + self.ways[0] * distance,
            world2: place + self.ways[1] * distance,
            normal: self.normal(),
            depth: -distance,
        }
    }

    /// A contact with its name, and how it moves, which is told for the solids as they are kept; so are
    /// the parts.
    pub(super) fn tracked(
        &self,
        point: &RawPoint<N, D>,
        kinematic: ContactKinematic<N, D>,
        parts: [u32; 2],
    ) -> TrackedContact<N, D> {
        let kinematic = if self.placement.is_swapped { kinematic.flipped() } else { kinematic };
        let [part1, part2] = self.in_order(parts);
        TrackedContact { contact: self.contact(point), kinematic, id: self.id(point), part1, part2 }
    }

    /// A contact with its name alone.
    #[inline]
    pub(super) fn point(&self, point: &RawPoint<N, D>, parts: [u32; 2]) -> ContactPoint<N, D> {
        let [feature1, feature2] = self.in_order([point.feature1, point.feature2]);
        let [part1, part2] = self.in_order(parts);
        let (contact, id) = (self.contact(point), self.id(point));
        ContactPoint { contact, id, feature1, feature2, part1, part2 }
    }

    #[inline]
    const fn id(&self, point: &RawPoint<N, D>) -> ContactId {
        ContactId { pair: self.placement.pair, number: point.id }
    }

    /// What belongs to the solids as they are kept, in the user's order.
    #[inline]
    const fn in_order<T: Copy>(&self, [first, second]: [T; 2]) -> [T; 2] {
        if self.placement.is_swapped { [second, first] } else { [first, second] }
    }
}
