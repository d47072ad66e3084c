//! Errors of shape constructors.
//!
//! Every size is finite and not negative, and every coordinate finite. Constructors reject anything
//! else, so that no algorithm has to check again.

use core::fmt;

use crate::math::{Real, Vector, is_unit};
use crate::shape::{MAX_NESTING, ShapeKind};

/// The reason why a constructor rejected its input. Values are converted to `f64` without loss.
///
/// ```
/// use impinge::dim2::shape::{Ball, ShapeError};
///
/// let refused = Ball::try_new(-2.5_f32).expect_err("no radius");
/// assert!(matches!(refused, ShapeError::Negative { value: -2.5, .. }));
/// assert_eq!(refused.to_string(), "the radius is -2.5, below zero");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ShapeError {
    /// A size or coordinate is NaN or infinite.
    NotFinite {
        /// The name of the size or coordinate, as in the constructor.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// A size is below zero.
    Negative {
        /// The name of the size, as in the constructor.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// A vector that has to be a unit vector is not: its length differs from 1 by more than 0.8 %.
    NotUnit {
        /// The name of the vector, as in the constructor.
        what: &'static str,
        /// The length of the vector.
        length: f64,
    },
    /// Fewer points were given than the shape needs.
    TooFewPoints {
        /// The number of points given.
        given: usize,
        /// The number of points that the shape needs.
        needed: usize,
    },
    /// The coordinate of a point is NaN or infinite.
    PointNotFinite {
        /// The index of the first such point.
        index: usize,
    },
    /// The points do not span the shape: they coincide or lie on a line or in a plane.
    Degenerate {
        /// The dimension of the affine hull of the points: 0 for a point, 1 for a line, 2 for a
        /// plane.
        dimension: usize,
    },
    /// The points given as a convex outline turn the wrong way, fold back or go around more than
    /// once.
    NotConvex {
        /// The index of the point at which this is detected.
        index: usize,
    },
    /// A face of a solid refers to a point that does not exist.
    NoSuchPoint {
        /// The index of the face.
        face: usize,
        /// The point index that the face contains.
        point: u32,
        /// The number of points.
        points: usize,
    },
    /// The faces of a solid do not close: a side of a face is not a side of exactly one other face.
    NotClosed {
        /// The index of a face with such a side.
        face: usize,
    },
    /// A face of a solid is not on the convex hull of its points, so the solid is not convex.
    FaceNotOnHull {
        /// The index of the face.
        face: usize,
    },
    /// A shape of this kind is not both bounded and convex, so it has no rounded variant.
    NotRoundable {
        /// The kind of the shape.
        kind: ShapeKind,
    },
    /// A compound was given no children.
    NoChildren,
    /// The position of a child of a compound is NaN or infinite.
    ChildPoseNotFinite {
        /// The index of the child.
        index: usize,
    },
    /// The rotation of a child's position, a complex number or quaternion, is not of unit length:
    /// its length differs from 1 by more than 0.8 %.
    ChildRotation {
        /// The index of the child.
        index: usize,
        /// The length of the complex number or quaternion.
        length: f64,
    },
    /// The nesting depth of compounds and rounded shapes exceeds
    /// [`MAX_NESTING`](crate::shape::MAX_NESTING).
    TooDeep {
        /// The nesting depth that the shape would have.
        depth: u32,
    },
    /// The parts do not fit 32-bit indices.
    TooManyParts {
        /// The number of parts.
        needed: u64,
    },
    /// A height field has too few heights along an axis for one cell.
    TooFewHeights {
        /// The number of heights along the axis.
        given: usize,
        /// The number of heights that one cell needs.
        needed: usize,
    },
    /// The number of heights differs from the number of rows times the number of columns.
    WrongHeightCount {
        /// The number of heights given.
        given: usize,
        /// The number of rows times the number of columns.
        needed: usize,
    },
    /// A height, or the height times the scale, is NaN or infinite.
    HeightNotFinite {
        /// The index of the row; 0 in 2D.
        row: usize,
        /// The index of the column.
        column: usize,
    },
}

impl fmt::Display for ShapeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { what, value } => write!(f, "{what} is {value}, which is not finite"),
            Self::Negative { what, value } => write!(f, "{what} is {value}, below zero"),
            Self::NotUnit { what, length } => write!(f, "{what} has the length {length}, not 1"),
            Self::TooFewPoints { given, needed } => {
                write!(f, "{given} points were given, at least {needed} are needed")
            }
            Self::PointNotFinite { index } => write!(f, "point {index} is not finite"),
            Self::Degenerate { dimension } => {
                let where_they_are = match dimension {
                    0 => "coincide",
                    1 => "lie on one line",
                    _ => "lie in one plane",
                };
                write!(f, "the points span no solid: they {where_they_are}")
            }
            Self::NotRoundable { kind } => {
                write!(f, "{kind:?} is not a bounded convex solid and cannot be rounded")
            }
            Self::NoSuchPoint { face, point, points } => {
                write!(f, "face {face} names point {point}, but there are {points}")
            }
            Self::NotClosed { face } => {
                write!(f, "a side of face {face} is not that of exactly one other face")
            }
            Self::FaceNotOnHull { face } => {
                write!(f, "face {face} is not on the convex hull of the points")
            }
            Self::NotConvex { index } => write!(f, "the outline is not convex at point {index}"),
            Self::NoChildren => write!(f, "a compound needs a child at least"),
            Self::ChildPoseNotFinite { index } => {
                write!(f, "the position of child {index} is not finite")
            }
            Self::ChildRotation { index, length } => {
                write!(f, "the rotation of child {index} has the length {length}, not 1")
            }
            Self::TooDeep { depth } => {
                write!(f, "the shape is nested {depth} deep, at most {MAX_NESTING} are allowed")
            }
            Self::TooManyParts { needed } => {
                write!(f, "{needed} parts are more than 32 bits can number")
            }
            Self::TooFewHeights { given, needed } => {
                write!(f, "a height field needs {needed} heights along each axis, {given} is given")
            }
            Self::WrongHeightCount { given, needed } => {
                write!(f, "{given} heights were given, {needed} are needed")
            }
            Self::HeightNotFinite { row, column } => {
                write!(f, "the height at row {row}, column {column} is not finite")
            }
        }
    }
}

impl std::error::Error for ShapeError {}

/// Checks that `vector` is finite and its length within 0.8 % of 1, a margin for accumulated
/// rounding.
pub(super) fn unit_vector<N: Real, const D: usize>(
    what: &'static str,
    vector: &Vector<N, D>,
) -> Result<(), ShapeError> {
    finite(what, vector)?;
    let squared = vector.norm_squared();
    if is_unit(squared) {
        return Ok(());
    }
    Err(ShapeError::NotUnit { what, length: squared.as_f64().sqrt() })
}

/// Returns the nesting depth of a shape that holds shapes with the depths `inner`: one more than
/// the deepest.
///
/// # Errors
/// If the depth exceeds [`MAX_NESTING`].
pub(super) fn nesting(inner: impl Iterator<Item = u32>) -> Result<u32, ShapeError> {
    let depth = inner.max().map_or(1, |inner| inner.saturating_add(1));
    if depth <= MAX_NESTING { Ok(depth) } else { Err(ShapeError::TooDeep { depth }) }
}

/// Checks that a size is finite and not negative, and returns it.
pub(super) fn size<N: Real>(what: &'static str, value: N) -> Result<N, ShapeError> {
    if !value.is_finite_number() {
        return Err(ShapeError::NotFinite { what, value: value.as_f64() });
    }
    if value < N::ZERO {
        return Err(ShapeError::Negative { what, value: value.as_f64() });
    }
    Ok(value)
}

/// Checks that all coordinates are finite.
pub(super) fn finite<N: Real, const D: usize>(
    what: &'static str,
    coordinates: &Vector<N, D>,
) -> Result<(), ShapeError> {
    match coordinates.iter().find(|x| !x.is_finite_number()) {
        Some(value) => Err(ShapeError::NotFinite { what, value: value.as_f64() }),
        None => Ok(()),
    }
}

/// Returns the value, or panics with the text of the error. Panicking constructors end with this
/// call.
#[track_caller]
pub(super) fn or_panic<S>(result: Result<S, ShapeError>) -> S {
    match result {
        Ok(shape) => shape,
        Err(error) => panic!("{error}"),
    }
}
