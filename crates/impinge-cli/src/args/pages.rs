//! Arguments of the verbs that create pages for browsers.

use std::path::PathBuf;

use clap::{Args, ValueHint};

use super::{Format, KeyFrames, OutputFile, SceneArgs, Size, Stepping, TimeStep};

/// The option for the files of the page.
#[derive(Args, Clone, Debug)]
pub(crate) struct PageArgs {
    /// A folder with `page.html`, `page.css`, `page.js` and `page.wasm.gz`, instead of the embedded page
    #[arg(
        long = "page",
        value_name = "FOLDER",
        env = "IMPINGE_PAGE",
        hide_env = true,
        value_hint = ValueHint::DirPath
    )]
    pub(crate) folder: Option<PathBuf>,
}

/// Write one HTML file that shows a recording and runs queries on it.
///
/// The file contains the recording and the library, so it opens from disk without a network. A
/// reader can play the recording, select objects, see why two objects touch or do not touch, cast
/// rays, and move objects. A scene is recorded first, by `--steps`, `--dt` and `--key-frames`.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge export balls.implog -o balls.html
  impinge export boxes.json -o boxes.html --steps 60 --title \"Boxes\"

Fields of --json: file, output, bytes, recording (its bytes, packed).")]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    #[command(flatten)]
    pub(crate) output: OutputFile,
    /// The heading of the page; by default the name of the file
    #[arg(long)]
    pub(crate) title: Option<String>,
    #[command(flatten)]
    pub(crate) stepping: Stepping,
    #[command(flatten)]
    pub(crate) key_frames: KeyFrames,
    #[command(flatten)]
    pub(crate) page: PageArgs,
    #[command(flatten)]
    pub(crate) format: Format,
}

/// Show a running scene, or a recording, in a browser on this machine.
///
/// The printed address is a port that only this machine can reach. The objects of a scene move by
/// its motions, one step in `--dt` seconds, until the command is interrupted. The page shows the
/// new steps as they arrive, and keeps all earlier steps.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge view balls.json --steps 30
  impinge view balls.json --steps 30 --port 0 --dt 0.001")]
pub(crate) struct ViewArgs {
    #[command(flatten)]
    pub(crate) scene: SceneArgs,
    /// The port; 0 selects a free one
    #[arg(long, default_value_t = 0)]
    pub(crate) port: u16,
    /// The number of updates of a scene after which the command ends
    #[arg(long, value_name = "N")]
    pub(crate) steps: Option<u64>,
    #[command(flatten)]
    pub(crate) time_step: TimeStep,
    #[command(flatten)]
    pub(crate) key_frames: KeyFrames,
    #[command(flatten)]
    pub(crate) page: PageArgs,
}

/// List the samples, or write them to a folder for any web server.
///
/// The file `index.html` in the folder contains all samples with their controls, and also opens
/// from disk. Thumbnails are in the subfolder `thumbnails`.
#[derive(Args, Debug)]
#[command(after_help = "\
Examples:
  impinge samples
  impinge samples -o gallery --size 96x64

Fields of --json: output, samples with name, title, about, dimension.")]
pub(crate) struct SamplesArgs {
    /// The folder to write
    #[arg(short, long, value_name = "FOLDER", value_hint = ValueHint::DirPath)]
    pub(crate) output: Option<PathBuf>,
    /// The size of the thumbnails in pixels
    #[arg(long, value_name = "WxH", default_value = "320x200")]
    pub(crate) size: Size,
    #[command(flatten)]
    pub(crate) page: PageArgs,
    #[command(flatten)]
    pub(crate) format: Format,
}
