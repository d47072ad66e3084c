//! The errors of recording a call, and of reading a recording.

use core::fmt;

use impinge::shape::{MeshError, ShapeError};
use impinge::world::{GroupError, WorldError};

/// An error that a constructor or method of the library returned for values of a file or recording.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LibraryError {
    /// A shape is invalid.
    Shape(ShapeError),
    /// A mesh or polyline is invalid.
    Mesh(MeshError),
    /// Collision groups are invalid.
    Group(GroupError),
    /// A world rejects a call.
    World(WorldError),
}

impl fmt::Display for LibraryError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Shape(error) => error.fmt(f),
            Self::Mesh(error) => error.fmt(f),
            Self::Group(error) => error.fmt(f),
            Self::World(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for LibraryError {}

impl From<ShapeError> for LibraryError {
    fn from(error: ShapeError) -> Self {
        Self::Shape(error)
    }
}

impl From<MeshError> for LibraryError {
    fn from(error: MeshError) -> Self {
        Self::Mesh(error)
    }
}

impl From<GroupError> for LibraryError {
    fn from(error: GroupError) -> Self {
        Self::Group(error)
    }
}

impl From<WorldError> for LibraryError {
    fn from(error: WorldError) -> Self {
        Self::World(error)
    }
}

/// The reason why a call was not recorded. The world and the recording are then unchanged.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum RecordError {
    /// The world rejects the call.
    World(WorldError),
    /// The shape has a user-defined type, and the registry has no name for it.
    UnknownShape {
        /// The shape, as `Debug` prints it.
        shape: String,
    },
    /// The constructors of the library cannot reproduce this shape to the bit. It is a mesh or
    /// polyline that was deformed so that vertices coincide that were distinct, or the reverse.
    Deformed {
        /// The shape, as `Debug` prints it.
        shape: String,
    },
    /// The shape nests more than [`MAX_DEPTH`](crate::MAX_DEPTH) shapes, or has more than
    /// [`MAX_PARTS`](crate::MAX_PARTS) parts.
    TooComplex,
    /// The registry has no pair filter of this name.
    UnknownFilter(String),
}

impl From<WorldError> for RecordError {
    fn from(error: WorldError) -> Self {
        Self::World(error)
    }
}

impl fmt::Display for RecordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::World(error) => error.fmt(f),
            Self::UnknownShape { shape } => {
                write!(f, "the registry does not name the shape {shape}")
            }
            Self::Deformed { shape } => write!(f, "no constructor makes {shape} again to the bit"),
            Self::TooComplex => write!(f, "the shape is nested too deep or has too many parts"),
            Self::UnknownFilter(name) => write!(f, "the registry has no pair filter {name:?}"),
        }
    }
}

impl std::error::Error for RecordError {}

/// The reason why bytes are not a valid recording, and its position.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadError {
    /// The offset of the field, in bytes from the beginning of the recording.
    pub offset: usize,
    /// The problem at that position.
    pub problem: Problem,
}

/// A problem of a recording.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Problem {
    /// The bytes do not begin with the signature of a recording.
    NotARecording,
    /// The version of the format is not supported: it is 0 or newer than this crate.
    Version {
        /// The version of the recording.
        found: u32,
    },
    /// The recording has numbers of another scalar than the requested one.
    Scalar {
        /// The number of bytes of a scalar in the recording.
        found: u8,
    },
    /// The recording has worlds of another dimension.
    Dimension {
        /// The dimension of the recording.
        found: u8,
    },
    /// The bytes end early, or a length exceeds its record.
    Truncated,
    /// The checksum of a record is wrong: a byte of this record or of an earlier one was changed.
    Checksum,
    /// Compressed bytes of a packed recording are damaged.
    Compression,
    /// A recording, or a part of it, is too large to be packed or unpacked.
    TooLarge {
        /// The number of bytes.
        bytes: u64,
    },
    /// A record has bytes after its fields, or bytes follow the last record.
    TrailingBytes,
    /// The kind of a record is unknown.
    UnknownRecord(u8),
    /// A field has an invalid value.
    BadValue {
        /// A description of the field.
        what: &'static str,
    },
    /// A record has the index of a shape that is not defined before it.
    NoSuchShape(u32),
    /// A call has the index of an object that does not exist.
    NoSuchObject(u32),
    /// In the replay a new object got another index than in the recording.
    OtherIndex {
        /// The index in the recording.
        recorded: u32,
        /// The index in the replayed world.
        replayed: usize,
    },
    /// The library rejects a shape, groups or a call.
    Library(LibraryError),
    /// A shape is nested too deep or has too many parts.
    TooComplex,
    /// The registry has no shape of this name.
    UnknownShape(String),
    /// The registry has no pair filter of this name.
    UnknownFilter(String),
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotARecording => write!(f, "this is not a recording"),
            Self::Version { found } => write!(f, "version {found} of the format is not known"),
            Self::Scalar { found } => write!(f, "the numbers have {found} bytes"),
            Self::Dimension { found } => write!(f, "the world has {found} dimensions"),
            Self::Truncated => write!(f, "the bytes end early"),
            Self::Checksum => write!(f, "the checksum is wrong"),
            Self::Compression => write!(f, "the compressed bytes are damaged"),
            Self::TooLarge { bytes } => write!(f, "{bytes} bytes are too many"),
            Self::TrailingBytes => write!(f, "bytes follow the last field"),
            Self::UnknownRecord(kind) => write!(f, "there is no record of kind {kind}"),
            Self::BadValue { what } => write!(f, "{what} has an impossible value"),
            Self::NoSuchShape(index) => write!(f, "shape {index} is not defined before"),
            Self::NoSuchObject(index) => write!(f, "there is no object {index}"),
            Self::OtherIndex { recorded, replayed } => {
                write!(f, "object {recorded} became object {replayed}")
            }
            Self::Library(error) => error.fmt(f),
            Self::TooComplex => write!(f, "the shape is nested too deep or has too many parts"),
            Self::UnknownShape(name) => write!(f, "the registry does not name the shape {name:?}"),
            Self::UnknownFilter(name) => write!(f, "the registry has no pair filter {name:?}"),
        }
    }
}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "at byte {}: {}", self.offset, self.problem)
    }
}

impl std::error::Error for ReadError {}

impl<E: Into<LibraryError>> From<E> for Problem {
    fn from(error: E) -> Self {
        Self::Library(error.into())
    }
}
