//! `impinge record`: the objects of a scene move, and every step is recorded.

use core::fmt::Write as _;

use serde::Serialize;

use crate::args::RecordArgs;
use crate::error::CliError;
use crate::output::{self, FAINT, NAME, Outcome, Report, finish};
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{KindFields, Stage, Task, run_in};
use crate::summary::summary;

/// Runs the verb.
pub(crate) fn run(args: &RecordArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    let Recorded { report, bytes } = run_in(loaded.kind, Record { loaded: &loaded, args })?;
    output::write(&args.output, &bytes)?;
    finish(&report, args.format)
}

/// Records a scene.
struct Record<'a> {
    loaded: &'a Loaded,
    args: &'a RecordArgs,
}

/// A recording and what there is to say about it.
struct Recorded {
    report: RecordReport,
    bytes: Vec<u8>,
}

/// What was recorded.
#[derive(Debug, Serialize)]
struct RecordReport {
    file: String,
    #[serde(flatten)]
    kind: KindFields,
    output: String,
    steps: u32,
    bytes: usize,
    objects: usize,
    /// After how many steps something touched.
    touched: usize,
}

impl Task for Record<'_> {
    type Answer = Recorded;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Recorded, CliError> {
        let Record { loaded, args } = self;
        let mut world = loaded.moving::<N, D>()?;
        let mut progress = Progress::new(args.steps as usize, "recording");
        let (objects, mut touched) = (world.len(), 0);
        for step in 1..=args.steps {
            world.step(args.dt.0)?;
            touched += usize::from(summary(&world, step as usize).touching > 0);
            progress.step();
        }
        let bytes = world.finish().bytes;
        let report = RecordReport {
            file: loaded.name(),
            kind: loaded.kind.fields(),
            output: args.output.display().to_string(),
            steps: args.steps,
            bytes: bytes.len(),
            objects,
            touched,
        };
        Ok(Recorded { report, bytes })
    }
}

impl Report for RecordReport {
    fn text(&self) -> String {
        let Self { output, steps, bytes, objects, touched, kind, .. } = self;
        let mut text = String::new();
        let _ = writeln!(
            text,
            "{NAME}{output}{NAME:#} {FAINT}({kind}){FAINT:#}: {objects} objects, {steps} steps, {bytes} \
             bytes; something touches after {touched} of the steps"
        );
        text
    }

    fn outcome(&self) -> Outcome {
        Outcome::Clear
    }
}
