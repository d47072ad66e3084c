//! `impinge check`: which objects of a scene touch, or come within a clearance.

use core::fmt;

use impinge::narrow_phase::GeometricQueryType;
use impinge::query::Proximity;
use impinge::world::{CollisionObject, CollisionWorld};
use serde::Serialize;

use crate::args::CheckArgs;
use crate::convert::scalar;
use crate::error::CliError;
use crate::number::Number;
use crate::output::{CLEAR, FAINT, Outcome, Report, Subject, finish};
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::separation::Separation;
use crate::space::{Stage, Task, run_in};
use crate::state::State;

/// Runs the verb.
pub(crate) fn run(args: &CheckArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    finish(&run_in(loaded.kind, CheckPairs { loaded: &loaded, args })?, args.format)
}

/// Checks all pairs of a scene.
struct CheckPairs<'a> {
    loaded: &'a Loaded,
    args: &'a CheckArgs,
}

/// The pairs that touch or are near.
#[derive(Debug, Serialize)]
struct CheckReport {
    #[serde(flatten)]
    subject: Subject,
    clearance: Number,
    objects: usize,
    /// Pairs that touch, and pairs that are near: also those that are omitted.
    touching: usize,
    near: usize,
    /// Pairs beyond the limit.
    omitted: usize,
    pairs: Vec<Separation>,
}

impl Task for CheckPairs<'_> {
    type Answer = CheckReport;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<CheckReport, CliError> {
        let Self { loaded, args } = self;
        let clearance = scalar::<N>("--clearance", args.clearance.0)?;
        let world = loaded.world::<N, D>()?;
        let objects = world.len();
        let mut pairs = pairs_within(world, clearance)?;
        pairs.sort_by(Separation::by_depth);
        let count = |state| pairs.iter().filter(|pair| pair.state == state).count();
        let (touching, near) = (count(State::Touch), count(State::Near));
        let limit = if args.all { usize::MAX } else { args.limit };
        let omitted = pairs.len().saturating_sub(limit);
        pairs.truncate(limit);
        let (subject, clearance) = (loaded.subject(), Number::new(clearance));
        Ok(CheckReport { subject, clearance, objects, touching, near, omitted, pairs })
    }
}

/// The pairs of a world that are at most a clearance apart and may interact.
///
/// The world itself culls: the query type of each object is proximity with half the clearance, since margins add
/// up. The nearest points are computed for the pairs that remain. So the cost is that of one update and of these
/// pairs.
fn pairs_within<N: Stage<D>, const D: usize>(
    mut world: CollisionWorld<N, D, String>,
    clearance: N,
) -> Result<Vec<Separation>, CliError> {
    let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    let proximity = GeometricQueryType::Proximity(clearance * N::HALF);
    for handle in handles {
        let set = world.try_set_query_type(handle, proximity);
        set.map_err(|error| CliError::argument("--clearance", clearance, error))?;
    }
    world.update();
    let is_near = |proximity| proximity != Proximity::Disjoint;
    let near = world.proximity_pairs().filter(|(_, _, pair)| is_near(pair.proximity()));
    let near: Vec<_> = near.collect();
    let mut progress = Progress::new(near.len(), "measuring pairs");
    let separations = near.into_iter().map(|(object1, object2, pair)| {
        progress.step();
        let names = [object1.data().clone(), object2.data().clone()];
        // The world decides what touches: its answer is exact, the signed distance is rounded.
        let state = match pair.proximity() {
            Proximity::Intersecting => State::Touch,
            _ => State::Near,
        };
        match N::witness(object1, object2, clearance) {
            Some(found) => Separation { state, ..Separation::of_witness(names, &found, clearance) },
            None => Separation::unbounded(names, state),
        }
    });
    Ok(separations.collect())
}

impl fmt::Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { subject, clearance, objects, touching, near, omitted, pairs } = self;
        pairs.iter().try_for_each(|pair| pair.fmt(f))?;
        if *omitted > 0 {
            writeln!(f, "{FAINT}… and {omitted} more: --all prints them{FAINT:#}")?;
        }
        write!(f, "{subject}: {objects} objects, ")?;
        let is_clear = touching + near == 0;
        match (is_clear, clearance.value() > 0.0) {
            (true, false) => writeln!(f, "{CLEAR}nothing touches{CLEAR:#}"),
            (true, true) => writeln!(f, "{CLEAR}nothing within {clearance}{CLEAR:#}"),
            (false, false) => writeln!(f, "{touching} pairs touch"),
            (false, true) => writeln!(f, "{touching} pairs touch, {near} within {clearance}"),
        }
    }
}

impl Report for CheckReport {
    fn outcome(&self) -> Outcome {
        (self.touching + self.near > 0).into()
    }
}
