//! Joints, which move a frame relative to its parent frame.

use crate::math::{Matrix, Pose, Real, Unit, Vector};

/// A joint: the motion of a frame relative to its parent frame, driven by a number of the
/// configuration, or fixed.
///
/// A revolute joint rotates about an axis through the frame's origin, in 2D counter-clockwise; a
/// prismatic joint slides along an axis. The axis is in the frame of the joint. The joint value, in
/// radians or as a length, is the number in a column of the configuration times a factor plus an
/// offset. So one column can drive several joints.
///
/// ```
/// use impinge::dim3::checker::Joint;
/// use impinge::dim3::math::Vector;
///
/// let finger: Joint<f64> = Joint::prismatic(Vector::y_axis(), 7);
/// let mirrored = finger.with_factor(-1.0).with_offset(0.5);
/// assert_eq!((mirrored.column(), mirrored.value_at(0.25)), (Some(7), 0.25));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joint<N: Real, const D: usize> {
    pub(super) motion: JointMotion<N, D>,
    column: usize,
    factor: N,
    offset: N,
}

/// The motion of a joint as a function of its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum JointMotion<N: Real, const D: usize> {
    Fixed,
    /// A rotation with this generator: v ↦ axis × v in 3D, the rotation by 90° in 2D.
    Turn(Matrix<N, D>),
    /// A translation along this unit vector.
    Slide(Vector<N, D>),
}

impl<N: Real, const D: usize> Joint<N, D> {
    /// Returns a joint without motion.
    #[must_use]
    pub fn fixed() -> Self {
        Self::driven(JointMotion::Fixed, 0)
    }

    /// Returns a joint that slides along an axis by the number in a column.
    #[must_use]
    pub fn prismatic(axis: Unit<Vector<N, D>>, column: usize) -> Self {
        Self::driven(JointMotion::Slide(axis.into_inner()), column)
    }

    /// Returns a joint with the rotation exp(θ K), where θ is the number in a column and K the
    /// generator. In 3D the generator is v ↦ axis × v for a unit axis, in 2D a rotation by 90°.
    ///
    /// ```
    /// use impinge::dim2::checker::Joint;
    /// use impinge::dim2::math::Matrix;
    ///
    /// assert_eq!(Joint::turning(Matrix::new(0.0, -1.0, 1.0, 0.0), 3), Joint::<f64>::revolute(3));
    /// ```
    #[must_use]
    pub const fn turning(generator: Matrix<N, D>, column: usize) -> Self {
        Self::driven(JointMotion::Turn(generator), column)
    }

    const fn driven(motion: JointMotion<N, D>, column: usize) -> Self {
        Self { motion, column, factor: N::ONE, offset: N::ZERO }
    }

    /// Returns the joint with its number multiplied by `factor`, which is 1 by default.
    #[must_use]
    pub const fn with_factor(self, factor: N) -> Self {
        Self { factor, ..self }
    }

    /// Returns the joint with `offset` added to the product of its number and factor; 0 by default.
    #[must_use]
    pub const fn with_offset(self, offset: N) -> Self {
        Self { offset, ..self }
    }

    /// Returns the column of the configuration that drives the joint; `None` for a fixed joint.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        (self.motion != JointMotion::Fixed).then_some(self.column)
    }

    /// Converts the number in the joint's column to the joint value: radians or a length.
    #[inline]
    #[must_use]
    pub fn value_at(&self, number: N) -> N {
        number * self.factor + self.offset
    }

    /// Returns whether the axis is a unit vector, or the generator generates a rotation about a
    /// unit axis, up to rounding. Another generator would distort the bodies; another axis would
    /// scale the joint value.
    pub(super) fn has_unit_axis(&self) -> bool {
        let is_one = |x: N| (x - N::ONE).abs() <= N::lit(64.0) * N::EPSILON;
        match &self.motion {
            JointMotion::Fixed => true,
            JointMotion::Turn(generator) => {
                let is_skew = *generator == -generator.transpose();
                is_skew && is_one(generator.norm_squared() * N::HALF)
            }
            JointMotion::Slide(axis) => is_one(axis.norm_squared()),
        }
    }

    /// Returns whether all numbers of the joint are finite.
    pub(super) fn is_finite(&self) -> bool {
        let of_motion = match &self.motion {
            JointMotion::Fixed => true,
            JointMotion::Turn(generator) => generator.iter().all(|x| x.is_finite_number()),
            JointMotion::Slide(axis) => axis.iter().all(|x| x.is_finite_number()),
        };
        of_motion && self.factor.is_finite_number() && self.offset.is_finite_number()
    }
}

impl<N: Real> Joint<N, 2> {
    /// Returns a joint that rotates counter-clockwise by the radians in a column.
    #[must_use]
    pub fn revolute(column: usize) -> Self {
        let quarter = Matrix::<N, 2>::new(N::ZERO, -N::ONE, N::ONE, N::ZERO);
        Self::turning(quarter, column)
    }
}

impl<N: Real> Joint<N, 3> {
    /// Returns a joint that rotates about an axis by the radians in a column, by the right-hand
    /// rule.
    #[must_use]
    pub fn revolute(axis: Unit<Vector<N, 3>>, column: usize) -> Self {
        Self::turning(axis.cross_matrix(), column)
    }
}

/// A frame that a joint connects to its parent frame or to the world.
///
/// The pose of the frame in its parent's frame is `origin ∘ motion of the joint`.
///
/// ```
/// use impinge::dim2::checker::{Frame, Joint};
/// use impinge::dim2::math::{Pose, Vector};
///
/// let elbow: Frame<f64> = Frame {
///     parent: Some(0),
///     origin: Pose::from_translation(Vector::new(1.0, 0.0)),
///     joint: Joint::revolute(1),
/// };
/// assert_eq!(elbow.joint.column(), Some(1));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<N: Real, const D: usize> {
    /// The index of the parent frame; `None` for the world.
    pub parent: Option<usize>,
    /// The pose of the joint in the frame of the parent.
    pub origin: Pose<N, D>,
    /// The motion of the frame relative to `origin`.
    pub joint: Joint<N, D>,
}
