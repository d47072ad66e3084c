//! `impinge replay`: what happened at the steps of a recording.

use core::fmt::Write as _;

use impinge::world::CollisionWorld;
use impinge_record::{Registry, Replay};
use serde::Serialize;

use crate::args::ReplayArgs;
use crate::error::CliError;
use crate::number::{Number, tuple};
use crate::output::{FAINT, NAME, NEAR, Outcome, Report, TOUCHES, finish};
use crate::progress::Progress;
use crate::recording::{Label, Log, Named as _, in_file};
use crate::space::{KindFields, Stage, Task, run_in};
use crate::summary::{PairSummary, State, StepSummary, pairs, summary};

/// Runs the verb.
pub(crate) fn run(args: &ReplayArgs) -> Result<Outcome, CliError> {
    let log = Log::read(&args.log)?;
    let report = run_in(log.kind, Play { log: &log, step: args.step })?;
    finish(&report, args.format)
}

/// Plays a recording to a step, or through all.
struct Play<'a> {
    log: &'a Log,
    step: Option<usize>,
}

/// What a recording says.
#[derive(Debug, Serialize)]
struct Story {
    file: String,
    #[serde(flatten)]
    kind: KindFields,
    /// All steps from 1 on, or the one that was asked for.
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

/// Where an object is.
#[derive(Debug, Serialize)]
struct Position {
    name: String,
    translation: Vec<Number>,
    rotation: Vec<Number>,
}

impl Task for Play<'_> {
    type Answer = Story;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Story, CliError> {
        let log = self.log;
        let failed = in_file(&log.path);
        let registry = Registry::<N, D, Label>::new();
        let mut replay =
            Replay::<N, D, Label>::open(log.bytes.as_slice(), &registry).map_err(&failed)?;
        let last = replay.len();
        let (file, kind) = (log.name(), log.kind.fields());
        let Some(step) = self.step else {
            let mut progress = Progress::new(last, "replaying");
            let steps = (1..=last).map(|step| {
                replay.seek(step)?;
                progress.step();
                Ok(summary(replay.world(), step))
            });
            let steps = steps.collect::<Result<_, _>>().map_err(failed)?;
            return Ok(Story { file, kind, steps, detail: None });
        };
        if step > last {
            return Err(CliError::NoStep { path: log.path.clone(), step, last });
        }
        replay.seek(step).map_err(failed)?;
        let steps = vec![summary(replay.world(), step)];
        Ok(Story { file, kind, steps, detail: Some(detail(replay.world())) })
    }
}

fn detail<N: Stage<D>, const D: usize>(world: &CollisionWorld<N, D, Label>) -> StepDetail {
    let objects = world.collision_objects();
    let positions = objects.map(|object| {
        let mut numbers = N::isometry_numbers(object.position()).into_iter().map(Number::new);
        let translation = numbers.by_ref().take(D).collect();
        Position { name: object.name(), translation, rotation: numbers.collect() }
    });
    StepDetail { positions: positions.collect(), pairs: pairs(world) }
}

impl Report for Story {
    fn text(&self) -> String {
        let mut text = String::new();
        let Self { file, kind, .. } = self;
        let _ = writeln!(text, "{NAME}{file}{NAME:#} {FAINT}({kind}){FAINT:#}");
        let _ = writeln!(
            text,
            "{FAINT}{:>6} {:>8} {:>9} {:>6} {:>9} {:>8} {:>8}{FAINT:#}",
            "step", "objects", "touching", "near", "contacts", "started", "stopped"
        );
        for row in &self.steps {
            let _ = writeln!(
                text,
                "{:>6} {:>8} {:>9} {:>6} {:>9} {:>8} {:>8}",
                row.step,
                row.objects,
                row.touching,
                row.near,
                row.contacts,
                row.started,
                row.stopped
            );
        }
        if let Some(detail) = &self.detail {
            detail.write(&mut text);
        }
        text
    }

    fn outcome(&self) -> Outcome {
        self.steps.last().is_some_and(|last| last.touching > 0).into()
    }
}

impl StepDetail {
    fn write(&self, text: &mut String) {
        let width = self.positions.iter().map(|position| position.name.chars().count()).max();
        let width = width.unwrap_or_default();
        for Position { name, translation, rotation } in &self.positions {
            let (at, turn) = (tuple(translation), tuple(rotation));
            let _ =
                writeln!(text, "{NAME}{name:width$}{NAME:#} at {at} {FAINT}turned {turn}{FAINT:#}");
        }
        for pair in &self.pairs {
            let style = if pair.state == State::Touch { TOUCHES } else { NEAR };
            let PairSummary { first, second, contacts, .. } = pair;
            let state = pair.state.word();
            let _ = write!(text, "{style}{state:5}{style:#} {first} {second}");
            if let Some(depth) = pair.depth {
                let _ = write!(text, ", {contacts} contacts, depth {depth}");
            }
            text.push('\n');
        }
    }
}
