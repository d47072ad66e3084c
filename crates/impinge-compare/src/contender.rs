//! What is asked of each contender, and the race.

use std::time::Duration;

use cpu_time::ThreadTime;
use impinge_scenes::{Placement, Scene};

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

/// How one contender did.
#[derive(Clone, Debug)]
pub struct Lane {
    /// Its name.
    pub name: &'static str,
    /// The step in which everything is new.
    pub first: Duration,
    /// The steps after it.
    pub times: Vec<Duration>,
    /// The part of each that was spent on reading.
    pub reading_times: Vec<Duration>,
    /// Touching pairs at the last comparison.
    pub touching: usize,
    /// What was read at the last step.
    pub reading: Reading,
}

/// How all did.
#[derive(Clone, Debug)]
pub struct Race {
    /// In the order of the contenders.
    pub lanes: [Lane; 2],
    /// The pairs that only one of them found, in the worst of the steps compared.
    pub disagreements: usize,
    /// How many steps were compared.
    pub comparisons: usize,
}

/// Steps two contenders alternately; who goes first alternates too.
pub fn race<const D: usize>(
    scene: &Scene<D>,
    contenders: [&mut dyn Contender<D>; 2],
    steps: u32,
) -> Race {
    let mut race = Race {
        lanes: [0, 1].map(|n: usize| Lane {
            name: contenders[n].name(),
            first: Duration::ZERO,
            times: Vec::new(),
            reading_times: Vec::new(),
            touching: 0,
            reading: Reading::default(),
        }),
        disagreements: 0,
        comparisons: 0,
    };
    for step in 0..steps {
        let moved = moved(scene, step);
        let order = if step % 2 == 0 { [0, 1] } else { [1, 0] };
        for n in order {
            contenders[n].prepare(&moved);
            let start = ThreadTime::now();
            contenders[n].step();
            let updated = start.elapsed();
            race.lanes[n].reading = contenders[n].read();
            race.lanes[n].note(step, start.elapsed(), updated);
        }
        if step % 10 == 0 {
            race.compare(&contenders);
        }
    }
    race
}

/// The objects that are elsewhere than at the step before; none at step 0, where the worlds are made.
fn moved<const D: usize>(scene: &Scene<D>, step: u32) -> Vec<(usize, Placement<D>)> {
    let Some(before) = step.checked_sub(1) else { return Vec::new() };
    let now = (0..scene.objects.len()).map(|n| (n, scene.placement(n, step)));
    now.filter(|(n, placement)| *placement != scene.placement(*n, before)).collect()
}

impl Lane {
    fn note(&mut self, step: u32, total: Duration, updated: Duration) {
        if step == 0 {
            self.first = total;
        } else {
            self.times.push(total);
            self.reading_times.push(total.saturating_sub(updated));
        }
    }
}

impl Race {
    fn compare<const D: usize>(&mut self, contenders: &[&mut dyn Contender<D>; 2]) {
        let [one, two] = [0, 1].map(|n: usize| contenders[n].touching());
        let missing = |from: &[(usize, usize)], of: &[(usize, usize)]| {
            of.iter().filter(|pair| from.binary_search(pair).is_err()).count()
        };
        let disagreements = missing(&one, &two) + missing(&two, &one);
        self.disagreements = self.disagreements.max(disagreements);
        self.comparisons += 1;
        self.lanes[0].touching = one.len();
        self.lanes[1].touching = two.len();
    }
}
