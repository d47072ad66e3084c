//! The command line: verbs, their arguments and what `--help` says.
//!
//! The examples of the help texts are run by a test in the folder `scenes`.

mod ask;
mod check;
mod draw;
mod numbers;
mod pages;
mod recordings;

use std::path::{Path, PathBuf};

use clap::builder::Styles;
use clap::builder::styling::{AnsiColor, Style};
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;

pub(crate) use ask::{CastArgs, DistanceArgs, RayArgs, ShapeKind, ShapeSpec};
pub(crate) use check::{BenchArgs, CheckArgs, InspectArgs};
pub(crate) use draw::{LayerName, RenderArgs};
pub(crate) use numbers::{NumberError, Numbers, Positive, Size};
pub(crate) use pages::{ExportArgs, PageArgs, SamplesArgs, ViewArgs};
pub(crate) use recordings::{RecordArgs, ReplayArgs, ValidateArgs};

/// The colours of help texts: headings in bold, what is typed literally in cyan.
const STYLES: Styles = Styles::styled()
    .header(Style::new().bold())
    .usage(Style::new().bold())
    .literal(AnsiColor::Cyan.on_default())
    .placeholder(AnsiColor::Cyan.on_default().dimmed());

/// Collision detection for scene files: which objects touch, how far apart they are, what a ray or a moving
/// shape hits; pictures and recordings.
#[derive(Debug, Parser)]
#[command(name = "impinge", version, styles = STYLES, max_term_width = 100, after_help = EXIT_CODES)]
pub(crate) struct Cli {
    /// What to do.
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

/// The verbs; the arguments of each describe it.
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

/// Where a scene is read from.
#[derive(Args, Clone, Debug)]
pub(crate) struct SceneArgs {
    /// A scene in JSON, a mesh (OBJ, STL, PLY, glTF) or a robot (URDF); `-` reads a scene from standard input
    #[arg(value_hint = ValueHint::FilePath)]
    pub(crate) scene: PathBuf,
    /// Compute with numbers of this type, whatever the scene says
    #[arg(long, value_enum)]
    pub(crate) scalar: Option<ScalarName>,
    /// A folder with packages, for `package://` paths of robots; may be repeated
    #[arg(long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) packages: Vec<PathBuf>,
}

/// A type of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum ScalarName {
    /// 32 bits
    F32,
    /// 64 bits
    F64,
}

/// How the answer is printed.
#[derive(Args, Clone, Copy, Debug)]
pub(crate) struct Format {
    /// Print one JSON document instead of text
    #[arg(long)]
    pub(crate) json: bool,
}

/// Whether a path stands for standard input.
pub(crate) fn is_stdin(path: &Path) -> bool {
    path.as_os_str() == "-"
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory as _;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
        let verbs = Cli::command().get_subcommands().count();
        assert!(verbs >= 15, "all verbs are there: {verbs}");
    }
}
