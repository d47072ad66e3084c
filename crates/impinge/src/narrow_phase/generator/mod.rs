//! The library's own contact algorithm for one pair, for use without a world.

mod contacts;
mod kept;
#[cfg(test)]
mod tests;

use crate::tables::entries;
use core::fmt;

pub(super) use self::contacts::PairContacts;
use self::contacts::{in_kept_order, placed, pose21};
pub(crate) use self::kept::Revolved;
use self::kept::{KeptShape, KeptTouch};
use super::IdAllocator;
use super::entry::ContactView;
use super::reuse::{Reference, ReuseError, usable_tolerance};
use super::state::KeptPoints;
use super::traits::{
    ContactAlgorithm, ContactDispatcher, ContactManifoldGenerator, ContactPrediction,
};
use crate::collide::far::{Apart, ReachBounds};
use crate::collide::{ManifoldRequest, Solid};
use crate::math::{Mapped, Pose, Real, Space};
use crate::query::ContactManifold;
use crate::shape::{Geometry, Shape};

/// Returns the default maximum number of points of a manifold: two in 2D and four in 3D, enough to
/// span the overlap of two faces.
pub(crate) const fn conforming_points<const D: usize>() -> usize {
    1 << (D - 1)
}

/// Computes the contacts of any two shapes, composites and shapes of users' types included.
///
/// One type serves all pairs: it selects the algorithm by the kinds of the shapes at each
/// update, so even the shapes may change from one update to the next.
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
    /// Identifier of the pair in contact ids; `None` until it is allocated.
    number: Option<u64>,
    /// Copies of the shapes at the last update. `None` for a shape whose changes cannot be
    /// detected.
    shapes: [Option<KeptShape<N, D>>; 2],
    /// The solids on which each contact of a composite lies, in the order of the contacts.
    touched: Vec<KeptTouch<N, D>>,
    /// Whether all data are kept that a reader needs to build the manifolds later.
    is_readable: bool,
    /// Whether the contacts belong to `numbers` and `request`.
    is_current: bool,
    /// The coordinates of both isometries at the last update, which show whether a shape has moved
    /// since.
    numbers: [[N; 7]; 2],
    request: ManifoldRequest<N>,
    /// Poses at the last update, for readers.
    poses: [Pose<N, D>; 2],
    contacts: PairContacts<N, D>,
    /// State of contact reuse, if it is enabled.
    reuse: Option<Box<PairReuse<N, D>>>,
    view: ContactView<Vec<ContactManifold<N, D>>>,
}

/// State of contact reuse for one pair.
#[derive(Clone)]
struct PairReuse<N: Real, const D: usize> {
    tolerance: N,
    /// Bounding radii of the two shapes around their origins, see [`ReachBounds::reach`]; infinite
    /// for a pair that is always computed.
    reaches: [N; 2],
    reference: Reference<N, D>,
}

impl<N: Real, const D: usize> PairManifoldGenerator<N, D> {
    /// Creates a generator without contacts, whose manifolds have at most `max_points` points (0
    /// means 1).
    #[must_use]
    pub fn new(max_points: usize) -> Self {
        Self {
            max_points: max_points.max(1),
            number: None,
            shapes: [None, None],
            touched: Vec::new(),
            is_readable: false,
            is_current: false,
            numbers: [[N::ZERO; 7]; 2],
            request: ManifoldRequest::new(N::ZERO, N::ZERO, 1),
            poses: [Pose::identity(); 2],
            contacts: PairContacts::new(false),
            reuse: None,
            view: ContactView::default(),
        }
    }

    /// Enables contact reuse with this tolerance; see [`Self::try_reusing`].
    ///
    /// # Panics
    /// If the tolerance is negative or not finite; [`Self::try_reusing`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn reusing(self, tolerance: N) -> Self {
        match self.try_reusing(tolerance) {
            Ok(generator) => generator,
            Err(error) => panic!("{error}"),
        }
    }

    /// Returns the generator with contact reuse, as
    /// [`DefaultNarrowPhase::try_reusing`](super::DefaultNarrowPhase::try_reusing) describes it.
    /// Contacts stay fixed to the solids, and only their depths are measured again, while the pair
    /// hardly moves. This means that no point of the smaller solid has moved, relative to the other
    /// solid and since the last computation, by `tolerance` or by the linear prediction.
    ///
    /// A pair of a ball with a ball, a box, a segment or a capsule is always computed, because that
    /// takes no more time. A pair with a convex shape of a user's type is always computed too,
    /// since the shape may have changed.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Vector};
    /// use impinge::dim3::narrow_phase::{
    ///     ContactManifoldGenerator, DefaultContactDispatcher, IdAllocator, PairManifoldGenerator,
    /// };
    /// use impinge::dim3::query::ContactPrediction;
    /// use impinge::dim3::shape::Cylinder;
    ///
    /// let can = Cylinder::new(1.0_f64, 0.5);
    /// let (dispatcher, mut ids) = (DefaultContactDispatcher::new(), IdAllocator::new());
    /// let near = ContactPrediction::new(0.125, 0.0, 0.0);
    /// let mut generator = PairManifoldGenerator::default().reusing(0.01);
    /// let mut depth = |y: f64| {
    ///     let (here, there) = (Isometry::identity(), Isometry::translation(0.0, y, 0.0));
    ///     generator.update(&dispatcher, &here, &can, &there, &can, &near, &mut ids);
    ///     let mut manifolds = Vec::new();
    ///     generator.contacts(&mut manifolds);
    ///     manifolds[0].deepest_contact().expect("they are near").contact.depth
    /// };
    /// assert_eq!(depth(1.9375), 0.0625);
    /// assert!((depth(1.9375 - 0.0078125) - 0.0703125).abs() < 1e-12, "measured, not computed");
    /// assert!(PairManifoldGenerator::<f32>::default().try_reusing(-1.0).is_err());
    /// ```
    ///
    /// # Errors
    /// If the tolerance is negative or not finite.
    pub fn try_reusing(self, tolerance: N) -> Result<Self, ReuseError> {
        let (tolerance, reaches) = (usable_tolerance(tolerance)?, [N::INFINITY; 2]);
        let reuse = PairReuse { tolerance, reaches, reference: Reference::default() };
        Ok(Self { reuse: Some(Box::new(reuse)), ..self })
    }
}

impl<N: Space<D>, const D: usize> PairManifoldGenerator<N, D> {
    /// Updates the contacts: keeps them if nothing changed, removes them if the solids are
    /// certainly farther apart than the prediction, moves them along if contact reuse allows it,
    /// else computes them.
    pub(crate) fn refresh(
        &mut self,
        isometries: [&N::Isometry; 2],
        given: [&dyn Shape<N, D>; 2],
        prediction: &ContactPrediction<N>,
        ids: &mut IdAllocator,
    ) {
        let request = prediction.request(self.max_points);
        let (numbers, shapes) = (isometries.mapped(N::numbers), given.mapped(Shape::geometry));
        let is_same_request = self.is_current && self.request == request;
        let is_still = is_same_request && self.numbers == numbers;
        let between = N::translation(isometries[1]) - N::translation(isometries[0]);
        let is_beyond =
            !is_still && (Apart { shapes, between }).is_certainly_beyond(request.prediction);
        if is_beyond && self.reuse.is_none() {
            self.is_current = false;
            return self.clear();
        }
        let are_kept = self.are_kept(&shapes);
        let is_as_before = are_kept && is_same_request;
        if is_still && are_kept {
            return;
        }
        self.view.expire();
        if !are_kept {
            self.replace_shapes(given, shapes);
        }
        if let Some(reuse) = self.reuse.as_mut().filter(|_| !is_as_before) {
            reuse.reference = Reference::default();
        }
        let number = *self.number.get_or_insert_with(|| ids.allocate());
        (self.numbers, self.request, self.is_current) = (numbers, request, true);
        self.poses = [shapes[0].pose_at(isometries[0]), shapes[1].pose_at(isometries[1])];
        if !(is_as_before && self.keeps_contacts()) {
            self.compute(shapes, is_beyond);
        }
        if !self.is_readable && self.contacts.len() > 0 {
            // If copies of the shapes cannot be kept for a later reader, the manifolds are built
            // now.
            let placed = placed(&self.poses, shapes);
            self.view.manifolds(|old| self.contacts.manifolds(&placed, number, old));
        }
    }

    /// Removes all contacts, and replaces a composite state by an empty convex state. Only for
    /// shapes that are certainly far apart, which are never composites.
    fn clear(&mut self) {
        match &mut self.contacts {
            PairContacts::Convex(state) => state.clear(),
            // The state belongs to the shapes of an earlier call.
            PairContacts::Composite(_) => {
                (self.number, self.shapes) = (None, [None, None]);
                self.contacts = PairContacts::new(false);
            }
        }
    }

    /// Computes the contacts, or removes all of them if `are_beyond`: the shapes are certainly
    /// farther apart than the prediction.
    fn compute(&mut self, shapes: [Geometry<'_, N, D>; 2], are_beyond: bool) {
        if are_beyond {
            self.clear();
        } else {
            let copies = self.shapes.each_ref().mapped(|shape| shape.as_ref()?.solid());
            self.contacts.update((&self.poses, shapes), copies, &self.request);
            self.is_readable = self.keep_touched(shapes);
        }
        if let Some(reuse) = &mut self.reuse {
            let is_swapped = self.contacts.is_swapped();
            let reaches = || in_kept_order(reuse.reaches, is_swapped);
            let pose21 = || pose21(&self.poses, is_swapped);
            reuse.reference.note(&mut self.contacts, pose21, reaches);
        }
    }

    /// Returns `true` if one solid is a ball and the other one a ball, a segment, a capsule or a
    /// box: computing contacts is then as fast as reusing them.
    fn has_closed_form(&self) -> bool {
        let solids = self.shapes.each_ref().mapped(|shape| shape.as_ref()?.solid());
        let is_ball = |solid: &Option<&Solid<N, D>>| matches!(solid, Some(Solid::Ball(_)));
        solids.iter().all(Option::is_some) && solids.iter().any(is_ball)
    }

    /// Moves the contacts along with the solids and returns `true`, if contact reuse is enabled and
    /// the solids have moved little enough. Otherwise returns `false`.
    fn keeps_contacts(&mut self) -> bool {
        let Some(reuse) = &mut self.reuse else { return false };
        let is_swapped = self.contacts.is_swapped();
        let limits = [reuse.tolerance, self.request.prediction];
        let pose21 = || pose21(&self.poses, is_swapped);
        reuse.reference.keeps(&mut self.contacts, pose21, limits)
    }

    /// Returns `true` if the shapes equal those of the last update.
    fn are_kept(&self, shapes: &[Geometry<'_, N, D>; 2]) -> bool {
        let is_kept = |(kept, shape): (&Option<KeptShape<N, D>>, &Geometry<'_, N, D>)| {
            kept.as_ref().is_some_and(|kept| kept.is(*shape))
        };
        self.shapes.iter().zip(shapes).all(is_kept)
    }

    /// Replaces the kept shapes, and resets the state where it depends on the old shapes.
    fn replace_shapes(&mut self, given: [&dyn Shape<N, D>; 2], shapes: [Geometry<'_, N, D>; 2]) {
        let has_composite = shapes.iter().any(|shape| shape.as_composite().is_some());
        match &mut self.contacts {
            PairContacts::Convex(state) if !has_composite => state.set_solids(given),
            PairContacts::Composite(state) if has_composite => {
                let mut both = self.shapes.iter().zip(&shapes);
                state.forget_shapes(both.any(|(kept, shape)| {
                    let is_kept = kept.as_ref().is_some_and(|kept| kept.is(*shape));
                    shape.as_composite().is_some() && !is_kept
                }));
            }
            _ => {
                // The new state starts its ids anew, so the pair needs a new identifier.
                self.number = None;
                self.contacts = PairContacts::new(has_composite);
            }
        }
        self.shapes = shapes.map(KeptShape::of);
        let has_closed_form = self.has_closed_form();
        if let Some(reuse) = &mut self.reuse {
            let reach =
                |shape| if has_closed_form { N::INFINITY } else { ReachBounds::of(shape).reach() };
            reuse.reaches = given.mapped(reach);
        }
    }

    /// Keeps copies of the parts on which the contacts of a composite lie. The contacts must have
    /// just been computed. Returns `false` if a shape or a part cannot be kept; the manifolds must
    /// then be built before the shapes are gone.
    fn keep_touched(&mut self, shapes: [Geometry<'_, N, D>; 2]) -> bool {
        let are_whole = self.wholes().mapped(|whole| whole.is_some());
        let PairContacts::Composite(state) = &self.contacts else { return are_whole == [true; 2] };
        let are_whole = in_kept_order(are_whole, state.is_swapped());
        self.touched.clear();
        let touched = &mut self.touched;
        let placed = placed(&self.poses, shapes);
        state.each_touched(&placed, |one| touched.extend(KeptTouch::of(one, are_whole)));
        touched.len() == state.len()
    }

    /// Returns the kept copies of the shapes; `None` for a composite or a shape without a copy.
    fn wholes(&self) -> [Option<Geometry<'_, N, D>>; 2] {
        self.shapes.each_ref().mapped(|shape| shape.as_ref()?.geometry())
    }

    /// Returns the manifolds as of the last update, from the copies of the shapes, in the memory of
    /// `old`.
    pub(crate) fn read(&self, old: Vec<ContactManifold<N, D>>) -> Vec<ContactManifold<N, D>> {
        let (wholes, number) = (self.wholes(), self.number.unwrap_or_default());
        match (&self.contacts, wholes) {
            (PairContacts::Composite(state), _) => {
                let wholes = in_kept_order(wholes, state.is_swapped());
                let mut touched = self.touched.iter();
                let next = || touched.next()?.touched(wholes);
                state.manifolds_on(&self.poses, number, next, old)
            }
            (contacts, [Some(shape1), Some(shape2)]) => {
                contacts.manifolds(&placed(&self.poses, [shape1, shape2]), number, old)
            }
            _ => old,
        }
    }

    /// Returns the manifolds with at least one contact; builds them on first access after an
    /// update.
    fn manifolds(&self) -> &[ContactManifold<N, D>] {
        if self.contacts.len() == 0 {
            return &[];
        }
        self.view.manifolds(|old| entries::read_generator(self, old))
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

/// Chooses the library's own algorithm for every pair of solids.
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
    /// Creates a dispatcher for manifolds of at most two points in 2D and four in 3D.
    #[must_use]
    pub const fn new() -> Self {
        Self { max_points: conforming_points::<D>() }
    }

    /// Creates a dispatcher for manifolds of at most `max_points` points (0 means 1).
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

    fn built_in_for_all(&self) -> Option<usize> {
        Some(self.max_points)
    }
}
