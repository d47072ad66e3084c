//! Motions of rigid bodies: poses over time, and bounds of the speed.

use super::ConstantVelocities;
use crate::math::{Point, Pose, Space, Vector};

/// The motion of a rigid body.
///
/// Times count from zero, in any unit; the frame is the world's. Speeds are bounded, not given: a
/// bound that is too high costs steps, one that is too low may miss an impact. The bounds are for
/// one point of the body, [`Self::local_center`], and for the angular speed, whatever the shape.
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
    /// Returns the position of the body at a time, zero or more.
    fn position_at(&self, time: N) -> N::Isometry;

    /// An upper bound of the speed of the point [`Self::local_center`] at all times between `from`
    /// and `to`, the latter of which may be infinite. Infinite if there is no bound; then shorter
    /// spans are queried. A negative number or NaN counts as infinite.
    fn speed_bound(&self, from: N, to: N) -> N;

    /// An upper bound of the angular speed, in radians per unit of time, at all times between
    /// `from` and `to`; with the conventions of [`Self::speed_bound`].
    fn turn_bound(&self, from: N, to: N) -> N;

    /// The point of the body, in its local frame, whose speed is bounded. The origin by default;
    /// the centre of the shape, or the fixed point of the rotation, saves steps.
    fn local_center(&self) -> Point<N, D> {
        Point::origin()
    }

    /// [`Self::position_at`] as a pose in the world frame moved to `origin`. Overriding it keeps
    /// digits far from the world's origin: the algorithms use differences of positions only.
    fn pose_about(&self, origin: &Vector<N, D>, time: N) -> Pose<N, D> {
        let pose = N::pose(&self.position_at(time));
        Pose { rotation: pose.rotation, translation: pose.translation - origin }
    }

    /// The motion, if it has constant velocities: then the body's speed is known in each direction,
    /// which saves steps. For wrappers; `None` (the default) is always right.
    fn constant_velocities(&self) -> Option<&ConstantVelocities<N, D>> {
        None
    }
}
