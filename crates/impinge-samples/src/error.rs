//! Errors of running a sample.

use core::fmt;

use impinge_record::RecordError;

use crate::ControlValue;

/// An error of a sample. After an error about a control, no control has changed.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum SampleError {
    /// The sample has no control with this name.
    UnknownControl(String),
    /// The kind of the value differs from the kind of the control.
    WrongKind {
        /// The name of the control.
        name: &'static str,
        /// The rejected value.
        value: ControlValue,
    },
    /// The number is NaN or out of bounds.
    OutOfBounds {
        /// The name of the control.
        name: &'static str,
        /// The rejected value.
        value: f64,
        /// The smallest and the largest value.
        bounds: [f64; 2],
    },
    /// The choice does not contain this word.
    UnknownChoice {
        /// The name of the control.
        name: &'static str,
        /// The rejected word.
        value: String,
    },
    /// The recorder rejects a call, such as a position that is not finite or the handle of a
    /// removed object.
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
