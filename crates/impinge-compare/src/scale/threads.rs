//! Compares one thread with two, in wall time: whole worlds of impinge and of rapier, each in its
//! own thread pool. All contacts are read; with impinge all threads read them, in pieces.

use std::time::Instant;

use impinge_scenes::{Scene, pile, sparse_drift};
use rayon::ThreadPool;

use super::{Lane, race_worlds};
use crate::Arguments;
use crate::build::world::{self, World};
use crate::table::Table;
use crate::world::contender::{Change, Contender, Entrant, KINDS, Reading, race};
use crate::world::ours;
use crate::world::rapier::{plane, space};
use crate::world::stages::asking_for_contacts;

/// The number of boxes of the scene "pile"; "sparse drift" has ten times as many.
const PILE: usize = 10_000;

/// Runs the scenes, and the drifting boxes of all sizes, up to the requested number of boxes.
pub fn run(arguments: &Arguments) -> Table {
    let mut table = Table::new("threads", "ms");
    for stage in stages::<2>(arguments) {
        run_scene(stage, arguments, &mut table, |scene, threads| {
            [pooled(ours::plane(scene), threads), pooled(plane::Rapier::new(scene), threads)]
        });
    }
    for stage in stages::<3>(arguments) {
        run_scene(stage, arguments, &mut table, |scene, threads| {
            [pooled(ours::space(scene), threads), pooled(space::Rapier::new(scene), threads)]
        });
    }
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        if arguments.includes(count) && arguments.wants_case(&format!("world, {count}")) {
            run_drift(count, arguments, &mut table);
        }
    }
    table
}

/// The name of a scene, its constructor, and the number of boxes.
type Stage<const D: usize> = (&'static str, fn(usize) -> Scene<D>, usize);

/// Returns the requested scenes.
fn stages<const D: usize>(arguments: &Arguments) -> impl Iterator<Item = Stage<D>> {
    let all: [Stage<D>; 2] = [("pile", pile, PILE), ("sparse drift", sparse_drift, 10 * PILE)];
    all.into_iter().filter(|(_, _, count)| arguments.includes(*count))
}

/// Runs a scene with both libraries, each with one thread and with two.
fn run_scene<const D: usize>(
    (name, make, count): Stage<D>,
    arguments: &Arguments,
    table: &mut Table,
    contenders: impl Fn(&Scene<D>, usize) -> [Box<dyn Contender<D>>; 2],
) {
    let cases = KINDS.map(|kind| format!("{name} {D}D, {count}: {kind}"));
    if !cases.iter().any(|case| arguments.wants_case(case)) {
        return;
    }
    let scene = asking_for_contacts(make(count), 0.0);
    let [ours1, theirs1] = contenders(&scene, 1);
    let [ours2, theirs2] = contenders(&scene, 2);
    let all = [
        ("impinge, 1 thread", ours1),
        ("impinge, 2 threads", ours2),
        ("rapier, 1 thread", theirs1),
        ("rapier, 2 threads", theirs2),
    ];
    let wanted = all.into_iter().filter(|(name, _)| arguments.wants_contender(name));
    let entrants = wanted.map(|(name, world)| Entrant { name, world }).collect();
    table.add(race(&scene, entrants, arguments.steps, &cases));
}

/// Runs `count` drifting boxes with both libraries, each with one thread and with two.
fn run_drift(count: usize, arguments: &Arguments, table: &mut Table) {
    let mut lanes = vec![
        lane("impinge, 1 thread", 1, world::Ours::new()),
        lane("impinge, 2 threads", 2, world::Ours::new()),
    ];
    if !arguments.is_alone() {
        lanes.push(lane("rapier, 1 thread", 1, world::Rapier::new()));
        lanes.push(lane("rapier, 2 threads", 2, world::Rapier::new()));
    }
    let steps = super::steps(count, arguments);
    table.add(race_worlds(&format!("world, {count}"), count, lanes, steps));
}

/// Creates a pool of `threads` threads.
fn pool(threads: usize) -> ThreadPool {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    pool.expect("a thread or two can be had")
}

/// Runs work in a pool, and returns the wall time in nanoseconds.
fn clocked<R: Send>(pool: &ThreadPool, work: impl FnOnce() -> R + Send) -> (f64, R) {
    pool.install(|| {
        let start = Instant::now();
        let result = work();
        (start.elapsed().as_secs_f64() * 1e9, result)
    })
}

fn lane(name: &'static str, threads: usize, world: impl World + 'static) -> Lane {
    let pool = pool(threads);
    let clock = move |work: &mut (dyn FnMut() + Send)| clocked(&pool, work).0;
    Lane { clock: Box::new(clock), ..Lane::new(name, world) }
}

/// A contender that runs in its own thread pool.
struct Pooled<W> {
    world: W,
    pool: ThreadPool,
}

fn pooled<W, const D: usize>(world: W, threads: usize) -> Box<dyn Contender<D>>
where
    W: Contender<D> + Send + Sync + 'static,
{
    Box::new(Pooled { world, pool: pool(threads) })
}

impl<W: Contender<D> + Send + Sync, const D: usize> Contender<D> for Pooled<W> {
    fn prepare(&mut self, change: &Change<D>) {
        self.world.prepare(change);
    }

    fn step(&mut self) {
        self.timed_step();
    }

    fn read(&mut self) -> Reading {
        self.timed_read().1
    }

    fn timed_step(&mut self) -> f64 {
        let Self { world, pool } = self;
        clocked(pool, || world.step()).0
    }

    fn timed_read(&mut self) -> (f64, Reading) {
        clocked(&self.pool, || self.world.read())
    }

    fn touching(&self) -> Vec<(usize, usize)> {
        self.world.touching()
    }
}
