//! Arguments of the verbs that read whole scenes.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::{Format, NonNegative, Reading, SceneArgs, Stepping};

/// Find the objects that touch, or that are within a clearance.
///
/// All pairs of objects that may interact by their groups are checked; the broad phase culls
/// distant pairs. With `self_collision` in its groups, an object whose shape has parts is also a
/// pair with itself: its parts that share no vertex are checked. `touch` means that the distance is zero. The depth is then the length of the
/// shortest translation that separates the objects. `near` means that the distance is at most the
/// clearance.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge check boxes.json                      the pairs that touch
  impinge check parts.obj --clearance 0.01      the groups of a mesh, nearer than a hundredth
  impinge check boxes.json --json               for programs
  impinge check - < boxes.json                  from standard input

Fields of --json: file, dimension, scalar, clearance, objects, touching, near, omitted, and pairs with first,
second, state (\"touch\" or \"near\"), distance, depth, point1, point2, normal (from the first to the second),
part1, part2. Exit code 1 if a pair is reported.")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// Report pairs whose distance is at most this clearance; 0 reports touching pairs
    #[arg(long, value_name = "DISTANCE", allow_negative_numbers = true, default_value = "0")]
    pub(crate) clearance: NonNegative,
    /// Print all pairs
    #[arg(long, conflicts_with = "limit")]
    pub(crate) all: bool,
    /// The maximum number of printed pairs, the deepest first
    #[arg(long, value_name = "N", default_value_t = 20)]
    pub(crate) limit: usize,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Describe the content of a file, and the defects of its meshes.
///
/// A scene or mesh is described by its objects with their shapes, and by a report of each mesh. A
/// recording is described by its version, the program that wrote it, and the number of its steps.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge inspect parts.obj
  impinge inspect boxes.json --json

Fields of --json: file, kind (\"scene\" or \"recording\"), dimension, scalar; of scenes objects (name, shape,
low, high) and meshes (file, name, vertices, triangles, pieces, closed, solid, volume, boundary_edges, problems),
joints_beyond_limits (a sentence for each joint of a robot outside the limits of its URDF file; no problem);
of recordings version, writer, steps. Exit code 1 if a mesh has a problem; an open surface is none.")]
pub(crate) struct InspectArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Measure the time of updates of a scene.
///
/// Objects move by their motions. Each run creates a new world and updates it `--steps` times.
/// Times of updates are medians over all runs, with the quartiles. Times depend on the machine and
/// its load: compare only times of one machine.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge bench boxes.json --steps 20
  impinge bench --steps 5 --runs 1

Fields of --json: scenes with name, objects, dimension, scalar, steps, runs, build_ms, first_update_ms, median_ms,
lower_quartile_ms, upper_quartile_ms, pairs.")]
pub(crate) struct BenchArgs {
    /// A scene; by default, some scenes that are part of the command
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) scene: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) reading: Reading,
    #[command(flatten)]
    pub(crate) stepping: Stepping,
    /// The number of runs of each scene
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) runs: u32,
    #[command(flatten)]
    pub(crate) format: Format,
}
