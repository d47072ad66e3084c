//! The time of impact of two moving shapes.
//!
//! [`linear`] is for solids that do not rotate: this file brings the pair into its canonical order
//! and maps the result back to the world, and the kernel in `linear` handles one pair of solids on
//! a straight path. [`nonlinear`] is for bodies that rotate. It is conservative advancement: each
//! step follows from the separation and from bounds of the speeds of points, which come from the
//! motions ([`motion`], [`velocities`]) and the extents of the shapes ([`bounds`]).
//!
//! An impact is never reported late: no step is longer than the time during which the solids
//! certainly stay apart. The number of steps is limited; the status reports a reached limit.

mod bounds;
mod linear;
mod motion;
mod nonlinear;
mod velocities;

use crate::tables::entries;
pub(crate) use linear::{Arrival, Beginning, Path, begin, size, soon};
use linear::{advance, is_hit_at_start};
pub use motion::RigidMotion;
pub use nonlinear::nonlinear_time_of_impact;
pub(crate) use nonlinear::{Flight, impact_of_flight};
pub use velocities::ConstantVelocities;

use super::composite::{PartArrival, first_arrival};
use crate::collide::far::Apart;
use crate::collide::pair::{Ordered, Pair, Placed, order};
use crate::collide::parts::Between;
use crate::math::{
    AbstractRotation, Isometry, IsometryRef, Point, Real, Space, Unit, Vector, max, max_component,
};
use crate::shape::{FeatureId, Shape};

/// A solid that moves along a straight line with constant velocity and does not rotate.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::{ImpactOptions, Moving, impact};
/// use impinge::dim2::shape::Ball;
///
/// let ball = Ball::new(1.0_f64);
/// let still = Moving::still(&Isometry::identity(), &ball);
/// let flies = Moving::new(&Isometry::translation(-6.0, 0.0), &Vector::new(2.0, 0.0), &ball);
/// assert_eq!(impact(&still, &flies, &ImpactOptions::new()).map(|hit| hit.toi), Some(2.0));
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Moving<'a, N: Real, const D: usize> {
    pub(crate) placed: Placed<'a, N, D>,
    pub(crate) velocity: Vector<N, D>,
}

impl<'a, N: Space<D>, const D: usize> Moving<'a, N, D> {
    /// Returns the shape that is at `position` at time zero and moves by `velocity`, in the world
    /// frame, per unit of time.
    #[must_use]
    pub fn new<R: AbstractRotation<N, D>>(
        position: &Isometry<N, R, D>,
        velocity: &Vector<N, D>,
        shape: &'a dyn Shape<N, D>,
    ) -> Self {
        entries::moving(R::view(position), velocity, shape)
    }

    /// Implements [`Self::new`] with the position by reference.
    #[inline]
    pub(crate) fn at(
        position: IsometryRef<'_, N, D>,
        velocity: &Vector<N, D>,
        shape: &'a dyn Shape<N, D>,
    ) -> Self {
        Self { placed: Placed::new(position, shape.geometry()), velocity: *velocity }
    }

    /// Returns the shape at rest at `position`.
    #[must_use]
    pub fn still<R: AbstractRotation<N, D>>(
        position: &Isometry<N, R, D>,
        shape: &'a dyn Shape<N, D>,
    ) -> Self {
        Self::new(position, &Vector::<N, D>::zeros(), shape)
    }
}

/// Options of an impact query.
///
/// ```
/// use impinge::query::ImpactOptions;
///
/// let options = ImpactOptions::new().with_max_time(0.5_f32).with_target_distance(0.125);
/// assert_eq!((options.max_time, options.target_distance), (0.5, 0.125));
/// assert_eq!(ImpactOptions::<f32>::default().max_time, f32::INFINITY);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ImpactOptions<N: Real> {
    /// The latest time of an impact that is reported, inclusive. If negative or NaN, no impact is
    /// reported. Infinite by default.
    pub max_time: N,
    /// The distance at which the solids are treated as touching. Zero by default; negative and NaN
    /// are treated as zero. With an infinite distance every pair touches at time zero.
    pub target_distance: N,
    /// The largest difference from the target distance, a length, at which rotating solids are
    /// treated as touching. The search ends there, which saves steps; the time found is then
    /// earlier, and never late. Negative and NaN are treated as zero. Values below the rounding
    /// error, 8 epsilon times the sum of the bodies' sizes and distance, are raised to it.
    ///
    /// With `None` (the default) the search continues up to rounding. After 256 consecutive steps
    /// with a gap below 2⁻²⁰ of the sizes plus the distance (`f32`: 2⁻¹⁷), as for sliding surfaces,
    /// it accepts that gap. [`impact()`] ignores this option.
    pub tolerance: Option<N>,
    /// Whether solids that touch or overlap at time zero are an impact at time zero, whatever their
    /// velocities. False by default: then the table of [`impact()`] decides.
    pub contact_at_start: bool,
}

impl<N: Real> ImpactOptions<N> {
    /// Returns options for impacts at any time, with a target distance of zero.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            max_time: N::INFINITY,
            target_distance: N::ZERO,
            tolerance: None,
            contact_at_start: false,
        }
    }

    /// Returns these options with [`Self::max_time`] replaced.
    #[must_use]
    pub const fn with_max_time(self, max_time: N) -> Self {
        Self { max_time, ..self }
    }

    /// Returns these options with [`Self::target_distance`] replaced.
    #[must_use]
    pub const fn with_target_distance(self, target_distance: N) -> Self {
        Self { target_distance, ..self }
    }

    /// Returns these options with [`Self::tolerance`] replaced.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: N) -> Self {
        Self { tolerance: Some(tolerance), ..self }
    }

    /// Returns these options with [`Self::contact_at_start`] replaced.
    #[must_use]
    pub const fn with_contact_at_start(self, contact_at_start: bool) -> Self {
        Self { contact_at_start, ..self }
    }
}

impl<N: Real> Default for ImpactOptions<N> {
    fn default() -> Self {
        Self::new()
    }
}

/// The kind of an impact, and its certainty.
///
/// "At the start" means at time zero, for the two parts of the impact. If a start in contact is not
/// an impact (see [`impact()`]), the status describes the later impact.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::{ImpactOptions, ImpactStatus, Moving, impact};
/// use impinge::dim2::shape::Ball;
///
/// let ball = Ball::new(1.0_f64);
/// let status = |x: f64| {
///     let (one, start) = (Moving::still(&Isometry::identity(), &ball), Isometry::translation(x, 0.0));
///     impact(&one, &Moving::new(&start, &Vector::x(), &ball), &ImpactOptions::new()).map(|hit| hit.status)
/// };
/// assert_eq!(status(-6.0), Some(ImpactStatus::Reached), "apart at first");
/// assert_eq!(status(-2.0), Some(ImpactStatus::TouchingAtStart));
/// assert_eq!(status(-1.5), Some(ImpactStatus::PenetratingAtStart));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum ImpactStatus {
    /// The time is after the start: the solids touch then, up to the tolerance.
    Reached,
    /// The time is zero: the solids touch, or are at the target distance, up to the tolerance.
    TouchingAtStart,
    /// The time is zero: the solids overlap, or are nearer than the target distance. If they
    /// overlap, the distance of the two points is the depth.
    PenetratingAtStart,
    /// The search ended without a decision, usually at the maximum number of steps: the solids
    /// certainly do not touch before the returned time; whether they touch later is unknown.
    StepsSpent,
}

impl ImpactStatus {
    /// Returns whether the impact is a contact or an overlap at time zero.
    #[must_use]
    pub const fn is_at_start(self) -> bool {
        matches!(self, Self::TouchingAtStart | Self::PenetratingAtStart)
    }

    /// Returns the status of an impact at time zero; a gap within the tolerance is treated as zero.
    fn at_start<N: Real>(gap: N, tolerance: N) -> Self {
        if gap < -tolerance { Self::PenetratingAtStart } else { Self::TouchingAtStart }
    }
}

/// The first touch of two moving solids: its time and geometry.
///
/// The points and the normal are in the world frame, for the solids at the time of impact.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::{ImpactOptions, Moving, impact};
/// use impinge::dim2::shape::Ball;
///
/// let (ball, start) = (Ball::new(1.0_f64), Isometry::translation(-6.0, 0.0));
/// let (one, two) = (Moving::new(&start, &Vector::x(), &ball), Moving::still(&Isometry::identity(), &ball));
/// let hit = impact(&one, &two, &ImpactOptions::new()).expect("head on");
/// assert_eq!((hit.toi, hit.world1.x, hit.world2.x), (4.0, -1.0, -1.0), "when, and where by then");
/// assert_eq!(*hit.normal, Vector::x(), "from the first to the second");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impact<N: Real, const D: usize> {
    /// The time of impact: zero or more, at most [`ImpactOptions::max_time`].
    pub toi: N,
    /// The point on the surface of the first solid.
    pub world1: Point<N, D>,
    /// The point on the surface of the second solid: at the target distance from `world1`, up to
    /// the tolerance, unless the solids are nearer at the start or the steps are spent.
    pub world2: Point<N, D>,
    /// The unit vector from the first solid to the second.
    pub normal: Unit<Vector<N, D>>,
    /// The index of the touching part of the first shape; zero for a shape of one part.
    pub part1: u32,
    /// The index of the touching part of the second shape; zero for a shape of one part.
    pub part2: u32,
    /// The touching feature of part `part1` of the first shape. Ids are as in a
    /// [`Witness`](super::Witness): for a rounded solid, they name features of its core.
    pub feature1: FeatureId,
    /// The touching feature of part `part2` of the second shape.
    pub feature2: FeatureId,
    /// Whether the touch is certain, and whether it was at the start.
    pub status: ImpactStatus,
}

impl<N: Real, const D: usize> Impact<N, D> {
    /// Returns the impact with the solids swapped.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self {
            world1: self.world2,
            world2: self.world1,
            normal: -self.normal,
            part1: self.part2,
            part2: self.part1,
            feature1: self.feature2,
            feature2: self.feature1,
            ..*self
        }
    }
}

/// Returns the first impact of two solids that move with constant velocities and do not rotate.
///
/// Returns `None` if the solids never come within the target distance up to the latest time, and if
/// a pose, a velocity or their difference is not finite. Swapping the solids gives a bitwise equal
/// result. The velocities define the unit of time.
///
/// At the returned time the solids are at the target distance, up to the rounding error of their
/// sizes and of their initial distance. Before that time they were not nearer by more than that
/// error. So the time is never late; solids that pass within that error may be reported to touch.
///
/// The impact of composites is the first impact of two of their parts; of several at the same time,
/// the one with the lowest part indices. A surface is hit from both sides.
///
/// # Starts in contact
///
/// A contact at time zero is an impact or not, depending on the velocities along its normal:
///
/// | at time zero the solids | approaching | sliding or at rest | separating |
/// |---|---|---|---|
/// | overlap, or are nearer than the target distance | impact at zero | impact at zero | `None` |
/// | just touch, or are at the target distance, up to rounding | impact at zero | `None` | `None` |
///
/// For composites the contacts of the whole shapes decide, as in [`contact`](super::contact()) and
/// in worlds: one along each normal of a surface, none with the inner edges of a floor, and for
/// shapes without a surface one for each pair of parts. The impact at zero is the deepest contact
/// that is an impact. If none is, parts in contact at the start are not hit later. Another part is
/// hit later unless the whole shapes then have contacts and none of these is an impact. So a box
/// that has sunk into a floor of many parts can be moved out of it. Parts that overlap without a
/// contact of the whole shapes, as behind a one-sided surface, decide by their own normal.
///
/// With [`ImpactOptions::contact_at_start`] every entry of the table is an impact at zero, as in
/// ncollide and, by default, parry. [`Impact::status`] distinguishes the rows of the table.
///
/// Convex solids that do not approach each other never will. A box that slides along the floor does
/// not hit it; a box that has sunk into the floor does, until it is moved out. Closing speeds below
/// 8 epsilon times the relative speed are treated as zero. At corner on corner, the solids approach
/// if all normals between the faces say so. Solids at the target distance that only pass each other
/// within rounding, also that of positions far from the origin, do not hit. Half-spaces that
/// overlap without bound hit at zero; the points are their origins.
///
/// # Cost
///
/// A query of two convex solids takes a few distance computations, about 130 at most. Each step is
/// as long as the solids are known to stay apart (conservative advancement: Mirtich, "Impulse-based
/// dynamic simulation", 1996). This is Newton's method on a convex function, which squares the
/// error at a head-on impact and halves it at a grazing one. A composite is searched for parts on
/// the path; of two composites, the parts of the one with fewer parts each search the other.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point, Vector};
/// use impinge::dim2::query::{ImpactOptions, Moving, impact};
/// use impinge::dim2::shape::{Ball, Cuboid};
///
/// let (floor, ball) = (Cuboid::new(Vector::new(10.0_f64, 1.0)), Ball::new(0.5));
/// let floor = Moving::still(&Isometry::identity(), &floor);
/// let fall = Moving::new(&Isometry::translation(3.0, 4.5), &Vector::new(1.0, -2.0), &ball);
/// let found = impact(&floor, &fall, &ImpactOptions::new()).expect("it falls on the floor");
/// assert_eq!((found.toi, found.normal.y), (1.5, 1.0));
/// assert_eq!(found.world1, Point::new(4.5, 1.0), "where the ball has moved to by then");
///
/// let early = ImpactOptions::new().with_target_distance(1.0);
/// assert_eq!(impact(&floor, &fall, &early).expect("a unit higher").toi, 1.0);
/// assert_eq!(impact(&floor, &fall, &ImpactOptions::new().with_max_time(1.0)), None);
/// ```
#[must_use]
pub fn impact<N: Space<D>, const D: usize>(
    moving1: &Moving<'_, N, D>,
    moving2: &Moving<'_, N, D>,
    options: &ImpactOptions<N>,
) -> Option<Impact<N, D>> {
    entries::impact(moving1, moving2, options)
}

/// Returns the first time, zero or more, at which two solids with constant velocities and without
/// rotation touch; `None` if [`impact`] returns `None`.
///
/// The time of [`impact`] with default options; see there for starts in contact, accuracy and cost.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::query::time_of_impact;
/// use impinge::dim3::shape::Ball;
///
/// let (ball, rest) = (Ball::new(1.0_f32), Vector::zeros());
/// let (here, there) = (Isometry::identity(), Isometry::translation(5.0, 0.0, 0.0));
/// let toi = |velocity| time_of_impact(&here, &velocity, &ball, &there, &rest, &ball);
/// assert_eq!(toi(Vector::x()), Some(3.0));
/// assert_eq!(toi(-Vector::x()), None, "the other way");
/// ```
#[must_use]
pub fn time_of_impact<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    v1: &Vector<N, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    v2: &Vector<N, D>,
    g2: &dyn Shape<N, D>,
) -> Option<N> {
    let (moving1, moving2) = (Moving::new(m1, v1, g1), Moving::new(m2, v2, g2));
    entries::time_of_impact(&moving1, &moving2, &ImpactOptions::new())
}

/// Computes [`impact`] in canonical order, so that swapped solids give the swapped result.
pub(crate) fn impact_of_pair<N: Space<D>, const D: usize>(
    moving1: &Moving<'_, N, D>,
    moving2: &Moving<'_, N, D>,
    options: &ImpactOptions<N>,
) -> Option<Impact<N, D>> {
    let course = Course::new(moving1, moving2, options)?;
    let (touch, toi) = course.touch()?;
    let found = course.impact(&touch, toi);
    Some(if course.ordered.swapped { found.flipped() } else { found })
}

/// Returns the time of [`impact_of_pair`], without the parts and features; `None` without impact.
pub(crate) fn time_of_pair<N: Space<D>, const D: usize>(
    moving1: &Moving<'_, N, D>,
    moving2: &Moving<'_, N, D>,
    options: &ImpactOptions<N>,
) -> Option<N> {
    Course::new(moving1, moving2, options)?.touch().map(|(_, toi)| toi)
}

/// Two solids in canonical order, with the motion of the second in the frame of the first.
///
/// The relative velocity is divided by a power of two, which brings its largest component between 1
/// and 2. So the squared speed stays in range, and scaling the time by powers of two is exact.
struct Course<'m, 'a, N: Real, const D: usize> {
    first: &'m Moving<'a, N, D>,
    ordered: Ordered<'m, 'a, N, D>,
    pair: Pair<'a, N, D>,
    path: Path<N, D>,
    /// The power of two by which the relative velocity was divided.
    scale: N,
}

impl<'m, 'a, N: Space<D>, const D: usize> Course<'m, 'a, N, D> {
    /// Brings two solids into canonical order. `None` if the latest time is negative or NaN, if
    /// bounding balls prove that the solids stay apart, or if a pose or velocity is not finite.
    #[inline(always)]
    fn new(
        moving1: &'m Moving<'a, N, D>,
        moving2: &'m Moving<'a, N, D>,
        options: &ImpactOptions<N>,
    ) -> Option<Self> {
        // Tested before the product of time and speed, which may be zero.
        let has_time = options.max_time >= N::ZERO;
        if !has_time || are_parted(moving1, moving2, options) {
            return None;
        }
        let order = order(&moving1.placed, &moving2.placed);
        let mirrored = order.is_eq();
        let swapped = if mirrored { is_later(moving1, moving2) } else { order.is_gt() };
        let (first, second) = if swapped { (moving2, moving1) } else { (moving1, moving2) };
        let ordered = Ordered { first: &first.placed, second: &second.placed, swapped };
        let (pair, velocity) = (ordered.pair(), second.velocity - first.velocity);
        if !(pair.pose12.is_finite() && velocity.iter().all(|x| x.is_finite_number())) {
            return None;
        }
        let scale = max_component(&velocity).power_of_two_below();
        let magnitude = |of: &Moving<'_, N, D>| max_component(&of.placed.pose.translation);
        let path = Path {
            velocity: first.placed.pose.inverse_vector(&(velocity / scale)),
            end: options.max_time * scale,
            target: max(options.target_distance, N::ZERO),
            rounding: N::EPSILON * (magnitude(first) + magnitude(second)),
            contact_at_start: options.contact_at_start,
            mirrored,
        };
        Some(Self { first, ordered, pair, path, scale })
    }

    /// Returns the earliest impact and its [`Impact::toi`]. `None` if there is no impact, or if its
    /// time overflows.
    #[inline(always)]
    fn touch(&self) -> Option<(PartArrival<N, D>, N)> {
        let found = if self.ordered.has_composite() {
            first_arrival(&Between::of_ordered(&self.ordered), &self.path)?
        } else {
            PartArrival {
                arrival: advance(&self.pair, &self.path)?,
                parts: [0, 0],
                is_of_whole: false,
            }
        };
        let toi = found.arrival.along / self.scale;
        toi.is_finite_number().then_some((found, toi))
    }

    /// Converts an impact to the world frame. The solids stay in canonical order.
    #[inline(always)]
    fn impact(&self, touch: &PartArrival<N, D>, toi: N) -> Impact<N, D> {
        let (found, features) = if self.ordered.has_composite() {
            touch.separation_with_features(&Between::of_ordered(&self.ordered), &self.path)
        } else {
            (touch.arrival.separation, touch.arrival.features(&self.pair, &self.path))
        };
        let (pose, moved) = (&self.first.placed.pose, self.first.velocity * toi);
        Impact {
            toi,
            world1: pose.point(&found.point1) + moved,
            world2: pose.point(&found.point2) + moved,
            normal: Unit::new_unchecked(pose.vector(&found.normal)),
            part1: touch.parts[0],
            part2: touch.parts[1],
            feature1: features[0],
            feature2: features[1],
            status: touch.arrival.status,
        }
    }
}

/// Returns whether bounding balls prove that the solids stay beyond the target distance.
fn are_parted<N: Real, const D: usize>(
    moving1: &Moving<'_, N, D>,
    moving2: &Moving<'_, N, D>,
    options: &ImpactOptions<N>,
) -> bool {
    let (placed1, placed2) = (&moving1.placed, &moving2.placed);
    let between = placed2.pose.translation - placed1.pose.translation;
    let apart = Apart { shapes: [placed1.shape, placed2.shape], between };
    if !apart.has_balls() {
        return false;
    }
    let velocity = moving2.velocity - moving1.velocity;
    apart.stays_beyond(options.target_distance, &velocity, options.max_time)
}

/// Returns whether the first of two equal solids at equal poses comes second in canonical order:
/// its velocity is lexicographically larger.
fn is_later<N: Real, const D: usize>(
    moving1: &Moving<'_, N, D>,
    moving2: &Moving<'_, N, D>,
) -> bool {
    let components = moving1.velocity.iter().zip(moving2.velocity.iter());
    let different = components.filter(|(x1, x2)| x1 != x2);
    different.map(|(x1, x2)| x1 > x2).next().unwrap_or(false)
}
