//! Errors of batches: invalid input, and cancellation.

use core::fmt;

/// The reason why the input of a batch was rejected, or why the batch ended early.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Shapes, Side};
/// use impinge::dim2::math::Pose;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
///
/// let shapes: Vec<ShapeHandle<f64>> = vec![ShapeHandle::new(Ball::new(1.0)); 2];
/// let poses = vec![Pose::identity(); 3];
/// let refused = Side::try_new(Shapes::Each(&shapes), &poses).expect_err("two and three");
/// assert_eq!(refused, BatchError::Length { argument: "poses", given: 3, needed: 2 });
/// assert_eq!(refused.to_string(), "`poses` has 3 elements where 2 are needed");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BatchError {
    /// The length of an array does not fit the batch.
    Length {
        /// The name of the array.
        argument: &'static str,
        /// The length of the array.
        given: usize,
        /// The required length.
        needed: usize,
    },
    /// The length of a flat array is not a multiple of the row length.
    PartialRow {
        /// The name of the array.
        argument: &'static str,
        /// The length of the array.
        given: usize,
        /// The length of a row.
        width: usize,
    },
    /// The shape index of an element is not less than the number of shapes.
    Pick {
        /// The index of the element.
        index: usize,
        /// The shape index of the element.
        pick: u32,
        /// The number of shapes.
        shapes: usize,
    },
    /// A matrix is not a pose.
    Matrix {
        /// The index of the matrix.
        index: usize,
        /// The reason.
        error: MatrixError,
    },
    /// The distance limit of pairs is negative or NaN.
    Distance {
        /// The distance limit.
        value: f64,
    },
    /// The index of a tile is not less than the number of tiles, or zero tiles were requested.
    NoTile {
        /// The index of the tile; 0 if zero tiles were requested.
        tile: u32,
        /// The number of tiles.
        tiles: u32,
    },
    /// The axis of a cut between tiles does not exist, or the position of the cut is not finite or
    /// lies outside the region that it divides.
    TileCut {
        /// The index of the cut.
        index: usize,
        /// The axis of the cut: 0 for x.
        axis: u32,
        /// The position of the cut on the axis.
        at: f64,
    },
    /// The number of elements does not fit in 32 bits.
    TooMany {
        /// The number of elements given.
        given: usize,
    },
    /// The callback of the [`Control`](super::Control) ended the batch.
    Cancelled {
        /// The number of finished elements that was last reported.
        done: usize,
    },
}

/// The reason why a matrix is not a pose; indices of rows and columns start at zero.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Matrices, MatrixError};
///
/// let mirror = [-1.0_f64, 0.0, 5.0, 0.0, 1.0, 5.0, 0.0, 0.0, 1.0];
/// let error = MatrixError::NotARotation { determinant: -1.0 };
/// assert_eq!(Matrices::<f64>::try_new(&mirror).err(), Some(BatchError::Matrix { index: 0, error }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MatrixError {
    /// An entry is infinite or NaN.
    NotFinite {
        /// The row of the entry.
        row: usize,
        /// The column of the entry.
        column: usize,
        /// The value of the entry.
        value: f64,
    },
    /// The last row is not 0, …, 0, 1.
    LastRow {
        /// The column of the wrong entry.
        column: usize,
        /// The value of the entry.
        value: f64,
    },
    /// Two columns of the rotation are not perpendicular, or one is not a unit vector.
    NotOrthogonal {
        /// The indices of both columns; equal if a column is not a unit vector.
        columns: [usize; 2],
        /// The scalar product of the columns. It must be within 2⁻¹⁶ of 0, or of 1 if both indices
        /// are equal.
        product: f64,
    },
    /// The rotation part is a reflection.
    NotARotation {
        /// The determinant of the rotation part; it must be positive.
        determinant: f64,
    },
}

impl fmt::Display for BatchError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Length { argument, given, needed } => {
                write!(f, "`{argument}` has {given} elements where {needed} are needed")
            }
            Self::PartialRow { argument, given, width } => {
                write!(f, "`{argument}` has {given} numbers, which are not whole rows of {width}")
            }
            Self::Pick { index, pick, shapes } => {
                write!(f, "element {index} picks shape {pick} of {shapes}")
            }
            Self::Matrix { index, error } => write!(f, "matrix {index} is no pose: {error}"),
            Self::Distance { value } => {
                write!(f, "the distance is {value}, where zero or more is needed")
            }
            Self::NoTile { tiles: 0, .. } => {
                write!(f, "there are to be 0 tiles, where 1 or more are needed")
            }
            Self::NoTile { tile, tiles } => write!(f, "there is no tile {tile} of {tiles}"),
            Self::TileCut { index, axis, at } => {
                write!(f, "cut {index} at {at} on axis {axis} is outside what it cuts")
            }
            Self::TooMany { given } => {
                write!(f, "{given} elements are more than 32 bits can number")
            }
            Self::Cancelled { done } => write!(f, "cancelled after {done} elements"),
        }
    }
}

impl fmt::Display for MatrixError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { row, column, value } => {
                write!(f, "the entry in row {row} and column {column} is {value}")
            }
            Self::LastRow { column, value } => {
                write!(f, "the last row has {value} in column {column}, where 0, …, 0, 1 is needed")
            }
            Self::NotOrthogonal { columns: [one, other], product } if one == other => {
                write!(f, "column {one} of the rotation has the squared length {product}")
            }
            Self::NotOrthogonal { columns: [one, other], product } => {
                write!(f, "columns {one} and {other} of the rotation have the product {product}")
            }
            Self::NotARotation { determinant } => {
                write!(f, "the rotation has the determinant {determinant}")
            }
        }
    }
}

impl core::error::Error for BatchError {
    fn source(&self) -> Option<&(dyn core::error::Error + 'static)> {
        match self {
            Self::Matrix { error, .. } => Some(error),
            _ => None,
        }
    }
}

impl core::error::Error for MatrixError {}
