//! What is kept of one built-in pair between updates, and how it is brought up to date.

use crate::math::{Pose, Real, Space};
use crate::query::{
    ContactManifold, ManifoldRequest, Pair, Placed, Placement, Proximity, RawManifold, canonical,
    materialise,
};
use crate::shape::{Geometry, Shape};

/// Two solids placed in the world.
#[derive(Clone, Copy)]
pub(crate) struct Posed<'a, N: Real, const D: usize> {
    pub(crate) pose1: &'a Pose<N, D>,
    pub(crate) shape1: &'a dyn Shape<N, D>,
    pub(crate) pose2: &'a Pose<N, D>,
    pub(crate) shape2: &'a dyn Shape<N, D>,
}

impl<'a, N: Real, const D: usize> Posed<'a, N, D> {
    /// The pair in the order in which every query computes it.
    fn canonical(&self) -> (Pair<'a, N, D>, bool) {
        canonical(self.pose1, self.shape1.geometry(), self.pose2, self.shape2.geometry())
    }
}

/// The contacts of a pair, in the frame of the solid that comes first in canonical order.
#[derive(Clone, Debug, Default)]
pub(crate) struct ContactState<N: Real, const D: usize> {
    raw: RawManifold<N, D>,
    /// The canonical order at the last update was the reverse of the pair's own.
    swapped: bool,
}

impl<N: Real, const D: usize> ContactState<N, D> {
    /// How many contact points there are.
    pub(crate) fn len(&self) -> usize {
        self.raw.points.len()
    }
}

impl<N: Space<D>, const D: usize> ContactState<N, D> {
    /// Computes the contacts for new poses; points whose features stay keep their numbers.
    pub(crate) fn update(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>) {
        let (pair, swapped) = posed.canonical();
        if swapped != self.swapped {
            self.raw.flip_names();
            self.swapped = swapped;
        }
        (N::tables().contacts)(&pair, request, &mut self.raw);
    }

    /// The manifold as users see it; `posed` is that of the last update and `pair_number` names the
    /// pair; `old` gives its memory.
    pub(crate) fn manifold(
        &self,
        posed: &Posed<'_, N, D>,
        pair_number: u64,
        old: ContactManifold<N, D>,
    ) -> ContactManifold<N, D> {
        if self.raw.points.is_empty() {
            return ContactManifold::default();
        }
        let (pair, is_swapped) = posed.canonical();
        let pose1 = if is_swapped { posed.pose2 } else { posed.pose1 };
        let placement = Placement { pose1, pair: pair_number, is_swapped };
        materialise(&pair, &self.raw, &placement, old)
    }
}

/// How near two solids are, by the same fact that contacts are derived from.
pub(crate) fn proximity_of<N: Space<D>, const D: usize>(
    posed: &Posed<'_, N, D>,
    margin: N,
) -> Proximity {
    let (pair, _) = posed.canonical();
    let is_composite = |kind| Geometry(kind).as_composite().is_some();
    let found = if is_composite(pair.first) || is_composite(pair.second) {
        let [placed1, placed2] = [(posed.pose1, posed.shape1), (posed.pose2, posed.shape2)]
            .map(|(pose, shape)| Placed { pose: *pose, shape: shape.geometry() });
        (N::tables().touching_in_world)(&placed1, &placed2, margin)
    } else {
        (N::tables().separation)(&pair, margin)
    };
    match found {
        None => Proximity::Disjoint,
        Some(separation) if separation.distance <= N::ZERO => Proximity::Intersecting,
        Some(_) => Proximity::WithinMargin,
    }
}
