//! Arguments of the verbs that write or read recordings.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::{Format, KeyFrames, OutputFile, SceneArgs, Stepping};

/// Move the objects of a scene and record every step.
///
/// Objects move by the motions of the scene. A recording contains each call that changed the world,
/// and the hashes of its results. `replay` and `validate` read it on any machine.
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

/// Print the state at the steps of a recording.
///
/// Without `--step` a line is printed for each step; with `--step`, the objects and pairs after
/// that step. The end of a recording is missing if the program that wrote it crashed. If the end is
/// missing or damaged, the earlier steps are replayed, and a note on standard error gives their
/// number.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge replay balls.implog
  impinge replay balls.implog --step 20
  impinge replay balls.implog --step 20 --json

Fields of --json: file, dimension, scalar, steps with step, objects, touching, near, contacts, started, stopped
(the pairs that began and ceased to touch since the step before);
with --step also positions (name, translation, rotation: cosine and sine in 2D, i, j, k, w in 3D) and pairs (first,
second, state, contacts, depth). Exit code 1 if something touches at the last step printed.")]
pub(crate) struct ReplayArgs {
    /// A recording; `-` is standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) log: PathBuf,
    /// The step to print, which is the number of updates before it
    #[arg(long, value_name = "N")]
    pub(crate) step: Option<usize>,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Check that recordings replay to the same bits.
///
/// Every call of a recording is repeated, and its results are compared by their hashes: positions,
/// pairs, contacts, proximities, events and results of queries. A recording without its end is an
/// error.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge validate balls.implog
  impinge validate balls.implog balls.implog --json

Fields of --json: recordings with file, steps, same, and difference (step, byte, object, field) or null. The
step is the first that differs, as `replay --step` counts. Exit code 1 if one differs.")]
pub(crate) struct ValidateArgs {
    /// The recordings; `-` is standard input
    #[arg(required = true, value_hint = ValueHint::FilePath)]
    pub(crate) logs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) format: Format,
}
