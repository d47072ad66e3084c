//! The time of impact of two bodies that move and rotate.

mod part_steps;

use self::part_steps::PartSteps;
use super::bounds::{Moment, MovingBody, length};
use super::linear::soon;
use super::{Impact, ImpactOptions, ImpactStatus, RigidMotion, is_hit_at_start};
use crate::tables::ByDimension;
use crate::tables::entries;
use core::cmp::Ordering;
use core::iter;

use crate::collide::Pair;
use crate::collide::pair::{Placed, order};
use crate::collide::parts::{
    Between, PairVisitor, PartSeparation, Wanted, nearest_between, visit_near_pairs,
};
use crate::math::{Mapped, Pose, Space, Unit, Vector, max, max_component, min};
use crate::shape::Shape;

/// The maximum number of steps of conservative advancement.
const MAX_STEPS: usize = 1024;

/// The maximum number of consecutive steps with a gap below [`NEAR`], if no tolerance is given.
const MAX_NEAR_STEPS: usize = 256;

/// A gap is near if it is at most the larger of two limits: 2^-20 and 64 epsilon, each times the
/// sum of the bodies' sizes and distance.
const NEAR: [f64; 2] = [1.0 / 1_048_576.0, 64.0];

/// A start is deep if the bodies overlap by more than this fraction of the sum of their sizes.
const DEEP: f64 = 1.0 / 64.0;

/// Parts of composites are advanced one by one if the gap is less than this fraction of the sum of
/// the bodies' sizes.
const PARTS_WITHIN: f64 = 1.0 / 128.0;

/// Parts are advanced separately while no point moves by more than this fraction of the sum of the
/// bodies' sizes.
const PARTS_WAY: f64 = 1.0 / 32.0;

/// Returns the first impact of two bodies that move and rotate.
///
/// Returns `None` if the bodies never come within the target distance up to the latest time, if a
/// pose at time zero is not finite, and for a composite without parts. Swapping the bodies gives a
/// bitwise equal result.
///
/// *Never late.* The time is not later than the first touch, up to the rounding error of the
/// bodies' positions and sizes: fast rotation and thin bodies are not missed. *Early by at most the
/// tolerance.* With [`ImpactStatus::Reached`] the bodies are, at the returned time, within
/// [`ImpactOptions::tolerance`] of the target distance, or they reach it within the resolution of
/// the time. With [`ImpactStatus::StepsSpent`] the search ended without a decision, usually after
/// 1024 steps: the bodies do not touch before the returned time, and whether they touch later is
/// unknown. This happens for bodies that stay in contact while they rotate, for motions that repeat
/// for ever without an impact and without a latest time, for bounds far above the true speeds, and
/// if a later pose is not finite. Query again from that time, or with a smaller latest time.
///
/// # Starts in contact
///
/// The table of [`impact`](super::impact) applies, with the velocities of the nearest points. But a
/// rotating body may come back, so a start that is not an impact is not final. The bodies hit if
/// they touch again after a gap of more than 1024 epsilon times the sum of their sizes and
/// distance, or if they get deeper than at the start by half of that. For composites the deepest
/// pair of parts decides. A gap of less than 1/64 of the sum of the sizes, or after a start that is
/// less deep than that, may open and close within one step; then the impact is found when the
/// bodies are as deep as at the start.
///
/// # Cost
///
/// Each step costs one distance computation. Convex solids typically take 15 steps for motions with
/// constant velocities and 40 for others, several times as many if the bodies graze each other or
/// rotate fast. No step is longer than the time in which some point of the bodies might use up the
/// gap (conservative advancement: Mirtich, "Impulse-based dynamic simulation", 1996). This time is
/// bounded by means of the speed along the normal (Zhang, Lee and Kim, "Interactive continuous
/// collision detection for non-convex polyhedra", 2006) of the fastest point of the shape and the
/// largest bend of its path, or by means of spheres around the bodies while these are apart. A
/// rotating half-space is fastest far out: its speed is taken where the other body can be.
/// Composites are bounded as a whole, by their largest speed, until they are within 1/128 of their
/// sizes. Then, for constant velocities, each pair of parts whose paths can cross is advanced
/// separately, with its own normal and speed, until the first pair touches. So all parts are
/// searched twice while the fastest point moves by 1/32 of the sizes, however many steps sliding
/// parts take.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::{ConstantVelocities, ImpactOptions, nonlinear_time_of_impact};
/// use impinge::dim2::shape::{Ball, Cuboid};
/// use std::f64::consts::FRAC_PI_2;
///
/// // A bar rotates by a quarter turn per second; a ball's centre lies a quarter turn ahead of it.
/// let (bar, ball) = (Cuboid::new(Vector::new(2.0, 0.0)), Ball::new(0.5));
/// let turns = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::zeros(), FRAC_PI_2);
/// let stays = ConstantVelocities::<f64>::still(Isometry::translation(0.0, 1.0));
/// let options = ImpactOptions::new().with_max_time(1.0);
/// let found = nonlinear_time_of_impact(&turns, &bar, &stays, &ball, &options);
/// // Seen from the origin, the ball extends 30° to each side of its centre: it is hit after 60°.
/// assert!((found.expect("it is in the way").toi - 2.0 / 3.0).abs() < 1e-12);
/// ```
#[must_use]
pub fn nonlinear_time_of_impact<N: Space<D>, const D: usize>(
    motion1: &dyn RigidMotion<N, D>,
    shape1: &dyn Shape<N, D>,
    motion2: &dyn RigidMotion<N, D>,
    shape2: &dyn Shape<N, D>,
    options: &ImpactOptions<N>,
) -> Option<Impact<N, D>> {
    let flight = Flight { motions: [motion1, motion2], shapes: [shape1, shape2] };
    entries::nonlinear_impact(&flight, options)
}

/// Two moving bodies, in the order of the arguments.
pub(crate) struct Flight<'a, N: Space<D>, const D: usize> {
    motions: [&'a dyn RigidMotion<N, D>; 2],
    shapes: [&'a dyn Shape<N, D>; 2],
}

/// Runs [`nonlinear_time_of_impact`] for the bodies in canonical order, and swaps the result back.
pub(crate) fn impact_of_flight<N: Space<D>, const D: usize>(
    flight: &Flight<'_, N, D>,
    options: &ImpactOptions<N>,
) -> Option<Impact<N, D>> {
    let [one, two] =
        [0, 1].mapped(|index| MovingBody::new(flight.motions[index], flight.shapes[index]));
    let world = Vector::<N, D>::zeros();
    let [start1, start2] = [&one, &two].mapped(|body| body.placed(&world, N::ZERO));
    let order = order(&start1, &start2);
    let mirrored = order.is_eq();
    let swapped = if mirrored { two_leads(&one, &two, options) } else { order.is_gt() };
    let (bodies, origin) = if swapped {
        ([two, one], start2.pose.translation)
    } else {
        ([one, two], start1.pose.translation)
    };
    let search = ImpactSearch {
        bodies,
        origin,
        end: options.max_time,
        target: max(options.target_distance, N::ZERO),
        tolerance: options.tolerance.map(|tolerance| max(tolerance, N::ZERO)),
        contact_at_start: options.contact_at_start,
        mirrored,
    };
    let found = search.run()?;
    Some(if swapped { found.flipped() } else { found })
}

/// Returns whether the second of two bodies that are equal at time zero comes first in canonical
/// order. They are compared by their poses at the latest time, if it is finite, and then at the
/// times 1, 2¹⁶, 2³², … until two poses differ.
fn two_leads<N: Space<D>, const D: usize>(
    one: &MovingBody<'_, N, D>,
    two: &MovingBody<'_, N, D>,
    options: &ImpactOptions<N>,
) -> bool {
    let world = Vector::<N, D>::zeros();
    let later = |time| [one, two].mapped(|body| body.placed(&world, time));
    // At most 64 of these times are finite.
    let times = iter::successors(Some(N::ONE), |time| Some(*time * N::lit(65536.0)));
    let times = times.take_while(|time| time.is_finite_number());
    let longest = Some(options.max_time).filter(|time| time.is_finite_number());
    let later_poses = longest.into_iter().chain(times).map(later);
    let mut orders = later_poses.map(|[later1, later2]| order(&later1, &later2));
    orders.find(|order| order.is_ne()).is_some_and(Ordering::is_gt)
}

impl<'a, N: Space<D>, const D: usize> MovingBody<'a, N, D> {
    /// Returns the body at a time, with positions relative to the world point `origin`.
    fn placed(&self, origin: &Vector<N, D>, time: N) -> Placed<'a, N, D> {
        Placed::of_pose(&self.motion.pose_about(origin, time), self.shape)
    }
}

/// The search for an impact of two bodies in canonical order.
struct ImpactSearch<'a, N: Space<D>, const D: usize> {
    bodies: [MovingBody<'a, N, D>; 2],
    /// The world point to which all positions are relative. It is near the bodies, to limit
    /// rounding errors.
    origin: Vector<N, D>,
    end: N,
    target: N,
    /// The largest difference from the target distance, zero or more; `None` for the default of
    /// [`ImpactOptions::tolerance`].
    tolerance: Option<N>,
    /// Whether a contact at time zero is an impact for all velocities.
    contact_at_start: bool,
    /// Whether the bodies are equal at time zero.
    mirrored: bool,
}

/// The poses of the bodies at a time, before their separation is known.
struct BodyPoses<'b, 'a, N: Space<D>, const D: usize> {
    /// The poses, centres and time; the normal is zero until it is known.
    moment: Moment<'b, 'a, N, D>,
    /// The pose of the body that is first in canonical order; without its rotation for a ball.
    pose1: Pose<N, D>,
    between: Between<'a, N, D>,
}

/// The poses of the bodies at a time, with their nearest parts and points.
struct Configuration<'b, 'a, N: Space<D>, const D: usize> {
    poses: BodyPoses<'b, 'a, N, D>,
    found: PartSeparation<N, D>,
    /// The nearest points, relative to the origin of the search.
    points: [Vector<N, D>; 2],
    /// The distance minus the target distance.
    gap: N,
    /// The sizes of the bodies plus their distance, for tolerances.
    size: N,
    /// A gap up to this length is treated as zero.
    tolerance: N,
}

/// The rule by which the gap decides whether the bodies have an impact.
#[derive(Clone, Copy, Debug)]
enum Mode<N> {
    /// The bodies have been apart: they touch when the gap is used up.
    Apart,
    /// The bodies have been in contact since the start; the value is the gap at the start. An
    /// impact is reported if the contact gets deeper.
    Contact(N),
}

impl<'a, N: Space<D>, const D: usize> ImpactSearch<'a, N, D> {
    /// Advances to the first impact. `None` if there is none up to `end`, if a pose at time zero is
    /// not finite, or if a composite has no parts.
    fn run(&self) -> Option<Impact<N, D>> {
        let mut configuration = self.look(N::ZERO, None)?;
        let starts = self.end >= N::ZERO;
        if !starts {
            return None;
        }
        let mut mode = Mode::Apart;
        if configuration.gap <= configuration.tolerance {
            let counts = self.counts_at_start(&configuration, configuration.gap);
            if counts && self.counts_soon(&configuration) {
                let status =
                    ImpactStatus::at_start(configuration.gap, self.start_slack(&configuration));
                return Some(self.impact(&configuration, status));
            }
            mode = Mode::Contact(configuration.gap);
        }
        let mut near_steps = 0;
        for _ in 0..MAX_STEPS {
            mode = configuration.mode_after(mode);
            let is_near = self.tolerance.is_none() && configuration.is_near(mode);
            near_steps = if is_near { near_steps + 1 } else { 0 };
            if configuration.is_hit(mode) || near_steps > MAX_NEAR_STEPS {
                return Some(self.impact(&configuration, ImpactStatus::Reached));
            }
            let time = configuration.poses.moment.time;
            let step = self.step(&configuration, mode);
            if time >= self.end || step.time > self.end - time || !step.time.is_finite_number() {
                return None;
            }
            let later = time + step.time;
            if later <= time {
                // A step of zero comes from an unbounded speed. Any other step that does not
                // advance the time is below the resolution of the time.
                let is_small = step.time > N::ZERO;
                let status =
                    if is_small { ImpactStatus::Reached } else { ImpactStatus::StepsSpent };
                return Some(self.impact(&configuration, status));
            }
            near_steps += step.near_steps;
            match self.look(if later < self.end { later } else { self.end }, Some(&configuration)) {
                Some(next) => configuration = next,
                None => break,
            }
        }
        Some(self.impact(&configuration, ImpactStatus::StepsSpent))
    }

    /// Returns a step during which the bodies certainly do not hit each other.
    fn step(&self, configuration: &Configuration<'_, 'a, N, D>, mode: Mode<N>) -> Step<N> {
        let moment = &configuration.poses.moment;
        let between = length(&(moment.centers[1] - moment.centers[0]));
        let [radius1, radius2] = self.bodies.each_ref().mapped(MovingBody::radius);
        let (excess, apart) =
            (configuration.excess(mode), between - radius1 - radius2 - self.target);
        let size = self.bodies[0].size() + self.bodies[1].size();
        let opening = configuration.opening(mode, N::lit(DEEP) * size);
        let whole = moment.safe_time([excess, apart], opening, self.end - moment.time);
        let whole = Step { time: whole, near_steps: 0 };
        // The depth of a piece inside a body is not a distance of two parts.
        let may_be_inside =
            matches!(mode, Mode::Contact(_)) && configuration.poses.between.has_bodies();
        let is_far = excess >= N::lit(PARTS_WITHIN) * size;
        if is_far || may_be_inside || !moment.has_parts_on_known_paths() {
            return whole;
        }
        let rate = moment.first_order(self.end);
        let longest = min(rate.time_for(N::lit(PARTS_WAY) * size), self.end - moment.time);
        let mut parts = PartSteps {
            search: self,
            configuration,
            mode,
            spent: configuration.found.separation.distance - excess,
            rate,
            step: Step { time: longest, near_steps: 0 },
        };
        // The nearest parts probably limit the step. With a short step, fewer other parts are
        // visited.
        parts.visit(configuration.found.parts);
        visit_near_pairs(&configuration.poses.between, &mut parts);
        if parts.step.time > whole.time { parts.step } else { whole }
    }

    /// Returns the poses of the bodies at a time; `None` if a pose is not finite.
    fn poses_at(&self, time: N) -> Option<BodyPoses<'_, 'a, N, D>> {
        let poses =
            self.bodies.each_ref().mapped(|body| body.motion.pose_about(&self.origin, time));
        let [one, two] =
            [0, 1].mapped(|index| Placed::of_pose(&poses[index], self.bodies[index].shape));
        let pair = Pair::new([one.shape, two.shape], [&one.pose, &two.pose]);
        let finite = one.pose.is_finite() && two.pose.is_finite() && pair.pose12.is_finite();
        finite.then(|| BodyPoses {
            moment: Moment {
                normal: Vector::<N, D>::zeros(),
                bodies: self.bodies.each_ref(),
                origin: self.origin,
                centers: [0, 1].mapped(|index| self.bodies[index].center_at(&poses[index])),
                poses,
                time,
            },
            pose1: one.pose,
            between: Between { pair, pose21: Pose::relative(&two.pose, &one.pose) },
        })
    }

    /// Returns the configuration of the bodies at a time; `None` if a pose is not finite, and for
    /// composites without parts. The nearest parts of the configuration `before` are tested first,
    /// to bound the search.
    fn look(
        &self,
        time: N,
        before: Option<&Configuration<'_, 'a, N, D>>,
    ) -> Option<Configuration<'_, 'a, N, D>> {
        let BodyPoses { moment, pose1, between } = self.poses_at(time)?;
        let first = before.map(|before| before.found.parts);
        let found = nearest_between(&between, N::INFINITY, Wanted::Deepest, first)?;
        let sizes = self.bodies[0].size() + self.bodies[1].size();
        let size = max_component(&between.pair.pose12.translation) + sizes;
        let rounding = N::lit(8.0) * N::EPSILON * size;
        let normal = pose1.vector(&found.separation.normal);
        Some(Configuration {
            gap: found.separation.distance - self.target,
            size,
            tolerance: self.tolerance.map_or(rounding, |tolerance| max(tolerance, rounding)),
            points: [found.separation.point1, found.separation.point2]
                .mapped(|point| pose1.point(&point).coords),
            poses: BodyPoses { moment: Moment { normal, ..moment }, pose1, between },
            found,
        })
    }

    /// Returns the largest depth at the start that counts as touching: the tolerance, and the
    /// rounding errors of the positions in the world.
    fn start_slack(&self, configuration: &Configuration<'_, '_, N, D>) -> N {
        configuration.tolerance + N::TWO * N::EPSILON * max_component(&self.origin)
    }

    /// Returns whether a contact with the `gap` at the start is an impact: always with
    /// `contact_at_start`, else by the rule of [`impact`](super::impact) for the motion of
    /// `configuration`.
    fn counts_at_start(&self, configuration: &Configuration<'_, '_, N, D>, gap: N) -> bool {
        let (closing, rounding_error) =
            configuration.poses.moment.closing(&configuration.points, configuration.size);
        let closing = if self.mirrored { -closing.abs() } else { closing };
        self.contact_at_start
            || is_hit_at_start(gap, closing, self.start_slack(configuration), rounding_error)
    }

    /// Returns whether a contact that counts at the start still counts after a tiny motion, as in
    /// [`Path::counts_soon`](super::linear::Path::counts_soon).
    fn counts_soon(&self, start: &Configuration<'_, 'a, N, D>) -> bool {
        let moment = &start.poses.moment;
        let length = soon(start.size, N::lit(8.0) * N::EPSILON * start.size);
        let soon = moment.time_to_open(length, self.end);
        let soon = min(soon, self.end);
        let is_deep = start.gap < -self.start_slack(start);
        if self.contact_at_start || is_deep || !(soon > N::ZERO && soon.is_finite_number()) {
            return true;
        }
        let later = self.look(soon, Some(start));
        later.is_none_or(|later| self.counts_at_start(&later, start.gap))
    }

    /// Converts the configuration to an impact in the world frame.
    fn impact(
        &self,
        configuration: &Configuration<'_, '_, N, D>,
        status: ImpactStatus,
    ) -> Impact<N, D> {
        let parts = configuration.poses.between.parts(configuration.found.parts);
        let features = <N::Algorithms>::witness_features(&parts.pair(), &configuration.found.local);
        let [point1, point2] = configuration.points.mapped(|point| (point + self.origin).into());
        Impact {
            toi: configuration.poses.moment.time,
            world1: point1,
            world2: point2,
            normal: Unit::new_unchecked(configuration.poses.moment.normal),
            part1: configuration.found.parts[0],
            part2: configuration.found.parts[1],
            feature1: features[0],
            feature2: features[1],
            status,
        }
    }
}

impl<N: Space<D>, const D: usize> Configuration<'_, '_, N, D> {
    /// Returns the smallest gap, beyond the tolerance, at which bodies in contact at the start are
    /// treated as separated. A contact that gets deeper by less than half of this length is not an
    /// impact.
    fn slack(&self) -> N {
        N::lit(1024.0) * N::EPSILON * self.size
    }

    /// Returns the mode after a step: `Apart` once the bodies have separated.
    fn mode_after(&self, mode: Mode<N>) -> Mode<N> {
        if self.gap > self.tolerance + self.slack() { Mode::Apart } else { mode }
    }

    /// Returns the gap that is accepted as an impact if it lasts for more than [`MAX_NEAR_STEPS`]
    /// consecutive steps.
    fn near(&self) -> N {
        max(N::lit(NEAR[0]), N::lit(NEAR[1]) * N::EPSILON) * self.size
    }

    /// Returns whether the bodies have been apart and their gap is within [`Self::near`].
    fn is_near(&self, mode: Mode<N>) -> bool {
        matches!(mode, Mode::Apart) && self.gap <= self.near()
    }

    /// Returns the distance by which the bodies may still approach before an impact is reported:
    /// the gap, or in [`Mode::Contact`] the gap minus the gap at the start, plus `slack`.
    fn excess(&self, mode: Mode<N>) -> N {
        match mode {
            Mode::Apart => self.gap,
            Mode::Contact(start) => self.gap - start + self.slack(),
        }
    }

    /// Returns the distance by which two points may approach or separate in one step; `None` for no
    /// limit. After a start deeper than `deep` a gap of more than `deep` must not open and close
    /// within one step. Bodies that only touch roll and slide for long, so they have no limit.
    fn opening(&self, mode: Mode<N>, deep: N) -> Option<N> {
        match mode {
            Mode::Contact(start) if start < -deep => Some(max(-self.gap, N::ZERO) + deep),
            _ => None,
        }
    }

    /// Returns whether the bodies have an impact: the gap is within the tolerance or, in
    /// [`Mode::Contact`], the excess is at most half of [`Self::slack`].
    fn is_hit(&self, mode: Mode<N>) -> bool {
        match mode {
            Mode::Apart => self.gap <= self.tolerance,
            Mode::Contact(_) => self.excess(mode) <= self.slack() * N::HALF,
        }
    }
}

/// A step during which the bodies certainly do not hit each other.
#[derive(Clone, Copy, Debug)]
struct Step<N> {
    time: N,
    /// The number of consecutive near steps at the end of the step, of the two parts that limit it.
    near_steps: usize,
}
