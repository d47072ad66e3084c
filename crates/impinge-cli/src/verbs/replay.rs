//! `impinge replay`: prints the state at the steps of a recording.

use core::fmt;

use impinge::world::CollisionWorld;
use impinge_files::Printable;
use serde::Serialize;

use crate::args::ReplayArgs;
use crate::error::CliError;
use crate::log::{Label, Log, in_file, name_of};
use crate::number::{Number, tuple};
use crate::output::{FAINT, NAME, Outcome, Report, Subject, finish};
use crate::progress::Progress;
use crate::space::{Stage, Task, run_in};
use crate::summary::{PairSummary, StepSummary, TouchingPairs, pairs, summary, touching_pairs};

/// Runs the verb.
pub(crate) fn run(args: &ReplayArgs) -> Result<Outcome, CliError> {
    let log = Log::read(&args.log)?;
    let (steps, detail) = match args.step {
        None => (run_in(log.kind, PlayAll(&log))?, None),
        Some(step) => {
            let (summary, detail) = run_in(log.kind, PlayTo { log: &log, step })?;
            (vec![summary], Some(detail))
        }
    };
    finish(&ReplayReport { subject: log.subject(), steps, detail }, args.format)
}

/// The task that replays a recording and summarizes every step.
struct PlayAll<'a>(&'a Log);

/// The task that replays a recording up to one step, and describes the world after it.
struct PlayTo<'a> {
    log: &'a Log,
    step: usize,
}

/// The report of the steps of a recording.
#[derive(Debug, Serialize)]
struct ReplayReport {
    #[serde(flatten)]
    subject: Subject,
    /// All steps from 1 on, or the single step of `--step`.
    steps: Vec<StepSummary>,
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    detail: Option<StepDetail>,
}

/// The objects and pairs after a step.
#[derive(Debug, Serialize)]
struct StepDetail {
    positions: Vec<Position>,
    pairs: Vec<PairSummary>,
}

/// The position of an object in the world frame.
#[derive(Debug, Serialize)]
struct Position {
    name: String,
    translation: Vec<Number>,
    /// The cosine and sine of the angle in 2D, the components i, j, k, w of a unit quaternion in
    /// 3D.
    rotation: Vec<Number>,
}

impl Task for PlayAll<'_> {
    type Answer = Vec<StepSummary>;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Vec<StepSummary>, CliError> {
        let mut replay = self.0.replay::<N, D>()?;
        let mut progress = Progress::new(replay.len(), "replaying");
        let mut before = TouchingPairs::new();
        let steps = (1..=replay.len()).map(|step| {
            replay.seek(step)?;
            progress.step();
            let after = touching_pairs(replay.world());
            let row = summary(replay.world(), step, [&before, &after]);
            before = after;
            Ok(row)
        });
        steps.collect::<Result<_, _>>().map_err(in_file(&self.0.path))
    }
}

impl Task for PlayTo<'_> {
    type Answer = (StepSummary, StepDetail);

    fn run<N: Stage<D>, const D: usize>(self) -> Result<(StepSummary, StepDetail), CliError> {
        let Self { log, step } = self;
        let mut replay = log.replay::<N, D>()?;
        log.expect_step(step, replay.len())?;
        replay.seek(step.saturating_sub(1)).map_err(in_file(&log.path))?;
        let before = touching_pairs(replay.world());
        replay.seek(step).map_err(in_file(&log.path))?;
        let after = touching_pairs(replay.world());
        Ok((summary(replay.world(), step, [&before, &after]), detail(replay.world())))
    }
}

/// Returns the positions of all objects of a world, and the pairs that touch or are near.
fn detail<N: Stage<D>, const D: usize>(world: &CollisionWorld<N, D, Label>) -> StepDetail {
    let objects = world.collision_objects();
    let positions = objects.map(|object| {
        // The first `D` numbers are the translation.
        let mut numbers = N::isometry_numbers(object.position()).into_iter().map(Number::new);
        let translation = numbers.by_ref().take(D).collect();
        Position { name: name_of(object), translation, rotation: numbers.collect() }
    });
    StepDetail { positions: positions.collect(), pairs: pairs(world) }
}

impl fmt::Display for ReplayReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.subject)?;
        // Each heading is right-aligned with the numbers of its column.
        writeln!(
            f,
            "{FAINT}  step  objects  touching   near  contacts  started  stopped{FAINT:#}"
        )?;
        for row in &self.steps {
            let StepSummary { step, objects, touching, near, contacts, started, stopped } = row;
            writeln!(
                f,
                "{step:>6} {objects:>8} {touching:>9} {near:>6} {contacts:>9} {started:>8} {stopped:>8}"
            )?;
        }
        self.detail.as_ref().map_or(Ok(()), |detail| detail.fmt(f))
    }
}

impl Report for ReplayReport {
    fn outcome(&self) -> Outcome {
        self.steps.last().is_some_and(|last| last.touching > 0).into()
    }
}

impl fmt::Display for StepDetail {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let shown = |position: &Position| Printable(&position.name).to_string();
        let width = self.positions.iter().map(|position| shown(position).chars().count()).max();
        let width = width.unwrap_or_default();
        for position @ Position { translation, rotation, .. } in &self.positions {
            let name = shown(position);
            let [at, turned] = [translation, rotation].map(|numbers| tuple(numbers));
            writeln!(f, "{NAME}{name:width$}{NAME:#} at {at} {FAINT}turned {turned}{FAINT:#}")?;
        }
        self.pairs.iter().try_for_each(|pair| pair.fmt(f))
    }
}
