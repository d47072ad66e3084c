//! Arguments of the verbs about recordings.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::{Format, KeyFrames, OutputFile, SceneArgs, Stepping};

/// Move the objects of a scene and record every step.
///
/// Objects move by the motions of the scene. A recording has each call that changed the world and the hashes of
/// its results: `replay` and `validate` read it, on any machine.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge record balls.json -o balls.implog --steps 30
  impinge record balls.json -o slow.implog --steps 10 --dt 0.001
  impinge record balls.json -o long.implog --steps 600 --key-frames 60

Fields of --json: file, dimension, scalar, output, steps, bytes, objects, touched (steps with a contact or an intersection).")]
pub(crate) struct RecordArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) output: OutputFile,
    #[command(flatten)]
    pub(crate) stepping: Stepping,
    #[command(flatten)]
    pub(crate) key_frames: KeyFrames,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// The state at the steps of a recording.
///
/// Without `--step` a line for each step; with it the objects and pairs after that step. If the end of a recording
/// is missing, because the program that wrote it crashed, or damaged, the earlier steps are replayed; a note on
/// standard error gives their number.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge replay balls.implog
  impinge replay balls.implog --step 20
  impinge replay balls.implog --step 20 --json

Fields of --json: file, dimension, scalar, steps with step, objects, touching, near, contacts, started, stopped;
with --step also positions (name, translation, rotation: cosine and sine in 2D, i, j, k, w in 3D) and pairs (first,
second, state, contacts, depth). Exit code 1 if something touches at the last step printed.")]
pub(crate) struct ReplayArgs {
    /// A recording; `-` is standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) log: PathBuf,
    /// The step to print: the number of earlier updates
    #[arg(long, value_name = "N")]
    pub(crate) step: Option<usize>,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Whether recordings replay to the same bits.
///
/// Every call of a recording is repeated, and its results are compared by their hashes: positions, pairs,
/// contacts, proximities, events and results of queries. A recording without its end is an error.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge validate balls.implog
  impinge validate balls.implog balls.implog --json

Fields of --json: recordings with file, steps, same, and difference (step, byte, object, field) or null. Exit
code 1 if one differs.")]
pub(crate) struct ValidateArgs {
    /// Recordings; `-` is standard input
    #[arg(required = true, value_hint = ValueHint::FilePath)]
    pub(crate) logs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) format: Format,
}
