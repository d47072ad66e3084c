//! Bodies, which move with the frames, and obstacles, which are at rest.

use crate::math::{Pose, Real};
use crate::shape::ShapeHandle;

/// A shape fixed to a frame.
///
/// ```
/// use impinge::dim2::checker::Body;
/// use impinge::dim2::math::Pose;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
///
/// let hand = Body { frame: 3, shape: ShapeHandle::new(Ball::new(0.1_f64)), pose: Pose::identity() };
/// assert_eq!(hand.frame, 3);
/// ```
#[derive(Clone, Debug)]
pub struct Body<N: Real, const D: usize> {
    /// The index of the frame to which the shape is fixed.
    pub frame: usize,
    /// The shape of the body.
    pub shape: ShapeHandle<N, D>,
    /// The pose of the shape in the frame.
    pub pose: Pose<N, D>,
}

/// A shape at rest in the world.
///
/// ```
/// use impinge::dim2::checker::Obstacle;
/// use impinge::dim2::math::{Pose, Vector};
/// use impinge::dim2::shape::{Ball, ShapeHandle};
///
/// let pose = Pose::from_translation(Vector::new(1.0_f32, 0.0));
/// let pillar = Obstacle { shape: ShapeHandle::new(Ball::new(0.5)), pose };
/// assert_eq!(pillar.pose.translation.x, 1.0);
/// ```
#[derive(Clone, Debug)]
pub struct Obstacle<N: Real, const D: usize> {
    /// The shape of the obstacle.
    pub shape: ShapeHandle<N, D>,
    /// The pose of the shape in the world.
    pub pose: Pose<N, D>,
}
