//! Lower bounds of the time during which two moving and rotating bodies stay apart.
//!
//! Nearly all bounds are for one direction, the normal, along which a gap separates the bodies. The
//! normal keeps separating them until their points have approached along the normal by that gap. It
//! is fixed in the world or, if one of the bodies is a rotating half-space, in the frame of that
//! body. The other bounds are for the bounding spheres, and for approach in any direction.

use super::{ConstantVelocities, RigidMotion};
use crate::bounding_volume::Aabb;
use crate::collide::parts::{PartPair, PartSweep};
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, max, max_component, min, unit};
use crate::shape::{Geometry, Shape};

/// The maximum number of time spans tried to find how long a bound holds.
const MAX_SPANS: usize = 64;

/// A body and its extents about the centre of its motion.
#[derive(Clone, Copy)]
pub(super) struct MovingBody<'a, N: Space<D>, const D: usize> {
    pub(super) motion: &'a dyn RigidMotion<N, D>,
    pub(super) shape: Geometry<'a, N, D>,
    center: Point<N, D>,
    /// An upper bound of the distance of the core's points from the centre, where the core is a
    /// convex solid without its rounding radius, or a whole composite; infinite for half-spaces and
    /// composites that contain one.
    reach: N,
    /// For constant velocities, an upper bound of the distance of the core's points from the axis
    /// of rotation; for other motions `reach`.
    arm: N,
    /// An upper bound of the distance of the body's points from the centre.
    radius: N,
}

impl<'a, N: Space<D>, const D: usize> MovingBody<'a, N, D> {
    pub(super) fn new(motion: &'a dyn RigidMotion<N, D>, shape: &'a dyn Shape<N, D>) -> Self {
        let (center, sphere, geometry) =
            (motion.local_center(), shape.local_bounding_sphere(), shape.geometry());
        let outer = length(&(sphere.center() - center)) + sphere.radius();
        let (reach, rounding) = geometry.as_support_map().map_or((outer, N::ZERO), |map| {
            (min(length(&center.coords) + map.reach(), outer), map.rounding())
        });
        let slack = N::ONE + N::lit(8.0) * N::EPSILON;
        let radius = min(outer, reach + rounding) * slack;
        let mut arm = reach;
        if let Some(constant) = motion.constant_velocities()
            && (outer * N::TWO).is_finite_number()
        {
            arm = min(arm_of_box(&shape.local_aabb(), &center, constant), reach);
        }
        Self { motion, shape: geometry, center, reach: reach * slack, arm: arm * slack, radius }
    }

    /// Returns a solid of the body as a separate body: `pose` is the pose of the solid, and
    /// `center` is the centre of the whole body's motion.
    fn part<'p>(
        &self,
        solid: Geometry<'p, N, D>,
        pose: &Pose<N, D>,
        center: &Vector<N, D>,
    ) -> MovingBody<'p, N, D>
    where
        'a: 'p,
    {
        let extents = solid.as_support_map().map(|map| (map.reach(), map.rounding()));
        let (extent, rounding) = extents.unwrap_or((N::INFINITY, N::ZERO));
        let local = pose.inverse_point(&Point::from(*center));
        let slack = N::ONE + N::lit(8.0) * N::EPSILON;
        let reach = (length(&local.coords) + extent) * slack;
        let across = self.constant().map(|motion| motion.across(&(pose.translation - center)));
        let arm = across.map_or(reach, |across| min((across + extent) * slack, reach));
        let radius = reach + rounding;
        MovingBody { motion: self.motion, shape: solid, center: local, reach, arm, radius }
    }

    /// Returns [`Self::radius`], to which tolerances are proportional; zero for an unbounded body.
    pub(super) fn size(&self) -> N {
        if self.radius.is_finite_number() { self.radius } else { N::ZERO }
    }

    /// Returns an upper bound of the distance of the body's points from the centre of its motion.
    pub(super) fn radius(&self) -> N {
        self.radius
    }

    pub(super) fn center_at(&self, pose: &Pose<N, D>) -> Vector<N, D> {
        pose.point(&self.center).coords
    }

    fn constant(&self) -> Option<&ConstantVelocities<N, D>> {
        self.motion.constant_velocities()
    }

    fn is_half_space(&self) -> bool {
        self.shape.as_support_map().is_none() && self.shape.as_composite().is_none()
    }

    fn speed_bound(&self, from: N, to: N) -> N {
        usable(self.motion.speed_bound(from, to))
    }

    fn turn_bound(&self, from: N, to: N) -> N {
        usable(self.motion.turn_bound(from, to))
    }
}

/// The poses and centres of two bodies at one time, and the direction that separates them.
pub(super) struct Moment<'b, 'a, N: Space<D>, const D: usize> {
    pub(super) bodies: [&'b MovingBody<'a, N, D>; 2],
    /// The world point to which all positions are relative.
    pub(super) origin: Vector<N, D>,
    pub(super) poses: [Pose<N, D>; 2],
    /// The positions of the bodies' centres of motion, relative to `origin`.
    pub(super) centers: [Vector<N, D>; 2],
    pub(super) time: N,
    /// The unit vector from the first body to the second, in the world's axes.
    pub(super) normal: Vector<N, D>,
}

/// A part of each of two bodies, both treated as separate bodies.
pub(super) struct ImpactParts<'p, N: Space<D>, const D: usize> {
    bodies: [MovingBody<'p, N, D>; 2],
    poses: [Pose<N, D>; 2],
}

/// An upper bound of the distance moved in a time `h`: `speed · h + bend · h²`. The speed may be
/// negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rate<N> {
    speed: N,
    /// The quadratic coefficient; not negative.
    bend: N,
}

impl<N: Real> Rate<N> {
    /// Returns an upper bound of the distance moved in the time `time`.
    pub(super) fn travel(&self, time: N) -> N {
        product(max(self.speed, N::ZERO), time) + product(product(self.bend, time), time)
    }

    /// Returns the time in which the motion uses up the length `gap`: infinite if it never does,
    /// and zero if a coefficient is NaN or the speed is infinite.
    pub(super) fn time_for(&self, gap: N) -> N {
        if !(self.speed <= N::INFINITY && self.bend <= N::INFINITY) {
            return N::ZERO;
        }
        // The product of the factors under one root could overflow; the product of their roots does
        // not.
        let gained_speed = N::TWO * self.bend.sqrt() * gap.sqrt();
        let root = length(&Vector::<N, 2>::new(self.speed, gained_speed));
        if self.speed > N::ZERO {
            // The usual formula would suffer from cancellation.
            N::TWO * gap / (self.speed + root)
        } else if self.bend > N::ZERO {
            (root - self.speed) / (N::TWO * self.bend)
        } else {
            N::INFINITY
        }
    }
}

impl<'a, N: Space<D>, const D: usize> Moment<'_, 'a, N, D> {
    /// Returns a time, counted from this moment, during which the bodies certainly do not approach
    /// by more than `gap`, and two points of the bodies do not approach or separate by more than
    /// `opening`, if given. A result of `remaining` or more means that they do not in the remaining
    /// time. `apart` is the distance between the bounding spheres minus the target distance; if
    /// negative, the spheres give no bound.
    pub(super) fn safe_time(&self, [gap, apart]: [N; 2], opening: Option<N>, remaining: N) -> N {
        let opened = |to| opening.map_or(N::INFINITY, |opening| self.time_to_open(opening, to));
        let within = |to| min(self.safe_within(gap, apart, to), opened(to));
        let safe = |span: N| within(self.time + span);
        let all = safe(remaining);
        if all >= remaining || self.bodies.iter().all(|body| body.constant().is_some()) {
            return all;
        }
        let mut span = if all > N::ZERO { all } else { self.first_span(remaining, &safe) };
        for _ in 0..MAX_SPANS {
            let wider = min(span * N::TWO, remaining);
            let found = min(safe(wider), wider);
            if found > span * N::lit(1.125) {
                span = found;
            } else {
                break;
            }
        }
        span
    }

    /// Returns one part of each body as separate bodies. `frame` is the world pose of the frame in
    /// which the parts are placed.
    pub(super) fn parts<'p>(
        &self,
        parts: &'p PartPair<'_, N, D>,
        frame: &Pose<N, D>,
    ) -> ImpactParts<'p, N, D>
    where
        'a: 'p,
    {
        let (pair, poses) = (parts.pair(), parts.poses().mapped(|pose| frame.compose(&pose)));
        let [center1, center2] = &self.centers;
        let part1 = self.bodies[0].part(Geometry(pair.first), &poses[0], center1);
        let part2 = self.bodies[1].part(Geometry(pair.second), &poses[1], center2);
        ImpactParts { bodies: [part1, part2], poses }
    }

    /// Implements [`Self::safe_time`] for parts of bodies that both have constant velocities; the
    /// result is valid up to the time `to`. `normal` points from the first part to the second, in
    /// the frame of the first part.
    pub(super) fn safe_time_of(
        &self,
        parts: &ImpactParts<'_, N, D>,
        normal: &Vector<N, D>,
        gap: N,
        to: N,
    ) -> N {
        let ImpactParts { bodies, poses } = parts;
        let normal = poses[0].vector(normal);
        let (bodies, centers) = (bodies.each_ref(), self.centers);
        let (poses, origin, time) = (*poses, self.origin, self.time);
        Moment { bodies, origin, poses, centers, time, normal }.safe_within(gap, -N::ONE, to)
    }

    /// Runs [`Self::rate_between`] for two parts.
    pub(super) fn rate_of(&self, parts: &ImpactParts<'_, N, D>, to: N) -> Rate<N> {
        self.rate_between(parts.bodies.each_ref(), to)
    }

    /// Returns an upper bound of the speed at which a point of one of two bodies, or parts of
    /// `self.bodies`, and a point of the other approach in any direction, up to the time `to`.
    fn rate_between(&self, bodies: [&MovingBody<'_, N, D>; 2], to: N) -> Rate<N> {
        let swings = [0, 1].mapped(|index| {
            product(self.bodies[index].turn_bound(self.time, to), bodies[index].arm)
        });
        Rate { speed: self.drift(None, to) + swings[0] + swings[1], bend: N::ZERO }
    }

    /// Returns a time in which no two points of the bodies approach or separate by more than
    /// `opening`, valid up to the time `to`; infinite if a body is unbounded.
    pub(super) fn time_to_open(&self, opening: N, to: N) -> N {
        let is_bounded = self.bodies.iter().all(|body| body.arm.is_finite_number());
        if is_bounded { self.rate_between(self.bodies, to).time_for(opening) } else { N::INFINITY }
    }

    /// Returns a bound of the motion of the points of body `which` during `span`, in the frame of
    /// the other body. `rate` bounds the approach of any two points. For constant velocities the
    /// result is a linear function of the position plus a spread. For other motions, and if the
    /// travel by `rate` is not larger than that spread, the result is that travel in an unknown
    /// direction.
    ///
    /// A point at `u` from the other body's centre has the velocity `u' - S u` in the frame of that
    /// body, which rotates with the generator `S`. The velocity is a linear function of the
    /// position. Its derivative, `u'' - 2 S u' + S² u`, curves the path.
    pub(super) fn sweep(&self, which: usize, rate: &Rate<N>, span: N) -> PartSweep<N, D> {
        let travel = rate.travel(span);
        let [body, other] = [which, 1 - which].mapped(|index| self.bodies[index]);
        let [Some(own), Some(frame)] = [body.constant(), other.constant()] else {
            return PartSweep::anywhere(travel);
        };
        let [center, pivot] = [self.centers[which], self.centers[1 - which]];
        let [turn, turning] = [body, other].mapped(|body| body.turn_bound(self.time, self.time));
        let swing = product(turn, body.arm);
        let speed = self.drift(None, self.time) + swing;
        let far = length(&(center - pivot)) + body.reach + speed * span;
        let bends =
            product(turn, swing) + N::TWO * turning * speed + product(turning * turning, far);
        let bend = product(bends * N::HALF, span * span);
        let pose = &self.poses[1 - which];
        let (spin, linear) = (own.spin - frame.spin, own.linear - frame.linear);
        let position = pose.translation;
        let shift = linear + own.spin * (position - center) - frame.spin * (position - pivot);
        let size = max(max_component(&position), max_component(&center))
            + far
            + max(body.size(), other.size());
        let spread = bend + N::lit(64.0) * N::EPSILON * (size + travel);
        if spread < travel {
            let shift = pose.inverse_vector(&shift) * span;
            let turn = pose.rotation.tr_mul(&(spin * pose.rotation)) * span;
            return PartSweep { turn, shift, spread };
        }
        PartSweep::anywhere(travel)
    }

    /// Returns whether the parts of the bodies can be advanced separately: at least one body is a
    /// composite, and both have constant velocities.
    pub(super) fn has_parts_on_known_paths(&self) -> bool {
        let is_known = self.bodies.iter().all(|body| body.constant().is_some());
        is_known && self.bodies.iter().any(|body| body.shape.as_composite().is_some())
    }

    /// Returns a time span that the bound `safe` covers completely (`safe(span) >= span`), found by
    /// bisection over all orders of magnitude; zero if none is found. Used if the bound for all the
    /// remaining time is zero, as when the speed is unbounded.
    fn first_span(&self, remaining: N, safe: &dyn Fn(N) -> N) -> N {
        let (mut low, mut high) = (N::MIN_POSITIVE, min(remaining, N::MAX));
        // The exponents of floating-point numbers span at most 2^11 values.
        for _ in 0..12 {
            let middle = low.sqrt() * high.sqrt();
            if safe(middle) >= middle { low = middle } else { high = middle }
        }
        if safe(low) >= low { low } else { N::ZERO }
    }

    /// Implements [`Self::safe_time`] with the bounds that hold from now to the time `to`; the
    /// result is valid up to `to`.
    fn safe_within(&self, gap: N, apart: N, to: N) -> N {
        let first = self.first_order(to).time_for(gap);
        let second = self.second_order(to).map_or(N::ZERO, |rate| rate.time_for(gap));
        let around = self.spheres(apart, to);
        let longest = max(max(first, second), around);
        if longest >= N::ZERO { longest } else { N::ZERO }
    }

    /// Returns the time in which the bounding spheres of the bodies use up the distance `apart`;
    /// zero if `apart` is not positive or the centres coincide.
    fn spheres(&self, apart: N, to: N) -> N {
        let is_apart = apart > N::ZERO;
        if !is_apart {
            return N::ZERO;
        }
        unit(&(self.centers[1] - self.centers[0])).map_or(N::ZERO, |(direction, _)| {
            Rate { speed: self.drift(Some(&direction), to), bend: N::ZERO }.time_for(apart)
        })
    }

    /// Returns the rate of approach along the normal from upper bounds of the speeds of all points
    /// of both bodies up to the time `to`.
    pub(super) fn first_order(&self, to: N) -> Rate<N> {
        for (index, body) in self.bodies.iter().enumerate() {
            if !body.reach.is_finite_number() && self.swing(index, N::ONE, to) > N::ZERO {
                return self.about_unbounded(index, to);
            }
        }
        let swings = [0, 1].mapped(|index| self.swing(index, self.bodies[index].arm, to));
        let speed = self.drift(self.direction(), to) + swings[0] + swings[1];
        Rate { speed, bend: N::ZERO }
    }

    /// Returns the direction that separates the bodies. `None` if one of the bodies is a composite
    /// and neither is a half-space, since other parts may be separated by another direction.
    fn direction(&self) -> Option<&Vector<N, D>> {
        let flat = self.bodies.iter().any(|body| body.is_half_space());
        let whole = self.bodies.iter().all(|body| body.shape.as_composite().is_none());
        (flat || whole).then_some(&self.normal)
    }

    /// Returns the rate of approach from the present speeds of points and the largest change of
    /// these speeds. `None` unless both bodies have constant velocities, one direction separates
    /// them, and each body whose rotation changes the gap is convex.
    ///
    /// A point farther from the centre moves faster, and its path bends more. Of all points of a
    /// convex core, the fastest along the normal is a support point.
    fn second_order(&self, to: N) -> Option<Rate<N>> {
        let (mut speed, mut bend) = (self.drift(Some(self.direction()?), to), N::ZERO);
        for (index, body) in self.bodies.iter().enumerate() {
            let slope = self.slope(index)?;
            if slope == Vector::<N, D>::zeros() {
                continue;
            }
            let pose = &self.poses[index];
            let fastest = body.shape.as_support_map()?.core_support(&pose.inverse_vector(&slope));
            speed += slope.dot(&(pose.point(&fastest).coords - self.centers[index]));
            let spin = &body.constant()?.spin;
            bend += N::HALF * length(&spin.tr_mul(&slope)) * body.arm;
        }
        Some(Rate { speed, bend })
    }

    /// Returns the rate due to the rotation of an unbounded body, in whose frame the normal is
    /// fixed.
    ///
    /// The speed of approach grows with the other body's distance from the centre of rotation. That
    /// distance may grow during the motion, and the normal may rotate towards the other body's
    /// motion.
    fn about_unbounded(&self, index: usize, to: N) -> Rate<N> {
        let other = self.bodies[1 - index];
        let turn = self.swing(index, N::ONE, to);
        let distance = length(&(self.centers[1] - self.centers[0])) + other.reach;
        let (along, all) = (self.drift(self.direction(), to), self.drift(None, to));
        let swing = product(other.turn_bound(self.time, to), other.arm);
        Rate { speed: along + swing + product(turn, distance), bend: product(turn, all) }
    }

    /// Returns an upper bound of the speed at which the centres approach along `direction`, a unit
    /// vector from the first body to the second; if `direction` is `None`, the bound is for any
    /// direction. If both velocities are constant, a speed within rounding error is treated as
    /// zero.
    fn drift(&self, direction: Option<&Vector<N, D>>, to: N) -> N {
        if let [Some(motion1), Some(motion2)] = self.bodies.mapped(MovingBody::constant) {
            let relative = motion1.linear - motion2.linear;
            let rounding_error = N::lit(8.0) * N::EPSILON * max_component(&relative);
            let speed = direction.map_or_else(|| length(&relative), |n| n.dot(&relative));
            return if speed.abs() <= rounding_error { N::ZERO } else { speed };
        }
        let speed = |index: usize, side: N| {
            let body = self.bodies[index];
            match (body.constant(), direction) {
                (Some(motion), Some(direction)) => side * direction.dot(&motion.linear),
                _ => body.speed_bound(self.time, to),
            }
        };
        speed(0, N::ONE) + speed(1, -N::ONE)
    }

    /// Returns an upper bound, for all times up to `to`, of the speed along the normal that the
    /// rotation of body `index` gives to a point at `distance` from its centre.
    fn swing(&self, index: usize, distance: N, to: N) -> N {
        let turn = match (self.slope(index), self.direction()) {
            (Some(slope), Some(_)) => length(&slope),
            _ => self.bodies[index].turn_bound(self.time, to),
        };
        product(turn, distance)
    }

    /// Returns the gradient, with respect to position, of the speed of a body's points towards the
    /// other body. `None` unless the velocities are constant. A gradient within rounding error is
    /// treated as zero, so that a body spinning about the normal does not approach.
    fn slope(&self, index: usize) -> Option<Vector<N, D>> {
        let motion = self.bodies[index].constant()?;
        let toward = if index == 0 { self.normal } else { -self.normal };
        let slope = motion.spin.tr_mul(&toward);
        let rounding_error =
            N::lit(8.0) * N::EPSILON * self.bodies[index].turn_bound(self.time, self.time);
        Some(if max_component(&slope) <= rounding_error { Vector::<N, D>::zeros() } else { slope })
    }

    /// Returns the speed at which a point of the first body and a point of the second approach
    /// along the normal, and a bound of the rounding error of that speed.
    pub(super) fn closing(&self, points: &[Vector<N, D>; 2], size: N) -> (N, N) {
        let arms = [0, 1].mapped(|index| points[index] - self.centers[index]);
        if let [Some(motion1), Some(motion2)] = self.bodies.mapped(MovingBody::constant) {
            let terms =
                [motion1.linear - motion2.linear, motion1.spin * arms[0], motion2.spin * arms[1]];
            let rounding_error = terms.iter().fold(N::ZERO, |sum, term| sum + max_component(term));
            let closing = self.normal.dot(&(terms[0] + terms[1] - terms[2]));
            return (closing, N::lit(8.0) * N::EPSILON * rounding_error);
        }
        self.closing_observed(points, &arms, size)
    }

    /// Computes the result of [`Self::closing`] from the positions of the points after a short
    /// time, in which they move by at most the square root of epsilon times `size`. Zero, with no
    /// error, if that time is zero or not finite, as when the bound of the speed is zero or
    /// infinite.
    fn closing_observed(
        &self,
        points: &[Vector<N, D>; 2],
        arms: &[Vector<N, D>; 2],
        size: N,
    ) -> (N, N) {
        let speed = [0, 1].iter().fold(N::ZERO, |sum, &index| {
            let (body, now) = (self.bodies[index], self.time);
            let turning = product(body.turn_bound(now, now), length(&arms[index]));
            sum + body.speed_bound(now, now) + turning
        });
        let root = N::EPSILON.sqrt();
        let span = root * size / speed;
        if !(span > N::ZERO && span.is_finite_number()) {
            return (N::ZERO, N::ZERO);
        }
        let moved = [0, 1].mapped(|index| self.moved(index, &points[index], span));
        (self.normal.dot(&(moved[0] - moved[1])) / span, N::lit(8.0) * root * speed)
    }

    /// Returns the displacement of a point of a body during `span`.
    fn moved(&self, index: usize, point: &Vector<N, D>, span: N) -> Vector<N, D> {
        let (body, pose) = (self.bodies[index], &self.poses[index]);
        let local = pose.inverse_point(&Point::from(*point));
        let later = body.motion.pose_about(&self.origin, self.time + span);
        later.point(&local).coords - point
    }
}

/// Returns the largest distance of the corners of a body's box from its axis of rotation.
fn arm_of_box<N: Space<D>, const D: usize>(
    aabb: &Aabb<N, D>,
    center: &Point<N, D>,
    motion: &ConstantVelocities<N, D>,
) -> N {
    (0..1_u32 << D).fold(N::ZERO, |most, corner| {
        let arm = Vector::<N, D>::from_fn(|axis, _| {
            let end = if corner >> axis & 1 == 0 { aabb.mins() } else { aabb.maxs() };
            end[axis] - center[axis]
        });
        max(motion.across_local(&arm), most)
    })
}

/// Returns the product of two numbers, where zero times infinity is zero.
fn product<N: Real>(a: N, b: N) -> N {
    if a == N::ZERO || b == N::ZERO { N::ZERO } else { a * b }
}

/// Returns the bound; infinity if it is negative or NaN.
fn usable<N: Real>(bound: N) -> N {
    if bound >= N::ZERO { bound } else { N::INFINITY }
}

/// Returns the length of a vector, without intermediate overflow.
pub(super) fn length<N: Real, const D: usize>(v: &Vector<N, D>) -> N {
    unit(v).map_or_else(|| max_component(v), |(_, length)| length)
}
