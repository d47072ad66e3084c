//! Scaling of shapes: the result is exact up to rounding, or an error is returned.

use core::fmt;

use crate::bounding_volume::Aabb;
use crate::math::{Point, Real, Vector};
use crate::shape::{MeshError, ShapeError};

/// The reason why a shape cannot be scaled.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::shape::{Cylinder, ScaleError, ShapeHandle};
///
/// let cylinder = ShapeHandle::new(Cylinder::new(1.0_f32, 0.5));
/// assert!(cylinder.scaled(&Vector::new(2.0, 5.0, 2.0)).is_ok());
/// let refused = cylinder.scaled(&Vector::new(2.0, 1.0, 1.0)).expect_err("not round");
/// assert!(matches!(refused, ScaleError::NotSuch { .. }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ScaleError {
    /// A factor is zero, infinite or NaN.
    BadFactor {
        /// The index of the axis: 0 for x.
        axis: usize,
        /// The factor along that axis.
        value: f64,
    },
    /// No shape of the library can represent the scaled solid: the solid would be sheared, its
    /// circular section would become an ellipse, or a cone would be reversed.
    NotSuch {
        /// The condition that the factors must meet.
        needs: &'static str,
    },
    /// The scaled coordinates exceed the range of the scalar type: they overflow, or a solid would
    /// lose its extent along an axis, or a half-space its normal.
    OutOfRange,
    /// A child of a compound cannot be scaled by these factors, because of its shape or its
    /// rotation.
    Child {
        /// The index of the child.
        index: usize,
    },
    /// Shapes of this type cannot be scaled.
    Unsupported,
}

impl fmt::Display for ScaleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadFactor { axis, value } => {
                write!(f, "the scale along axis {axis} is {value}")
            }
            Self::NotSuch { needs } => write!(f, "the shape cannot be scaled so: it needs {needs}"),
            Self::OutOfRange => write!(f, "the scaled shape is too large or too small"),
            Self::Child { index } => write!(f, "child {index} cannot be scaled so"),
            Self::Unsupported => write!(f, "shapes of this type are not scaled"),
        }
    }
}

impl std::error::Error for ScaleError {}

/// The constructor of an already valid shape can fail only because its scaled sizes are out of
/// range.
impl From<ShapeError> for ScaleError {
    fn from(_: ShapeError) -> Self {
        Self::OutOfRange
    }
}

/// The scaling of an already valid mesh can fail only because of the factors, or because scaled
/// coordinates are out of range.
impl From<MeshError> for ScaleError {
    fn from(error: MeshError) -> Self {
        match error {
            MeshError::BadScale { axis, value } => Self::BadFactor { axis, value },
            _ => Self::OutOfRange,
        }
    }
}

/// Scale factors along the axes of a shape's frame: finite, and not zero.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scale<'a, N: Real, const D: usize>(&'a Vector<N, D>);

impl<'a, N: Real, const D: usize> Scale<'a, N, D> {
    /// Returns the factors as a scale; an error if one is zero or not finite.
    pub(super) fn try_new(factors: &'a Vector<N, D>) -> Result<Self, ScaleError> {
        let is_bad = |x: &N| *x == N::ZERO || !x.is_finite_number();
        match factors.iter().position(is_bad) {
            Some(axis) => Err(ScaleError::BadFactor { axis, value: factors[axis].as_f64() }),
            None => Ok(Self(factors)),
        }
    }

    /// Returns the magnitudes of the factors.
    pub(super) fn magnitudes(self) -> Vector<N, D> {
        self.0.abs()
    }

    /// Returns the signs of the factors, 1 or −1.
    pub(super) fn signs(self) -> Vector<N, D> {
        self.0.map(|x| if x < N::ZERO { -N::ONE } else { N::ONE })
    }

    /// Returns whether the scale mirrors: an odd number of factors is negative.
    pub(super) fn is_mirror(self) -> bool {
        self.0.iter().filter(|&&x| x < N::ZERO).count() % 2 == 1
    }

    /// Returns the common magnitude of the factors.
    ///
    /// # Errors
    /// If the magnitudes differ.
    pub(super) fn uniform(self) -> Result<N, ScaleError> {
        let magnitudes = self.magnitudes();
        let is_uniform = magnitudes.iter().all(|&x| x == magnitudes[0]);
        let needs = "factors that differ in sign at most";
        if is_uniform { Ok(magnitudes[0]) } else { Err(ScaleError::NotSuch { needs }) }
    }

    pub(super) fn vector(self, v: &Vector<N, D>) -> Vector<N, D> {
        v.component_mul(self.0)
    }

    pub(super) fn point(self, point: &Point<N, D>) -> Point<N, D> {
        Point::from(self.vector(&point.coords))
    }

    /// Returns the scaled corners of a solid with a volume.
    ///
    /// # Errors
    /// If the extent along an axis vanishes or overflows.
    pub(super) fn corners(self, points: &[Point<N, D>]) -> Result<Vec<Point<N, D>>, ScaleError> {
        let scaled: Vec<_> = points.iter().map(|point| self.point(point)).collect();
        let solid = Aabb::from_points(&scaled).filter(Aabb::is_bounded);
        let solid = solid.filter(|aabb| (0..D).all(|axis| aabb.maxs()[axis] > aabb.mins()[axis]));
        solid.map(|_| scaled).ok_or(ScaleError::OutOfRange)
    }

    /// Returns the outward unit normal of a scaled half-space with the outward normal `normal`.
    ///
    /// # Errors
    /// If the scaled normal vanishes or is not finite.
    pub(super) fn normal(self, normal: &Vector<N, D>) -> Result<Vector<N, D>, ScaleError> {
        let largest = self.magnitudes().iter().copied().fold(N::ZERO, crate::math::max);
        let inverse = normal.component_div(&(self.0 / largest));
        crate::math::unit(&inverse).map(|(along, _)| along).ok_or(ScaleError::OutOfRange)
    }
}

impl<N: Real> Scale<'_, N, 3> {
    /// Returns two magnitudes of the factors: along the y axis, and across it.
    ///
    /// # Errors
    /// If the magnitudes along x and z differ.
    pub(super) fn axial(self) -> Result<(N, N), ScaleError> {
        let magnitudes = self.magnitudes();
        let needs = "factors along x and z that differ in sign at most";
        if magnitudes.x == magnitudes.z {
            Ok((magnitudes.y, magnitudes.x))
        } else {
            Err(ScaleError::NotSuch { needs })
        }
    }
}
