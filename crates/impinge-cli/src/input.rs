//! Reads the input of the command: scenes or recordings, from files or from standard input.

use std::fs::{self, File};
use std::io::{self, Read as _};
use std::path::Path;

use impinge_record::{Header, Problem};

use crate::args::{SceneArgs, is_stdin};
use crate::error::CliError;
use crate::log::Log;
use crate::scene::Loaded;

/// A scene or a recording.
#[derive(Debug)]
pub(crate) enum Input {
    /// A scene that was read from a scene file, a mesh or a robot.
    Scene(Box<Loaded>),
    /// A recording.
    Recording(Box<Log>),
}

/// The number of bytes that are read from a file to identify a recording.
const HEAD: u64 = 64;

impl Input {
    /// Reads a file as the kind of input that its first bytes indicate.
    ///
    /// The first bytes of a scene are read twice: its reader takes a path, since a mesh may name
    /// other files in its folder.
    pub(crate) fn open(args: &SceneArgs) -> Result<Self, CliError> {
        let path = &args.scene;
        if is_stdin(path) {
            // A stream can be read only once.
            let bytes = stdin(args.reading.limits.of_files().bytes)?;
            return if is_recording(&bytes) {
                Ok(Self::Recording(Box::new(Log::of_bytes(path, bytes)?)))
            } else {
                Ok(Self::Scene(Box::new(Loaded::of_stdin(bytes, &args.reading)?)))
            };
        }
        Ok(if is_recording(&head(path)?) {
            Self::Recording(Box::new(Log::read(path)?))
        } else {
            Self::Scene(Box::new(Loaded::read(args)?))
        })
    }
}

/// Returns `true` if the bytes begin like a recording, even a truncated one or one of an unknown
/// version. The input is then read as a recording, so that an error is not about JSON.
fn is_recording(head: &[u8]) -> bool {
    !Header::read(head).is_err_and(|error| error.problem == Problem::NotARecording)
}

/// Returns the first [`HEAD`] bytes of a file, or all if it is shorter.
fn head(path: &Path) -> Result<Vec<u8>, CliError> {
    let mut head = Vec::new();
    let read = regular(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    read.map_err(CliError::reading(path))?;
    Ok(head)
}

/// Returns the bytes of a recording, or of standard input for `-`.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, CliError> {
    if is_stdin(path) {
        return stdin(usize::MAX);
    }
    let mut bytes = Vec::new();
    let read = regular(path).and_then(|mut file| file.read_to_end(&mut bytes));
    read.map_err(CliError::reading(path))?;
    Ok(bytes)
}

/// Opens a regular file. Other files are errors, since opening a pipe would wait for a writer.
fn regular(path: &Path) -> io::Result<File> {
    if fs::metadata(path)?.is_file() {
        return File::open(path);
    }
    Err(io::Error::other("it is no regular file; `-` reads standard input"))
}

/// Returns all bytes of standard input; an error if they are more than `limit`.
pub(crate) fn stdin(limit: usize) -> Result<Vec<u8>, CliError> {
    let mut bytes = Vec::new();
    let read = io::stdin().lock().take((limit as u64).saturating_add(1)).read_to_end(&mut bytes);
    read.map_err(CliError::reading(Path::new("-")))?;
    if bytes.len() > limit { Err(CliError::TooLong { limit }) } else { Ok(bytes) }
}
