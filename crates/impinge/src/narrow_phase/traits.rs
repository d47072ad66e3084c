//! Algorithms for one pair as objects: to use a pair alone, and to plug in algorithms of one's own.

use super::IdAllocator;
use crate::collide::ManifoldRequest;
use crate::math::{Real, Space};
use crate::query::{ContactManifold, Proximity};
use crate::shape::Shape;

/// How far ahead contacts are wanted.
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
    /// Contacts up to the distance `linear`, and those that turning the first solid by `angular1`
    /// radians and the second by `angular2` would bring about.
    #[must_use]
    pub const fn new(linear: N, angular1: N, angular2: N) -> Self {
        Self { linear, angular1, angular2 }
    }

    /// The distance up to which there are contact points.
    #[must_use]
    pub const fn linear(&self) -> N {
        self.linear
    }

    /// The angle in radians by which the first solid may turn.
    #[must_use]
    pub const fn angular1(&self) -> N {
        self.angular1
    }

    /// The angle in radians by which the second solid may turn.
    #[must_use]
    pub const fn angular2(&self) -> N {
        self.angular2
    }

    /// The question about a pair whose manifolds have at most `max_points` points.
    pub(crate) fn request(&self, max_points: usize) -> ManifoldRequest<N> {
        ManifoldRequest::new(self.linear, self.angular1 + self.angular2, max_points)
    }
}

/// Contacts of one pair of solids, kept from update to update.
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
    /// `dispatcher` is for composite solids, whose parts need algorithms of their own. Contacts
    /// that are new take their names from `ids`; those that only moved keep theirs. Answers whether
    /// this algorithm can treat the two solids; if not, it holds no contact.
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

    /// How many contact points there are, over all manifolds.
    fn num_contacts(&self) -> usize;

    /// Pushes the manifolds that hold a contact.
    fn contacts<'a>(&'a self, out: &mut Vec<&'a ContactManifold<N, D>>);

    /// A copy, which goes on as this one does: `Box::new(self.clone())`. For worlds that are cloned.
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
    /// A new algorithm for the contacts of `a` with `b`; `None` if there shall be none.
    fn get_contact_algorithm(
        &self,
        a: &dyn Shape<N, D>,
        b: &dyn Shape<N, D>,
    ) -> Option<ContactAlgorithm<N, D>>;

    /// The most points of a manifold, where the pair is left to the library's own algorithm without
    /// a box of its own; `None` if [`Self::get_contact_algorithm`] shall be asked.
    #[doc(hidden)]
    fn built_in(&self, _: &dyn Shape<N, D>, _: &dyn Shape<N, D>) -> Option<usize> {
        None
    }
}

/// The nearness of one pair of solids, kept from update to update.
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
    /// Computes the proximity of `a` placed at `ma` and `b` placed at `mb`: `margin` apart at most is within the margin.
    ///
    /// Answers whether this algorithm can treat the two solids; if not, they are disjoint.
    fn update(
        &mut self,
        dispatcher: &dyn ProximityDispatcher<N, D>,
        ma: &N::Isometry,
        a: &dyn Shape<N, D>,
        mb: &N::Isometry,
        b: &dyn Shape<N, D>,
        margin: N,
    ) -> bool;

    /// The proximity at the last update.
    fn proximity(&self) -> Proximity;

    /// A copy, which goes on as this one does: `Box::new(self.clone())`. For worlds that are cloned.
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
    /// A new algorithm for the proximity of `a` and `b`; `None` if there shall be none.
    fn get_proximity_algorithm(
        &self,
        a: &dyn Shape<N, D>,
        b: &dyn Shape<N, D>,
    ) -> Option<ProximityAlgorithm<N, D>>;

    /// The pair is left to the library's own algorithm without a box of its own.
    #[doc(hidden)]
    fn is_built_in(&self, _: &dyn Shape<N, D>, _: &dyn Shape<N, D>) -> bool {
        false
    }
}

/// A contact algorithm in a box.
pub type ContactAlgorithm<N, const D: usize> = Box<dyn ContactManifoldGenerator<N, D>>;
/// A proximity algorithm in a box.
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
