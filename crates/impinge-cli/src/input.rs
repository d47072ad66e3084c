//! Files that may be scenes or recordings.

use std::fs::File;
use std::io::Read as _;

use impinge_record::{Header, Problem};

use crate::args::{SceneArgs, is_stdin};
use crate::error::CliError;
use crate::output;
use crate::recording::Log;
use crate::scene::Loaded;

/// A scene or a recording.
#[derive(Debug)]
pub(crate) enum Input {
    /// A scene, a mesh or a robot.
    Scene(Box<Loaded>),
    /// A recording.
    Recording(Box<Log>),
}

/// A recording is known by fewer bytes.
const HEAD: u64 = 64;

impl Input {
    /// Reads a file as what its first bytes say. On standard input there is a scene.
    pub(crate) fn open(args: &SceneArgs) -> Result<Self, CliError> {
        let path = &args.scene;
        if is_stdin(path) {
            return Ok(Self::Scene(Box::new(Loaded::read(args)?)));
        }
        let failed = |error| CliError::Read { path: path.clone(), error };
        let mut head = Vec::new();
        File::open(path).map_err(failed)?.take(HEAD).read_to_end(&mut head).map_err(failed)?;
        let is_scene =
            Header::read(&head).is_err_and(|error| error.problem == Problem::NotARecording);
        Ok(if is_scene {
            Self::Scene(Box::new(Loaded::read(args)?))
        } else {
            Self::Recording(Box::new(Log::of_bytes(path, output::read(path)?)?))
        })
    }
}
