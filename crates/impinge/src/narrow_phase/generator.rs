//! The library's own contact algorithm as an object, for use alone.

use crate::tables::entries;
use core::fmt;

use super::IdAllocator;
use super::state::{CompositeState, ContactState, Posed, poses_within};
use super::traits::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
};
use crate::collide::ManifoldRequest;
use crate::math::{Real, Space};
use crate::query::ContactManifold;
use crate::shape::Shape;

/// How many points a manifold is reduced to unless more are asked for: what it takes to delimit an
/// area, two in 2D and four in 3D.
pub(crate) const fn conforming_points<const D: usize>() -> usize {
    1 << (D - 1)
}

/// Contacts of any two built-in solids, composites among them.
///
/// One type serves all pairs: it looks the algorithm up by the kinds of the solids at each update,
/// so it may even be given other solids from one update to the next.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::narrow_phase::{
///     ContactManifoldGenerator, DefaultContactDispatcher, IdAllocator, PairManifoldGenerator,
/// };
/// use impinge::dim2::query::ContactPrediction;
/// use impinge::dim2::shape::Cuboid;
///
/// let square = Cuboid::new(Vector::new(1.0_f64, 1.0));
/// let (here, there) = (Isometry::identity(), Isometry::translation(0.0, 1.75));
/// let (dispatcher, mut ids) = (DefaultContactDispatcher::new(), IdAllocator::new());
///
/// let mut generator = PairManifoldGenerator::default();
/// let prediction = ContactPrediction::new(0.0, 0.0, 0.0);
/// generator.update(&dispatcher, &here, &square, &there, &square, &prediction, &mut ids);
/// let mut manifolds = Vec::new();
/// generator.contacts(&mut manifolds);
/// assert_eq!(manifolds[0].len(), 2);
/// ```
#[derive(Clone)]
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

impl<N: Space<D>, const D: usize> PairManifoldGenerator<N, D> {
    /// Computes the contacts of two solids that may be within the prediction; `number` names the pair.
    fn refresh(&mut self, posed: &Posed<'_, N, D>, request: &ManifoldRequest<N>, number: u64) {
        let mut old = core::mem::take(&mut self.manifolds);
        if posed.has_composite() {
            // The shapes are given anew at each call.
            self.composite.forget_shapes();
            entries::update_composites(&mut self.composite, posed, request);
            self.manifolds = entries::composite_manifolds(&self.composite, posed, number, old);
        } else {
            entries::update_contacts(&mut self.state, posed, request);
            let manifold = old.pop().unwrap_or_default();
            let manifold = entries::public_manifold(&self.state, posed, number, manifold);
            old.clear();
            if !manifold.is_empty() {
                old.push(manifold);
            }
            self.manifolds = old;
        }
    }

    /// The manifolds of two solids that may be within the prediction, computed from nothing. The pair has
    /// the number 0.
    pub(super) fn once(
        mut self,
        posed: &Posed<'_, N, D>,
        prediction: &ContactPrediction<N>,
    ) -> Vec<ContactManifold<N, D>> {
        self.refresh(posed, &prediction.request(self.max_points), 0);
        self.manifolds
    }
}

impl<N: Real, const D: usize> fmt::Debug for PairManifoldGenerator<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PairManifoldGenerator")
            .field("max_points", &self.max_points)
            .field("manifolds", &self.manifolds)
            .finish_non_exhaustive()
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
        let request = prediction.request(self.max_points);
        match poses_within([ma, mb], [a, b], prediction.linear()) {
            Some([pose1, pose2]) => {
                self.refresh(&Posed::new([&pose1, &pose2], [a, b]), &request, number);
            }
            None => {
                self.state.clear();
                self.manifolds.clear();
            }
        }
        true
    }

    fn num_contacts(&self) -> usize {
        self.manifolds.iter().map(ContactManifold::len).sum()
    }

    fn contacts<'a>(&'a self, out: &mut Vec<&'a ContactManifold<N, D>>) {
        out.extend(&self.manifolds);
    }

    fn boxed_clone(&self) -> ContactAlgorithm<N, D> {
        Box::new(self.clone())
    }
}

/// Chooses the library's own algorithm for every two solids.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::narrow_phase::{
///     ContactDispatcher, ContactManifoldGenerator, DefaultContactDispatcher, IdAllocator,
/// };
/// use impinge::dim2::query::ContactPrediction;
/// use impinge::dim2::shape::Cuboid;
///
/// let square = Cuboid::new(Vector::new(1.0_f64, 1.0));
/// let (here, there) = (Isometry::identity(), Isometry::translation(0.0, 1.75));
/// let (dispatcher, mut ids) = (DefaultContactDispatcher::new(), IdAllocator::new());
///
/// let algorithm = dispatcher.get_contact_algorithm(&square, &square);
/// let mut algorithm = algorithm.expect("every pair of built-in shapes has one");
/// let prediction = ContactPrediction::new(0.0, 0.0, 0.0);
/// assert!(algorithm.update(&dispatcher, &here, &square, &there, &square, &prediction, &mut ids));
/// assert_eq!(algorithm.num_contacts(), 2);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct DefaultContactDispatcher<const D: usize> {
    max_points: usize,
}

impl<const D: usize> DefaultContactDispatcher<D> {
    /// Manifolds of at most two points in 2D and four in 3D.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Isometry2;
    use crate::math::{Point, Vector};
    use crate::shape::{Ball, ConvexPolygon, Cuboid, Polyline};

    struct Asker {
        generator: PairManifoldGenerator<f64, 2>,
        ids: IdAllocator,
    }

    impl Asker {
        fn new() -> Self {
            Self { generator: PairManifoldGenerator::default(), ids: IdAllocator::new() }
        }

        /// The manifolds of two solids, the second of which stands at `x`.
        fn manifolds(
            &mut self,
            first: &dyn Shape<f64, 2>,
            second: &dyn Shape<f64, 2>,
            x: f64,
        ) -> Vec<ContactManifold<f64, 2>> {
            let dispatcher = DefaultContactDispatcher::<2>::new();
            let prediction = ContactPrediction::new(0.25, 0.0, 0.0);
            let (here, there) = (Isometry2::identity(), Isometry2::translation(x, 0.0));
            let able = self.generator.update(
                &dispatcher,
                &here,
                first,
                &there,
                second,
                &prediction,
                &mut self.ids,
            );
            assert!(able, "the library's own solids");
            let mut manifolds = Vec::new();
            self.generator.contacts(&mut manifolds);
            manifolds.into_iter().cloned().collect()
        }

        /// The depths of the contacts in [`Self::manifolds`].
        fn depths(
            &mut self,
            first: &dyn Shape<f64, 2>,
            second: &dyn Shape<f64, 2>,
            x: f64,
        ) -> Vec<f64> {
            let manifolds = self.manifolds(first, second, x);
            let contacts = manifolds.iter().flat_map(ContactManifold::contacts);
            contacts.map(|tracked| tracked.contact.depth).collect()
        }
    }

    /// A square with half sides of the given size.
    fn square(size: f64) -> ConvexPolygon<f64> {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        ConvexPolygon::new(&corners.map(|(x, y)| Point::<f64, 2>::new(x, y) * size))
    }

    #[test]
    fn an_update_without_motion_keeps_contacts_and_ids() {
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0));
        let (ball, square) = (Ball::new(1.0), square(1.0));
        let wall = [-2.0, 0.0, 2.0].map(|y| Point::<f64, 2>::new(-0.75, y));
        let wall = Polyline::new(wall.to_vec(), vec![[0, 1], [1, 2]]);
        let others: [&dyn Shape<f64, 2>; 4] = [&cuboid, &ball, &square, &wall];
        for (index, other) in others.into_iter().enumerate() {
            let mut asker = Asker::new();
            let before = asker.manifolds(&cuboid, other, 1.5);
            assert!(!before.is_empty(), "shape {index} overlaps the cuboid");
            assert_eq!(asker.manifolds(&cuboid, other, 1.5), before, "shape {index}");
        }
    }

    #[test]
    fn each_update_may_be_given_other_solids() {
        let mut asker = Asker::new();
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0));
        let mut ball = Ball::new(1.0);
        assert_eq!(asker.depths(&cuboid, &ball, 1.5), [0.5]);
        ball = Ball::new(0.75);
        assert_eq!(asker.depths(&cuboid, &ball, 1.5), [0.25], "another ball at its address");
        assert!(asker.depths(&cuboid, &ball, 9.0).is_empty(), "far away");
        assert_eq!(asker.depths(&cuboid, &ball, 1.5), [0.25], "back again");
        for (size, depth) in [(1.0, 0.5), (0.75, 0.25)] {
            let found = asker.depths(&cuboid, &square(size), 1.5);
            assert_eq!(found, [depth; 2], "a square of {size}");
        }
    }
}
