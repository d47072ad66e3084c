//! One thread against two, by the clock on the wall: whole worlds of impinge and of rapier, each in its
//! pool.

use std::time::Instant;

use super::{Lane, race_worlds};
use crate::Arguments;
use crate::build::world::{self, World};
use crate::table::Table;

/// Runs all sizes up to so many boxes.
pub fn run(arguments: &Arguments) -> Table {
    let mut table = Table::new("threads", "ms");
    for count in [1_000, 10_000, 100_000, 1_000_000] {
        if !arguments.includes(count) {
            continue;
        }
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
    table
}

fn lane(name: &'static str, threads: usize, world: impl World + 'static) -> Lane {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let pool = pool.expect("a thread or two can be had");
    let clock = move |work: &mut (dyn FnMut() + Send)| {
        pool.install(|| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64() * 1e9
        })
    };
    Lane { clock: Box::new(clock), ..Lane::new(name, world) }
}
