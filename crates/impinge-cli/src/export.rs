//! `impinge export`: a recording as one HTML file.

use core::fmt::Write as _;

use serde::Serialize;

use crate::args::ExportArgs;
use crate::error::CliError;
use crate::input::Input;
use crate::output::{self, NAME, Outcome, Report, finish};
use crate::page::{assets, record};

/// Runs the verb.
pub(crate) fn run(args: &ExportArgs) -> Result<Outcome, CliError> {
    let assets = assets(&args.page)?;
    let (file, bytes) = match Input::open(&args.scene)? {
        Input::Recording(log) => (log.name(), log.bytes),
        Input::Scene(loaded) => (loaded.name(), record(&loaded, args.steps, args.dt)?),
    };
    let failed = |error| CliError::Recording { path: args.scene.scene.clone(), error };
    let packed = impinge_record::pack(&bytes).map_err(failed)?;
    let title = args.title.as_ref().unwrap_or(&file);
    let page = impinge_html::export(&assets, &packed, title)?;
    output::write(&args.output, page.as_bytes())?;
    let output = args.output.display().to_string();
    let report = ExportReport { file, output, bytes: page.len(), recording: packed.len() };
    finish(&report, args.format)
}

/// What was written.
#[derive(Debug, Serialize)]
struct ExportReport {
    file: String,
    output: String,
    bytes: usize,
    recording: usize,
}

impl Report for ExportReport {
    fn text(&self) -> String {
        let Self { output, bytes, recording, .. } = self;
        let mut text = String::new();
        let _ =
            writeln!(text, "{NAME}{output}{NAME:#}: {bytes} bytes, {recording} of the recording");
        text
    }

    fn outcome(&self) -> Outcome {
        Outcome::Clear
    }
}
