//! Views of manifolds, which read the stored contacts in place.
//!
//! The contacts of a view are bitwise equal to the contacts of the manifold to which the view
//! converts.

use crate::tables::entries;
use core::fmt;

use super::kinematic::KinematicSides;
use super::manifold::{materialise, placed, tracked};
use super::{
    Contact, ContactId, ContactKinematic, ContactManifold, Placement, TrackedContact, composite,
};
use crate::collide::mesh::Patch;
use crate::collide::{Pair, Placed, RawManifold, RawPoint};
use crate::math::{Point, Pose, Real, Space, Unit, Vector};
use crate::shape::{FeatureId, Geometry};

/// A contact as [`ManifoldView::contacts`] returns it: its geometry, id, features and parts.
/// [`ManifoldView::kinematic`] returns the kinematic.
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
/// for (_, point) in world.contacts_with(b) {
///     assert_eq!((point.contact.depth, point.contact.normal.y), (0.25, -1.0), "away from b");
///     assert_eq!(point.flipped().contact.normal.y, 1.0, "away from a");
/// }
/// # assert_eq!(world.contacts_with(a).count(), 2);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint<N: Real, const D: usize> {
    /// The geometry at the last update, in the world frame.
    pub contact: Contact<N, D>,
    /// The id, which is kept while the contact exists.
    pub id: ContactId,
    /// The touching feature of the first solid.
    pub feature1: FeatureId,
    /// The touching feature of the second solid.
    pub feature2: FeatureId,
    /// The index of the touching part of the first shape; 0 if the shape is not a composite.
    pub part1: u32,
    /// The index of the touching part of the second shape; 0 if the shape is not a composite.
    pub part2: u32,
}

impl<N: Real, const D: usize> ContactPoint<N, D> {
    /// Returns the contact with the solids swapped.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self {
            contact: self.contact.flipped(),
            id: self.id,
            feature1: self.feature2,
            feature2: self.feature1,
            part1: self.part2,
            part2: self.part1,
        }
    }
}

/// A view of a manifold: contact points of a flat contact area with one common normal.
///
/// A view reads the narrow phase's storage. Each contact is placed in the world on access, and
/// nothing is stored. Reading every contact of a world once, as a solver does, moves a fifth of the
/// memory that it would move with a [`ContactManifold`] for each pair. A view has at least one
/// contact.
///
/// | to read | use |
/// |---|---|
/// | the common normal, from the first solid to the second | [`Self::normal`] |
/// | points, depth, id, features and parts of each contact | [`Self::contacts`], a [`ContactPoint`] for each |
/// | the deepest contact | [`Self::deepest_contact`] |
/// | the motion of a contact with its solids | [`Self::kinematic`] |
/// | a contact and its kinematic, as in ncollide's guide | [`Self::tracked_contact`], a [`TrackedContact`] |
/// | the manifold to keep across an update | [`Self::to_manifold`], a [`ContactManifold`] |
///
/// A world returns views of all its manifolds
/// ([`CollisionWorld::contact_views`](crate::world::CollisionWorld::contact_views)) and of the
/// manifolds of one pair ([`ContactPair::views`](crate::narrow_phase::ContactPair::views)).
/// [`CollisionWorld::contact_manifolds`](crate::world::CollisionWorld::contact_manifolds) and
/// [`ContactPair::contacts`](crate::narrow_phase::ContactPair::contacts) return manifolds that are
/// built on first use, with bitwise equal contacts. Within a manifold the order of the contacts is
/// the same; `contact_manifolds` sorts the pairs by handle, and `contact_views` does not.
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
/// let (_, _, view) = world.contact_views().next().expect("they overlap");
/// assert_eq!((view.len(), *view.normal()), (2, Vector::y()));
/// assert!(view.contacts().all(|point| point.contact.depth == 0.25));
/// // The prediction if the upper square is lifted by an eighth:
/// let lifted = view.kinematic(0).contact(&Isometry::identity(), &Isometry::translation(0.0, 1.875));
/// assert_eq!(lifted.depth, 0.125);
/// # assert!(world.contains(a) && world.contains(b));
/// ```
#[derive(Clone, Copy)]
pub struct ManifoldView<'a, N: Real, const D: usize>(ViewSource<'a, N, D>);

/// The objects of a pair. A view reads the pose of one object; only kinematics read both.
#[derive(Clone, Copy)]
pub(crate) struct PairRef<'a, N: Real, const D: usize> {
    solids: &'a dyn PlacedSolids<N, D>,
    /// The indices of the two objects, in the user's order.
    key: [u32; 2],
}

/// The poses and geometries of objects by index, as of the last update.
pub(crate) trait PlacedSolids<N: Real, const D: usize>: Sync {
    /// Returns the pose and the geometry of an object.
    fn placed(&self, object: u32) -> (&Pose<N, D>, Geometry<'_, N, D>);

    /// Returns the pose of an object.
    #[inline]
    fn pose(&self, object: u32) -> &Pose<N, D> {
        self.placed(object).0
    }
}

/// A pair without a world: the objects 0 and 1.
impl<N: Real, const D: usize> PlacedSolids<N, D> for [Placed<'_, N, D>; 2] {
    fn placed(&self, object: u32) -> (&Pose<N, D>, Geometry<'_, N, D>) {
        let Placed { pose, shape } = &self[object as usize];
        (pose, *shape)
    }
}

impl<'a, N: Real, const D: usize> PairRef<'a, N, D> {
    #[inline]
    pub(crate) fn new(solids: &'a dyn PlacedSolids<N, D>, key: [u32; 2]) -> Self {
        Self { solids, key }
    }

    /// Returns the solids in the order in which their contacts are stored.
    fn in_order(&self, is_swapped: bool) -> Pair<'a, N, D> {
        let [first, second] = [usize::from(is_swapped), usize::from(!is_swapped)];
        let (pose1, solid1) = self.solids.placed(self.key[first]);
        let (pose2, solid2) = self.solids.placed(self.key[second]);
        Pair::new([solid1, solid2], [pose1, pose2])
    }
}

/// The storage that a view reads.
#[derive(Clone, Copy)]
enum ViewSource<'a, N: Real, const D: usize> {
    /// The manifold of two convex solids.
    Convex(&'a RawManifold<N, D>, Placement<'a, N, D>, PairRef<'a, N, D>),
    /// One patch of the contacts of a composite.
    Patch(&'a Patch<N, D>, Placement<'a, N, D>, PairRef<'a, N, D>),
    /// The manifold of a user's algorithm.
    Made(&'a ContactManifold<N, D>),
}

impl<N: Space<D>, const D: usize> fmt::Debug for ManifoldView<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let contacts: Vec<_> = self.contacts().collect();
        f.debug_struct("ManifoldView").field("contacts", &contacts).finish()
    }
}

/// An iterator over the contacts of a view, each placed in the world on access.
struct Contacts<'a, N: Real, const D: usize> {
    view: ManifoldView<'a, N, D>,
    /// The result of [`ManifoldView::own_normal`].
    normal: [Vector<N, D>; 2],
    index: usize,
    count: usize,
}

impl<N: Space<D>, const D: usize> Iterator for Contacts<'_, N, D> {
    type Item = ContactPoint<N, D>;

    #[inline]
    fn next(&mut self) -> Option<Self::Item> {
        if self.index == self.count {
            return None;
        }
        self.index += 1;
        Some(entries::contact_of_view(&self.view, self.index - 1, &self.normal))
    }

    #[inline]
    fn size_hint(&self) -> (usize, Option<usize>) {
        (self.count - self.index, Some(self.count - self.index))
    }
}

impl<N: Space<D>, const D: usize> ExactSizeIterator for Contacts<'_, N, D> {}

impl<'a, N: Space<D>, const D: usize> ManifoldView<'a, N, D> {
    #[inline]
    pub(crate) fn of_convex(
        raw: &'a RawManifold<N, D>,
        placement: Placement<'a, N, D>,
        pair: PairRef<'a, N, D>,
    ) -> Self {
        Self(ViewSource::Convex(raw, placement, pair))
    }

    #[inline]
    pub(super) fn of_patch(
        patch: &'a Patch<N, D>,
        placement: Placement<'a, N, D>,
        pair: PairRef<'a, N, D>,
    ) -> Self {
        Self(ViewSource::Patch(patch, placement, pair))
    }

    /// Returns a view of a manifold; `None` if the manifold is empty.
    #[must_use]
    pub fn of_manifold(manifold: &'a ContactManifold<N, D>) -> Option<Self> {
        (!manifold.is_empty()).then_some(Self(ViewSource::Made(manifold)))
    }

    /// Returns the number of contacts, at least one.
    #[inline]
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a view is never empty")]
    pub fn len(&self) -> usize {
        match self.0 {
            ViewSource::Convex(raw, ..) => raw.points.len(),
            ViewSource::Patch(patch, ..) => patch.points.len(),
            ViewSource::Made(manifold) => manifold.len(),
        }
    }

    /// Returns the unit vector from the first solid to the second, in the world frame. It is the
    /// normal of the first contact, which all contacts of a manifold share.
    #[inline]
    #[must_use]
    pub fn normal(&self) -> Unit<Vector<N, D>> {
        let world = |own: &Vector<N, D>, placement: &Placement<'_, N, D>| {
            let normal = placement.pose1.vector(own);
            Unit::new_unchecked(if placement.is_swapped { -normal } else { normal })
        };
        match self.0 {
            ViewSource::Convex(raw, placement, _) => world(&raw.normal, &placement),
            ViewSource::Patch(patch, placement, _) => world(&patch.normal, &placement),
            ViewSource::Made(manifold) => manifold.contacts()[0].contact.normal,
        }
    }

    /// Returns the contacts in the order in which they began; a user's manifold keeps its own
    /// order.
    #[inline]
    pub fn contacts(self) -> impl ExactSizeIterator<Item = ContactPoint<N, D>> + 'a {
        Contacts { view: self, normal: entries::own_normal(&self), index: 0, count: self.len() }
    }

    /// Returns the contact with the largest depth, the first if there are several.
    #[must_use]
    pub fn deepest_contact(&self) -> ContactPoint<N, D> {
        let depth = |index: usize| match self.0 {
            ViewSource::Convex(raw, ..) => -raw.points[index].distance,
            ViewSource::Patch(patch, ..) => -patch.points[index].raw.distance,
            ViewSource::Made(manifold) => manifold.contacts()[index].contact.depth,
        };
        let deeper = |best, index| if depth(index) > depth(best) { index } else { best };
        self.contact((1..self.len()).fold(0, deeper), &self.own_normal())
    }

    /// Returns the stored normal, which points away from the first solid in stored order, and this
    /// normal rotated to the world. Both are zero, and unused, for a user's manifold.
    #[inline]
    pub(crate) fn own_normal(&self) -> [Vector<N, D>; 2] {
        let (own, pose1) = match self.0 {
            ViewSource::Convex(raw, placement, _) => (raw.normal, placement.pose1),
            ViewSource::Patch(patch, placement, _) => (patch.normal, placement.pose1),
            ViewSource::Made(_) => return [Vector::<N, D>::zeros(); 2],
        };
        [own, pose1.vector(&own)]
    }

    /// Calls `each` with the id, the point on the first solid in the world frame, and the depth of
    /// each contact.
    #[inline(always)]
    pub(crate) fn each_placed(&self, mut each: impl FnMut(ContactId, Point<N, D>, N)) {
        match self.0 {
            ViewSource::Convex(raw, placement, _) => {
                raw.points.iter().for_each(|point| placement.place(&raw.normal, point, &mut each));
            }
            ViewSource::Patch(patch, placement, _) => {
                let points = patch.points.iter().map(|point| &point.raw);
                points.for_each(|point| placement.place(&patch.normal, point, &mut each));
            }
            ViewSource::Made(manifold) => {
                let contacts = manifold.contacts().iter();
                contacts.for_each(|made| each(made.id, made.contact.world1, made.contact.depth));
            }
        }
    }

    /// Returns the contact at an index; `normal` must be the result of [`Self::own_normal`].
    #[inline]
    pub(crate) fn contact(&self, index: usize, normal: &[Vector<N, D>; 2]) -> ContactPoint<N, D> {
        match self.0 {
            ViewSource::Convex(raw, placement, _) => {
                point(normal, &raw.points[index], [0; 2], &placement)
            }
            ViewSource::Patch(patch, placement, _) => {
                let found = &patch.points[index];
                point(normal, &found.raw, found.parts, &placement)
            }
            ViewSource::Made(manifold) => {
                let made = &manifold.contacts()[index];
                ContactPoint {
                    contact: made.contact,
                    id: made.id,
                    feature1: made.kinematic.feature1(),
                    feature2: made.kinematic.feature2(),
                    part1: made.part1,
                    part2: made.part2,
                }
            }
        }
    }
}

/// Values that are computed on each call, from the solids as of the last update.
impl<N: Space<D>, const D: usize> ManifoldView<'_, N, D> {
    /// Returns the kinematic of a contact, which predicts the contact at other poses without a new
    /// query.
    ///
    /// # Panics
    /// If `index` is not below [`Self::len`]; contacts have the order of [`Self::contacts`].
    #[must_use]
    pub fn kinematic(&self, index: usize) -> ContactKinematic<N, D> {
        self.tracked_contact(index).kinematic
    }

    /// Returns a contact with its kinematic.
    ///
    /// # Panics
    /// If `index` is not below [`Self::len`]; contacts have the order of [`Self::contacts`].
    #[must_use]
    pub fn tracked_contact(&self, index: usize) -> TrackedContact<N, D> {
        entries::tracked_contact(self, index)
    }

    /// Converts the view to a manifold that owns its data: all contacts with their kinematics.
    #[must_use]
    pub fn to_manifold(&self) -> ContactManifold<N, D> {
        entries::manifold_of_view(self, ContactManifold::default())
    }

    /// Implements [`Self::to_manifold`] in the memory of `old`.
    pub(crate) fn manifold_in(&self, mut old: ContactManifold<N, D>) -> ContactManifold<N, D> {
        match self.0 {
            ViewSource::Convex(raw, placement, pair) => {
                materialise(&pair.in_order(placement.is_swapped), raw, &placement, old)
            }
            ViewSource::Patch(patch, placement, pair) => {
                let pair = pair.in_order(placement.is_swapped);
                let points = patch.points.iter();
                old.refill(points.map(|point| composite::tracked(&pair, patch, point, &placement)));
                old
            }
            ViewSource::Made(manifold) => {
                old.clone_from(manifold);
                old
            }
        }
    }

    /// Implements [`Self::tracked_contact`].
    pub(crate) fn tracked(&self, index: usize) -> TrackedContact<N, D> {
        match self.0 {
            ViewSource::Convex(raw, placement, pair) => {
                let pair = pair.in_order(placement.is_swapped);
                let mut sides = KinematicSides::new(&pair, &raw.normal);
                tracked(&mut sides, &raw.normal, &raw.points[index], &placement)
            }
            ViewSource::Patch(patch, placement, pair) => {
                let pair = pair.in_order(placement.is_swapped);
                composite::tracked(&pair, patch, &patch.points[index], &placement)
            }
            ViewSource::Made(manifold) => manifold.contacts()[index],
        }
    }
}

/// Returns a contact point in the world and in the user's order; `own` is the stored normal,
/// `normal` is `own` rotated to the world.
#[inline]
fn point<N: Real, const D: usize>(
    [own, normal]: &[Vector<N, D>; 2],
    raw: &RawPoint<N, D>,
    [part1, part2]: [u32; 2],
    placement: &Placement<'_, N, D>,
) -> ContactPoint<N, D> {
    let contact = placed(own, raw, placement.pose1, *normal);
    let id = ContactId { pair: placement.pair, number: raw.id };
    let (feature1, feature2) = (raw.feature1, raw.feature2);
    let point = ContactPoint { contact, id, feature1, feature2, part1, part2 };
    if placement.is_swapped { point.flipped() } else { point }
}
