//! Recordings as the command reads them: of any scalar, dimension and data.

use std::path::{Path, PathBuf};

use impinge::math::Space;
use impinge::world::CollisionObject;
use impinge_files::Dimension;
use impinge_record::{Header, ReadError};

use crate::args::ScalarName;
use crate::error::CliError;
use crate::output;
use crate::space::Kind;

/// The data of a recorded object: any bytes, which are its name if they are text.
pub(crate) type Label = Vec<u8>;

/// The bytes of a recording, and what its header says.
#[derive(Debug)]
pub(crate) struct Log {
    pub(crate) path: PathBuf,
    pub(crate) bytes: Vec<u8>,
    pub(crate) header: Header,
    pub(crate) kind: Kind,
}

impl Log {
    /// Reads the header of a recording in a file.
    pub(crate) fn read(path: &Path) -> Result<Self, CliError> {
        Self::of_bytes(path, output::read(path)?)
    }

    /// Reads the header of a recording that was in a file.
    pub(crate) fn of_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, CliError> {
        let header = Header::read(&bytes).map_err(in_file(path))?;
        let kind = kind_of(&header).ok_or_else(|| CliError::ForeignRecording {
            path: path.to_owned(),
            scalar_bytes: header.scalar_bytes,
            dimension: header.dimension,
        })?;
        Ok(Self { path: path.to_owned(), bytes, header, kind })
    }

    /// The file, as reports name it.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }
}

/// A problem of a recording as one of a file.
pub(crate) fn in_file(path: &Path) -> impl Fn(ReadError) -> CliError {
    let path = path.to_owned();
    move |error| CliError::Recording { path: path.clone(), error }
}

const fn kind_of(header: &Header) -> Option<Kind> {
    let scalar = match header.scalar_bytes {
        4 => ScalarName::F32,
        8 => ScalarName::F64,
        _ => return None,
    };
    let dimension = match header.dimension {
        2 => Dimension::Two,
        3 => Dimension::Three,
        _ => return None,
    };
    Some(Kind { scalar, dimension })
}

/// Objects that a report can name.
pub(crate) trait Named {
    /// The name.
    fn name(&self) -> String;
}

impl<N: Space<D>, const D: usize> Named for CollisionObject<N, D, Label> {
    /// The data, if it is text that can be printed; else the index of the handle.
    fn name(&self) -> String {
        let text = core::str::from_utf8(self.data()).unwrap_or_default();
        if text.is_empty() || text.chars().any(char::is_control) {
            format!("#{}", self.handle().uid())
        } else {
            text.to_owned()
        }
    }
}

impl<N: Space<D>, const D: usize> Named for CollisionObject<N, D, String> {
    fn name(&self) -> String {
        self.data().clone()
    }
}
