//! Runs of scenes, and what is measured in them.

use std::time::Instant;

use impinge::math::{Vector, max};
use impinge_scenes::Random;

use crate::scenes::Shaken;
use crate::stack::Kind;
use crate::watch::{Counts, Watch};
use crate::{Body, Contact, ContactSource, Memory, Solver, Stack, Stage, bodies_of};

/// How many steps at the end of a run show whether the solids are at rest.
pub const LAST: usize = 120;

/// How a scene went.
#[derive(Clone, Copy, Debug, Default)]
pub struct Outcome {
    /// The largest sum of kinetic energies in the last steps.
    pub energy: f64,
    /// How far the center of a solid is at most, at the end, from where it began: along the ground, and for
    /// solids that slide across their way.
    pub drift: f64,
    /// How far a solid sank at most.
    pub sunk: f64,
    /// The largest speed of a center, or for solids that slide along the vertical.
    pub max_speed: f64,
    /// What a sliding solid lost of its speed, as a share.
    pub slowed: f64,
    /// The contacts of the second half of the run.
    pub counts: Counts,
    /// Pairs that ceased to touch in the last steps.
    pub parted: usize,
    /// Milliseconds of finding contacts in a step.
    pub time: f64,
}

/// Plays a scene.
pub fn play<N: Stage<D>, const D: usize, S: ContactSource<N, D>>(
    stack: &Stack<D>,
    source: &mut S,
    memory: Memory<N, D, S::Id>,
    steps: usize,
) -> Outcome {
    let mut bodies = bodies_of(stack);
    let begin = centers(&bodies);
    let mut solver = Solver { friction: N::lit(stack.friction), ..Solver::new(memory) };
    let mut watch = Watch::new();
    let mut outcome = Outcome::default();
    for step in 0..steps {
        let start = Instant::now();
        let contacts = source.contacts(&bodies);
        outcome.time += start.elapsed().as_secs_f64() * 1e3 / steps as f64;
        watch.see(&bodies, &contacts);
        if step == steps / 2 {
            watch.take();
        }
        solver.step(&mut bodies, &contacts);
        outcome.see(stack.kind, &bodies, step + LAST >= steps);
        if step + LAST + 1 == steps {
            outcome.counts = watch.take();
        }
    }
    let last = watch.take();
    outcome.parted = last.parted;
    outcome.counts = outcome.counts.plus(last);
    outcome.end(stack, &begin, &bodies);
    outcome
}

impl Outcome {
    fn see<N: Stage<D>, const D: usize>(
        &mut self,
        kind: Kind,
        bodies: &[Body<N, D>],
        is_last: bool,
    ) {
        for body in bodies.iter().filter(|body| body.inverse_mass != N::ZERO) {
            let speed =
                if kind == Kind::Slide { body.velocity[1].abs() } else { body.velocity.norm() };
            self.max_speed = self.max_speed.max(speed.as_f64());
        }
        if is_last {
            self.energy = self.energy.max(energy(bodies));
        }
    }

    fn end<N: Stage<D>, const D: usize>(
        &mut self,
        stack: &Stack<D>,
        begin: &[Vector<N, D>],
        bodies: &[Body<N, D>],
    ) {
        for ((old, new), item) in begin.iter().zip(centers(bodies)).zip(&stack.items) {
            let way = new - old;
            let along = match stack.kind {
                Kind::Slide => (2..D).fold(N::ZERO, |sum, axis| sum + way[axis] * way[axis]),
                _ => way.norm_squared() - way[1] * way[1],
            };
            self.drift = self.drift.max(max(along, N::ZERO).sqrt().as_f64());
            self.sunk = self.sunk.max(-way[1].as_f64());
            if stack.kind == Kind::Slide && item.density > 0.0 {
                let body = &bodies[bodies.len() - 1];
                self.slowed = 1.0 - body.velocity[0].as_f64() / item.velocity[0];
            }
        }
    }
}

/// Shakes the upper solid of a pair: each step it is off its place by up to `shake` in every direction, and turned
/// by as many radians.
pub fn shake<N: Stage<D>, const D: usize, S: ContactSource<N, D>>(
    pair: &Shaken<D>,
    source: &mut S,
    shake: f64,
    steps: usize,
) -> Counts {
    let mut bodies: Vec<Body<N, D>> = bodies_of(&pair.stack);
    let rest = bodies[1];
    let mut random = Random::new(1);
    let mut watch = Watch::new();
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

/// The sum of kinetic energies.
fn energy<N: Stage<D>, const D: usize>(bodies: &[Body<N, D>]) -> f64 {
    let energies = bodies.iter().filter(|body| body.inverse_mass != N::ZERO).map(|body| {
        let inertia = N::in_world(&body.inverse_inertia, &body.pose);
        N::HALF * body.velocity.norm_squared() / body.inverse_mass + N::energy(&inertia, body.spin)
    });
    energies.map(N::as_f64).sum()
}

fn centers<N: Stage<D>, const D: usize>(bodies: &[Body<N, D>]) -> Vec<Vector<N, D>> {
    bodies.iter().map(|body| N::point(&body.pose, &body.center)).collect()
}
