//! `impinge distance`: how far apart two objects are, and where.

use serde::Serialize;

use crate::args::DistanceArgs;
use crate::between::Between;
use crate::convert::scalar;
use crate::error::CliError;
use crate::output::{Outcome, Report, finish};
use crate::scene::Loaded;
use crate::space::{Stage, Task, run_in};
use crate::summary::State;

/// Runs the verb.
pub(crate) fn run(args: &DistanceArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    let between = run_in(loaded.kind, Measure { loaded: &loaded, args })?;
    finish(&Distance { file: loaded.name(), between }, args.format)
}

/// Measures the distance of two objects.
struct Measure<'a> {
    loaded: &'a Loaded,
    args: &'a DistanceArgs,
}

/// How two objects of a file are to each other.
#[derive(Debug, Serialize)]
struct Distance {
    file: String,
    #[serde(flatten)]
    between: Between,
}

impl Task for Measure<'_> {
    type Answer = Between;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Between, CliError> {
        let world = self.loaded.world::<N, D>()?;
        let names = [&self.args.first, &self.args.second].map(Clone::clone);
        let object1 = self.loaded.object(&world, &names[0])?;
        let object2 = self.loaded.object(&world, &names[1])?;
        let margin = scalar("--margin", self.args.margin.0)?;
        Ok(match N::witness(object1, object2, N::INFINITY) {
            Some(found) => Between::apart_or_not(names, &found, margin),
            // Objects of finite positions without nearest points are half-spaces that overlap.
            None => Between::unbounded(names, State::Touch),
        })
    }
}

impl Report for Distance {
    fn text(&self) -> String {
        let mut text = String::new();
        self.between.headline(&mut text);
        self.between.points(&mut text);
        text
    }

    fn outcome(&self) -> Outcome {
        (self.between.state == State::Touch).into()
    }
}
