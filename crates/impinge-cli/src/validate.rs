//! `impinge validate`: whether recordings replay to the same bits.

use core::fmt::Write as _;

use impinge::world::CollisionWorld;
use impinge_record::{Difference, Divergence, ObjectField, Registry, Replay, validate};
use serde::Serialize;

use crate::args::ValidateArgs;
use crate::error::CliError;
use crate::output::{CLEAR, FAINT, NAME, Outcome, Report, TOUCHES, finish};
use crate::progress::Progress;
use crate::recording::{Label, Log, Named, in_file};
use crate::space::{Stage, Task, run_in};

/// Runs the verb.
pub(crate) fn run(args: &ValidateArgs) -> Result<Outcome, CliError> {
    let mut progress = Progress::new(args.logs.len(), "replaying");
    let recordings = args.logs.iter().map(|path| {
        let log = Log::read(path)?;
        let checked = run_in(log.kind, Check(&log));
        progress.step();
        checked
    });
    let recordings = recordings.collect::<Result<_, _>>()?;
    drop(progress);
    finish(&Verdicts { recordings }, args.format)
}

/// Replays a recording and compares all hashes.
struct Check<'a>(&'a Log);

/// Whether recordings replay to the same bits.
#[derive(Debug, Serialize)]
struct Verdicts {
    recordings: Vec<Verdict>,
}

/// Whether one does.
#[derive(Debug, Serialize)]
struct Verdict {
    file: String,
    steps: usize,
    same: bool,
    difference: Option<FirstDifference>,
}

/// Where a replay first differs.
#[derive(Debug, Serialize)]
struct FirstDifference {
    /// The number of updates before the call that differs.
    step: usize,
    /// Where its record is.
    byte: usize,
    /// The object, if one differs.
    object: Option<String>,
    /// What of it, or of the step.
    field: &'static str,
}

impl Task for Check<'_> {
    type Answer = Verdict;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Verdict, CliError> {
        let log = self.0;
        let failed = in_file(&log.path);
        let registry = Registry::<N, D, Label>::new();
        let found = validate(log.bytes.as_slice(), &registry).map_err(&failed)?;
        let mut replay =
            Replay::<N, D, Label>::open(log.bytes.as_slice(), &registry).map_err(&failed)?;
        let steps = replay.len();
        let difference = match found {
            Some(found) => {
                replay.seek(found.step + 1).map_err(failed)?;
                Some(described(found, replay.world()))
            }
            None => None,
        };
        Ok(Verdict { file: log.name(), steps, same: difference.is_none(), difference })
    }
}

/// A difference with the name that its object has in the world after the step.
fn described<N: Stage<D>, const D: usize>(
    found: Divergence,
    world: &CollisionWorld<N, D, Label>,
) -> FirstDifference {
    let (object, field) = match found.difference {
        Difference::Object { index, field } => {
            let object = world.collision_objects().find(|object| object.handle().uid() == index);
            let name = object.map_or_else(|| format!("#{index}"), Named::name);
            (Some(name), field_name(field))
        }
        Difference::State => (None, "state"),
        Difference::Events => (None, "events"),
        Difference::Answer => (None, "answer of a query"),
        _ => (None, "unknown"),
    };
    FirstDifference { step: found.step, byte: found.offset, object, field }
}

const fn field_name(field: ObjectField) -> &'static str {
    match field {
        ObjectField::Description => "position, groups or query type",
        ObjectField::Pairs => "contacts or proximities",
    }
}

impl Report for Verdicts {
    fn text(&self) -> String {
        let mut text = String::new();
        for Verdict { file, steps, difference, .. } in &self.recordings {
            let _ = write!(text, "{NAME}{file}{NAME:#} ");
            let Some(found) = difference else {
                let _ = writeln!(text, "{CLEAR}same bits{CLEAR:#} at all {steps} steps");
                continue;
            };
            let FirstDifference { step, byte, object, field } = found;
            let _ = write!(text, "{TOUCHES}differs{TOUCHES:#} first at step {step}: ");
            if let Some(object) = object {
                let _ = write!(text, "object {NAME}{object}{NAME:#}, ");
            }
            let _ = writeln!(text, "{field} {FAINT}(byte {byte}){FAINT:#}");
        }
        text
    }

    fn outcome(&self) -> Outcome {
        self.recordings.iter().any(|verdict| !verdict.same).into()
    }
}
