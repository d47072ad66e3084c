//! The command line: verbs, their arguments and the texts of `--help`.
//!
//! A test runs the examples of the help texts in the folder `scenes`.

mod ask;
mod check;
mod draw;
mod numbers;
mod pages;
mod recordings;

use core::num::NonZeroU64;
use std::path::{Path, PathBuf};

use clap::builder::styling::{AnsiColor, Style};
use clap::builder::{PossibleValuesParser, Styles, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueHint, value_parser};
use clap_complete::Shell;
use impinge_files::{Limits, ReadOptions, ScalarFile};

pub(crate) use ask::{CastArgs, DistanceArgs, RayArgs, ShapeKind, ShapeSpec, ShortShape};
pub(crate) use check::{BenchArgs, CheckArgs, InspectArgs};
pub(crate) use draw::{LayerName, RenderArgs};
pub(crate) use numbers::{NonNegative, NumberError, Numbers, Size};
pub(crate) use pages::{ExportArgs, PageArgs, SamplesArgs, ViewArgs};
pub(crate) use recordings::{RecordArgs, ReplayArgs, ValidateArgs};

/// The colours of help texts: headings in bold, literals in cyan.
const STYLES: Styles = Styles::styled()
    .header(Style::new().bold())
    .usage(Style::new().bold())
    .literal(AnsiColor::Cyan.on_default())
    .placeholder(AnsiColor::Cyan.on_default().dimmed());

/// Collision detection for scene files: touching objects, distances, hits of rays and moving shapes, pictures
/// and recordings.
#[derive(Debug, Parser)]
#[command(name = "impinge", version, styles = STYLES, max_term_width = 100, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    /// The verb to run.
    #[command(subcommand)]
    pub(crate) verb: Verb,
}

const EXIT_CODES: &str = "\
Exit codes:
  0  nothing touches, nothing is hit, no difference; or the verb has no such answer
  1  something touches, is hit, or differs
  2  the input or the arguments are wrong

Scenes are JSON files (see `impinge schema`) or meshes whose groups are the objects. `-` is standard input.
`impinge help VERB` has examples.";

/// The verbs. The comment on the arguments of a verb is its description.
#[derive(Debug, Subcommand)]
pub(crate) enum Verb {
    Check(CheckArgs),
    Distance(DistanceArgs),
    Cast(CastArgs),
    Ray(RayArgs),
    Render(RenderArgs),
    Record(RecordArgs),
    Replay(ReplayArgs),
    Validate(ValidateArgs),
    Export(ExportArgs),
    View(ViewArgs),
    Samples(SamplesArgs),
    Inspect(InspectArgs),
    Bench(BenchArgs),
    /// Print the JSON Schema of scene files
    Schema,
    /// Print the completions for a shell
    #[command(after_help = "\
Examples:
  impinge completions bash
  impinge completions fish")]
    Completions {
        /// The shell
        shell: Shell,
    },
}

/// The input file of a verb, and the options for reading it.
#[derive(Args, Clone, Debug)]
pub(crate) struct SceneArgs {
    /// A scene in JSON, a mesh (OBJ, STL, PLY, glTF) or a robot (URDF); `-` is standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) reading: Reading,
}

/// The options for reading a scene.
#[derive(Args, Clone, Debug)]
pub(crate) struct Reading {
    /// Compute with this type of numbers, instead of the type of the scene
    #[arg(long, value_parser = scalar_parser())]
    pub(crate) scalar: Option<ScalarFile>,
    /// A folder with packages, for `package://` paths of robots; may be repeated
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) packages: Vec<PathBuf>,
    /// The folder that contains all files that the scene names; by default the folder of the scene
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) root: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) limits: LimitArgs,
}

/// Limits on the memory that a scene may use, since small files can request much memory.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct LimitArgs {
    /// The maximum total size of all files in bytes
    #[arg(long, value_name = "N", hide_short_help = true, default_value_t = Limits::default().bytes)]
    max_bytes: usize,
    /// The maximum number of vertices and corners of triangles
    #[arg(long, value_name = "N", hide_short_help = true, default_value_t = Limits::default().elements)]
    max_elements: usize,
    /// The maximum number of corners of a polygon
    #[arg(long, value_name = "N", hide_short_help = true, default_value_t = Limits::default().corners)]
    max_corners: usize,
    /// The maximum number of objects
    #[arg(long, value_name = "N", hide_short_help = true, default_value_t = Limits::default().objects)]
    max_objects: usize,
    /// The maximum total size of all names in bytes
    #[arg(long, value_name = "N", hide_short_help = true, default_value_t = Limits::default().names)]
    max_names: usize,
    /// The maximum number of pairs of objects that are near each other
    #[arg(long, value_name = "N", hide_short_help = true, default_value_t = 1 << 20)]
    pub(crate) max_pairs: usize,
}

impl LimitArgs {
    /// Returns the limits for the readers of files.
    pub(crate) const fn of_files(&self) -> Limits {
        Limits {
            bytes: self.max_bytes,
            elements: self.max_elements,
            corners: self.max_corners,
            objects: self.max_objects,
            names: self.max_names,
        }
    }
}

impl Reading {
    /// Returns the options for the readers of files.
    pub(crate) fn options(&self) -> ReadOptions {
        let options = ReadOptions::new().with_limits(self.limits.of_files());
        let options = self.packages.iter().fold(options, ReadOptions::with_packages);
        match &self.root {
            Some(root) => options.with_root(root),
            None => options,
        }
    }
}

/// Parses a scalar by its name in scene files.
fn scalar_parser() -> impl TypedValueParser<Value = ScalarFile> {
    PossibleValuesParser::new(["f32", "f64"]).map(|name| match name.as_str() {
        "f32" => ScalarFile::F32,
        _ => ScalarFile::F64,
    })
}

/// The time between two updates of a scene.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct TimeStep {
    // The default is the `f64` nearest to 1/60.
    /// Seconds from one update to the next
    #[arg(
        long = "dt",
        value_name = "SECONDS",
        allow_negative_numbers = true,
        default_value = "0.016666666666666666"
    )]
    pub(crate) seconds: NonNegative,
}

/// The number of updates of a scene, and the time between them.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Stepping {
    /// The number of updates
    #[arg(long, value_name = "N", default_value_t = 120, value_parser = value_parser!(u32).range(1..))]
    pub(crate) steps: u32,
    #[command(flatten)]
    pub(crate) time_step: TimeStep,
}

/// The option for key frames of a recording.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct KeyFrames {
    /// Write all objects again every N updates: a player that goes back then replays little more
    /// than N updates; by default it replays from the start
    #[arg(long = "key-frames", value_name = "N")]
    pub(crate) every: Option<NonZeroU64>,
}

/// The file that a verb writes.
#[derive(Args, Clone, Debug)]
pub(crate) struct OutputFile {
    /// The file to write
    #[arg(short = 'o', long = "output", value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) path: PathBuf,
}

/// The format of the output.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Format {
    /// Print one JSON document instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

/// Returns `true` if the path is `-`, which stands for standard input.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
        let verbs = Cli::command().get_subcommands().count();
        assert!(verbs >= 15, "all verbs are there: {verbs}");
    }

    #[test]
    fn the_default_time_step_is_a_sixtieth() {
        let cli = Cli::try_parse_from(["impinge", "record", "a.json", "-o", "a.implog"]);
        let Ok(Cli { verb: Verb::Record(args) }) = &cli else { panic!("{cli:?}") };
        assert_eq!(args.stepping.time_step.seconds.0, 1.0 / 60.0);
    }
}
