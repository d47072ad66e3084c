//! The library's own contact algorithm as an object, for use alone.

use super::IdAllocator;
use super::state::{CompositeState, ContactState, Posed};
use super::traits::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
};
use crate::math::{Real, Space};
use crate::query::far::Apart;
use crate::query::{ContactManifold, ManifoldRequest};
use crate::shape::Shape;

/// How many points a manifold is reduced to unless more are asked for: what it takes to delimit an
/// area, two in the plane and four in space.
pub(crate) const fn conforming_points<const D: usize>() -> usize {
    1 << (D - 1)
}

/// Contacts of any two built-in solids, composites among them.
///
/// One type serves all pairs: it looks the algorithm up by the kinds of the solids at each update,
/// so it may even be given other solids from one update to the next.
#[derive(Clone, Debug)]
pub struct PairManifoldGenerator<N: Real, const D: usize> {
    state: ContactState<N, D>,
    /// Where one of the solids is a composite.
    composite: CompositeState<N, D>,
    /// The number that names the pair, once it has one.
    number: Option<u64>,
    max_points: usize,
    /// As of the last update; all hold a contact.
    manifolds: Vec<ContactManifold<N, D>>,
}

impl<N: Real, const D: usize> PairManifoldGenerator<N, D> {
    /// A generator that holds no contact; manifolds are reduced to at most `max_points` points,
    /// but never to fewer than one.
    #[must_use]
    pub fn new(max_points: usize) -> Self {
        Self {
            state: ContactState::default(),
            composite: CompositeState::default(),
            number: None,
            max_points: max_points.max(1),
            manifolds: Vec::new(),
        }
    }
}

impl<N: Real, const D: usize> Default for PairManifoldGenerator<N, D> {
    fn default() -> Self {
        Self::new(conforming_points::<D>())
    }
}

impl<N: Space<D>, const D: usize> ContactManifoldGenerator<N, D> for PairManifoldGenerator<N, D> {
    fn update(
        &mut self,
        _: &dyn ContactDispatcher<N, D>,
        ma: &N::Isometry,
        a: &dyn Shape<N, D>,
        mb: &N::Isometry,
        b: &dyn Shape<N, D>,
        prediction: &ContactPrediction<N>,
        ids: &mut IdAllocator,
    ) -> bool {
        let number = *self.number.get_or_insert_with(|| ids.allocate());
        let apart = Apart {
            shapes: [a.geometry(), b.geometry()],
            between: N::translation(mb) - N::translation(ma),
        };
        if (N::tables().are_beyond)(&apart, prediction.linear()) {
            self.state.clear();
            self.manifolds.clear();
            return true;
        }
        let (pose1, pose2) = (N::pose(ma), N::pose(mb));
        let posed = Posed { pose1: &pose1, shape1: a, pose2: &pose2, shape2: b, is_self: false };
        let angle = prediction.angular1() + prediction.angular2();
        let request = ManifoldRequest::new(prediction.linear(), angle, self.max_points);
        let tables = N::tables();
        let mut old = core::mem::take(&mut self.manifolds);
        if posed.has_composite() {
            // The shapes are given anew at each call.
            self.composite.forget_shapes();
            (tables.update_composites)(&mut self.composite, &posed, &request);
            self.manifolds = (tables.composite_manifolds)(&self.composite, &posed, number, old);
        } else {
            (tables.update_contacts)(&mut self.state, &posed, &request);
            let old = old.pop().unwrap_or_default();
            let manifold = (tables.public_manifold)(&self.state, &posed, number, old);
            self.manifolds.extend(Some(manifold).filter(|manifold| !manifold.is_empty()));
        }
        true
    }

    fn num_contacts(&self) -> usize {
        self.manifolds.iter().map(ContactManifold::len).sum()
    }

    fn contacts<'a>(&'a self, out: &mut Vec<&'a ContactManifold<N, D>>) {
        out.extend(&self.manifolds);
    }
}

/// Chooses the library's own algorithm for every two solids.
#[derive(Clone, Copy, Debug)]
pub struct DefaultContactDispatcher<const D: usize> {
    max_points: usize,
}

impl<const D: usize> DefaultContactDispatcher<D> {
    /// Manifolds of at most two points in the plane and four in space.
    #[must_use]
    pub const fn new() -> Self {
        Self { max_points: conforming_points::<D>() }
    }

    /// Manifolds of at most `max_points` points (at least one).
    #[must_use]
    pub const fn with_max_points(max_points: usize) -> Self {
        Self { max_points: if max_points == 0 { 1 } else { max_points } }
    }
}

impl<const D: usize> Default for DefaultContactDispatcher<D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Space<D>, const D: usize> ContactDispatcher<N, D> for DefaultContactDispatcher<D> {
    fn get_contact_algorithm(
        &self,
        _: &dyn Shape<N, D>,
        _: &dyn Shape<N, D>,
    ) -> Option<ContactAlgorithm<N, D>> {
        Some(Box::new(PairManifoldGenerator::new(self.max_points)))
    }

    fn built_in(&self, _: &dyn Shape<N, D>, _: &dyn Shape<N, D>) -> Option<usize> {
        Some(self.max_points)
    }
}
