//! What is asked of each contender, and the race.

use impinge_scenes::{Placement, Scene};

use crate::measure::{Times, timed};
use crate::table::Row;

/// A world that is compared with another.
pub trait Contender<const D: usize> {
    /// The name in the table.
    fn name(&self) -> &'static str;

    /// Converts the new placements of some objects; not timed.
    fn prepare(&mut self, moved: &[(usize, Placement<D>)]);

    /// Hands over the new poses and updates; timed.
    fn step(&mut self);

    /// Reads every contact point; timed.
    fn read(&self) -> Reading;

    /// The pairs with a contact point, smaller index first, sorted; not timed.
    fn touching(&self) -> Vec<(usize, usize)>;
}

/// A digest of all contact points: they have to be read, and should be about the same.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reading {
    /// How many points there are.
    pub points: usize,
    /// The sum of their depths.
    pub depth: f64,
}

/// How one contender did, in milliseconds per step.
#[derive(Clone, Debug, Default)]
struct Lane {
    update: Times,
    read: Times,
    total: Times,
    touching: usize,
    differ: usize,
}

/// Steps the contenders alternately; who goes first alternates too. The first step, in which
/// everything is new, is not in the times. Each contender gives three rows: the update, the reading
/// and both together.
pub fn race<const D: usize>(
    scene: &Scene<D>,
    contenders: &mut [&mut dyn Contender<D>],
    steps: u32,
) -> Vec<Row> {
    let count = contenders.len();
    let mut lanes = vec![Lane::default(); count];
    for step in 0..=steps {
        let moved = moved(scene, step);
        for n in (0..count).map(|n| (n + step as usize) % count) {
            lanes[n].step(contenders[n], &moved, step > 0);
        }
        if step % 10 == 0 {
            compare(contenders, &mut lanes);
        }
    }
    rows(scene, contenders, &lanes)
}

impl Lane {
    fn step<const D: usize>(
        &mut self,
        contender: &mut dyn Contender<D>,
        moved: &[(usize, Placement<D>)],
        is_kept: bool,
    ) {
        contender.prepare(moved);
        let (update, ()) = timed(|| contender.step());
        let (read, reading) = timed(|| contender.read());
        assert!(reading.depth.is_finite(), "{} points of no depth", reading.points);
        if is_kept {
            self.update.push(update * 1e-6);
            self.read.push(read * 1e-6);
            self.total.push((update + read) * 1e-6);
        }
    }
}

/// The objects that are elsewhere than at the step before; none at step 0, where the worlds are made.
fn moved<const D: usize>(scene: &Scene<D>, step: u32) -> Vec<(usize, Placement<D>)> {
    let Some(before) = step.checked_sub(1) else { return Vec::new() };
    let now = (0..scene.objects.len()).map(|n| (n, scene.placement(n, step)));
    now.filter(|(n, placement)| *placement != scene.placement(*n, before)).collect()
}

/// Notes by how many touching pairs each differs from the first, in the worst of the steps compared.
fn compare<const D: usize>(contenders: &[&mut dyn Contender<D>], lanes: &mut [Lane]) {
    let pairs: Vec<_> = contenders.iter().map(|contender| contender.touching()).collect();
    let missing = |from: &[(usize, usize)], of: &[(usize, usize)]| {
        of.iter().filter(|pair| from.binary_search(pair).is_err()).count()
    };
    for (lane, found) in lanes.iter_mut().zip(&pairs) {
        lane.touching = found.len();
        let differ = missing(&pairs[0], found) + missing(found, &pairs[0]);
        lane.differ = lane.differ.max(differ);
    }
}

fn rows<const D: usize>(
    scene: &Scene<D>,
    contenders: &[&mut dyn Contender<D>],
    lanes: &[Lane],
) -> Vec<Row> {
    let objects = scene.objects.len();
    let row = |what: &str, lane: &Lane, name: &str, times: &Times| Row {
        case: format!("{} {D}D, {objects}: {what}", scene.name),
        contender: name.to_owned(),
        answers: lane.touching,
        differ: lane.differ,
        times: times.clone(),
    };
    let named = || lanes.iter().zip(contenders.iter().map(|contender| contender.name()));
    let total = named().map(|(lane, name)| row("step and reading", lane, name, &lane.total));
    let update = named().map(|(lane, name)| row("step alone", lane, name, &lane.update));
    let read = named().map(|(lane, name)| row("reading alone", lane, name, &lane.read));
    total.chain(update).chain(read).collect()
}
