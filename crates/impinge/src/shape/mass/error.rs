//! Errors of mass properties.

use core::fmt;

/// The reason why a shape has no mass properties, or why given values are not mass properties.
/// Values are converted to `f64` without loss.
///
/// `part` is the part index that queries use: 0 for a shape of one part. `path_to_part` of the
/// shape converts it to a path in nested compounds.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::query::{MassError, mass_properties};
/// use impinge::dim3::shape::{Cuboid, HalfSpace};
///
/// let floor = HalfSpace::<f64>::new(Vector::y_axis());
/// let refused = mass_properties(&floor, 1.0).expect_err("it has no end");
/// assert_eq!(refused, MassError::Unbounded { part: 0 });
/// let refused = mass_properties(&Cuboid::new(Vector::new(1.0_f64, 1.0, 1.0)), -2.0).expect_err("no density");
/// assert_eq!(refused.to_string(), "the density is -2, below zero");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MassError {
    /// An input, or a component of the result, is NaN or infinite. A mass or a moment is infinite
    /// if it exceeds the range of the scalar.
    NotFinite {
        /// The name of the quantity.
        what: &'static str,
        /// The value.
        value: f64,
    },
    /// An input is below zero.
    Negative {
        /// The name of the input.
        what: &'static str,
        /// The value given.
        value: f64,
    },
    /// The shape is, or contains, a half-space, whose mass is infinite.
    Unbounded {
        /// The index of the part that is a half-space.
        part: u32,
    },
    /// A surface or line bounds no solid: an open mesh, a mesh whose triangles disagree about the
    /// front, an open polyline, a polyline in 3D, a height field, or a user's surface.
    NotClosed {
        /// For a triangle mesh, the index of the first triangle with an open side or a side in the
        /// wrong direction. For other shapes, the index of the first part.
        part: u32,
    },
}

impl fmt::Display for MassError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { what, value } => write!(f, "{what} is {value}, which is not finite"),
            Self::Negative { what, value } => write!(f, "{what} is {value}, below zero"),
            Self::Unbounded { part } => {
                write!(f, "part {part} is a half-space, whose mass is infinite")
            }
            Self::NotClosed { part } => {
                write!(f, "the surface is not closed at part {part}, so it bounds no mass")
            }
        }
    }
}

impl std::error::Error for MassError {}

/// Returns the number `value`, or an error if it is not finite.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<f64, MassError> {
    if value.is_finite() { Ok(value) } else { Err(MassError::NotFinite { what, value }) }
}

/// Returns the number `value`, or an error if it is negative or not finite.
pub(crate) fn amount(what: &'static str, value: f64) -> Result<f64, MassError> {
    if value < 0.0 { Err(MassError::Negative { what, value }) } else { finite(what, value) }
}
