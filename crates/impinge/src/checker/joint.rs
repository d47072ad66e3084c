//! Joints: how one frame moves on another.

use crate::math::{Matrix, Pose, Real, Unit, Vector};

/// How a frame moves on its parent: by a number of the configuration, or not at all.
///
/// A revolute joint turns by radians about an axis through the frame's origin, in 2D counter-clockwise; a prismatic
/// joint shifts along an axis. The axis is in the frame of the joint. The number is that of a column of the
/// configuration, times a factor, plus an offset: so one column drives several joints.
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

/// What a joint does with its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum JointMotion<N: Real, const D: usize> {
    Fixed,
    /// Turns by the rotation whose generator this is: v ↦ axis × v, in 2D a quarter turn.
    Turn(Matrix<N, D>),
    /// Shifts along a unit vector.
    Slide(Vector<N, D>),
}

impl<N: Real, const D: usize> Joint<N, D> {
    /// No motion.
    #[must_use]
    pub fn fixed() -> Self {
        Self::driven(JointMotion::Fixed, 0)
    }

    /// Shifts along an axis by the number in a column.
    #[must_use]
    pub fn prismatic(axis: Unit<Vector<N, D>>, column: usize) -> Self {
        Self::driven(JointMotion::Slide(axis.into_inner()), column)
    }

    /// Turns by the rotation exp(θ K) with the number θ in a column and the generator K: v ↦ axis × v of a unit axis in
    /// 3D, a quarter turn in 2D.
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

    /// With a number that is multiplied by this; 1 at first.
    #[must_use]
    pub const fn with_factor(self, factor: N) -> Self {
        Self { factor, ..self }
    }

    /// With a number to which this is added; 0 at first.
    #[must_use]
    pub const fn with_offset(self, offset: N) -> Self {
        Self { offset, ..self }
    }

    /// The column of the configuration that moves it; `None` of a fixed joint.
    #[must_use]
    pub fn column(&self) -> Option<usize> {
        (self.motion != JointMotion::Fixed).then_some(self.column)
    }

    /// What a number in its column means for it: radians or a length.
    #[inline]
    #[must_use]
    pub fn value_at(&self, number: N) -> N {
        number * self.factor + self.offset
    }

    /// Its axis is a unit vector, or its generator that of a turn about one, up to rounding: other numbers would stretch
    /// what they move.
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

    /// All its numbers are finite.
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
    /// Turns counter-clockwise by the radians in a column.
    #[must_use]
    pub fn revolute(column: usize) -> Self {
        let quarter = Matrix::<N, 2>::new(N::ZERO, -N::ONE, N::ONE, N::ZERO);
        Self::turning(quarter, column)
    }
}

impl<N: Real> Joint<N, 3> {
    /// Turns about an axis by the radians in a column, by the rule of the right hand.
    #[must_use]
    pub fn revolute(axis: Unit<Vector<N, 3>>, column: usize) -> Self {
        Self::turning(axis.cross_matrix(), column)
    }
}

/// A frame on its parent, or on the world.
///
/// It stands at `parent ∘ origin ∘ motion of the joint`.
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
    /// The number of the frame that it moves on; `None` for the world.
    pub parent: Option<usize>,
    /// Where its joint is in the frame of the parent.
    pub origin: Pose<N, D>,
    /// How it moves.
    pub joint: Joint<N, D>,
}
