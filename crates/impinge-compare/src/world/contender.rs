//! The interface of the contenders, and the race between them.

use impinge_scenes::{Placement, Scene};

use crate::measure::{Times, timed};
use crate::table::Row;

/// A world that takes part in the comparison.
pub trait Contender<const D: usize> {
    /// Converts the placements of the moved and added objects to the contender's types, and stores
    /// the changes for the next step; not timed.
    fn prepare(&mut self, change: &Change<D>);

    /// Removes and adds objects, sets the new poses and updates; timed.
    fn step(&mut self);

    /// Reads every contact point and returns their digest; timed.
    fn read(&mut self) -> Reading;

    /// Runs a step, and returns its time in nanoseconds.
    fn timed_step(&mut self) -> f64 {
        timed(|| self.step()).0
    }

    /// Reads every contact point. Returns the time in nanoseconds, and the digest.
    fn timed_read(&mut self) -> (f64, Reading) {
        timed(|| self.read())
    }

    /// Returns the pairs with a contact point, sorted, the smaller index first; not timed.
    fn touching(&self) -> Vec<(usize, usize)>;
}

/// The changes of the objects of a scene between two steps.
#[derive(Clone, Debug, Default)]
pub struct Change<const D: usize> {
    /// The removed objects.
    pub gone: Vec<usize>,
    /// The added objects, with their placements.
    pub born: Vec<(usize, Placement<D>)>,
    /// The moved objects, with their placements.
    pub moved: Vec<(usize, Placement<D>)>,
}

impl<const D: usize> Change<D> {
    /// Returns the changes since the previous step; none at step 0, at which the worlds are
    /// created.
    fn at(scene: &Scene<D>, step: u32) -> Self {
        let mut change = Self::default();
        let Some(before) = step.checked_sub(1) else { return change };
        for n in 0..scene.objects.len() {
            let now = scene.placement(n, step);
            match [before, step].map(|step| scene.is_alive(n, step)) {
                [true, false] => change.gone.push(n),
                [false, true] => change.born.push((n, now)),
                [true, true] if now != scene.placement(n, before) => change.moved.push((n, now)),
                _ => {}
            }
        }
        change
    }
}

/// A world and its name in the table.
pub struct Entrant<const D: usize> {
    /// The name.
    pub name: &'static str,
    /// The world.
    pub world: Box<dyn Contender<D>>,
}

/// The timed parts: the three cases of each scene.
pub const KINDS: [&str; 3] = ["step and reading", "step alone", "reading alone"];

/// The index in [`KINDS`] of the case whose results are the contact points of the last step. The
/// results of the others are touching pairs.
const READING: usize = 2;

/// A digest of all contact points. It forces a contender to read them, and shows whether the
/// contenders find about the same contacts.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading {
    /// The number of points.
    pub points: usize,
    /// The sum of their depths.
    pub depth: f64,
}

#[cfg(feature = "parallel")]
impl Reading {
    /// Returns the sum of two digests.
    pub fn plus(self, other: Self) -> Self {
        Self { points: self.points + other.points, depth: self.depth + other.depth }
    }
}

/// The results of one contender, in milliseconds per step.
#[derive(Clone, Debug, Default)]
struct Lane {
    /// The times of each part of [`KINDS`].
    times: [Times; 3],
    points: usize,
    touching: usize,
    differ: usize,
}

/// Steps the contenders alternately, in a rotating order. The first step, in which everything is
/// new, is not timed. Returns a row for each contender in each case.
pub fn race<const D: usize>(
    scene: &Scene<D>,
    mut entrants: Vec<Entrant<D>>,
    steps: u32,
    cases: &[String; 3],
) -> Vec<Row> {
    let count = entrants.len();
    let mut lanes = vec![Lane::default(); count];
    for step in 0..=steps {
        let change = Change::at(scene, step);
        for n in (0..count).map(|n| (n + step as usize) % count) {
            lanes[n].step(&mut *entrants[n].world, &change, step > 0);
        }
        if step % 10 == 0 {
            compare(&entrants, &mut lanes);
        }
    }
    let named = || lanes.iter().zip(&entrants);
    let rows = cases.iter().enumerate().flat_map(|(kind, case)| {
        named().map(move |(lane, entrant)| lane.row(case, entrant.name, kind))
    });
    rows.collect()
}

impl Lane {
    fn step<const D: usize>(
        &mut self,
        contender: &mut dyn Contender<D>,
        change: &Change<D>,
        is_kept: bool,
    ) {
        contender.prepare(change);
        let update = contender.timed_step();
        let (read, reading) = contender.timed_read();
        assert!(reading.depth.is_finite(), "{} points of no depth", reading.points);
        self.points = reading.points;
        if is_kept {
            let times = [update + read, update, read];
            self.times.iter_mut().zip(times).for_each(|(kept, time)| kept.push(time * 1e-6));
        }
    }

    fn row(&self, case: &str, name: &str, kind: usize) -> Row {
        Row {
            case: case.to_owned(),
            contender: name.to_owned(),
            answers: if kind == READING { self.points } else { self.touching },
            differ: self.differ,
            times: self.times[kind].clone(),
        }
    }
}

/// Counts the touching pairs of each contender that differ from those of the first one, and stores
/// the maximum over the compared steps.
fn compare<const D: usize>(entrants: &[Entrant<D>], lanes: &mut [Lane]) {
    let pairs: Vec<_> = entrants.iter().map(|entrant| entrant.world.touching()).collect();
    let missing = |from: &[(usize, usize)], of: &[(usize, usize)]| {
        of.iter().filter(|pair| from.binary_search(pair).is_err()).count()
    };
    for (lane, found) in lanes.iter_mut().zip(&pairs) {
        lane.touching = found.len();
        let differ = missing(&pairs[0], found) + missing(found, &pairs[0]);
        lane.differ = lane.differ.max(differ);
    }
}
