//! `impinge check`: finds the objects of a scene that touch, or that are within a clearance.

use core::cell::RefCell;
use core::cmp::Ordering;
use core::fmt;

use impinge::query::{Proximity, Witness};
use serde::{Serialize, Serializer};

use crate::args::CheckArgs;
use crate::convert::scalar;
use crate::error::CliError;
use crate::itself;
use crate::near::Boxed;
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
    run_in(loaded.kind, CheckPairs { loaded: &loaded, args })
}

/// The task that checks all pairs of a scene.
struct CheckPairs<'a> {
    loaded: &'a Loaded,
    args: &'a CheckArgs,
}

/// The report of the pairs that touch or are near.
#[derive(Serialize)]
#[serde(bound = "")]
struct CheckReport<'a, N: Stage<D>, const D: usize> {
    #[serde(flatten)]
    subject: Subject,
    clearance: Number,
    objects: usize,
    /// The number of touching pairs, including the omitted ones. The field `near` is the number of
    /// near pairs, including the omitted ones.
    touching: usize,
    near: usize,
    /// The number of pairs that are not printed because of the limit.
    omitted: usize,
    pairs: Pairs<'a, N, D>,
}

impl Task for CheckPairs<'_> {
    type Answer = Outcome;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Outcome, CliError> {
        let Self { loaded, args } = self;
        let clearance = scalar::<N>("--clearance", args.clearance.0)?;
        let world = loaded.world::<N, D>()?;
        let measure = Measure { boxed: Boxed::new(&world)?, clearance };
        let most = if args.all { loaded.max_pairs() } else { args.limit };
        let Found { touching, near, deepest } = measure.found(most, args.all);
        let omitted = touching + near - deepest.len();
        if args.all && omitted > 0 {
            return Err(CliError::TooManyPairs { limit: most });
        }
        let report = CheckReport {
            subject: loaded.subject(),
            clearance: Number::new(clearance),
            objects: measure.boxed.len(),
            touching,
            near,
            omitted,
            pairs: Pairs { measure, deepest },
        };
        finish(&report, args.format)
    }
}

/// Measures the pairs of a world that are at most a clearance apart and may interact.
///
/// Bounding boxes cull pairs. The remaining pairs are measured one by one and not stored, so that
/// memory does not grow with their number: n objects at one position have n (n - 1) / 2 pairs.
struct Measure<'a, N: Stage<D>, const D: usize> {
    boxed: Boxed<'a, N, D, String>,
    clearance: N,
}

/// The numbers of touching and near pairs, and the deepest pairs in order.
struct Found {
    touching: usize,
    near: usize,
    deepest: Vec<Near>,
}

/// A pair that touches or is near: its distance, by which pairs are sorted, and the indices of its
/// objects.
#[derive(Clone, Copy)]
struct Near {
    /// The signed distance; minus infinity for an unbounded overlap.
    distance: f64,
    state: State,
    objects: [u32; 2],
}

impl<N: Stage<D>, const D: usize> Measure<'_, N, D> {
    /// Finds all pairs, and keeps the `most` deepest. With `all`, the search ends as soon as more
    /// than `most` pairs are found.
    fn found(&self, most: usize, all: bool) -> Found {
        let found = RefCell::new(Found { touching: 0, near: 0, deepest: Vec::new() });
        let progress = RefCell::new(Progress::new(self.boxed.len(), "measuring pairs"));
        let visit = |objects| {
            let Some(near) = self.near(objects) else { return };
            let found = &mut *found.borrow_mut();
            match near.state {
                State::Touch => found.touching += 1,
                _ => found.near += 1,
            }
            found.deepest.push(near);
            if found.deepest.len() / 2 > most {
                self.keep_deepest(&mut found.deepest, most);
            }
        };
        let goes_on = || {
            progress.borrow_mut().step();
            let Found { touching, near, .. } = &*found.borrow();
            !(all && touching + near > most)
        };
        self.boxed.each(|_| self.clearance, visit, goes_on);
        let mut found = found.into_inner();
        self.keep_deepest(&mut found.deepest, most);
        found
    }

    /// Sorts the pairs, and keeps the first `most`.
    fn keep_deepest(&self, pairs: &mut Vec<Near>, most: usize) {
        pairs.sort_by(|one, other| self.order(one, other));
        pairs.truncate(most);
    }

    /// Orders pairs by signed distance, the deepest first; ties by the names of the objects.
    fn order(&self, one: &Near, other: &Near) -> Ordering {
        let names = |near: &Near| near.objects.map(|object| self.boxed.object(object).data());
        let by_distance = one.distance.total_cmp(&other.distance);
        by_distance.then_with(|| names(one).cmp(&names(other)))
    }

    /// Returns the state and distance of a pair of objects; `None` if their distance exceeds the
    /// clearance.
    fn near(&self, objects: [u32; 2]) -> Option<Near> {
        // `proximity` decides whether objects touch, as in a world. The sign of the distance is not
        // used, since the distance is rounded.
        let state = match self.proximity(objects) {
            Proximity::Disjoint => return None,
            Proximity::Intersecting => State::Touch,
            Proximity::WithinMargin => State::Near,
        };
        let distance =
            self.witness(objects).map_or(f64::NEG_INFINITY, |found| found.distance.as_f64());
        Some(Near { distance, state, objects })
    }

    /// Returns the proximity of a pair of objects for the clearance.
    fn proximity(&self, objects: [u32; 2]) -> Proximity {
        let [object1, object2] = objects.map(|object| self.boxed.object(object));
        if objects[0] == objects[1] {
            return itself::proximity(object1, self.clearance);
        }
        N::proximity(object1, object2, self.clearance)
    }

    /// Returns the nearest points of a pair of objects; `None` if their distance exceeds the
    /// clearance or their overlap is unbounded.
    fn witness(&self, objects: [u32; 2]) -> Option<Witness<N, D>> {
        let [object1, object2] = objects.map(|object| self.boxed.object(object));
        if objects[0] == objects[1] {
            return itself::witness(object1, self.clearance);
        }
        N::witness(object1, object2, self.clearance)
    }

    /// Returns the fields of a pair in the report.
    fn separation(&self, &Near { state, objects, .. }: &Near) -> Separation {
        let names = objects.map(|object| self.boxed.object(object).data().clone());
        match self.witness(objects) {
            Some(found) => {
                Separation { state, ..Separation::of_witness(names, &found, self.clearance) }
            }
            None => Separation::unbounded(names, state),
        }
    }
}

/// The pairs of a report. Their fields are computed when they are written.
struct Pairs<'a, N: Stage<D>, const D: usize> {
    measure: Measure<'a, N, D>,
    deepest: Vec<Near>,
}

impl<N: Stage<D>, const D: usize> Pairs<'_, N, D> {
    fn separations(&self) -> impl Iterator<Item = Separation> {
        self.deepest.iter().map(|near| self.measure.separation(near))
    }
}

impl<N: Stage<D>, const D: usize> Serialize for Pairs<'_, N, D> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_seq(self.separations())
    }
}

impl<N: Stage<D>, const D: usize> fmt::Display for CheckReport<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { subject, clearance, objects, touching, near, omitted, pairs } = self;
        pairs.separations().try_for_each(|pair| pair.fmt(f))?;
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

impl<N: Stage<D>, const D: usize> Report for CheckReport<'_, N, D> {
    fn outcome(&self) -> Outcome {
        (self.touching + self.near > 0).into()
    }
}
