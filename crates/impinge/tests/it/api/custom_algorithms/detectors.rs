//! A custom proximity algorithm.

use super::dim::math::{DIM, Isometry, Real};
use super::dim::narrow_phase::{
    DefaultProximityDispatcher, ProximityAlgorithm, ProximityDetector, ProximityDispatcher,
};
use super::dim::query::Proximity;
use super::dim::shape::{Ball, Shape};
use super::generators::Policy;

/// The proximity of two balls; `update` returns `false` for all other solids.
#[derive(Clone, Debug)]
pub(super) struct OwnNearness(Proximity);

impl<N: Real> ProximityDetector<N, DIM> for OwnNearness {
    fn update(
        &mut self,
        _: &dyn ProximityDispatcher<N, DIM>,
        ma: &Isometry<N>,
        a: &dyn Shape<N, DIM>,
        mb: &Isometry<N>,
        b: &dyn Shape<N, DIM>,
        margin: N,
    ) -> bool {
        // An arbitrary wrong value, because the result of a detector whose `update` returned
        // `false` must not be used.
        self.0 = Proximity::Intersecting;
        let (Some(a), Some(b)) = (a.as_shape::<Ball<N>>(), b.as_shape::<Ball<N>>()) else {
            return false;
        };
        let gap = (ma.translation.vector - mb.translation.vector).norm() - a.radius() - b.radius();
        self.0 = match gap {
            _ if gap <= N::ZERO => Proximity::Intersecting,
            _ if gap <= margin => Proximity::WithinMargin,
            _ => Proximity::Disjoint,
        };
        true
    }

    fn proximity(&self) -> Proximity {
        self.0
    }

    fn boxed_clone(&self) -> ProximityAlgorithm<N> {
        Box::new(self.clone())
    }
}

impl<N: Real> ProximityDispatcher<N, DIM> for Policy {
    fn get_proximity_algorithm(
        &self,
        a: &dyn Shape<N, DIM>,
        b: &dyn Shape<N, DIM>,
    ) -> Option<ProximityAlgorithm<N>> {
        let balls = a.as_shape::<Ball<N>>().is_some() && b.as_shape::<Ball<N>>().is_some();
        match self {
            Self::Nothing => None,
            Self::Balls if !balls => {
                DefaultProximityDispatcher::new().get_proximity_algorithm(a, b)
            }
            _ => Some(Box::new(OwnNearness(Proximity::Disjoint))),
        }
    }
}
