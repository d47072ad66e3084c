//! `impinge validate`: checks by hashes that replays of recordings give the recorded results, to
//! the bit.

use core::fmt;

use impinge_files::Printable;
use impinge_record::{Difference, Divergence, ObjectField, Registry, Replay, validate};
use serde::Serialize;

use crate::args::ValidateArgs;
use crate::error::CliError;
use crate::log::{Label, Log, in_file, name_of};
use crate::output::{CLEAR, FAINT, NAME, Outcome, Report, TOUCHES, finish};
use crate::progress::Progress;
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &ValidateArgs) -> Result<Outcome, CliError> {
    let mut progress = Progress::new(args.logs.len(), "replaying");
    let recordings = args.logs.iter().map(|path| {
        let log = Log::read(path)?;
        let checked = run_in(log.kind, CompareHashes(&log));
        progress.step();
        checked
    });
    let recordings = recordings.collect::<Result<_, _>>()?;
    drop(progress);
    finish(&ValidateReport { recordings }, args.format)
}

/// The task that replays a recording and compares all hashes.
struct CompareHashes<'a>(&'a Log);

/// The report of all validated recordings.
#[derive(Debug, Serialize)]
struct ValidateReport {
    recordings: Vec<Validated>,
}

/// The result for one recording.
#[derive(Debug, Serialize)]
struct Validated {
    file: String,
    steps: usize,
    /// `true` if all hashes of the replay equal the recorded hashes.
    same: bool,
    difference: Option<FirstDifference>,
}

/// The first difference of a replay.
#[derive(Debug, Serialize)]
struct FirstDifference {
    /// The first step that differs, counted like the steps of `replay`: from 1 to the last step.
    step: usize,
    /// The offset in the recording of the record of the first call whose results differ.
    byte: usize,
    /// The name of the object that differs; `None` if the difference is not in an object.
    object: Option<String>,
    /// The differing field of the object, or of the step.
    field: &'static str,
}

impl Task for CompareHashes<'_> {
    type Answer = Validated;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Validated, CliError> {
        let log = self.0;
        let failed = in_file(&log.path);
        let registry = Registry::<N, D, Label>::new();
        let found = validate(&log.bytes, &registry).map_err(&failed)?;
        // `validate` returns no world. A second replay counts the steps, and provides the world
        // from which the name of a differing object is read.
        let replay = Replay::<N, D, Label>::open(log.bytes.as_slice(), &registry);
        let mut replay = replay.map_err(&failed)?;
        let steps = replay.len();
        let difference = match found {
            Some(found) => {
                replay.seek(found.step + 1).map_err(failed)?;
                Some(described(found, &replay))
            }
            None => None,
        };
        Ok(Validated { file: log.name(), steps, same: difference.is_none(), difference })
    }
}

/// Describes a difference. `replay` is at the step that differs; the name of the object is read from
/// its world.
fn described<N: Stage<D>, const D: usize>(
    found: Divergence,
    replay: &Replay<N, D, Label>,
) -> FirstDifference {
    let (object, field) = match found.difference {
        Difference::Object { index, field } => {
            let mut objects = replay.world().collision_objects();
            let object = objects.find(|object| object.handle().uid() == index);
            let name = object.map_or_else(|| format!("#{index}"), name_of);
            (Some(name), field_name(field))
        }
        Difference::State => (None, "state"),
        Difference::Events => (None, "events"),
        Difference::Answer => (None, "answer of a query"),
        _ => (None, "unknown"),
    };
    FirstDifference { step: replay.step(), byte: found.offset, object, field }
}

/// Returns the names of the fields of an object that a hash covers, as a text for the report.
const fn field_name(field: ObjectField) -> &'static str {
    match field {
        ObjectField::Description => "position, groups or query type",
        ObjectField::Pairs => "contacts or proximities",
    }
}

impl fmt::Display for ValidateReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for Validated { file, steps, difference, .. } in &self.recordings {
            write!(f, "{NAME}{}{NAME:#} ", Printable(file))?;
            match difference {
                Some(difference) => writeln!(f, "{difference}")?,
                None => writeln!(f, "{CLEAR}same bits{CLEAR:#} at all {steps} steps")?,
            }
        }
        Ok(())
    }
}

impl fmt::Display for FirstDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { step, byte, object, field } = self;
        write!(f, "{TOUCHES}differs{TOUCHES:#} first at step {step}: ")?;
        if let Some(object) = object {
            write!(f, "object {NAME}{}{NAME:#}, ", Printable(object))?;
        }
        write!(f, "{field} {FAINT}(byte {byte}){FAINT:#}")
    }
}

impl Report for ValidateReport {
    fn outcome(&self) -> Outcome {
        self.recordings.iter().any(|recording| !recording.same).into()
    }
}
