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
        /// The name of the placeholder, without braces.
        name: &'static str,
        /// The number of its occurrences in the template.
        count: usize,
    },
    /// A file cannot be read or written, or a folder cannot be created.
    File {
        /// The path of the file or folder.
        path: PathBuf,
        /// The reason.
        error: io::Error,
    },
    /// The server cannot be started on this port of the loopback interface, usually because another
    /// program uses the port.
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
