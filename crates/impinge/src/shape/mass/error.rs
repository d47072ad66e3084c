//! Errors of mass properties.

use core::fmt;

/// Why a shape, or some numbers, have no mass properties. Values are given as `f64`, exactly.
///
/// `part` is the part number that queries use: 0 for a shape of one part; `path_to_part` of the
/// shape translates it for a nested compound.
///
/// ```
/// use impinge::dim3::math::Vector;
/// use impinge::dim3::query::{MassError, mass_properties};
/// use impinge::dim3::shape::{Cuboid, HalfSpace};
///
/// let ground = HalfSpace::<f64>::new(Vector::y_axis());
/// let refused = mass_properties(&ground, 1.0).expect_err("it has no end");
/// assert_eq!(refused, MassError::Unbounded { part: 0 });
/// let refused = mass_properties(&Cuboid::new(Vector::new(1.0_f64, 1.0, 1.0)), -2.0).expect_err("no density");
/// assert_eq!(refused.to_string(), "the density is -2, below zero");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum MassError {
    /// An input, or a number of the result, is NaN or infinite. A mass or a moment is infinite if
    /// it exceeds the range of the scalar.
    NotFinite {
        /// Which number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// An input is below zero.
    Negative {
        /// Which number.
        what: &'static str,
        /// The number.
        value: f64,
    },
    /// The shape is, or contains, a half-space: its mass is infinite.
    Unbounded {
        /// The part that is a half-space.
        part: u32,
    },
    /// A surface or line bounds no solid: an open mesh, a mesh whose triangles disagree about the
    /// front, an open polyline, a polyline in 3D, a height field, a user's surface.
    NotClosed {
        /// In a triangle mesh the first triangle with an open side or a side in the wrong
        /// direction, else the first part.
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

/// Checks that a number is finite.
pub(crate) fn finite(what: &'static str, value: f64) -> Result<f64, MassError> {
    if value.is_finite() { Ok(value) } else { Err(MassError::NotFinite { what, value }) }
}

/// Checks that a number is finite and not below zero.
pub(crate) fn amount(what: &'static str, value: f64) -> Result<f64, MassError> {
    if value < 0.0 { Err(MassError::Negative { what, value }) } else { finite(what, value) }
}
