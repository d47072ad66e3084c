//! The library's own proximity algorithm for one pair, for use without a world.

use super::traits::{ProximityAlgorithm, ProximityDetector, ProximityDispatcher};
use crate::math::{IsometryRef, Space};
use crate::query::Proximity;
use crate::shape::Shape;
use crate::tables::entries;

/// Computes the proximity of any two shapes by the library's own algorithm.
///
/// ```
/// use impinge::dim2::events::Proximity;
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::narrow_phase::{
///     DefaultProximityDispatcher, PairProximityDetector, ProximityDetector,
/// };
/// use impinge::dim2::shape::Ball;
///
/// let mut detector = PairProximityDetector::new();
/// let (dispatcher, ball) = (DefaultProximityDispatcher::new(), Ball::new(1.0_f32));
/// let (detector, here): (&mut dyn ProximityDetector<f32, 2>, _) = (&mut detector, Isometry::identity());
/// detector.update(&dispatcher, &here, &ball, &here, &ball, 0.0);
/// assert_eq!(detector.proximity(), Proximity::Intersecting);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct PairProximityDetector {
    proximity: Proximity,
}

impl PairProximityDetector {
    /// Creates a detector whose proximity is `Disjoint`.
    #[must_use]
    pub const fn new() -> Self {
        Self { proximity: Proximity::Disjoint }
    }
}

impl Default for PairProximityDetector {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Space<D>, const D: usize> ProximityDetector<N, D> for PairProximityDetector {
    fn update(
        &mut self,
        _: &dyn ProximityDispatcher<N, D>,
        ma: &N::Isometry,
        a: &dyn Shape<N, D>,
        mb: &N::Isometry,
        b: &dyn Shape<N, D>,
        margin: N,
    ) -> bool {
        let (at1, at2) = (IsometryRef::Own(ma), IsometryRef::Own(mb));
        self.proximity = entries::proximity_at(at1, a, at2, b, margin);
        true
    }

    fn proximity(&self) -> Proximity {
        self.proximity
    }

    fn boxed_clone(&self) -> ProximityAlgorithm<N, D> {
        Box::new(*self)
    }
}

/// Chooses the library's own algorithm for every pair of solids.
///
/// ```
/// use impinge::dim2::events::Proximity;
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::narrow_phase::{
///     DefaultProximityDispatcher, ProximityDetector, ProximityDispatcher,
/// };
/// use impinge::dim2::shape::Ball;
///
/// let (ball, dispatcher) = (Ball::new(1.0_f32), DefaultProximityDispatcher::new());
/// let mut detector = dispatcher.get_proximity_algorithm(&ball, &ball).expect("every pair has one");
/// let there = Isometry::translation(2.25, 0.0);
/// detector.update(&dispatcher, &Isometry::identity(), &ball, &there, &ball, 0.5);
/// assert_eq!(detector.proximity(), Proximity::WithinMargin);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct DefaultProximityDispatcher<const D: usize>;

impl<const D: usize> DefaultProximityDispatcher<D> {
    /// Creates the dispatcher, which has no settings.
    #[must_use]
    pub const fn new() -> Self {
        Self
    }
}

impl<N: Space<D>, const D: usize> ProximityDispatcher<N, D> for DefaultProximityDispatcher<D> {
    fn get_proximity_algorithm(
        &self,
        _: &dyn Shape<N, D>,
        _: &dyn Shape<N, D>,
    ) -> Option<ProximityAlgorithm<N, D>> {
        Some(Box::new(PairProximityDetector::new()))
    }

    fn is_built_in(&self, _: &dyn Shape<N, D>, _: &dyn Shape<N, D>) -> bool {
        true
    }

    fn is_built_in_for_all(&self) -> bool {
        true
    }
}
