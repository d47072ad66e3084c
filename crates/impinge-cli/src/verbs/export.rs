//! `impinge export`: writes a recording as one HTML file.

use core::fmt;

use impinge_files::Printable;
use serde::Serialize;

use crate::args::ExportArgs;
use crate::error::CliError;
use crate::input::Input;
use crate::log::in_file;
use crate::motion::record;
use crate::output::{self, NAME, Outcome, Report, finish};
use crate::page::assets;

/// Runs the verb.
pub(crate) fn run(args: &ExportArgs) -> Result<Outcome, CliError> {
    let assets = assets(&args.page)?;
    let (file, bytes) = match Input::open(&args.scene)? {
        Input::Recording(log) => (log.name(), log.into_page_bytes()?),
        Input::Scene(loaded) => {
            let mut bytes = Vec::new();
            let mut take = |piece: &[u8]| {
                bytes.extend(piece);
                Ok(())
            };
            record(&loaded, args.stepping, args.key_frames, &mut take)?;
            (loaded.name(), bytes)
        }
    };
    // `impinge_html::export` would also pack the recording, but the report needs the number of its
    // packed bytes.
    let packed = impinge_record::pack(&bytes).map_err(in_file(&args.scene.scene))?;
    let page = impinge_html::export(&assets, &packed, args.title.as_ref().unwrap_or(&file))?;
    output::write(&args.output.path, page.as_bytes())?;
    let output = args.output.path.display().to_string();
    let report = ExportReport { file, output, bytes: page.len(), recording: packed.len() };
    finish(&report, args.format)
}

/// The report of the written file.
#[derive(Debug, Serialize)]
struct ExportReport {
    file: String,
    output: String,
    /// The number of bytes of the page.
    bytes: usize,
    /// The number of bytes of the packed recording, before the base64 encoding.
    recording: usize,
}

impl fmt::Display for ExportReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { output, bytes, recording, .. } = self;
        let output = Printable(output);
        writeln!(f, "{NAME}{output}{NAME:#}: {bytes} bytes, {recording} of the recording")
    }
}

impl Report for ExportReport {}
