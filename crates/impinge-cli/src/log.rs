//! Reads recordings of worlds of any scalar, dimension and type of data.

use std::path::{Path, PathBuf};

use impinge::math::Space;
use impinge::world::CollisionObject;
use impinge_files::{Dimension, ScalarFile};
use impinge_record::{Header, Loss, Problem, ReadError, Registry, Replay};

use crate::error::CliError;
use crate::input;
use crate::output::{Subject, note};
use crate::space::{Kind, Stage, Task, run_in};

/// The data of a recorded object as bytes. If they are text, they are the name of the object.
pub(crate) type Label = Vec<u8>;

/// A recording whose header was decoded.
#[derive(Debug)]
pub(crate) struct Log {
    pub(crate) path: PathBuf,
    pub(crate) bytes: Vec<u8>,
    pub(crate) header: Header,
    pub(crate) kind: Kind,
}

impl Log {
    /// Reads a recording from a file or from standard input, and decodes its header.
    pub(crate) fn read(path: &Path) -> Result<Self, CliError> {
        Self::of_bytes(path, input::read(path)?)
    }

    /// Creates a log from the bytes of a recording.
    pub(crate) fn of_bytes(path: &Path, bytes: Vec<u8>) -> Result<Self, CliError> {
        let header = Header::read(&bytes).map_err(in_file(path))?;
        let kind = kind_of(&header).ok_or_else(|| CliError::ForeignRecording {
            path: path.to_owned(),
            scalar_bytes: header.scalar_bytes,
            dimension: header.dimension,
        })?;
        Ok(Self { path: path.to_owned(), bytes, header, kind })
    }

    /// Returns the name of the file for reports.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Returns the first fields of a report about the recording.
    pub(crate) fn subject(&self) -> Subject {
        Subject { file: self.name(), kind: self.kind }
    }

    /// Opens the recording at step 0.
    ///
    /// If its end is missing or damaged, for example after a crash of the program that wrote it,
    /// the earlier records are replayed. A note then gives the number of their steps. Other
    /// problems, such as an unknown shape, are errors.
    pub(crate) fn replay<N: Stage<D>, const D: usize>(
        &self,
    ) -> Result<Replay<N, D, Label>, CliError> {
        let replay = Replay::salvage(self.bytes.as_slice(), &Registry::new());
        let replay = replay.map_err(in_file(&self.path))?;
        match replay.loss() {
            None => {}
            Some(Loss { error, bytes, .. }) if is_damage(error) => note(format_args!(
                "{}: the end of the recording cannot be read ({error}): {} steps are kept, {bytes} bytes left out",
                self.path.display(),
                replay.len()
            )),
            Some(Loss { error, .. }) => return Err(in_file(&self.path)(error.clone())),
        }
        Ok(replay)
    }

    /// Opens the recording at `step`, or at its last step. A step that the recording does not have
    /// is an error.
    pub(crate) fn replay_to<N: Stage<D>, const D: usize>(
        &self,
        step: Option<usize>,
    ) -> Result<Replay<N, D, Label>, CliError> {
        let mut replay = self.replay()?;
        let last = replay.len();
        let step = step.unwrap_or(last);
        self.expect_step(step, last)?;
        replay.seek(step).map_err(in_file(&self.path))?;
        Ok(replay)
    }

    /// Returns an error if `step` is beyond the last step. `Replay::seek` would go to the last step
    /// without an error.
    pub(crate) fn expect_step(&self, step: usize, last: usize) -> Result<(), CliError> {
        if step > last {
            return Err(CliError::NoStep { path: self.path.clone(), step, last });
        }
        Ok(())
    }

    /// Returns the bytes for a page: all whole records. The page accepts a recording without its
    /// end, but no incomplete record.
    ///
    /// A recording with unknown shapes is returned unchanged, since it cannot be replayed here. The
    /// page shows balls in their place.
    pub(crate) fn into_page_bytes(self) -> Result<Vec<u8>, CliError> {
        match run_in(self.kind, WholeRecords(&self)) {
            Err(CliError::Recording { error, .. })
                if matches!(error.problem, Problem::UnknownShape(_)) =>
            {
                Ok(self.bytes)
            }
            bytes => bytes,
        }
    }
}

/// Replays a recording, and returns the bytes of its whole records.
struct WholeRecords<'a>(&'a Log);

impl Task for WholeRecords<'_> {
    type Answer = Vec<u8>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<u8>, CliError> {
        Ok(self.0.replay::<N, D>()?.bytes().to_vec())
    }
}

/// Returns `true` if the recording is incomplete or was changed after it was written. After a power
/// failure a file system may return zeros for the last bytes, whose checksum is then wrong.
const fn is_damage(error: &ReadError) -> bool {
    matches!(error.problem, Problem::Truncated | Problem::Checksum)
}

/// Returns a function that converts an error of a recording to an error of its file.
pub(crate) fn in_file(path: &Path) -> impl Fn(ReadError) -> CliError {
    let path = path.to_owned();
    move |error| CliError::Recording { path: path.clone(), error }
}

/// Returns the scalar and dimension of a recording; `None` if the library does not support them.
const fn kind_of(header: &Header) -> Option<Kind> {
    let scalar = match header.scalar_bytes {
        4 => ScalarFile::F32,
        8 => ScalarFile::F64,
        _ => return None,
    };
    let dimension = match header.dimension {
        2 => Dimension::Two,
        3 => Dimension::Three,
        _ => return None,
    };
    Some(Kind { dimension, scalar })
}

/// Returns the name of a recorded object: its data if that is a text, not empty and without control
/// characters; otherwise `#` and the index of its handle.
pub(crate) fn name_of<N: Space<D>, const D: usize>(
    object: &CollisionObject<N, D, Label>,
) -> String {
    let text = core::str::from_utf8(object.data()).unwrap_or_default();
    if text.is_empty() || text.chars().any(char::is_control) {
        format!("#{}", object.handle().uid())
    } else {
        text.to_owned()
    }
}
