//! The interface of the contenders, and the race between them.

use std::collections::HashSet;

use super::swarm::{Cell, Change, Swarm};
use crate::measure::{Times, timed};
use crate::table::Row;

/// The margin by which all contenders enlarge boxes to fat AABBs, so that small motions need no
/// update.
pub const MARGIN: f32 = 0.05;

/// A broad phase that takes part in the comparison.
pub trait Contender<const D: usize> {
    /// Returns the name in the table.
    fn name(&self) -> &'static str;

    /// Applies the changed boxes, updates, and collects the events; timed.
    fn step(&mut self, change: &Change<D>);

    /// Processes the events of the step; not timed.
    fn settle(&mut self, _change: &Change<D>) {}

    /// Returns all current pairs as [`key`]s; not timed.
    fn pairs(&mut self) -> Vec<u64>;
}

/// The contenders of a case; the first one is impinge.
pub type Contenders<const D: usize> = Vec<Box<dyn Contender<D>>>;

/// Combines two indices into one key that does not depend on their order; the smaller one is in the
/// high half.
pub fn key(a: u32, b: u32) -> u64 {
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

/// Two indices, and `true` if the pair started, `false` if it stopped.
pub type Event = (u32, u32, bool);

/// The set of current pairs, maintained from events.
#[derive(Clone, Debug, Default)]
pub struct Held(HashSet<u64>);

impl Held {
    /// Adds the started pairs and removes the stopped ones.
    pub fn apply(&mut self, events: impl IntoIterator<Item = Event>) {
        for (a, b, started) in events {
            if started {
                self.0.insert(key(a, b));
            } else {
                self.0.remove(&key(a, b));
            }
        }
    }

    /// Removes the pairs of removed boxes, for contenders that do not report these as stopped.
    pub fn forget<const D: usize>(&mut self, change: &Change<D>) {
        let gone: HashSet<u32> = change.replaced.iter().map(|(n, _)| *n).collect();
        if !gone.is_empty() {
            let stays = |key: &u64| {
                !(gone.contains(&((key >> 32) as u32)) || gone.contains(&(*key as u32)))
            };
            self.0.retain(stays);
        }
    }

    /// Returns all pairs.
    pub fn pairs(&self) -> Vec<u64> {
        self.0.iter().copied().collect()
    }
}

/// The results of one contender, with times in milliseconds per step.
#[derive(Clone, Debug, Default)]
struct Lane {
    times: Times,
    pairs: usize,
    differ: usize,
}

/// Steps the contenders alternately, in a rotating order.
///
/// The first step, in which everything is new, is not timed. Neither are the warm-up steps after
/// it, half as many as the timed ones: at first all boxes are in the middle of their fat AABBs, so
/// that many would leave them in the same step. The pairs are compared after the warm-up, after
/// every tenth step and after the last.
pub fn race<const D: usize>(
    case: &str,
    swarm: &mut Swarm<D>,
    contenders: &mut Contenders<D>,
    steps: u32,
) -> Vec<Row> {
    let count = contenders.len();
    let mut lanes = vec![Lane::default(); count];
    let warmup = (steps / 2).max(1);
    for step in 0..=warmup + steps {
        let change = if step == 0 { Change::default() } else { swarm.step() };
        for n in (0..count).map(|n| (n + step as usize) % count) {
            let (time, ()) = timed(|| contenders[n].step(&change));
            contenders[n].settle(&change);
            if step > warmup {
                lanes[n].times.push(time * 1e-6);
            }
        }
        if step == warmup || step == warmup + steps || step > warmup && step % 10 == 0 {
            compare(&swarm.cells, contenders, &mut lanes);
        }
    }
    let rows = lanes.into_iter().zip(contenders).map(|(lane, contender)| Row {
        case: case.to_owned(),
        contender: contender.name().to_owned(),
        answers: lane.pairs,
        differ: lane.differ,
        times: lane.times,
    });
    rows.collect()
}

/// Counts the wrong results of each contender, and keeps in its lane the maximum over the compared
/// steps.
///
/// Two overlapping boxes must be a pair: if a contender lacks such a pair that another one has, it
/// is counted. Boxes that are near each other may be a pair, depending on when their fat AABBs were
/// computed. A fat AABB extends at most two margins beyond its box. So a pair whose boxes are more
/// than four margins apart is stale and counted, as is each duplicate of a pair.
fn compare<const D: usize>(cells: &[Cell<D>], contenders: &mut Contenders<D>, lanes: &mut [Lane]) {
    let gap = |key: &u64| cells[(key >> 32) as usize].gap(&cells[(key & 0xffff_ffff) as usize]);
    let mut overlapping = Vec::new();
    let mut counts = Vec::new();
    for (contender, lane) in contenders.iter_mut().zip(lanes.iter_mut()) {
        let mut pairs = contender.pairs();
        pairs.sort_unstable();
        let all = pairs.len();
        pairs.dedup();
        let stale = pairs.iter().filter(|key| gap(key) > 4.01 * MARGIN).count();
        lane.pairs = all;
        lane.differ = lane.differ.max(stale + all - pairs.len());
        pairs.retain(|key| gap(key) <= 0.0);
        counts.push(pairs.len());
        overlapping.extend(pairs);
        overlapping.sort_unstable();
        overlapping.dedup();
    }
    for (lane, count) in lanes.iter_mut().zip(counts) {
        lane.differ = lane.differ.max(overlapping.len() - count);
    }
}
