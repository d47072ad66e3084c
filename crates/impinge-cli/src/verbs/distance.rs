//! `impinge distance`: computes the distance of two objects, and their nearest points.

use core::fmt;

use serde::Serialize;

use crate::args::DistanceArgs;
use crate::convert::scalar;
use crate::error::CliError;
use crate::output::{Outcome, Report, Subject, finish};
use crate::scene::Loaded;
use crate::separation::Separation;
use crate::space::{Stage, Task, run_in};
use crate::state::State;

/// Runs the verb.
pub(crate) fn run(args: &DistanceArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    let separation = run_in(loaded.kind, Measure { loaded: &loaded, args })?;
    finish(&DistanceReport { subject: loaded.subject(), separation }, args.format)
}

/// The task that measures the distance of two objects.
struct Measure<'a> {
    loaded: &'a Loaded,
    args: &'a DistanceArgs,
}

/// The report of the distance of two objects.
#[derive(Debug, Serialize)]
struct DistanceReport {
    #[serde(flatten)]
    subject: Subject,
    #[serde(flatten)]
    separation: Separation,
}

impl Task for Measure<'_> {
    type Answer = Separation;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Separation, CliError> {
        let Self { loaded, args } = self;
        let world = loaded.world::<N, D>()?;
        let object1 = loaded.object(&world, &args.first)?;
        let object2 = loaded.object(&world, &args.second)?;
        let names = [args.first.clone(), args.second.clone()];
        let margin = scalar("--margin", args.margin.0)?;
        Ok(match N::witness(object1, object2, N::INFINITY) {
            Some(found) => Separation::of_witness(names, &found, margin),
            // Without a limit, only half-spaces with an unbounded overlap have no nearest points.
            None => Separation::unbounded(names, State::Touch),
        })
    }
}

impl fmt::Display for DistanceReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.separation.fmt(f)
    }
}

impl Report for DistanceReport {
    fn outcome(&self) -> Outcome {
        (self.separation.state == State::Touch).into()
    }
}
