//! Runs of scenes, and their measures.

use std::time::Instant;

use impinge::math::Vector;
use impinge_scenes::Random;

use crate::watch::{Counts, Watch};
use crate::{Body, Contact, ContactSource, Kind, Solver, Stack, Stage, bodies_of};

/// The number of steps at the end of a run in which rest is measured.
pub const LAST: usize = 120;

/// The measures of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// The largest total kinetic energy in the last [`LAST`] steps. It is computed from the
    /// velocities of the solids relative to their initial velocities.
    pub energy: f64,
    /// The largest horizontal distance, at the end, of a centre from the position that it would
    /// have with its initial velocity.
    pub drift: f64,
    /// The largest distance by which a solid has sunk.
    pub sunk: f64,
    /// The largest difference of the velocity of a centre from its initial velocity.
    pub max_speed: f64,
    /// The counts of contacts in the second half of the run; for solids that slide, in all steps
    /// but the first.
    pub counts: Counts,
    /// The number of pairs that stopped touching in the last [`LAST`] steps.
    pub parted: usize,
    /// The mean time of computing contacts, in milliseconds per step.
    pub time: f64,
}

/// Simulates a scene for `steps` steps, and returns its measures.
pub fn play<N: Stage<D>, const D: usize, S: ContactSource<N, D>>(
    stack: &Stack<D>,
    source: &mut S,
    mut solver: Solver<N, D, S::Id>,
    steps: usize,
) -> Outcome {
    let begin = bodies_of(stack);
    let mut bodies = begin.clone();
    solver.friction = N::lit(stack.friction);
    solver.iterations = solver.iterations.max(stack.iterations);
    let mut watch = Watch::new(stack.extents());
    let mut outcome = Outcome::default();
    let settled = if stack.kind == Kind::Slide { 1 } else { steps / 2 };
    for step in 0..steps {
        let start = Instant::now();
        let contacts = source.contacts(&bodies);
        outcome.time += start.elapsed().as_secs_f64() * 1e3 / steps as f64;
        watch.see(&bodies, &contacts);
        if step < settled {
            watch.take();
        }
        if step + LAST == steps {
            outcome.counts = watch.take();
        }
        solver.step(&mut bodies, &contacts);
        outcome.see(&begin, &bodies, step + LAST >= steps);
    }
    let last = watch.take();
    outcome.parted = last.parted;
    outcome.counts = outcome.counts.plus(last);
    outcome.end(&begin, &bodies, solver.step * N::lit(steps as f64));
    outcome
}

impl Outcome {
    /// Returns the measures with their names, as columns of a table.
    #[must_use]
    pub fn columns(&self) -> [(&'static str, String); 10] {
        let Self { energy, drift, sunk, max_speed, counts, parted, time } = self;
        [
            ("energy", format!("{energy:.1e}")),
            ("drift", format!("{drift:.4}")),
            ("sunk", format!("{sunk:.4}")),
            ("speed", format!("{max_speed:.4}")),
            ("new_%", format!("{:.2}", 100.0 * counts.new_share())),
            ("jump_%", format!("{:.2}", 100.0 * counts.jump_share())),
            ("farthest", format!("{:.4}", counts.farthest)),
            ("parted", format!("{parted}")),
            ("points", format!("{:.2}", counts.points())),
            ("ms", format!("{time:.4}")),
        ]
    }

    fn see<N: Stage<D>, const D: usize>(
        &mut self,
        begin: &[Body<N, D>],
        bodies: &[Body<N, D>],
        is_last: bool,
    ) {
        let mut energy = N::ZERO;
        for (old, body) in begin.iter().zip(bodies).filter(|(old, _)| old.inverse_mass != N::ZERO) {
            let change = body.velocity - old.velocity;
            self.max_speed = self.max_speed.max(change.norm().as_f64());
            let inertia = N::in_world(&body.inverse_inertia, &body.pose);
            energy += N::HALF * change.norm_squared() / body.inverse_mass;
            energy += N::energy(&inertia, body.spin);
        }
        if is_last {
            self.energy = self.energy.max(energy.as_f64());
        }
    }

    fn end<N: Stage<D>, const D: usize>(
        &mut self,
        begin: &[Body<N, D>],
        bodies: &[Body<N, D>],
        time: N,
    ) {
        for (old, new) in begin.iter().zip(bodies).filter(|(old, _)| old.inverse_mass != N::ZERO) {
            let center = |body: &Body<N, D>| N::point(&body.pose, &body.center);
            let mut way = center(new) - center(old) - old.velocity * time;
            self.sunk = self.sunk.max(-way[1].as_f64());
            way[1] = N::ZERO;
            self.drift = self.drift.max(way.norm().as_f64());
        }
    }
}

/// Shakes the upper solid of a pair: in each step it is displaced from its position at rest by up
/// to `shake` along each axis, and rotated by up to `shake` radians about each axis. Returns the
/// counts of contacts over `steps` steps after the first.
pub fn shake<N: Stage<D>, const D: usize, S: ContactSource<N, D>>(
    pair: &Stack<D>,
    source: &mut S,
    shake: f64,
    steps: usize,
) -> Counts {
    let mut bodies: Vec<Body<N, D>> = bodies_of(pair);
    let rest = bodies[1];
    let mut random = Random::new(1);
    let mut watch = Watch::new(pair.extents());
    for step in 0..=steps {
        let mut draw = || N::lit(random.between(-shake, shake));
        let shift = Vector::<N, D>::from_fn(|_, _| draw());
        let angle = N::spin([draw(), draw(), draw()]);
        bodies[1].pose = N::moved(&rest.pose, &rest.center, &shift, angle);
        let contacts: Vec<Contact<N, D, S::Id>> = source.contacts(&bodies);
        watch.see(&bodies, &contacts);
        if step == 0 {
            watch.take();
        }
    }
    watch.take()
}
