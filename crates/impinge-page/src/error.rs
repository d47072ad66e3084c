//! The errors that a message can cause.

use core::fmt;

use impinge::world::WorldError;
use impinge_record::{Problem, ReadError, RecordError};
use impinge_samples::SampleError;

/// The reason why a message is rejected. The error message is for developers who embed the engine;
/// the page translates the [`code`](EngineError::code) into a message for its users.
#[derive(Debug)]
#[non_exhaustive]
pub enum EngineError {
    /// The message ends before the JSON text does.
    Truncated {
        /// The number of bytes that the message should have.
        wanted: u64,
        /// The number of bytes that the message has.
        found: usize,
    },
    /// The text is not JSON, or not a message.
    Json(serde_json::Error),
    /// No stage is open.
    NothingOpen,
    /// The gallery has no sample of this name.
    UnknownSample(String),
    /// The operation is for recordings only: a sample has no recorded steps, and no bytes can be
    /// appended to it. The text names what a sample lacks.
    OfRecordings(&'static str),
    /// The operation is not for this recording: recordings have no controls, and only growing ones
    /// accept bytes. The text names what the recording lacks.
    OfSamples(&'static str),
    /// The message requests more steps than one message may request.
    TooManySteps(u64),
    /// No object has a handle with this index.
    NoObject(u32),
    /// Both objects of a requested pair are this object.
    OneObject(u32),
    /// The quaternion has length zero, or is not finite.
    Rotation([f64; 4]),
    /// The value of a control has an invalid type, for instance a list.
    Value(String),
    /// The bytes are not a recording that can be replayed.
    Read(ReadError),
    /// The dimension of a recording is neither 2 nor 3, or its numbers have neither 4 nor 8 bytes.
    Kind {
        /// The dimension.
        dimension: u8,
        /// The number of bytes of each number.
        scalar_bytes: u8,
    },
    /// The world rejects a change.
    World(WorldError),
    /// The sample rejects a change.
    Sample(SampleError),
}

impl EngineError {
    /// Returns the code of the error; `PROTOCOL.md` lists the codes.
    #[must_use]
    pub const fn code(&self) -> &'static str {
        match self {
            Self::NothingOpen
            | Self::Truncated { .. }
            | Self::Json(_)
            | Self::OfRecordings(_)
            | Self::OfSamples(_)
            | Self::TooManySteps(_)
            | Self::OneObject(_)
            | Self::Rotation(_)
            | Self::Value(_) => "message",
            Self::UnknownSample(_) => "unknown-sample",
            Self::NoObject(_) => "no-object",
            Self::World(_) => "world",
            Self::Sample(_) => "sample",
            Self::Kind { .. } => "foreign",
            Self::Read(error) => match error.problem {
                Problem::NotARecording => "no-recording",
                Problem::Version { .. } => "version",
                Problem::UnknownShape(_) | Problem::UnknownFilter(_) => "foreign",
                _ => "damaged",
            },
        }
    }
}

impl fmt::Display for EngineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Truncated { wanted, found } => {
                write!(f, "the message has {found} bytes, its text asks for {wanted}")
            }
            Self::Json(error) => write!(f, "the message is not understood: {error}"),
            Self::NothingOpen => f.write_str("nothing is open"),
            Self::UnknownSample(name) => write!(f, "there is no sample {name:?}"),
            Self::OfRecordings(what) => write!(f, "a sample has no {what}"),
            Self::OfSamples(what) => write!(f, "a recording has no {what}"),
            Self::TooManySteps(steps) => {
                write!(f, "{steps} steps at once are more than {}", crate::stage::MAX_STEPS)
            }
            Self::NoObject(object) => write!(f, "there is no object {object}"),
            Self::OneObject(object) => write!(f, "object {object} and itself are no pair"),
            Self::Rotation(rotation) => write!(f, "{rotation:?} is no rotation"),
            Self::Value(value) => write!(f, "{value} is no value of a control"),
            Self::Read(error) => error.fmt(f),
            Self::Kind { dimension, scalar_bytes } => write!(
                f,
                "there are no worlds of dimension {dimension} with numbers of {scalar_bytes} bytes"
            ),
            Self::World(error) => error.fmt(f),
            Self::Sample(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for EngineError {}

impl From<serde_json::Error> for EngineError {
    fn from(error: serde_json::Error) -> Self {
        Self::Json(error)
    }
}

impl From<ReadError> for EngineError {
    fn from(error: ReadError) -> Self {
        Self::Read(error)
    }
}

impl From<WorldError> for EngineError {
    fn from(error: WorldError) -> Self {
        Self::World(error)
    }
}

impl From<SampleError> for EngineError {
    fn from(error: SampleError) -> Self {
        Self::Sample(error)
    }
}

impl From<RecordError> for EngineError {
    fn from(error: RecordError) -> Self {
        Self::Sample(error.into())
    }
}
