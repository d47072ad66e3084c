//! What is kept of one built-in pair between updates, and how it is brought up to date.

use crate::math::{Pose, Real, Space};
use crate::query::composite::Between;
use crate::query::pair::is_swapped;
use crate::query::{
    BoxJob, CompositeContacts, ContactManifold, ManifoldRequest, ManifoldView, Pair, Placed,
    Placement, Proximity, RawManifold, canonical, materialise, own_distance,
};
use crate::shape::{Geometry, Kind, Shape};

/// Two solids placed in the world.
#[derive(Clone, Copy)]
pub(crate) struct Posed<'a, N: Real, const D: usize> {
    pub(crate) pose1: &'a Pose<N, D>,
    pub(crate) shape1: &'a dyn Shape<N, D>,
    pub(crate) pose2: &'a Pose<N, D>,
    pub(crate) shape2: &'a dyn Shape<N, D>,
    /// Both are one object, which is tested against itself.
    pub(crate) is_self: bool,
}

impl<'a, N: Real, const D: usize> Posed<'a, N, D> {
    /// The pair in the order in which every query computes it.
    fn canonical(&self) -> (Pair<'a, N, D>, bool) {
        canonical(self.pose1, self.shape1.geometry(), self.pose2, self.shape2.geometry())
    }

    /// The two solids, each for itself.
    fn placed(&self) -> [Placed<'a, N, D>; 2] {
        [(self.pose1, self.shape1), (self.pose2, self.shape2)]
            .map(|(pose, shape)| Placed { pose: *pose, shape: shape.geometry() })
    }

    /// Where the pair in canonical order stands.
    fn placement(&self, pair: u64, is_swapped: bool) -> Placement<'a, N, D> {
        let pose1 = if is_swapped { self.pose2 } else { self.pose1 };
        Placement { pose1, pair, is_swapped }
    }

    /// A composite is among them.
    pub(crate) fn has_composite(&self) -> bool {
        has_composite(self.shape1, self.shape2)
    }
}

/// One of two shapes at least is a composite.
pub(crate) fn has_composite<N: Real, const D: usize>(
    shape1: &dyn Shape<N, D>,
    shape2: &dyn Shape<N, D>,
) -> bool {
    let is_composite = |shape: &dyn Shape<N, D>| shape.geometry().as_composite().is_some();
    is_composite(shape1) || is_composite(shape2)
}

/// The contacts of a pair, kept from update to update.
pub(crate) trait KeptContacts<N: Real, const D: usize>: Default {
    /// As users see them.
    type Manifolds: Default;

    /// How many contact points there are.
    fn len(&self) -> usize;

    /// Computes the contacts for new poses; points whose features stay keep their numbers.
    fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>);

    /// The contacts as users see them; `posed` is that of the last update and `pair_number` names
    /// the pair; `old` gives its memory.
    fn manifolds(
        &self,
        posed: &Posed<'_, N, D>,
        pair_number: u64,
        old: Self::Manifolds,
    ) -> Self::Manifolds;
}

/// The contacts of two convex solids, in the frame of the solid that comes first in canonical order.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactState<N: Real, const D: usize> {
    raw: RawManifold<N, D>,
    /// The canonical order at the last update was the reverse of the pair's own.
    swapped: bool,
}

impl<N: Space<D>, const D: usize> KeptContacts<N, D> for ContactState<N, D> {
    type Manifolds = ContactManifold<N, D>;

    fn len(&self) -> usize {
        self.raw.points.len()
    }

    fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>) {
        let (pair, swapped) = posed.canonical();
        self.turn(swapped);
        (N::tables().contacts)(&pair, request, &mut self.raw);
    }

    fn manifolds(
        &self,
        posed: &Posed<'_, N, D>,
        pair_number: u64,
        old: ContactManifold<N, D>,
    ) -> ContactManifold<N, D> {
        if self.raw.points.is_empty() {
            return ContactManifold::default();
        }
        let (pair, is_swapped) = posed.canonical();
        materialise(&pair, &self.raw, &posed.placement(pair_number, is_swapped), old)
    }
}

impl<N: Space<D>, const D: usize> ContactState<N, D> {
    /// What it takes to bring the contacts of two boxes up to date; `None` for other solids.
    pub(super) fn box_job<'a>(
        &'a mut self,
        posed: &Posed<'a, N, D>,
        request: &'a ManifoldRequest<N>,
    ) -> Option<BoxJob<'a, N, D>> {
        let (shape1, shape2) = (posed.shape1.geometry(), posed.shape2.geometry());
        self.turn(is_swapped(posed.pose1, shape1, posed.pose2, shape2));
        let (Kind::Cuboid(cuboid1), Kind::Cuboid(cuboid2)) = (shape1.0, shape2.0) else {
            return None;
        };
        let (mut poses, mut cuboids) = ([posed.pose1, posed.pose2], [cuboid1, cuboid2]);
        if self.swapped {
            poses.reverse();
            cuboids.reverse();
        }
        Some(BoxJob { poses, cuboids, request, raw: &mut self.raw })
    }

    /// The canonical order is this one now.
    fn turn(&mut self, swapped: bool) {
        if swapped != self.swapped {
            self.raw.flip_names();
            self.swapped = swapped;
        }
    }

    /// The contacts, which are not none, read in place; the poses are those of the last update.
    #[inline]
    pub(crate) fn view<'a>(
        &'a self,
        poses: [&'a Pose<N, D>; 2],
        pair_number: u64,
    ) -> ManifoldView<'a, N, D> {
        let pose1 = poses[usize::from(self.swapped)];
        let placement = Placement { pose1, pair: pair_number, is_swapped: self.swapped };
        ManifoldView::of_convex(&self.raw, placement)
    }
}

impl<N: Real, const D: usize> CompositeState<N, D> {
    /// One of the shapes may be another one now.
    pub(crate) fn forget_shapes(&mut self) {
        self.contacts.forget_shapes();
    }
}

impl<N: Space<D>, const D: usize> CompositeState<N, D> {
    /// As [`ContactState::view`], one for each patch.
    pub(crate) fn views<'a>(
        &'a self,
        poses: [&'a Pose<N, D>; 2],
        pair_number: u64,
    ) -> impl Iterator<Item = ManifoldView<'a, N, D>> {
        let pose1 = poses[usize::from(self.swapped)];
        let placement = Placement { pose1, pair: pair_number, is_swapped: self.swapped };
        self.contacts.views(placement)
    }
}

/// The contacts of a pair of which one solid at least is a composite, as [`ContactState`].
#[derive(Clone, Debug, Default)]
pub(crate) struct CompositeState<N: Real, const D: usize> {
    contacts: CompositeContacts<N, D>,
    swapped: bool,
}

impl<N: Space<D>, const D: usize> KeptContacts<N, D> for CompositeState<N, D> {
    type Manifolds = Vec<ContactManifold<N, D>>;

    fn len(&self) -> usize {
        self.contacts.len()
    }

    fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>) {
        let (pair, swapped) = posed.canonical();
        if swapped != self.swapped {
            self.contacts.flip_names();
            self.swapped = swapped;
        }
        let (first, second) =
            if swapped { (posed.pose2, posed.pose1) } else { (posed.pose1, posed.pose2) };
        let between = Between { pair, pose21: Pose::relative(second, first) };
        self.contacts.update(&between, posed.is_self, request);
    }

    fn manifolds(
        &self,
        posed: &Posed<'_, N, D>,
        pair_number: u64,
        old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        let (pair, is_swapped) = posed.canonical();
        self.contacts.manifolds(&pair, &posed.placement(pair_number, is_swapped), old)
    }
}

/// How near two solids are, by the same fact that contacts are derived from.
pub(crate) fn proximity_of<N: Space<D>, const D: usize>(
    posed: &Posed<'_, N, D>,
    margin: N,
) -> Proximity {
    let (pair, _) = posed.canonical();
    let is_composite = |kind| Geometry(kind).as_composite().is_some();
    let found = if posed.is_self {
        own_distance(&pair, margin)
    } else if is_composite(pair.first) || is_composite(pair.second) {
        let [placed1, placed2] = posed.placed();
        (N::tables().touching_in_world)(&placed1, &placed2, margin).map(|found| found.distance)
    } else {
        (N::tables().separation)(&pair, margin).map(|found| found.distance)
    };
    match found {
        None => Proximity::Disjoint,
        Some(distance) if distance <= N::ZERO => Proximity::Intersecting,
        Some(_) => Proximity::WithinMargin,
    }
}
