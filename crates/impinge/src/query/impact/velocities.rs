//! Motions with constant velocities.

use core::fmt;

use super::RigidMotion;
use super::bounds::length;
use crate::math::{
    Isometry2, Isometry3, Matrix, Point, Pose, Real, Space, Vector, max_component, na, unit,
};

/// The motion of a body with constant velocities: one point of the body moves along a straight
/// line, and the body rotates about that point.
///
/// At its start time, zero by default, the body is at the given position; before that time it moves
/// with the same velocities. The rotation angle has a rounding error of about epsilon times the
/// angle since the start. If the start time is not finite, no position is finite.
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
    start_time: N,
    local_center: Point<N, D>,
    pub(super) linear: Vector<N, D>,
    /// Maps the position of a body point, relative to the centre, to the velocity due to rotation.
    pub(super) spin: Matrix<N, D>,
    /// The value of [`Self::spin`] for a rotation by one radian per unit of time.
    unit_spin: Matrix<N, D>,
    /// The angular speed in radians per unit of time; not negative.
    turn: N,
}

impl<N: Space<D>, const D: usize> fmt::Debug for ConstantVelocities<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ConstantVelocities")
            .field("position", &self.start)
            .field("start_time", &self.start_time)
            .field("local_center", &self.local_center)
            .field("linear", &self.linear)
            .field("turn", &self.turn)
            .finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize> ConstantVelocities<N, D> {
    /// Returns the motion of a body at rest.
    #[must_use]
    pub fn still(position: N::Isometry) -> Self {
        Self::straight(position, Vector::<N, D>::zeros())
    }

    /// Returns the motion of a body that moves without rotating.
    #[must_use]
    pub fn straight(position: N::Isometry, linear: Vector<N, D>) -> Self {
        let none = Matrix::<N, D>::zeros();
        Self::spinning(position, linear, none, N::ZERO)
    }

    /// Returns this motion with another centre: the point `local_center` of the body, in its local
    /// frame, moves along a straight line.
    #[must_use]
    pub const fn with_local_center(self, local_center: Point<N, D>) -> Self {
        Self { local_center, ..self }
    }

    /// Returns this motion with another start time: the body is at its start position at
    /// `start_time`.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Vector};
    /// use impinge::dim2::query::ConstantVelocities;
    /// use impinge::query::RigidMotion;
    ///
    /// let late = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::x(), 0.0).with_start_time(2.0);
    /// assert_eq!(late.position_at(5.0), Isometry::translation(3.0, 0.0));
    /// assert_eq!(late.position_at(0.0), Isometry::translation(-2.0, 0.0), "before its start");
    /// ```
    #[must_use]
    pub const fn with_start_time(self, start_time: N) -> Self {
        Self { start_time, ..self }
    }

    /// Returns the position of the body at its start time.
    #[must_use]
    pub const fn start(&self) -> &N::Isometry {
        &self.start
    }

    /// Returns the time at which the body is at [`Self::start`].
    #[must_use]
    pub const fn start_time(&self) -> N {
        self.start_time
    }

    /// Returns the velocity of the point [`RigidMotion::local_center`] of the body, in the world
    /// frame.
    #[must_use]
    pub const fn linear_velocity(&self) -> &Vector<N, D> {
        &self.linear
    }

    /// Returns a motion with the generator `unit_spin` and `turn` radians per unit of time,
    /// starting at time zero.
    fn spinning(
        start: N::Isometry,
        linear: Vector<N, D>,
        unit_spin: Matrix<N, D>,
        turn: N,
    ) -> Self {
        let spin = unit_spin * turn;
        let (start_time, local_center) = (N::ZERO, Point::origin());
        Self { start, start_time, local_center, linear, spin, unit_spin, turn }
    }

    /// Returns the rotation during the time `since` after the start, by Rodrigues' formula, which
    /// also holds in 2D.
    fn rotation_after(&self, since: N) -> Matrix<N, D> {
        let (sine, cosine) = (self.turn * since).sine_cosine();
        let squared = self.unit_spin * self.unit_spin;
        Matrix::<N, D>::identity() + self.unit_spin * sine + squared * (N::ONE - cosine)
    }

    /// Returns the position of the body's local origin relative to `origin`, at the time `since`
    /// after the start, when the body has the rotation `rotation`.
    fn translation(
        &self,
        origin: &Vector<N, D>,
        since: N,
        rotation: &Matrix<N, D>,
    ) -> Vector<N, D> {
        let start = N::pose(&self.start);
        let swung = (start.rotation - rotation) * self.local_center.coords;
        (start.translation - origin) + self.linear * since + swung
    }

    fn pose(&self, origin: &Vector<N, D>, time: N) -> Pose<N, D> {
        let since = time - self.start_time;
        let rotation = self.rotation_after(since) * N::pose(&self.start).rotation;
        Pose { rotation, translation: self.translation(origin, since, &rotation) }
    }

    /// Returns the distance of a body point from the axis of rotation; `offset` is the point's
    /// position relative to the centre, in the world's axes.
    pub(super) fn across(&self, offset: &Vector<N, D>) -> N {
        length(&(self.unit_spin * offset))
    }

    /// Returns the distance of a body point from the axis of rotation; `offset` is the point's
    /// position relative to the centre, in the local axes at the start.
    pub(super) fn across_local(&self, offset: &Vector<N, D>) -> N {
        self.across(&(N::pose(&self.start).rotation * offset))
    }

    fn speed(&self) -> N {
        let largest = max_component(&self.linear);
        let finite = self.linear.iter().all(|x| x.is_finite_number());
        if finite { unit(&self.linear).map_or(largest, |(_, speed)| speed) } else { N::INFINITY }
    }
}

impl<N: Real> ConstantVelocities<N, 2> {
    /// Returns the motion of a body that is at `position` at time zero. Its local origin moves by
    /// `linear` per unit of time, and it rotates by `angular` radians per unit of time, positive
    /// counter-clockwise.
    #[must_use]
    pub fn new(position: Isometry2<N>, linear: Vector<N, 2>, angular: N) -> Self {
        let side = if angular < N::ZERO { -N::ONE } else { N::ONE };
        let unit_spin = Matrix::<N, 2>::new(N::ZERO, -side, side, N::ZERO);
        Self::spinning(position, linear, unit_spin, angular.abs())
    }

    /// Returns the angular velocity in radians per unit of time, positive counter-clockwise.
    #[must_use]
    pub fn angular_velocity(&self) -> N {
        self.spin[(1, 0)]
    }

    /// Returns the motion in an outer frame, in which the present frame has the pose `isometry`: at
    /// each time `isometry * position_at(time)`.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Vector};
    /// use impinge::dim2::query::ConstantVelocities;
    /// use impinge::query::RigidMotion;
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// // On a platform that is rotated by a quarter turn, a cart drives to the platform's right.
    /// let cart = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::x(), 0.0);
    /// let platform = Isometry::new(Vector::new(5.0, 0.0), FRAC_PI_2);
    /// let seen = cart.append_transformation(&platform).position_at(3.0).translation.vector;
    /// assert!((seen - Vector::new(5.0, 3.0)).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn append_transformation(&self, isometry: &Isometry2<N>) -> Self {
        let linear = isometry.rotation * self.linear;
        Self { start: isometry * self.start, linear, ..*self }
    }

    /// Returns the motion of a body fixed to this body at `isometry` in this body's frame: at each
    /// time `position_at(time) * isometry`. The velocities, and the point that moves along a
    /// straight line, stay the same.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point, Vector};
    /// use impinge::dim2::query::ConstantVelocities;
    /// use impinge::query::RigidMotion;
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// let hub = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::zeros(), FRAC_PI_2);
    /// let blade = hub.prepend_transformation(&Isometry::translation(2.0, 0.0));
    /// let tip = blade.position_at(1.0) * Point::new(1.0, 0.0);
    /// assert!((tip - Point::new(0.0, 3.0)).norm() < 1e-15, "a quarter of a turn later");
    /// ```
    #[must_use]
    pub fn prepend_transformation(&self, isometry: &Isometry2<N>) -> Self {
        let local_center = isometry.inverse_transform_point(&self.local_center);
        Self { start: self.start * isometry, local_center, ..*self }
    }
}

impl<N: Real> ConstantVelocities<N, 3> {
    /// Returns the motion of a body that is at `position` at time zero. Its local origin moves by
    /// `linear` per unit of time. It rotates about the world direction of `angular`, by the length
    /// of `angular` in radians per unit of time.
    #[must_use]
    pub fn new(position: Isometry3<N>, linear: Vector<N, 3>, angular: Vector<N, 3>) -> Self {
        let usable = angular.iter().all(|x| x.is_finite_number());
        // An angular velocity that is not finite gives poses that are not finite.
        let none = if usable { N::ZERO } else { N::INFINITY };
        let (axis, turn) = unit(&angular).unwrap_or((Vector::<N, 3>::zeros(), none));
        Self::spinning(position, linear, axis.cross_matrix(), turn)
    }

    /// Returns the angular velocity in the world frame: the unit vector of the axis times the
    /// radians per unit of time.
    #[must_use]
    pub fn angular_velocity(&self) -> Vector<N, 3> {
        self.axis() * self.turn
    }

    /// Returns the unit vector along the axis of rotation; zero if the body does not rotate.
    fn axis(&self) -> Vector<N, 3> {
        let spin = &self.unit_spin;
        Vector::<N, 3>::new(spin[(2, 1)], spin[(0, 2)], spin[(1, 0)])
    }

    /// Returns the motion in an outer frame, in which the present frame has the pose `isometry`: at
    /// each time `isometry * position_at(time)`.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Vector};
    /// use impinge::dim3::query::ConstantVelocities;
    /// use impinge::query::RigidMotion;
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// // In a frame that is rotated by a quarter turn about x, a top spins about the frame's y.
    /// let top = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::x(), Vector::y());
    /// let frame = Isometry::new(Vector::new(5.0, 0.0, 0.0), Vector::x() * FRAC_PI_2);
    /// let seen = top.append_transformation(&frame);
    /// assert!((seen.angular_velocity() - Vector::z()).norm() < 1e-15);
    /// assert!((seen.position_at(3.0).translation.vector - Vector::x() * 8.0).norm() < 1e-15);
    /// ```
    #[must_use]
    pub fn append_transformation(&self, isometry: &Isometry3<N>) -> Self {
        let linear = isometry.rotation * self.linear;
        // The rotated axis is normalised, so that rounding does not lengthen it with repeated
        // calls.
        let axis = isometry.rotation * self.axis();
        let axis = unit(&axis).map_or(axis, |(axis, _)| axis);
        let rotated = Self::spinning(isometry * self.start, linear, axis.cross_matrix(), self.turn);
        rotated.with_start_time(self.start_time).with_local_center(self.local_center)
    }

    /// Returns the motion of a body fixed to this body at `isometry` in this body's frame: at each
    /// time `position_at(time) * isometry`. The velocities, and the point that moves along a
    /// straight line, stay the same.
    ///
    /// ```
    /// use impinge::dim3::math::{Isometry, Point, Vector};
    /// use impinge::dim3::query::ConstantVelocities;
    /// use impinge::query::RigidMotion;
    /// use std::f64::consts::FRAC_PI_2;
    ///
    /// let hub = ConstantVelocities::<f64>::new(Isometry::identity(), Vector::zeros(), Vector::z() * FRAC_PI_2);
    /// let blade = hub.prepend_transformation(&Isometry::translation(2.0, 0.0, 0.0));
    /// let tip = blade.position_at(1.0) * Point::new(1.0, 0.0, 0.0);
    /// assert!((tip - Point::new(0.0, 3.0, 0.0)).norm() < 1e-15, "a quarter of a turn later");
    /// ```
    #[must_use]
    pub fn prepend_transformation(&self, isometry: &Isometry3<N>) -> Self {
        let local_center = isometry.inverse_transform_point(&self.local_center);
        Self { start: self.start * isometry, local_center, ..*self }
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
        let since = time - self.start_time;
        let (sine, cosine) = (self.turn * since * N::HALF).sine_cosine();
        let axis = self.axis();
        let quaternion = na::Quaternion::new(cosine, axis.x * sine, axis.y * sine, axis.z * sine);
        let rotation = na::UnitQuaternion::new_normalize(quaternion) * self.start.rotation;
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
    fn a_start_time_shifts_the_motion_and_isometries_compose() {
        let rotated =
            |x: f64| Isometry3::new(Vector::<f64, 3>::new(x, -1.0, 2.0), [x, -0.2, 0.9].into());
        let angular = Vector::<f64, 3>::new(1.5, -2.5, 0.5);
        let motion =
            ConstantVelocities::<f64, 3>::new(rotated(0.3), [0.5, 2.0, -1.0].into(), angular)
                .with_local_center(Point::<f64, 3>::new(0.25, 1.5, -0.75));
        let late = motion.with_start_time(2.5);
        assert_eq!((late.start(), late.start_time()), (motion.start(), 2.5), "as given");
        assert!((late.angular_velocity() - angular).norm() < 1e-15, "as given");
        let (outer, inner) = (rotated(-2.0), rotated(1.25));
        let composed = late.append_transformation(&outer).prepend_transformation(&inner);
        let corner = Point::<f64, 3>::new(1.0, -2.0, 3.0);
        for time in [0.0, 2.5, 7.25] {
            assert_eq!(late.position_at(time), motion.position_at(time - 2.5), "at {time}");
            let expected = outer * late.position_at(time) * inner * corner;
            let found = composed.position_at(time) * corner;
            assert!((found - expected).norm() < 1e-13, "{found}, not {expected} at {time}");
            let pose = composed.pose_about(&Vector::<f64, 3>::zeros(), time);
            assert!((pose.point(&corner) - expected).norm() < 1e-13, "the pose at {time}");
        }
        let never = motion.with_start_time(f64::INFINITY);
        assert!(!never.pose_about(&Vector::<f64, 3>::zeros(), 1.0).is_finite(), "no position");
    }

    #[test]
    fn isometries_compose_2d() {
        let rotated = |x: f64| Isometry2::new(Vector::<f64, 2>::new(x, -1.0), 3.0 * x);
        let motion = ConstantVelocities::<f64, 2>::new(rotated(0.3), [0.5, 2.0].into(), -1.5)
            .with_local_center(Point::<f64, 2>::new(0.25, 1.5))
            .with_start_time(-0.5);
        let linear = Vector::<f64, 2>::new(0.5, 2.0);
        assert_eq!((motion.angular_velocity(), motion.linear_velocity()), (-1.5, &linear), "given");
        let (outer, inner) = (rotated(-2.0), rotated(1.25));
        let composed = motion.append_transformation(&outer).prepend_transformation(&inner);
        let corner = Point::<f64, 2>::new(1.0, -2.0);
        for time in [0.0, 2.5, 7.25] {
            let expected = outer * motion.position_at(time) * inner * corner;
            let found = composed.position_at(time) * corner;
            assert!((found - expected).norm() < 1e-13, "{found}, not {expected} at {time}");
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
