//! Manifolds read where they are kept.
//!
//! A view has the contacts of the public manifold, to the bit.

use core::fmt;

use super::manifold::placed;
use super::{Contact, ContactId, ContactManifold, Placement};
use crate::collide::mesh::Patch;
use crate::collide::{RawManifold, RawPoint};
use crate::math::{Real, Unit, Vector};
use crate::shape::FeatureId;

/// A contact as [`ManifoldView`] gives it: a [`TrackedContact`](super::TrackedContact) without its
/// kinematic.
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

impl<N: Real, const D: usize> ContactPoint<N, D> {
    /// The same contact with the solids swapped.
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

/// A [`ContactManifold`] read where the narrow phase keeps it: each contact is placed in the world
/// when it is asked for, and nothing is stored.
///
/// It gives the same contacts, to the bit and in the same order, as the manifold that it stands for,
/// but not their kinematics. To read every contact of a world once, as a solver does, it is
/// several times faster: it moves a fifth of the memory. It always holds a contact.
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
/// # assert!(world.contains(a) && world.contains(b));
/// ```
#[derive(Clone, Copy)]
pub struct ManifoldView<'a, N: Real, const D: usize>(ViewSource<'a, N, D>);

/// What a view looks at.
#[derive(Clone, Copy, Debug)]
enum ViewSource<'a, N: Real, const D: usize> {
    /// The contacts of two convex solids.
    Convex(&'a RawManifold<N, D>, Placement<'a, N, D>),
    /// Some of the contacts of a composite.
    Patch(&'a Patch<N, D>, Placement<'a, N, D>),
    /// What an algorithm of the user's own has found.
    Made(&'a ContactManifold<N, D>),
}

impl<N: Real, const D: usize> fmt::Debug for ManifoldView<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let contacts: Vec<_> = self.contacts().collect();
        f.debug_struct("ManifoldView").field("contacts", &contacts).finish()
    }
}

impl<'a, N: Real, const D: usize> ManifoldView<'a, N, D> {
    pub(crate) fn of_convex(raw: &'a RawManifold<N, D>, placement: Placement<'a, N, D>) -> Self {
        Self(ViewSource::Convex(raw, placement))
    }

    pub(super) fn of_patch(patch: &'a Patch<N, D>, placement: Placement<'a, N, D>) -> Self {
        Self(ViewSource::Patch(patch, placement))
    }

    /// A view of a manifold; `None` if it is empty.
    #[must_use]
    pub fn of_manifold(manifold: &'a ContactManifold<N, D>) -> Option<Self> {
        (!manifold.is_empty()).then_some(Self(ViewSource::Made(manifold)))
    }

    /// How many contacts it holds: at least one.
    #[inline]
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a view is never empty")]
    pub fn len(&self) -> usize {
        match self.0 {
            ViewSource::Convex(raw, _) => raw.points.len(),
            ViewSource::Patch(patch, _) => patch.points.len(),
            ViewSource::Made(manifold) => manifold.len(),
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
            ViewSource::Convex(raw, placement) => world(&raw.normal, &placement),
            ViewSource::Patch(patch, placement) => world(&patch.normal, &placement),
            ViewSource::Made(manifold) => manifold.contacts()[0].contact.normal,
        }
    }

    /// The contacts, in the order in which they began.
    #[inline]
    pub fn contacts(self) -> impl ExactSizeIterator<Item = ContactPoint<N, D>> + 'a {
        let normal = self.own_normal();
        (0..self.len()).map(move |index| self.contact(index, &normal))
    }

    /// The contact of the largest depth, the first of equals.
    #[must_use]
    pub fn deepest_contact(&self) -> ContactPoint<N, D> {
        let depth = |index: usize| match self.0 {
            ViewSource::Convex(raw, _) => -raw.points[index].distance,
            ViewSource::Patch(patch, _) => -patch.points[index].raw.distance,
            ViewSource::Made(manifold) => manifold.contacts()[index].contact.depth,
        };
        let deeper = |best, index| if depth(index) > depth(best) { index } else { best };
        self.contact((1..self.len()).fold(0, deeper), &self.own_normal())
    }

    /// The normal of what is kept, from the solid that is kept as the first, and turned to the world;
    /// nothing of use for manifolds that are made.
    #[inline]
    fn own_normal(&self) -> [Vector<N, D>; 2] {
        let (own, pose1) = match self.0 {
            ViewSource::Convex(raw, placement) => (raw.normal, placement.pose1),
            ViewSource::Patch(patch, placement) => (patch.normal, placement.pose1),
            ViewSource::Made(_) => return [Vector::<N, D>::zeros(); 2],
        };
        [own, pose1.vector(&own)]
    }

    /// The contact at an index; `normal` is [`Self::own_normal`].
    #[inline]
    fn contact(&self, index: usize, normal: &[Vector<N, D>; 2]) -> ContactPoint<N, D> {
        match self.0 {
            ViewSource::Convex(raw, placement) => {
                point(normal, &raw.points[index], [0; 2], &placement)
            }
            ViewSource::Patch(patch, placement) => {
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

/// A point in the world, by the normal as it is kept and in the world, as the user's order of the solids has it.
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
