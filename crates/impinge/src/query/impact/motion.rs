//! Motions of rigid bodies: poses over time, and bounds of the speed.

use super::ConstantVelocities;
use crate::math::{Point, Pose, Space, Vector};

/// The motion of a rigid body.
///
/// Times start at zero, in any unit; positions are in the world frame. Speeds are bounded, not
/// given: too high a bound costs steps, too low a bound may miss an impact. One bound is for the
/// speed of one point of the body, [`Self::local_center`], the other for the angular speed; both
/// are independent of the shape.
///
/// Example: a pendulum of length 2 that swings about the origin with the angle `cos t`:
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
    /// Returns the position of the body at a time, zero or more.
    fn position_at(&self, time: N) -> N::Isometry;

    /// Returns an upper bound of the speed of the point [`Self::local_center`] at all times between
    /// `from` and `to`; `to` may be infinite. Infinite if there is no bound; the library then
    /// queries shorter spans. A negative result or NaN is treated as infinite.
    fn speed_bound(&self, from: N, to: N) -> N;

    /// Returns an upper bound of the angular speed, in radians per unit of time, at all times
    /// between `from` and `to`; `to` may be infinite. Infinite if there is no bound; a negative
    /// result or NaN is treated as infinite.
    fn turn_bound(&self, from: N, to: N) -> N;

    /// Returns the point of the body, in its local frame, whose speed [`Self::speed_bound`] bounds.
    /// The default is the origin; the centre of the shape, or the fixed point of the rotation,
    /// saves steps.
    fn local_center(&self) -> Point<N, D> {
        Point::origin()
    }

    /// Returns [`Self::position_at`] as a pose in the world frame translated so that `origin` is
    /// its origin. An override can avoid rounding errors far from the world's origin: the
    /// algorithms use only differences of positions.
    fn pose_about(&self, origin: &Vector<N, D>, time: N) -> Pose<N, D> {
        let pose = N::pose(&self.position_at(time));
        Pose { rotation: pose.rotation, translation: pose.translation - origin }
    }

    /// Returns the motion if it has constant velocities: the body's speed is then known in each
    /// direction, which saves steps. Override it in wrappers; `None` (the default) is always valid.
    fn constant_velocities(&self) -> Option<&ConstantVelocities<N, D>> {
        None
    }
}
