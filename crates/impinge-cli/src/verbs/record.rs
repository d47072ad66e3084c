//! `impinge record`: moves the objects of a scene and records every step.

use core::fmt;

use impinge_files::Printable;
use serde::Serialize;

use crate::args::RecordArgs;
use crate::error::CliError;
use crate::motion::{Recorded, record};
use crate::output::{self, NAME, Outcome, Report, Subject, finish};
use crate::scene::Loaded;

/// Runs the verb.
pub(crate) fn run(args: &RecordArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    let mut file = output::Growing::new(&args.output.path);
    let mut take = |bytes: &[u8]| file.append(bytes);
    let recorded = record(&loaded, args.stepping, args.key_frames, &mut take)?;
    file.finish()?;
    let Recorded { bytes, objects, touched } = recorded;
    let report = RecordReport {
        subject: loaded.subject(),
        output: args.output.path.display().to_string(),
        steps: args.stepping.steps,
        bytes,
        objects,
        touched,
    };
    finish(&report, args.format)
}

/// The report of the written recording.
#[derive(Debug, Serialize)]
struct RecordReport {
    #[serde(flatten)]
    subject: Subject,
    output: String,
    steps: u32,
    /// The number of bytes of the recording, unpacked.
    bytes: usize,
    objects: usize,
    /// The number of steps after which at least one pair touched.
    touched: usize,
}

impl fmt::Display for RecordReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { subject, output, steps, bytes, objects, touched } = self;
        writeln!(
            f,
            "{subject}: {objects} objects, something touches after {touched} of {steps} steps"
        )?;
        let output = Printable(output);
        writeln!(f, "{NAME}{output}{NAME:#}: {bytes} bytes")
    }
}

impl Report for RecordReport {}
