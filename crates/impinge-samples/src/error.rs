//! Errors of samples.

use core::fmt;

use impinge_record::RecordError;

use crate::ControlValue;

/// An error of a sample. An invalid control has changed nothing.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SampleError {
    /// The sample has no control of this name.
    UnknownControl(String),
    /// The kind of the value differs from that of the control.
    WrongKind {
        /// The control.
        name: &'static str,
        /// The value.
        value: ControlValue,
    },
    /// The number is NaN or out of bounds.
    OutOfBounds {
        /// The control.
        name: &'static str,
        /// The value.
        value: f64,
        /// The least and the greatest value.
        bounds: [f64; 2],
    },
    /// The control has no such choice.
    UnknownChoice {
        /// The control.
        name: &'static str,
        /// The value.
        value: String,
    },
    /// The world rejects a call: a position that is not finite, or the handle of a removed object.
    World(RecordError),
}

impl From<RecordError> for SampleError {
    fn from(error: RecordError) -> Self {
        Self::World(error)
    }
}

impl fmt::Display for SampleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::UnknownControl(name) => write!(f, "there is no control {name:?}"),
            Self::WrongKind { name, value } => write!(f, "{name} cannot be {value:?}"),
            Self::OutOfBounds { name, value, bounds: [min, max] } => {
                write!(f, "{name} is {value}, not from {min} to {max}")
            }
            Self::UnknownChoice { name, value } => write!(f, "{name} has no choice {value:?}"),
            Self::World(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for SampleError {}
