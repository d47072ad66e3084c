//! The library's own contact algorithm as an object, for use alone.

mod kept;
#[cfg(test)]
mod tests;

use crate::tables::entries;
use core::fmt;

use self::kept::KeptShape;
pub(crate) use self::kept::Revolved;
use super::IdAllocator;
use super::entry::ContactView;
use super::state::{CompositeState, ContactState, KeptContacts};
use super::traits::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
};
use crate::collide::{AtIsometry, ManifoldRequest, Placed};
use crate::math::{IsometryRef, Mapped, Pose, Real, Space};
use crate::query::ContactManifold;
use crate::shape::{Geometry, Shape};

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
    max_points: usize,
    /// The number that names the pair, once it has one.
    number: Option<u64>,
    /// Of the last update at which the shapes were near; `None` for one that cannot be known again.
    shapes: [Option<KeptShape<N, D>>; 2],
    /// What the last update was about, if it need not be computed once more.
    asked: Option<Question<N>>,
    /// Of the last update; what readers place contacts by.
    poses: [Pose<N, D>; 2],
    contacts: PairContacts<N, D>,
    view: ContactView<Vec<ContactManifold<N, D>>>,
}

/// What is asked about two shapes.
#[derive(Clone, Copy, PartialEq)]
struct Question<N: Real> {
    /// Those of the two isometries.
    numbers: [[N; 7]; 2],
    request: ManifoldRequest<N>,
}

/// Contacts as they are kept.
#[derive(Clone)]
pub(super) enum PairContacts<N: Real, const D: usize> {
    Convex(ContactState<N, D>),
    /// Of a pair with a composite.
    Composite(Box<CompositeState<N, D>>),
}

impl<N: Real, const D: usize> PairContacts<N, D> {
    /// There is none yet.
    pub(super) fn new(has_composite: bool) -> Self {
        if has_composite {
            Self::Composite(Box::default())
        } else {
            Self::Convex(ContactState::default())
        }
    }

    fn clear(&mut self) {
        match self {
            Self::Convex(state) => state.clear(),
            Self::Composite(_) => *self = Self::new(false),
        }
    }
}

impl<N: Space<D>, const D: usize> PairContacts<N, D> {
    pub(super) fn len(&self) -> usize {
        match self {
            Self::Convex(state) => state.len(),
            Self::Composite(state) => state.len(),
        }
    }

    pub(super) fn update(&mut self, placed: &[Placed<'_, N, D>; 2], request: &ManifoldRequest<N>) {
        match self {
            Self::Convex(state) => state.update_alone(placed, request),
            Self::Composite(state) => state.update_between(placed, false, request),
        }
    }

    /// The manifolds that hold a contact, in the memory of old ones.
    pub(super) fn manifolds(
        &self,
        placed: &[Placed<'_, N, D>; 2],
        number: u64,
        mut old: Vec<ContactManifold<N, D>>,
    ) -> Vec<ContactManifold<N, D>> {
        match self {
            Self::Convex(state) => {
                let manifold = old.pop().unwrap_or_default();
                old.clear();
                old.push(entries::public_manifold(state, placed, number, manifold));
                old
            }
            Self::Composite(state) => entries::composite_manifolds(state, placed, number, old),
        }
    }
}

impl<N: Real, const D: usize> PairManifoldGenerator<N, D> {
    /// A generator that holds no contact; manifolds are reduced to at most `max_points` points,
    /// but never to fewer than one.
    #[must_use]
    pub fn new(max_points: usize) -> Self {
        Self {
            max_points: max_points.max(1),
            number: None,
            shapes: [None, None],
            asked: None,
            poses: [Pose::identity(); 2],
            contacts: PairContacts::Convex(ContactState::default()),
            view: ContactView::default(),
        }
    }
}

impl<N: Space<D>, const D: usize> PairManifoldGenerator<N, D> {
    /// Brings the contacts up to date.
    pub(crate) fn refresh(
        &mut self,
        isometries: [&N::Isometry; 2],
        shapes: [&dyn Shape<N, D>; 2],
        prediction: &ContactPrediction<N>,
        ids: &mut IdAllocator,
    ) {
        let request = prediction.request(self.max_points);
        let question = Question { numbers: isometries.mapped(N::numbers), request };
        let shapes = shapes.mapped(Shape::geometry);
        let are_kept = self.are_kept(&shapes);
        if are_kept && self.asked == Some(question) {
            return;
        }
        self.view.expire();
        let [at1, at2] = isometries.mapped(IsometryRef::Own);
        let [one, other] = [(at1, shapes[0]), (at2, shapes[1])].mapped(AtIsometry::of);
        let Some(placed) = Placed::within(&one, &other, request.prediction) else {
            return self.clear();
        };
        if !are_kept {
            self.meet(shapes);
        }
        let number = *self.number.get_or_insert_with(|| ids.allocate());
        self.contacts.update(&placed, &request);
        (self.poses, self.asked) = (placed.mapped(|solid| solid.pose), Some(question));
        if self.placed().is_none() && self.contacts.len() > 0 {
            // What cannot be kept until somebody reads is read at once.
            self.view.manifolds(|old| self.contacts.manifolds(&placed, number, old));
        }
    }

    /// The shapes are those of the last update, unchanged.
    fn are_kept(&self, shapes: &[Geometry<'_, N, D>; 2]) -> bool {
        let is_kept = |(kept, shape): (&Option<KeptShape<N, D>>, &Geometry<'_, N, D>)| {
            kept.as_ref().is_some_and(|kept| kept.is(*shape))
        };
        self.shapes.iter().zip(shapes).all(is_kept)
    }

    /// The shapes are these from now on.
    fn meet(&mut self, shapes: [Geometry<'_, N, D>; 2]) {
        let has_composite = shapes.iter().any(|shape| shape.as_composite().is_some());
        match &mut self.contacts {
            PairContacts::Convex(_) if !has_composite => {}
            PairContacts::Composite(state) if has_composite => state.forget_shapes(),
            _ => {
                // Contacts of the other sort have their own numbers: the pair gets a new name.
                self.number = None;
                self.contacts = PairContacts::new(has_composite);
            }
        }
        self.shapes = shapes.map(KeptShape::of);
    }

    /// There are no contacts.
    fn clear(&mut self) {
        self.asked = None;
        self.contacts.clear();
    }

    /// The solids as of the last update; `None` where one of them is not kept.
    fn placed(&self) -> Option<[Placed<'_, N, D>; 2]> {
        let [one, other] = self.shapes.each_ref().mapped(Option::as_ref);
        let [pose1, pose2] = self.poses;
        let (shape1, shape2) = (one?.geometry()?, other?.geometry()?);
        Some([Placed { pose: pose1, shape: shape1 }, Placed { pose: pose2, shape: shape2 }])
    }

    /// The manifolds that hold a contact, made when they are read first.
    fn manifolds(&self) -> &[ContactManifold<N, D>] {
        if self.contacts.len() == 0 {
            return &[];
        }
        self.view.manifolds(|old| match (self.placed(), self.number) {
            (Some(placed), Some(number)) => self.contacts.manifolds(&placed, number, old),
            _ => old,
        })
    }
}

impl<N: Space<D>, const D: usize> fmt::Debug for PairManifoldGenerator<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("PairManifoldGenerator")
            .field("max_points", &self.max_points)
            .field("manifolds", &self.manifolds())
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
        entries::update_generator(self, [ma, mb], [a, b], prediction, ids);
        true
    }

    fn num_contacts(&self) -> usize {
        self.contacts.len()
    }

    fn contacts<'a>(&'a self, out: &mut Vec<&'a ContactManifold<N, D>>) {
        out.extend(self.manifolds());
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
