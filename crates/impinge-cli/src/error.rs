//! The errors of the command.

use core::fmt;
use std::io;
use std::path::{Path, PathBuf};

use impinge_files::{Printable, Problem};
use impinge_html::HtmlError;
use impinge_record::{ReadError, RecordError};
use impinge_samples::SampleError;

/// An error that ends the command with exit code 2. The message names the file or the argument at
/// fault, if there is one.
#[derive(Debug)]
pub(crate) enum CliError {
    /// A scene, mesh or robot file is invalid.
    File(impinge_files::FileError),
    /// A file cannot be read.
    Read { path: PathBuf, error: io::Error },
    /// A file cannot be written.
    Write { path: PathBuf, error: io::Error },
    /// Standard output cannot be written.
    Output(io::Error),
    /// A recording cannot be replayed.
    Recording { path: PathBuf, error: ReadError },
    /// The recording has a scalar or dimension that the library does not support.
    ForeignRecording { path: PathBuf, scalar_bytes: u8, dimension: u8 },
    /// The recorder rejects a call.
    Record(RecordError),
    /// A page cannot be written or served.
    Page(HtmlError),
    /// The command was built without the page, and the arguments name no folder with a page.
    NoPage,
    /// A sample cannot run.
    Sample { name: &'static str, error: SampleError },
    /// The recording has fewer steps than the requested one.
    NoStep { path: PathBuf, step: usize, last: usize },
    /// The library rejects the objects of a scene.
    Objects(String),
    /// The number of pairs of objects that are near each other exceeds the limit.
    TooManyPairs { limit: usize },
    /// Standard input is longer than the limit, in bytes.
    TooLong { limit: usize },
    /// The scene has no object with this name. `similar` is the most similar name of an object, if
    /// one is similar.
    NoObject { path: PathBuf, name: String, similar: Option<String> },
    /// An argument is invalid for the scene or recording.
    Argument { name: &'static str, value: String, reason: String },
}

impl CliError {
    /// Returns a function that creates the error of reading a file.
    pub(crate) fn reading(path: &Path) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::Read { path: path.to_owned(), error }
    }

    /// Creates the error for an argument that is invalid for the scene or recording.
    pub(crate) fn argument(
        name: &'static str,
        value: impl fmt::Display,
        reason: impl fmt::Display,
    ) -> Self {
        Self::Argument { name, value: value.to_string(), reason: reason.to_string() }
    }
}

impl fmt::Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(error) => {
                error.fmt(f)?;
                match &*error.problem {
                    Problem::Limit { limit, .. } => write!(f, "; here --max-{}", limit.name()),
                    Problem::Outside { .. } => write!(f, "; --root allows another one"),
                    _ => Ok(()),
                }
            }
            Self::Objects(reason) => f.write_str(reason),
            Self::TooManyPairs { limit } => write!(
                f,
                "more than {limit} pairs of objects are near each other: --max-pairs raises the limit"
            ),
            Self::TooLong { limit } => write!(
                f,
                "standard input has more than {limit} bytes: --max-bytes raises the limit"
            ),
            Self::Read { path, error } => write!(f, "{}: cannot be read: {error}", path.display()),
            Self::Write { path, error } => {
                write!(f, "{}: cannot be written: {error}", path.display())
            }
            Self::Output(error) => write!(f, "standard output: {error}"),
            Self::Recording { path, error } => write!(f, "{}: {error}", path.display()),
            Self::ForeignRecording { path, scalar_bytes, dimension } => write!(
                f,
                "{}: the recording has {dimension} dimensions and numbers of {scalar_bytes} bytes",
                path.display()
            ),
            Self::Record(error) => write!(f, "the scene cannot be recorded: {error}"),
            Self::Page(error) => error.fmt(f),
            Self::NoPage => f.write_str(
                "this command was built without the page: build it with `--features page`, or name a folder \
                 with its parts by --page",
            ),
            Self::Sample { name, error } => write!(f, "the sample {name}: {error}"),
            Self::NoStep { path, step, last } => {
                write!(f, "{}: there is no step {step}, the last is {last}", path.display())
            }
            Self::NoObject { path, name, similar } => {
                let name = Printable(name);
                write!(f, "{}: no object has the name \"{name}\"", path.display())?;
                let similar = similar.as_deref().map(Printable);
                similar.map_or(Ok(()), |similar| write!(f, "; did you mean \"{similar}\"?"))
            }
            Self::Argument { name, value, reason } => write!(f, "{name} {value}: {reason}"),
        }
    }
}

impl std::error::Error for CliError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::File(error) => Some(error),
            Self::Read { error, .. } | Self::Write { error, .. } | Self::Output(error) => {
                Some(error)
            }
            Self::Recording { error, .. } => Some(error),
            Self::Record(error) => Some(error),
            Self::Page(error) => Some(error),
            Self::Sample { error, .. } => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for CliError {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

impl From<RecordError> for CliError {
    fn from(error: RecordError) -> Self {
        Self::Record(error)
    }
}

impl From<impinge_files::FileError> for CliError {
    fn from(error: impinge_files::FileError) -> Self {
        Self::File(error)
    }
}

impl From<HtmlError> for CliError {
    fn from(error: HtmlError) -> Self {
        Self::Page(error)
    }
}
