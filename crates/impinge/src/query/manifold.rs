//! Contact manifolds in the public interface: world frame, kinematics, ids.

use super::kinematic::KinematicSides;
use super::{Contact, ContactKinematic};
use crate::collide::{Pair, RawManifold, RawPoint};
use crate::math::{Point, Pose, Real, Unit, Vector};

/// The id of a contact, unique among all contacts of a world at all times.
///
/// A contact that moved between two updates keeps its id if it is on the same features. It also
/// keeps its id if, in the frame of one of the solids, it has moved by no more than 1/16 of the
/// size of the smaller solid, while the normal rotated by at most 45°. The size of a ball is its
/// radius, the size of most other solids half the diagonal of the local box. Two crossing edges are
/// treated as the same features up to a movement of half of that size.
/// The id has no other meaning; ids of one pair are ordered by creation. [`ContactId::NULL`], which
/// is also the default, is the id of no contact, for empty slots of a cache.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// let [a, b] = [0.0, 1.75].map(|y| {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ())
/// });
/// world.update();
///
/// let ids = |world: &CollisionWorld<f64, ()>| -> Vec<_> {
///     world.contact_views().flat_map(|(_, _, view)| view.contacts().map(|point| point.id)).collect()
/// };
/// let before = ids(&world);
/// world.set_position(b, Isometry::translation(0.0, 1.8125));
/// world.update();
/// assert_eq!(ids(&world), before, "the same contacts, moved");
/// # assert!(world.contains(a));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactId {
    /// The id of the pair, never reused.
    pub(crate) pair: u64,
    /// The id of the contact within the pair, never reused.
    pub(crate) number: u32,
}

impl ContactId {
    /// The id of no contact: neither a world nor an algorithm of the library ever assigns it. It is
    /// the largest id.
    ///
    /// ```
    /// use impinge::query::ContactId;
    ///
    /// // The impulses of the last step, by id; at first all slots are empty.
    /// let mut impulses = [(ContactId::NULL, 0.0_f32); 4];
    /// impulses[0] = (ContactId::new(7, 0), 1.5);
    /// assert_eq!(impulses.iter().filter(|(id, _)| id.is_null()).count(), 3);
    /// assert_eq!(ContactId::default(), ContactId::NULL);
    /// ```
    pub const NULL: Self = Self { pair: u64::MAX, number: u32::MAX };

    /// Returns the id of a contact of a user's algorithm. `pair` is a number that
    /// [`IdAllocator`](crate::narrow_phase::IdAllocator) assigned to the pair; `number` must be
    /// unique within the pair.
    #[must_use]
    pub const fn new(pair: u64, number: u32) -> Self {
        Self { pair, number }
    }

    /// Returns whether the id is [`Self::NULL`].
    #[must_use]
    pub const fn is_null(self) -> bool {
        self.pair == u64::MAX && self.number == u32::MAX
    }
}

/// The default is [`ContactId::NULL`].
impl Default for ContactId {
    fn default() -> Self {
        Self::NULL
    }
}

/// A contact with its kinematic and id: returned by
/// [`ManifoldView::tracked_contact`](super::ManifoldView::tracked_contact), stored in a
/// [`ContactManifold`].
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// let [a, b] = [0.0, 1.75].map(|y| {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ())
/// });
/// world.update();
///
/// let (_, _, manifold) = world.contact_manifolds().next().expect("they overlap");
/// for tracked in manifold.contacts() {
///     assert_eq!(tracked.contact.depth, 0.25);
///     // The prediction if the upper square is lifted by an eighth:
///     let lifted = tracked.kinematic.contact(&Isometry::identity(), &Isometry::translation(0.0, 1.875));
///     assert_eq!(lifted.depth, 0.125);
/// }
/// # assert!(world.contains(a) && world.contains(b));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackedContact<N: Real, const D: usize> {
    /// The geometry at the last update, in the world frame.
    pub contact: Contact<N, D>,
    /// The kinematic, which predicts the contact when its solids move.
    pub kinematic: ContactKinematic<N, D>,
    /// The id, which is kept while the contact exists.
    pub id: ContactId,
    /// The index of the touching part of the first shape; 0 if the shape is not a composite.
    pub part1: u32,
    /// The index of the touching part of the second shape; 0 if the shape is not a composite.
    pub part2: u32,
}

impl<N: Real, const D: usize> TrackedContact<N, D> {
    /// Returns the contact of the solids inflated by the lengths `skins`; see [`Contact::grown`].
    pub(super) fn grown(&self, skins: [N; 2]) -> Self {
        let kinematic = self.kinematic.grown(skins);
        Self { contact: self.contact.grown(skins), kinematic, ..*self }
    }

    /// Returns the contact with the solids swapped.
    pub(super) fn flipped(&self) -> Self {
        Self {
            contact: self.contact.flipped(),
            kinematic: self.kinematic.flipped(),
            id: self.id,
            part1: self.part2,
            part2: self.part1,
        }
    }
}

/// Contact points of a flat contact area with one common normal: a manifold that owns its data.
///
/// To read manifolds in a world, use [`ManifoldView`](super::ManifoldView);
/// [`ManifoldView::to_manifold`](super::ManifoldView::to_manifold) converts a view to this type,
/// which can be kept across an update. Users' algorithms also build this type.
///
/// Two convex solids have one manifold, composites one for each flat patch of contact. A box that
/// rests on a plane has one manifold of four points in 3D and two in 2D; a ball gives one point.
/// The first manifold of a pair contains its deepest point: [`Self::deepest_contact`] has the depth
/// that the query for one contact returns. From the second update on, a point of the previous
/// update may replace the deepest point and take its depth, if their depths differ by at most 1/512
/// of the size of the smaller solid (for most solids half the diagonal of the local box). An empty
/// manifold means that the solids are farther apart than the prediction.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// let [a, b] = [0.0, 1.75].map(|y| {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ())
/// });
/// world.update();
///
/// let (_, _, manifold) = world.contact_manifolds().next().expect("they overlap");
/// assert_eq!(manifold.len(), 2, "the ends of the side that they share");
/// let deepest = manifold.deepest_contact().expect("it holds two");
/// assert_eq!((deepest.contact.depth, *deepest.contact.normal), (0.25, Vector::y()));
/// # assert!(world.contains(a) && world.contains(b));
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactManifold<N: Real, const D: usize> {
    /// A heap vector: most pairs have fewer contacts than the maximum.
    contacts: Vec<TrackedContact<N, D>>,
}

impl<N: Real, const D: usize> ContactManifold<N, D> {
    /// Builds the manifold of a user's algorithm; the order of the contacts is kept.
    #[must_use]
    pub fn from_contacts(contacts: impl IntoIterator<Item = TrackedContact<N, D>>) -> Self {
        Self { contacts: contacts.into_iter().collect() }
    }

    /// Returns the manifold of the solids inflated by the lengths `skins`; see [`Contact::grown`].
    pub(crate) fn grown(mut self, skins: [N; 2]) -> Self {
        if skins != [N::ZERO; 2] {
            self.contacts.iter_mut().for_each(|contact| *contact = contact.grown(skins));
        }
        self
    }

    /// Replaces the contacts, reusing the allocation.
    pub(super) fn refill(&mut self, contacts: impl Iterator<Item = TrackedContact<N, D>>) {
        self.contacts.clear();
        self.contacts.extend(contacts);
    }

    /// Returns the number of contacts.
    #[must_use]
    pub fn len(&self) -> usize {
        self.contacts.len()
    }

    /// Returns whether the manifold has no contacts.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contacts.is_empty()
    }

    /// Returns the contacts in the order in which they began; a user's manifold keeps its own
    /// order.
    #[must_use]
    pub fn contacts(&self) -> &[TrackedContact<N, D>] {
        &self.contacts
    }

    /// Returns the index of the deepest contact, the first if there are several; 0 for an empty
    /// manifold.
    #[must_use]
    pub fn deepest_contact_id(&self) -> usize {
        let depth = |index: usize| self.contacts[index].contact.depth;
        let deeper = |best, index| if depth(index) > depth(best) { index } else { best };
        (1..self.contacts.len()).fold(0, deeper)
    }

    /// Returns the contact with the largest depth, the first if there are several; `None` for an
    /// empty manifold.
    #[must_use]
    pub fn deepest_contact(&self) -> Option<&TrackedContact<N, D>> {
        self.contacts.get(self.deepest_contact_id())
    }
}

/// The data that convert a raw manifold to a manifold in the world frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement<'a, N: Real, const D: usize> {
    /// The pose of the first solid of the raw pair in the world.
    pub(crate) pose1: &'a Pose<N, D>,
    /// The id of the pair, for the ids of its contacts.
    pub(crate) pair: u64,
    /// Whether the user's first solid is the second of the raw pair: the result is then flipped.
    pub(crate) is_swapped: bool,
}

impl<N: Real, const D: usize> Placement<'_, N, D> {
    /// Calls `each` with the id of a contact of a raw manifold, its point on the user's first solid
    /// in the world frame, and its depth; `own` is the normal of that manifold. The values are
    /// bitwise equal to the values that [`placed`] computes.
    #[inline(always)]
    pub(super) fn place(
        &self,
        own: &Vector<N, D>,
        raw: &RawPoint<N, D>,
        each: &mut impl FnMut(ContactId, Point<N, D>, N),
    ) {
        let on_second = || raw.point1 + own * raw.distance;
        let own_first = if self.is_swapped { on_second() } else { raw.point1 };
        let id = ContactId { pair: self.pair, number: raw.id };
        each(id, self.pose1.point(&own_first), -raw.distance);
    }
}

/// Converts a raw manifold to the public type; `pair` must be the pair for which `raw` was built.
/// Reuses the memory of `old`.
pub(super) fn materialise<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    raw: &RawManifold<N, D>,
    placement: &Placement<'_, N, D>,
    old: ContactManifold<N, D>,
) -> ContactManifold<N, D> {
    let mut sides = KinematicSides::new(pair, &raw.normal);
    let mut contacts = old.contacts;
    contacts.clear();
    let points = raw.points.iter();
    contacts.extend(points.map(|point| tracked(&mut sides, &raw.normal, point, placement)));
    ContactManifold { contacts }
}

/// Converts a contact of two convex solids; `sides` and `normal` belong to its manifold.
pub(super) fn tracked<N: Real, const D: usize>(
    sides: &mut KinematicSides<'_, N, D>,
    normal: &Vector<N, D>,
    point: &RawPoint<N, D>,
    placement: &Placement<'_, N, D>,
) -> TrackedContact<N, D> {
    let contact = placed(normal, point, placement.pose1, placement.pose1.vector(normal));
    let kinematic = sides.kinematic(point);
    let id = ContactId { pair: placement.pair, number: point.id };
    let tracked = TrackedContact { contact, kinematic, id, part1: 0, part2: 0 };
    if placement.is_swapped { tracked.flipped() } else { tracked }
}

/// Returns a contact point in the world frame; `own` is the stored normal of the manifold, `normal`
/// is `own` rotated to the world.
#[inline]
pub(super) fn placed<N: Real, const D: usize>(
    own: &Vector<N, D>,
    point: &RawPoint<N, D>,
    pose1: &Pose<N, D>,
    normal: Vector<N, D>,
) -> Contact<N, D> {
    Contact {
        world1: pose1.point(&point.point1),
        world2: pose1.point(&(point.point1 + own * point.distance)),
        normal: Unit::new_unchecked(normal),
        depth: -point.distance,
    }
}
