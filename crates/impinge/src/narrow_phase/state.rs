//! The state of a pair with a built-in algorithm, and its update.
//!
//! A world computes the same bits for a pair as a generator that serves this pair alone. The
//! *canonical order* of two solids is that of [`canonical`]: by kind, pose and numbers, so it does
//! not depend on the order in which the solids are passed. The pair's *own order* is that of its
//! key.

use super::group::PairKey;
use crate::collide::far::ReachBounds;
use crate::collide::pair::{Ordered, is_swapped};
use crate::collide::parts::Between;
use crate::collide::{
    CompositeContacts, ManifoldRequest, Pair, PairQuestion, Placed, RawManifold, Solid, canonical,
    own_distance,
};
use crate::math::{Mapped, Point, Pose, Real, Space, Vector};
use crate::memory::clone_fields;
use crate::query::composite::{Touched, touched};
use crate::query::{ContactManifold, ManifoldView, PairRef, PlacedSolids, Placement, Proximity};
use crate::shape::{Geometry, Kind, Shape};
use crate::tables::ByDimension;
use crate::tables::entries;

/// The input of an update of a pair: two solids placed in the world, with their bounds.
#[derive(Clone, Copy)]
pub(crate) struct Posed<'a, N: Real, const D: usize> {
    pub(crate) pose1: &'a Pose<N, D>,
    pub(crate) shape1: &'a dyn Shape<N, D>,
    pub(crate) pose2: &'a Pose<N, D>,
    pub(crate) shape2: &'a dyn Shape<N, D>,
    /// Bounding balls and boxes of the shapes.
    pub(crate) bounds: [&'a ReachBounds<N, D>; 2],
    /// Whether both solids are the same object, which is tested against itself.
    pub(crate) is_self: bool,
}

impl<'a, N: Real, const D: usize> Posed<'a, N, D> {
    /// Returns the pair in canonical order, and `true` if the canonical order is the reverse of the
    /// pair's own order.
    fn canonical(&self) -> (Pair<'a, N, D>, bool) {
        canonical(self.pose1, self.shape1.geometry(), self.pose2, self.shape2.geometry())
    }

    /// Returns the two placed solids in the pair's own order.
    pub(super) fn placed(&self) -> [Placed<'a, N, D>; 2] {
        [(self.pose1, self.shape1), (self.pose2, self.shape2)]
            .mapped(|(pose, shape)| Placed { pose: *pose, shape: shape.geometry() })
    }

    /// Returns `true` if the bounds prove that the solids are farther apart than `limit`.
    fn are_beyond(&self, limit: N) -> bool {
        let between = self.pose2.translation - self.pose1.translation;
        self.bounds[0].is_clear_of(self.bounds[1], &between, limit)
    }

    /// Returns `true` if the bounding boxes prove that the solids are farther apart than `limit`.
    /// `pose12` is the relative pose in canonical order.
    fn have_boxes_beyond(&self, pose12: &Pose<N, D>, is_swapped: bool, limit: N) -> bool {
        let [first, second] = [usize::from(is_swapped), usize::from(!is_swapped)];
        self.bounds[first].has_box_clear_of(self.bounds[second], pose12, limit)
    }

    /// Returns `true` if at least one of the two shapes is a composite.
    pub(crate) fn has_composite(&self) -> bool {
        has_composite(self.shape1, self.shape2)
    }
}

/// Returns two placed solids as a pair, whose first solid is the one in whose frame contacts are
/// stored.
fn ordered_pair<'a, N: Real, const D: usize>(
    placed: &[Placed<'a, N, D>; 2],
    is_swapped: bool,
) -> Pair<'a, N, D> {
    let [first, second] = [&placed[usize::from(is_swapped)], &placed[usize::from(!is_swapped)]];
    Pair::new([first.shape, second.shape], [&first.pose, &second.pose])
}

/// Returns `true` if at least one of two shapes is a composite.
pub(crate) fn has_composite<N: Real, const D: usize>(
    shape1: &dyn Shape<N, D>,
    shape2: &dyn Shape<N, D>,
) -> bool {
    let is_composite = |shape: &dyn Shape<N, D>| shape.geometry().as_composite().is_some();
    is_composite(shape1) || is_composite(shape2)
}

/// The stored contact points of a pair, as contact reuse reads and measures them.
pub(crate) trait KeptPoints<N: Real, const D: usize> {
    /// Returns the number of contact points.
    fn len(&self) -> usize;

    /// Returns `true` if contacts are stored in the frame of the pair's second solid.
    fn is_swapped(&self) -> bool;

    /// Calls `each` with the normal, the signed distance and the point on the first solid of each
    /// contact, in the frame in which contacts are stored.
    fn each_point(&mut self, each: impl FnMut(&Vector<N, D>, &mut N, &Point<N, D>));
}

/// Contacts of a pair by the library's own algorithm, kept from update to update.
pub(crate) trait KeptContacts<N: Real, const D: usize>: KeptPoints<N, D> + Default {
    /// The representation of the contacts in the public interface.
    type Manifolds: Default;

    /// Computes the contacts for new poses; a contact that only moved keeps its id.
    fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>);

    /// Returns the contacts as public manifolds, in the memory of `old`. `placed` has the solids at
    /// the last update, and `pair_number` is the first half of the contact ids.
    fn manifolds(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        pair_number: u64,
        old: Self::Manifolds,
    ) -> Self::Manifolds;
}

/// The contacts of a pair, in the frame of the solid that comes first in canonical order.
#[derive(Debug, Default)]
#[repr(C)]
pub(crate) struct OrderedContacts<C> {
    /// Whether the canonical order at the last update was the reverse of the pair's own order.
    pub(super) swapped: bool,
    pub(super) contacts: C,
}

clone_fields!([C: Clone] OrderedContacts<C> { swapped, contacts });

/// Contacts of two convex solids. Fields that readers need come first, so that readers load few
/// cache lines.
#[derive(Debug, Default)]
#[repr(C)]
pub(crate) struct ContactState<N: Real, const D: usize> {
    kept: OrderedContacts<RawManifold<N, D>>,
    /// Copies of the solids in the pair's own order; `None` unless both are balls, segments,
    /// capsules or boxes.
    solids: Option<[Solid<N, D>; 2]>,
}

clone_fields!([N: Real, const D: usize] ContactState<N, D> { kept, solids });

/// Contacts of a pair with at least one composite.
pub(crate) type CompositeState<N, const D: usize> = OrderedContacts<CompositeContacts<N, D>>;

impl<N: Real, const D: usize> OrderedContacts<RawManifold<N, D>> {
    /// Flips the stored contacts if the canonical order of the two solids has changed. Returns the
    /// indices of the first and the second solid in canonical order.
    #[inline(always)]
    fn set_canonical_order(
        &mut self,
        poses: [&Pose<N, D>; 2],
        [kind1, kind2]: [Kind<'_, N, D>; 2],
    ) -> [usize; 2] {
        let swapped = is_swapped(poses[0], Geometry(kind1), poses[1], Geometry(kind2));
        let [first, second] = [usize::from(swapped), usize::from(!swapped)];
        self.set_order(swapped, |raw| {
            if !raw.points.is_empty() {
                raw.flip(&Pose::relative(poses[first], poses[second]));
            }
        });
        [first, second]
    }
}

impl<C> OrderedContacts<C> {
    /// Stores whether the canonical order is the reverse of the pair's own order; calls `flip` on
    /// the contacts if that has changed.
    #[inline(always)]
    fn set_order(&mut self, swapped: bool, flip: impl FnOnce(&mut C)) {
        if swapped != self.swapped {
            self.flip_order(flip);
        }
    }

    #[cold]
    #[inline(never)]
    fn flip_order(&mut self, flip: impl FnOnce(&mut C)) {
        flip(&mut self.contacts);
        self.swapped = !self.swapped;
    }
}

impl<N: Real, const D: usize> KeptPoints<N, D> for ContactState<N, D> {
    fn len(&self) -> usize {
        self.kept.contacts.points.len()
    }

    fn is_swapped(&self) -> bool {
        self.kept.swapped
    }

    #[inline]
    fn each_point(&mut self, mut each: impl FnMut(&Vector<N, D>, &mut N, &Point<N, D>)) {
        let RawManifold { normal, points, .. } = &mut self.kept.contacts;
        points.iter_mut().for_each(|point| each(normal, &mut point.distance, &point.point1));
    }
}

impl<N: Space<D>, const D: usize> KeptContacts<N, D> for ContactState<N, D> {
    type Manifolds = ContactManifold<N, D>;

    fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>) {
        if posed.are_beyond(request.prediction) {
            return self.clear();
        }
        let (pair, swapped) = posed.canonical();
        // Only for pairs without contacts: the boxes rarely reject a pair that had contacts.
        if self.kept.contacts.points.is_empty()
            && posed.have_boxes_beyond(&pair.pose12, swapped, request.prediction)
        {
            return;
        }
        self.kept.set_order(swapped, |raw| raw.flip(&pair.pose12));
        <N::Algorithms>::contacts(&pair, request, &mut self.kept.contacts);
    }

    fn manifolds(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        pair_number: u64,
        old: ContactManifold<N, D>,
    ) -> ContactManifold<N, D> {
        if self.len() == 0 {
            return ContactManifold::default();
        }
        self.view(placed, [0, 1], pair_number).manifold_in(old)
    }
}

impl<N: Real, const D: usize> ContactState<N, D> {
    /// Returns the manifold, and `true` if it is in the frame of the second solid.
    pub(super) const fn kept(&self) -> (&RawManifold<N, D>, bool) {
        (&self.kept.contacts, self.kept.swapped)
    }

    /// Sets the manifold; `swapped` is `true` if it is in the frame of the second solid.
    pub(super) fn keep(&mut self, contacts: RawManifold<N, D>, swapped: bool) {
        self.kept = OrderedContacts { swapped, contacts };
    }

    /// Removes all contacts.
    pub(super) fn clear(&mut self) {
        self.kept.contacts.points.clear();
    }
}

impl<N: Space<D>, const D: usize> ContactState<N, D> {
    /// Computes the contacts of two solids without a test of their bounds. A contact that only
    /// moved keeps its id. `copies` has a copy of each solid that is a ball, segment, capsule or
    /// box.
    pub(super) fn update_alone(
        &mut self,
        ([pose1, pose2], [one, other]): (&[Pose<N, D>; 2], [Geometry<'_, N, D>; 2]),
        copies: [Option<&Solid<N, D>>; 2],
        request: &ManifoldRequest<N>,
    ) {
        let (poses, kinds) = ([pose1, pose2], [one.0, other.0]);
        let [first, second] = self.kept.set_canonical_order(poses, kinds);
        let (poses, raw) = ([poses[first], poses[second]], &mut self.kept.contacts);
        if let [Some(one), Some(other)] = [copies[first], copies[second]] {
            let question = PairQuestion { poses, solids: [one, other], request };
            if <N::Algorithms>::update_pair(&question, raw) {
                return;
            }
        }
        let pair = Pair::new([Geometry(kinds[first]), Geometry(kinds[second])], poses);
        <N::Algorithms>::contacts_of_separation(&pair, request, raw);
    }

    /// Stores copies of the solids if both are balls, segments, capsules or boxes; else drops the
    /// copies. The kernels for such pairs store no pose, so that of the old solids is dropped.
    pub(super) fn set_solids(&mut self, shapes: [&dyn Shape<N, D>; 2]) {
        let [one, other] = shapes.mapped(Shape::geometry);
        self.solids = Solid::of(one).zip(Solid::of(other)).map(<[_; 2]>::from);
        if self.solids.is_some() {
            self.kept.contacts.pose12 = None;
        }
    }

    /// Returns the copies of the solids, in the pair's own order; `None` if there are none.
    pub(super) const fn solids(&self) -> Option<&[Solid<N, D>; 2]> {
        self.solids.as_ref()
    }

    /// Returns the manifold, in the frame of the first solid in canonical order, for changes.
    #[inline]
    pub(super) const fn raw_mut(&mut self) -> &mut RawManifold<N, D> {
        &mut self.kept.contacts
    }

    /// Flips the manifold to the present canonical order, and returns it with the solids in that
    /// order; `None` without copies of the solids.
    #[inline(always)]
    pub(super) fn canonical_question<'a>(
        &'a mut self,
        poses: [&'a Pose<N, D>; 2],
        request: &'a ManifoldRequest<N>,
    ) -> Option<(PairQuestion<'a, N, D>, &'a mut RawManifold<N, D>)> {
        let solids = self.solids.as_ref()?;
        let kinds = [solids[0].kind(), solids[1].kind()];
        let [first, second] = self.kept.set_canonical_order(poses, kinds);
        let (poses, solids) = ([poses[first], poses[second]], [&solids[first], &solids[second]]);
        Some((PairQuestion { poses, solids, request }, &mut self.kept.contacts))
    }

    /// Returns the handle index of the object in whose frame the contacts are stored.
    #[inline]
    pub(super) const fn frame_object(&self, [first, second]: PairKey) -> u32 {
        if self.kept.swapped { second } else { first }
    }

    /// Reads every cache line of the contacts that [`Self::view`] needs; the returned value is
    /// meaningless and only keeps the loads alive.
    #[inline]
    pub(super) fn prefetch(&self) -> u32 {
        let ids = self.kept.contacts.points.iter().map(|point| point.id);
        ids.fold(0, u32::wrapping_add)
    }

    /// Returns a view of the contacts, of which there must be at least one.
    #[inline]
    pub(super) fn view<'a>(
        &'a self,
        solids: &'a impl PlacedSolids<N, D>,
        key: PairKey,
        number: u64,
    ) -> ManifoldView<'a, N, D> {
        let pose1 = solids.pose(self.frame_object(key));
        let placement = Placement { pose1, pair: number, is_swapped: self.kept.swapped };
        ManifoldView::of_convex(&self.kept.contacts, placement, PairRef::new(solids, key))
    }
}

impl<N: Real, const D: usize> CompositeState<N, D> {
    /// Reads the cache lines that an update needs first; the returned value is meaningless and only
    /// keeps the loads alive.
    #[inline]
    pub(super) fn prefetch(&self) -> N {
        self.contacts.prefetch()
    }

    /// Returns the handle index of the object in whose frame the contacts are stored.
    #[inline]
    pub(super) const fn frame_object(&self, [first, second]: PairKey) -> u32 {
        if self.swapped { second } else { first }
    }

    /// Drops the cached data of the shapes, because a shape may have been replaced: a composite if
    /// `has_composite_changed`.
    pub(crate) fn forget_shapes(&mut self, has_composite_changed: bool) {
        self.contacts.forget_shapes(has_composite_changed);
    }
}

impl<N: Space<D>, const D: usize> CompositeState<N, D> {
    /// Computes the contacts of two shapes, or of a shape with itself if `is_self`; a contact that
    /// only moved keeps its id.
    pub(crate) fn update_between(
        &mut self,
        [one, other]: &[Placed<'_, N, D>; 2],
        is_self: bool,
        request: &ManifoldRequest<N>,
    ) {
        let ordered = Ordered::new(one, other);
        self.set_order(ordered.swapped, CompositeContacts::flip);
        self.contacts.update(&Between::of_ordered(&ordered), is_self, request);
    }

    /// Calls `each` with the solids on which each contact lies, in the order of contacts. `placed`
    /// has the solids at the last update.
    pub(super) fn each_touched(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        mut each: impl FnMut(&Touched<'_, N, D>),
    ) {
        let pair = ordered_pair(placed, self.swapped);
        for patch in self.contacts.patches() {
            patch.points.iter().for_each(|point| touched(&pair, patch, point, &mut each));
        }
    }

    /// Returns the contacts as public manifolds, in the memory of `old`. `next` is called once for
    /// each contact, in order, and returns the solids on which the contact lies.
    pub(super) fn manifolds_on<'a>(
        &self,
        poses: &[Pose<N, D>; 2],
        pair: u64,
        next: impl FnMut() -> Option<Touched<'a, N, D>>,
        old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        let is_swapped = self.swapped;
        let [pose1, pose2] = [&poses[usize::from(is_swapped)], &poses[usize::from(!is_swapped)]];
        let placement = Placement { pose1, pair, is_swapped };
        self.contacts.manifolds_on([pose1, pose2], &placement, next, old)
    }

    /// Returns a view of the contacts of patch `patch`; `None` if `patch` is not less than the
    /// number of patches.
    #[inline]
    pub(super) fn view<'a>(
        &'a self,
        solids: &'a impl PlacedSolids<N, D>,
        key: PairKey,
        number: u64,
        patch: usize,
    ) -> Option<ManifoldView<'a, N, D>> {
        let pose1 = solids.pose(self.frame_object(key));
        let placement = Placement { pose1, pair: number, is_swapped: self.swapped };
        self.contacts.view(patch, placement, PairRef::new(solids, key))
    }
}

impl<N: Real, const D: usize> KeptPoints<N, D> for CompositeState<N, D> {
    fn len(&self) -> usize {
        self.contacts.len()
    }

    fn is_swapped(&self) -> bool {
        self.swapped
    }

    fn each_point(&mut self, each: impl FnMut(&Vector<N, D>, &mut N, &Point<N, D>)) {
        self.contacts.each_point(each);
    }
}

impl<N: Space<D>, const D: usize> KeptContacts<N, D> for CompositeState<N, D> {
    type Manifolds = Vec<ContactManifold<N, D>>;

    fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>) {
        self.update_between(&posed.placed(), posed.is_self, request);
    }

    fn manifolds(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        pair_number: u64,
        mut old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        old.resize_with(self.contacts.patches().len(), ContactManifold::default);
        for (patch, manifold) in old.iter_mut().enumerate() {
            if let Some(view) = self.view(placed, [0, 1], pair_number, patch) {
                *manifold = view.manifold_in(core::mem::take(manifold));
            }
        }
        old
    }
}

/// Returns the proximity of two solids, derived from the same distance as their contacts.
pub(crate) fn proximity_of<N: Space<D>, const D: usize>(
    posed: &Posed<'_, N, D>,
    margin: N,
) -> Proximity {
    let found = if posed.is_self {
        own_distance(&posed.canonical().0, margin)
    } else if posed.has_composite() {
        let [placed1, placed2] = posed.placed();
        entries::distance_in_world(&placed1, &placed2, margin)
    } else if posed.are_beyond(margin) {
        None
    } else {
        let (pair, swapped) = posed.canonical();
        if posed.have_boxes_beyond(&pair.pose12, swapped, margin) {
            None
        } else {
            <N::Algorithms>::distance(&pair, margin)
        }
    };
    match found {
        None => Proximity::Disjoint,
        Some(distance) if distance <= N::ZERO => Proximity::Intersecting,
        Some(_) => Proximity::WithinMargin,
    }
}
