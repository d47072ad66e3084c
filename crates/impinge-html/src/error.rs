//! The errors of building and serving pages.

use core::fmt;
use std::io;
use std::path::{Path, PathBuf};

use impinge_record::ReadError;

/// The reason why a page cannot be built or served.
#[derive(Debug)]
#[non_exhaustive]
pub enum HtmlError {
    /// The bytes are not a recording that can be packed.
    Recording(ReadError),
    /// The template does not contain this placeholder exactly once.
    Placeholder {
        /// The placeholder.
        name: &'static str,
        /// The number of its occurrences in the template.
        count: usize,
    },
    /// A file cannot be read or written.
    File {
        /// The file.
        path: PathBuf,
        /// The reason.
        error: io::Error,
    },
    /// The port of the loopback interface cannot be opened. Usually another program uses it.
    Port {
        /// The port.
        port: u16,
        /// The reason.
        error: io::Error,
    },
}

impl HtmlError {
    pub(crate) fn file(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::File { path: path.to_owned(), error }
    }
}

impl From<ReadError> for HtmlError {
    fn from(error: ReadError) -> Self {
        Self::Recording(error)
    }
}

impl fmt::Display for HtmlError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Recording(error) => write!(f, "the recording cannot be packed: {error}"),
            Self::Placeholder { name, count } => {
                write!(f, "the template has {{{{{name}}}}} {count} times instead of once")
            }
            Self::File { path, error } => write!(f, "{}: {error}", path.display()),
            Self::Port { port, error } => write!(f, "port {port} cannot be used: {error}"),
        }
    }
}

impl std::error::Error for HtmlError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Recording(error) => Some(error),
            Self::File { error, .. } | Self::Port { error, .. } => Some(error),
            Self::Placeholder { .. } => None,
        }
    }
}
