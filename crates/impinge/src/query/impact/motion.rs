//! How a rigid body moves: where it is at each time, and how fast it can be.

use core::fmt;

use super::bounds::length;
use crate::math::{
    Isometry2, Isometry3, Matrix, Point, Pose, Real, Space, Vector, max_component, na, unit,
};

/// The motion of a rigid body.
///
/// Times count from zero, in any unit; the frame is the world's. Speeds are bounded, not given: a
/// bound that is too high costs steps, one that is too low may miss an impact. The bounds are about
/// one point of the body, [`Self::local_center`], and about how fast the body turns, whatever its
/// shape.
///
/// A pendulum of length 2 that swings about the origin with the angle `cos t`:
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::{ConstantVelocities, ImpactOptions, nonlinear_time_of_impact};
/// use impinge::dim2::shape::Ball;
/// use impinge::query::RigidMotion;
///
/// struct Pendulum;
///
/// impl RigidMotion<f64, 2> for Pendulum {
///     fn position_at(&self, time: f64) -> Isometry<f64> {
///         let angle = time.cos();
///         Isometry::new(Vector::new(2.0 * angle.sin(), -2.0 * angle.cos()), angle)
///     }
///
///     fn speed_bound(&self, from: f64, to: f64) -> f64 {
///         2.0 * self.turn_bound(from, to)
///     }
///
///     fn turn_bound(&self, _: f64, to: f64) -> f64 {
///         to.min(1.0) // |sin t|, which is less than t
///     }
/// }
///
/// let (bob, post) = (Ball::new(0.25), Ball::new(0.125));
/// let stays = ConstantVelocities::still(Isometry::translation(0.0, -2.0));
/// let found = nonlinear_time_of_impact(&Pendulum, &bob, &stays, &post, &ImpactOptions::new());
/// let toi = found.expect("the post stands at the lowest point").toi;
/// let angle = 2.0 * (0.375_f64 / 4.0).asin(); // the chord to the post is 0.25 + 0.125 long
/// assert!((toi - angle.acos()).abs() < 1e-9);
/// ```
pub trait RigidMotion<N: Space<D>, const D: usize> {
    /// Where the body is at a time, zero or more.
    fn position_at(&self, time: N) -> N::Isometry;

    /// At least the speed of the point [`Self::local_center`] at all times between `from` and `to`,
    /// the latter of which may be infinite. Infinite if there is no bound; then shorter spans are
    /// asked about. A negative number or NaN counts as infinite.
    fn speed_bound(&self, from: N, to: N) -> N;

    /// At least how fast the body turns, in radians per unit of time, at all times between `from` and
    /// `to`; as [`Self::speed_bound`].
    fn turn_bound(&self, from: N, to: N) -> N;

    /// The point of the body, in its local frame, whose speed is bounded. The origin by default; the
    /// middle of the shape, or the point that the body turns about, saves steps.
    fn local_center(&self) -> Point<N, D> {
        Point::origin()
    }

    /// [`Self::position_at`] as a pose in the frame of the world moved to `origin`. Far from the
    /// world's origin it keeps digits to override this: what is asked about are differences.
    fn pose_about(&self, origin: &Vector<N, D>, time: N) -> Pose<N, D> {
        let pose = N::pose(&self.position_at(time));
        Pose { rotation: pose.rotation, translation: pose.translation - origin }
    }

    /// The motion, if it is one with constant velocities: then the body's speed is known in each
    /// direction, which saves steps. For wrappers; nothing is lost by the default.
    fn constant_velocities(&self) -> Option<&ConstantVelocities<N, D>> {
        None
    }
}

/// A body that moves with constant velocities: a point of it along a straight line, the body turning
/// about that point.
///
/// Angles are exact up to the rounding of the angular velocity times the time: about that many
/// radians times epsilon.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::ConstantVelocities;
/// use impinge::query::RigidMotion;
///
/// let spin = Vector::z() * 0.5_f64;
/// let motion = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::x(), spin);
/// let corner = motion.position_at(2.0) * Point::new(1.0, 0.0, 0.0);
/// assert!((corner - Point::new(2.0 + 1.0_f64.cos(), 1.0_f64.sin(), 0.0)).norm() < 1e-15);
/// ```
#[derive(Clone, Copy, PartialEq)]
pub struct ConstantVelocities<N: Space<D>, const D: usize> {
    start: N::Isometry,
    local_center: Point<N, D>,
    pub(super) linear: Vector<N, D>,
    /// The velocity of a point of the body, seen from the centre, is this matrix times its place.
    pub(super) spin: Matrix<N, D>,
    /// The same for a turn by one radian per unit of time.
    unit_spin: Matrix<N, D>,
    /// Radians per unit of time; not negative.
    turn: N,
}

impl<N: Space<D>, const D: usize> fmt::Debug for ConstantVelocities<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ConstantVelocities")
            .field("position", &self.start)
            .field("local_center", &self.local_center)
            .field("linear", &self.linear)
            .field("turn", &self.turn)
            .finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize> ConstantVelocities<N, D> {
    /// A body that stays where it is.
    #[must_use]
    pub fn still(position: N::Isometry) -> Self {
        Self::straight(position, Vector::<N, D>::zeros())
    }

    /// A body that moves without turning.
    #[must_use]
    pub fn straight(position: N::Isometry, linear: Vector<N, D>) -> Self {
        let none = Matrix::<N, D>::zeros();
        Self::spinning(position, linear, none, N::ZERO)
    }

    /// The same velocities for a body that turns about another point of its own: this point, in the
    /// local frame, moves along a straight line.
    #[must_use]
    pub const fn with_local_center(self, local_center: Point<N, D>) -> Self {
        Self { local_center, ..self }
    }

    fn spinning(
        start: N::Isometry,
        linear: Vector<N, D>,
        unit_spin: Matrix<N, D>,
        turn: N,
    ) -> Self {
        let spin = unit_spin * turn;
        Self { start, local_center: Point::origin(), linear, spin, unit_spin, turn }
    }

    /// The rotation since time zero, by the formula of Rodrigues, which in 2D says the same.
    fn turned(&self, time: N) -> Matrix<N, D> {
        let (sine, cosine) = (self.turn * time).sine_cosine();
        let squared = self.unit_spin * self.unit_spin;
        Matrix::<N, D>::identity() + self.unit_spin * sine + squared * (N::ONE - cosine)
    }

    /// Where the local origin is, seen from `origin`, once the body has got the given rotation.
    fn translation(&self, origin: &Vector<N, D>, time: N, rotation: &Matrix<N, D>) -> Vector<N, D> {
        let start = N::pose(&self.start);
        let swung = (start.rotation - rotation) * self.local_center.coords;
        (start.translation - origin) + self.linear * time + swung
    }

    fn pose(&self, origin: &Vector<N, D>, time: N) -> Pose<N, D> {
        let rotation = self.turned(time) * N::pose(&self.start).rotation;
        Pose { rotation, translation: self.translation(origin, time, &rotation) }
    }

    /// How far a point of the body is from the axis that it turns about, by its place seen from the centre, along
    /// the world's axes.
    pub(super) fn across(&self, place: &Vector<N, D>) -> N {
        length(&(self.unit_spin * place))
    }

    /// The same by its place along the local axes.
    pub(super) fn across_local(&self, place: &Vector<N, D>) -> N {
        self.across(&(N::pose(&self.start).rotation * place))
    }

    fn speed(&self) -> N {
        let largest = max_component(&self.linear);
        let finite = self.linear.iter().all(|x| x.is_finite_number());
        if finite { unit(&self.linear).map_or(largest, |(_, speed)| speed) } else { N::INFINITY }
    }
}

impl<N: Real> ConstantVelocities<N, 2> {
    /// A body that stands at `position` at time zero, whose local origin moves by `linear` per unit of
    /// time, and that turns by `angular` radians, counter-clockwise, per unit of time.
    #[must_use]
    pub fn new(position: Isometry2<N>, linear: Vector<N, 2>, angular: N) -> Self {
        let side = if angular < N::ZERO { -N::ONE } else { N::ONE };
        let unit_spin = Matrix::<N, 2>::new(N::ZERO, -side, side, N::ZERO);
        Self::spinning(position, linear, unit_spin, angular.abs())
    }
}

impl<N: Real> ConstantVelocities<N, 3> {
    /// A body that stands at `position` at time zero, whose local origin moves by `linear` per unit of
    /// time, and that turns about the world direction of `angular`, by its length in radians per unit
    /// of time.
    #[must_use]
    pub fn new(position: Isometry3<N>, linear: Vector<N, 3>, angular: Vector<N, 3>) -> Self {
        let usable = angular.iter().all(|x| x.is_finite_number());
        // Angular velocities that are not finite make poses that are not.
        let none = if usable { N::ZERO } else { N::INFINITY };
        let (axis, turn) = unit(&angular).unwrap_or((Vector::<N, 3>::zeros(), none));
        Self::spinning(position, linear, axis.cross_matrix(), turn)
    }
}

impl<N: Real> RigidMotion<N, 2> for ConstantVelocities<N, 2> {
    fn position_at(&self, time: N) -> Isometry2<N> {
        let pose = self.pose(&Vector::<N, 2>::zeros(), time);
        let (cosine, sine) = (pose.rotation[(0, 0)], pose.rotation[(1, 0)]);
        let rotation = na::UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(pose.translation.into(), rotation)
    }

    fn speed_bound(&self, _: N, _: N) -> N {
        self.speed()
    }

    fn turn_bound(&self, _: N, _: N) -> N {
        self.turn
    }

    fn local_center(&self) -> Point<N, 2> {
        self.local_center
    }

    fn pose_about(&self, origin: &Vector<N, 2>, time: N) -> Pose<N, 2> {
        self.pose(origin, time)
    }

    fn constant_velocities(&self) -> Option<&Self> {
        Some(self)
    }
}

impl<N: Real> RigidMotion<N, 3> for ConstantVelocities<N, 3> {
    fn position_at(&self, time: N) -> Isometry3<N> {
        let pose = self.pose(&Vector::<N, 3>::zeros(), time);
        let (sine, cosine) = (self.turn * time * N::HALF).sine_cosine();
        let (spin, w) = (&self.unit_spin, cosine);
        let turned =
            na::Quaternion::new(w, spin[(2, 1)] * sine, spin[(0, 2)] * sine, spin[(1, 0)] * sine);
        let rotation = na::UnitQuaternion::new_normalize(turned) * self.start.rotation;
        Isometry3::from_parts(pose.translation.into(), rotation)
    }

    fn speed_bound(&self, _: N, _: N) -> N {
        self.speed()
    }

    fn turn_bound(&self, _: N, _: N) -> N {
        self.turn
    }

    fn local_center(&self) -> Point<N, 3> {
        self.local_center
    }

    fn pose_about(&self, origin: &Vector<N, 3>, time: N) -> Pose<N, 3> {
        self.pose(origin, time)
    }

    fn constant_velocities(&self) -> Option<&Self> {
        Some(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_centre_goes_straight_and_the_isometry_is_the_pose() {
        let at = Isometry3::new(Vector::<f64, 3>::new(5.0, -1.0, 2.0), [0.3, -0.2, 0.9].into());
        let linear = Vector::<f64, 3>::new(0.5, 2.0, -1.0);
        let center = Point::<f64, 3>::new(0.25, 1.5, -0.75);
        let motion = ConstantVelocities::<f64, 3>::new(at, linear, [1.5, -2.5, 0.5].into())
            .with_local_center(center);
        for time in [0.0, 0.5, 7.25] {
            let (isometry, pose) =
                (motion.position_at(time), motion.pose_about(&Vector::<f64, 3>::zeros(), time));
            let expected = at * center + linear * time;
            assert!((isometry * center - expected).norm() < 1e-13, "straight at {time}");
            let corner = Point::<f64, 3>::new(1.0, -2.0, 3.0);
            assert!((pose.point(&corner) - isometry * corner).norm() < 1e-13, "one at {time}");
        }
    }

    #[test]
    fn a_point_moves_by_its_spin() {
        let (at, h) = (Isometry2::new(Vector::<f64, 2>::new(1.0, 2.0), 0.4), 1e-6);
        let motion = ConstantVelocities::<f64, 2>::new(at, Vector::<f64, 2>::zeros(), -3.0);
        let corner = Point::<f64, 2>::new(2.0, 1.0);
        let moved = (motion.position_at(h) * corner - at * corner) / h;
        let expected = motion.spin * (at * corner - Point::<f64, 2>::new(1.0, 2.0));
        assert!((moved - expected).norm() < 1e-4, "{moved} and {expected}");
        assert!((expected.norm() - 3.0 * 5.0_f64.sqrt()).abs() < 1e-12, "three times its radius");
    }
}
