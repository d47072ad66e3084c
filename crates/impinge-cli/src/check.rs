//! `impinge check`: which objects of a scene touch, or come within a clearance.

use core::fmt::Write as _;

use impinge::narrow_phase::GeometricQueryType;
use impinge::query::Proximity;
use impinge::world::{CollisionObject, CollisionWorld};
use serde::Serialize;

use crate::args::CheckArgs;
use crate::between::Between;
use crate::convert::scalar;
use crate::error::CliError;
use crate::number::Number;
use crate::output::{CLEAR, FAINT, NAME, Outcome, Report, finish};
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{KindFields, Stage, Task, run_in};
use crate::summary::State;

/// Runs the verb.
pub(crate) fn run(args: &CheckArgs) -> Result<Outcome, CliError> {
    let loaded = Loaded::read(&args.scene)?;
    let limit = if args.all { usize::MAX } else { args.limit };
    let check = Check { loaded: &loaded, clearance: args.clearance.0, limit };
    finish(&run_in(loaded.kind, check)?, args.format)
}

/// Looks at all pairs of a scene.
struct Check<'a> {
    loaded: &'a Loaded,
    clearance: f64,
    limit: usize,
}

/// The pairs that touch or are near.
#[derive(Debug, Serialize)]
struct Pairs {
    file: String,
    #[serde(flatten)]
    kind: KindFields,
    clearance: Number,
    objects: usize,
    touching: usize,
    near: usize,
    omitted: usize,
    pairs: Vec<Between>,
}

impl Task for Check<'_> {
    type Answer = Pairs;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Pairs, CliError> {
        let clearance = scalar::<N>("--clearance", self.clearance)?;
        let world = self.loaded.world::<N, D>()?;
        let objects = world.len();
        let mut pairs = pairs_within(world, clearance)?;
        pairs.sort_by(Between::by_depth);
        let count = |state| pairs.iter().filter(|pair| pair.state == state).count();
        let (touching, near) = (count(State::Touch), count(State::Near));
        let omitted = pairs.len().saturating_sub(self.limit);
        pairs.truncate(self.limit);
        let (file, kind) = (self.loaded.name(), self.loaded.kind.fields());
        let clearance = Number::new(clearance);
        Ok(Pairs { file, kind, clearance, objects, touching, near, omitted, pairs })
    }
}

/// The pairs of a world that are at most a clearance apart and may interact.
///
/// The world itself culls: each object asks for proximity with half the clearance, since margins add up. The
/// nearest points are computed for what remains. So the cost is that of one update and of the pairs found.
fn pairs_within<N: Stage<D>, const D: usize>(
    mut world: CollisionWorld<N, D, String>,
    clearance: N,
) -> Result<Vec<Between>, CliError> {
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
    let between = near.into_iter().map(|(object1, object2, pair)| {
        progress.step();
        let names = [object1.data().clone(), object2.data().clone()];
        let state = match pair.proximity() {
            Proximity::Intersecting => State::Touch,
            _ => State::Near,
        };
        match N::witness(object1, object2, clearance) {
            Some(found) => Between { state, ..Between::apart_or_not(names, &found, clearance) },
            None => Between::unbounded(names, state),
        }
    });
    Ok(between.collect())
}

impl Report for Pairs {
    fn text(&self) -> String {
        let mut text = String::new();
        for pair in &self.pairs {
            pair.headline(&mut text);
            pair.points(&mut text);
        }
        if self.omitted > 0 {
            let omitted = self.omitted;
            let _ = writeln!(text, "{FAINT}… and {omitted} more: --all prints them{FAINT:#}");
        }
        let Self { file, kind, objects, touching, near, clearance, .. } = self;
        let _ = write!(text, "{NAME}{file}{NAME:#} {FAINT}({kind}){FAINT:#}: {objects} objects, ");
        let is_clear = touching + near == 0;
        let _ = match (is_clear, clearance.value() > 0.0) {
            (true, false) => writeln!(text, "{CLEAR}nothing touches{CLEAR:#}"),
            (true, true) => writeln!(text, "{CLEAR}nothing within {clearance}{CLEAR:#}"),
            (false, false) => writeln!(text, "{touching} pairs touch"),
            (false, true) => writeln!(text, "{touching} pairs touch, {near} within {clearance}"),
        };
        text
    }

    fn outcome(&self) -> Outcome {
        (self.touching + self.near > 0).into()
    }
}
