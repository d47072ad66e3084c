//! Traits for the algorithm of a pair. They let a program use one pair without a world, and plug in
//! custom algorithms.

use super::IdAllocator;
use crate::collide::ManifoldRequest;
use crate::math::{Real, Space};
use crate::query::{ContactManifold, Proximity};
use crate::shape::Shape;

/// The distance up to which contacts are requested, and the angle by which each solid is expected
/// to rotate.
///
/// ```
/// use impinge::dim3::query::ContactPrediction;
///
/// let prediction = ContactPrediction::new(0.25_f32, 0.09, 0.0);
/// assert_eq!((prediction.linear(), prediction.angular1()), (0.25, 0.09));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ContactPrediction<N: Real> {
    linear: N,
    angular1: N,
    angular2: N,
}

impl<N: Real> ContactPrediction<N> {
    /// Requests contacts up to the distance `linear`, and contacts that would come within it if the
    /// first solid rotated by up to `angular1` radians and the second by up to `angular2`.
    #[must_use]
    pub const fn new(linear: N, angular1: N, angular2: N) -> Self {
        Self { linear, angular1, angular2 }
    }

    /// Returns the distance up to which there are contact points.
    #[must_use]
    pub const fn linear(&self) -> N {
        self.linear
    }

    /// Returns the angle in radians by which the first solid may rotate for a point to come within
    /// [`Self::linear`].
    #[must_use]
    pub const fn angular1(&self) -> N {
        self.angular1
    }

    /// Returns the angle in radians by which the second solid may rotate for a point to come within
    /// [`Self::linear`].
    #[must_use]
    pub const fn angular2(&self) -> N {
        self.angular2
    }

    /// Returns the request for manifolds of at most `max_points` points, with the sum of both
    /// angles.
    pub(crate) fn request(&self, max_points: usize) -> ManifoldRequest<N> {
        ManifoldRequest::new(self.linear, self.angular1 + self.angular2, max_points)
    }
}

/// An algorithm for the contacts of a pair of solids. It keeps the contacts from update to update.
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
pub trait ContactManifoldGenerator<N: Space<D>, const D: usize>: Send + Sync {
    /// Computes the contacts of `a` placed at `ma` with `b` placed at `mb`.
    ///
    /// `dispatcher` serves composites, whose parts need their own algorithms. New contacts take
    /// their ids from `ids`; contacts that only moved keep their ids. Returns `false` if this
    /// algorithm does not support the two solids; there are then no contacts.
    #[expect(clippy::too_many_arguments, reason = "the two posed solids and what is asked")]
    fn update(
        &mut self,
        dispatcher: &dyn ContactDispatcher<N, D>,
        ma: &N::Isometry,
        a: &dyn Shape<N, D>,
        mb: &N::Isometry,
        b: &dyn Shape<N, D>,
        prediction: &ContactPrediction<N>,
        ids: &mut IdAllocator,
    ) -> bool;

    /// Returns the number of contact points over all manifolds.
    fn num_contacts(&self) -> usize;

    /// Appends the manifolds with at least one contact to `out`.
    fn contacts<'a>(&'a self, out: &mut Vec<&'a ContactManifold<N, D>>);

    /// Returns a clone with the same future behaviour: `Box::new(self.clone())`. For cloned worlds.
    fn boxed_clone(&self) -> ContactAlgorithm<N, D>;
}

/// Chooses a contact algorithm for two solids.
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
pub trait ContactDispatcher<N: Space<D>, const D: usize>: Send + Sync {
    /// Returns a new algorithm for the contacts of `a` with `b`; `None` if no contacts are to be
    /// computed for the pair.
    fn get_contact_algorithm(
        &self,
        a: &dyn Shape<N, D>,
        b: &dyn Shape<N, D>,
    ) -> Option<ContactAlgorithm<N, D>>;

    /// Returns the maximum number of points of a manifold if the library's own algorithm serves the
    /// pair, without a boxed algorithm. `None` if [`Self::get_contact_algorithm`] chooses the
    /// algorithm.
    #[doc(hidden)]
    fn built_in(&self, _: &dyn Shape<N, D>, _: &dyn Shape<N, D>) -> Option<usize> {
        None
    }

    /// Returns the result of [`Self::built_in`] if it is the same for all pairs of shapes; else
    /// `None`.
    #[doc(hidden)]
    fn built_in_for_all(&self) -> Option<usize> {
        None
    }
}

/// An algorithm for the proximity of a pair of solids. It keeps the proximity until the next
/// update.
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
pub trait ProximityDetector<N: Space<D>, const D: usize>: Send + Sync {
    /// Computes the proximity of `a` placed at `ma` and `b` placed at `mb`. Solids that do not
    /// overlap are within the margin if their distance is at most `margin`.
    ///
    /// Returns `false` if this algorithm does not support the two solids, which are then treated as
    /// disjoint.
    fn update(
        &mut self,
        dispatcher: &dyn ProximityDispatcher<N, D>,
        ma: &N::Isometry,
        a: &dyn Shape<N, D>,
        mb: &N::Isometry,
        b: &dyn Shape<N, D>,
        margin: N,
    ) -> bool;

    /// Returns the proximity at the last update.
    fn proximity(&self) -> Proximity;

    /// Returns a clone with the same future behaviour: `Box::new(self.clone())`. For cloned worlds.
    fn boxed_clone(&self) -> ProximityAlgorithm<N, D>;
}

/// Chooses a proximity algorithm for two solids.
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
pub trait ProximityDispatcher<N: Space<D>, const D: usize>: Send + Sync {
    /// Returns a new algorithm for the proximity of `a` and `b`; `None` if no proximity is to be
    /// computed for the pair.
    fn get_proximity_algorithm(
        &self,
        a: &dyn Shape<N, D>,
        b: &dyn Shape<N, D>,
    ) -> Option<ProximityAlgorithm<N, D>>;

    /// Returns `true` if the library's own algorithm serves the pair, without a boxed algorithm.
    #[doc(hidden)]
    fn is_built_in(&self, _: &dyn Shape<N, D>, _: &dyn Shape<N, D>) -> bool {
        false
    }

    /// Returns `true` if [`Self::is_built_in`] returns `true` for all pairs of shapes.
    #[doc(hidden)]
    fn is_built_in_for_all(&self) -> bool {
        false
    }
}

/// A boxed contact algorithm.
pub type ContactAlgorithm<N, const D: usize> = Box<dyn ContactManifoldGenerator<N, D>>;
/// A boxed proximity algorithm.
pub type ProximityAlgorithm<N, const D: usize> = Box<dyn ProximityDetector<N, D>>;

impl<N: Space<D>, const D: usize> Clone for ContactAlgorithm<N, D> {
    fn clone(&self) -> Self {
        (**self).boxed_clone()
    }
}

impl<N: Space<D>, const D: usize> Clone for ProximityAlgorithm<N, D> {
    fn clone(&self) -> Self {
        (**self).boxed_clone()
    }
}
