//! The suite of growth: the time of a step as a function of the number of boxes, for broad phases
//! and for whole worlds, with all boxes moving. Beside the table it writes `scale-series.csv` and
//! its drawing `scale.svg`, with logarithmic axes, below `bench/<machine>/`.
//!
//! With the feature `parallel` it also compares one thread with two, in wall time. Without it all
//! contenders have one thread, and times are processor times.

mod growth;
#[cfg(feature = "parallel")]
mod threads;

use std::path::Path;

use crate::Arguments;
use crate::broad::swarm::{Cell, Plan, Swarm};
use crate::broad::{Contenders, FAST, Impinge, Ncollide, Parry, Rapier, race};
use crate::build::world::{self, World, certainly_touching};
use crate::measure::{Times, timed};
use crate::table::{Row, Table};
use growth::Measured;

/// Runs all sizes up to the requested number of boxes.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("scale", "ms");
    let mut measured = Vec::new();
    let sizes = [100, 316, 1_000, 3_162, 10_000, 31_623, 100_000, 316_228, 1_000_000];
    let sizes = || sizes.into_iter().filter(|size| arguments.includes(*size));
    let mut add = |subject: &str, boxes: usize, rows: Vec<Row>| {
        measured.extend(rows.iter().map(|row| growth(subject, boxes, row)));
        table.add(rows);
    };
    for count in sizes() {
        add("broad phase", count, broad_phase(count, arguments));
    }
    for count in sizes() {
        add("world", count, whole_world(count, arguments));
    }
    if arguments.is_whole() {
        let bench = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../bench");
        let written = growth::write(&measured, &bench.join(&arguments.machine));
        written.unwrap_or_else(|error| eprintln!("growth could not be written: {error}"));
    }
    #[cfg(feature = "parallel")]
    return vec![table, threads::run(arguments)];
    #[cfg(not(feature = "parallel"))]
    vec![table]
}

fn growth(subject: &str, boxes: usize, row: &Row) -> Measured {
    let [median, minimum] = [50, 0].map(|percent| row.times.quantile(percent));
    let (subject, contender) = (subject.to_owned(), row.contender.clone());
    Measured { subject, contender, boxes, median, minimum }
}

/// Returns the number of steps: a million divided by the number of boxes, at least 6, but at most
/// the requested number.
fn steps(count: usize, arguments: &Arguments) -> u32 {
    let most = u32::try_from(1_000_000 / count).expect("it is less than a million");
    arguments.steps.min(most.max(6))
}

fn broad_phase(count: usize, arguments: &Arguments) -> Vec<Row> {
    let mut swarm = Swarm::<3>::new(Plan { count, ..FAST });
    let cells = &swarm.cells;
    let mut contenders: Contenders<3> = vec![Box::new(Impinge::new(cells))];
    if !arguments.is_alone() {
        contenders.push(Box::new(Rapier::new(cells, false)));
        contenders.push(Box::new(Parry::new(cells)));
    }
    if !arguments.is_alone() && count <= 31_623 {
        contenders.push(Box::new(Ncollide::new(cells)));
    }
    let case = format!("broad phase, {count}");
    race(&case, &mut swarm, &mut contenders, steps(count, arguments))
}

fn whole_world(count: usize, arguments: &Arguments) -> Vec<Row> {
    let mut lanes = vec![Lane::new("impinge", world::Ours::new())];
    if !arguments.is_alone() {
        lanes.push(Lane::new("rapier", world::Rapier::new()));
    }
    if !arguments.is_alone() && count <= 31_623 {
        lanes.push(Lane::new("ncollide", world::Ncollide::new()));
    }
    race_worlds(&format!("world, {count}"), count, lanes, steps(count, arguments))
}

/// A contender: a world, and its results.
struct Lane {
    name: &'static str,
    world: Box<dyn World>,
    /// Runs work on the threads of the lane and returns the nanoseconds that it took.
    clock: Box<dyn Fn(&mut (dyn FnMut() + Send)) -> f64>,
    times: Times,
    touching: usize,
    differ: usize,
}

impl Lane {
    /// Creates a lane that runs on the calling thread.
    fn new(name: &'static str, world: impl World + 'static) -> Self {
        Self {
            name,
            world: Box::new(world),
            clock: Box::new(|work| timed(work).0),
            times: Times::default(),
            touching: 0,
            differ: 0,
        }
    }

    /// Runs a step and reads all contact points. Returns the time of both, in milliseconds.
    fn step(&mut self, moved: &[(u32, Cell<3>)]) -> f64 {
        let (world, mut reading) = (&mut self.world, (0, 0.0));
        let time = (self.clock)(&mut || {
            world.step(moved);
            reading = world.read();
        });
        assert!(reading.1.is_finite(), "{} points of no depth", reading.0);
        time * 1e-6
    }
}

/// Steps worlds alternately, as [`race`] does for broad phases, but without warm-up steps.
fn race_worlds(case: &str, count: usize, mut lanes: Vec<Lane>, steps: u32) -> Vec<Row> {
    let mut swarm = Swarm::<3>::new(Plan { count, ..FAST });
    for lane in &mut lanes {
        swarm.cells.iter().for_each(|cell| lane.world.add(cell));
        lane.step(&[]);
    }
    let contenders = lanes.len();
    for step in 1..=steps {
        let moved = swarm.step().moved;
        for n in (0..contenders).map(|n| (n + step as usize) % contenders) {
            let time = lanes[n].step(&moved);
            lanes[n].times.push(time);
        }
        if step % 10 == 0 || step == steps {
            compare(&swarm.cells, &mut lanes);
        }
    }
    let row = |lane: Lane| Row {
        case: case.to_owned(),
        contender: lane.name.to_owned(),
        answers: lane.touching,
        differ: lane.differ,
        times: lane.times,
    };
    lanes.into_iter().map(row).collect()
}

/// Counts the touching pairs of each world that differ from those of the first world, and stores
/// the maximum.
fn compare(cells: &[Cell<3>], lanes: &mut [Lane]) {
    let mut first = Vec::new();
    for (n, lane) in lanes.iter_mut().enumerate() {
        let touching = certainly_touching(&*lane.world, cells);
        if n == 0 {
            first.clone_from(&touching);
        }
        let missing = |from: &[u64], of: &[u64]| {
            of.iter().filter(|pair| from.binary_search(pair).is_err()).count()
        };
        lane.touching = touching.len();
        lane.differ = lane.differ.max(missing(&first, &touching) + missing(&touching, &first));
    }
}
