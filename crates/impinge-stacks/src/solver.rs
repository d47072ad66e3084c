//! A sequential-impulse solver: Erin Catto, "Iterative Dynamics with Temporal Coherence" (2005).
//!
//! Contacts are plain data, from any library. Each contact starts with the impulse that its id had
//! in the previous step. Then all contacts are solved in turn, several times: the normal impulse is
//! never negative, and the friction impulse is at most `friction` times the normal impulse.
//! Penetrations beyond the slop are corrected by Baumgarte's method; gaps may close within a step.
//! Gyroscopic torques are omitted.
//!
//! An iteration solves all friction constraints, then all normal constraints: the constraints
//! solved last have the smallest error, and penetration is the worse error.

use core::hash::Hash;

use impinge::math::{Vector, max};

use crate::{Memory, Turn};

/// A rigid body. A fixed body has zero inverse mass and inertia.
#[derive(Clone, Copy, Debug)]
pub struct Body<N: Turn<D>, const D: usize> {
    /// The pose of the body frame in the world frame.
    pub pose: N::Isometry,
    /// The centre of mass, in the body frame.
    pub center: Vector<N, D>,
    /// The velocity of the centre of mass, in the world frame.
    pub velocity: Vector<N, D>,
    /// The angular velocity, in the world frame.
    pub spin: N::Spin,
    /// The inverse mass.
    pub inverse_mass: N,
    /// The inverse inertia tensor about the centre of mass, in the body frame.
    pub inverse_inertia: N::Inertia,
}

/// A contact point of two bodies.
#[derive(Clone, Copy, Debug)]
pub struct Contact<N: Turn<D>, const D: usize, K> {
    /// The indices of the bodies.
    pub bodies: [usize; 2],
    /// The point on each body, in the world frame.
    pub points: [Vector<N, D>; 2],
    /// The unit normal from the first body to the second.
    pub normal: Vector<N, D>,
    /// The penetration depth; minus the distance if the bodies are apart.
    pub depth: N,
    /// The id, by which the contact is found in the next step.
    pub id: K,
}

/// The impulse of a contact at the end of a step.
#[derive(Clone, Copy, Debug)]
pub struct Impulse<N: Turn<D>, const D: usize> {
    /// The impulse along the normal, zero or more.
    pub normal: N,
    /// The friction impulse in the contact plane, in the world frame: the basis of the plane may
    /// differ from step to step.
    pub friction: Vector<N, D>,
}

/// The parameters of a solver, and the impulses of its last step.
#[derive(Clone, Debug)]
pub struct Solver<N: Turn<D>, const D: usize, K> {
    /// The length of a step in seconds.
    pub step: N,
    /// The gravitational acceleration.
    pub gravity: Vector<N, D>,
    /// Coulomb's coefficient of friction.
    pub friction: N,
    /// The number of iterations over all contacts in a step.
    pub iterations: usize,
    /// Whether every other iteration takes the contacts in reverse order. With one order the
    /// remaining errors all have the same direction, and a tall stack tilts.
    pub alternates: bool,
    /// The fraction of the penetration beyond the slop that is corrected in a step.
    pub baumgarte: N,
    /// The penetration that is not corrected, so that contacts persist.
    pub slop: N,
    /// The impulses of the last step.
    pub memory: Memory<N, D, K>,
}

impl<N: Turn<D>, const D: usize, K: Copy + Eq + Hash> Solver<N, D, K> {
    /// Creates a solver with the defaults: 60 steps per second, 10 iterations, gravity 10 along the
    /// negative second axis, friction 0.5.
    #[must_use]
    pub fn new(memory: Memory<N, D, K>) -> Self {
        let mut gravity = Vector::<N, D>::zeros();
        gravity[1] = N::lit(-10.0);
        let (step, friction) = (N::lit(1.0 / 60.0), N::HALF);
        let (baumgarte, slop) = (N::lit(0.2), N::lit(0.005));
        Self { step, gravity, friction, iterations: 10, alternates: true, baumgarte, slop, memory }
    }

    /// Advances the bodies by a step. `contacts` are the contacts at the current poses of the
    /// bodies.
    pub fn step(&mut self, bodies: &mut [Body<N, D>], contacts: &[Contact<N, D, K>]) {
        for body in bodies.iter_mut().filter(|body| body.inverse_mass != N::ZERO) {
            body.velocity += self.gravity * self.step;
        }
        let inertias: Vec<_> =
            bodies.iter().map(|body| N::in_world(&body.inverse_inertia, &body.pose)).collect();
        let old = self.memory.recalled(bodies, contacts);
        let constraints = contacts.iter().zip(old);
        let mut constraints: Vec<_> = constraints
            .map(|(contact, old)| self.constraint(bodies, &inertias, contact, &old))
            .collect();
        for constraint in &constraints {
            constraint.warm_start(bodies);
        }
        for iteration in 0..self.iterations {
            let is_backwards = self.alternates && iteration % 2 == 1;
            self.iterate(&mut constraints, is_backwards, bodies);
        }
        let impulses = constraints.iter().map(Constraint::impulse);
        self.memory.store(bodies, contacts, impulses);
        for body in bodies {
            let angle = body.spin * self.step;
            body.pose = N::moved(&body.pose, &body.center, &(body.velocity * self.step), angle);
        }
    }

    /// Runs one iteration over all constraints.
    fn iterate(
        &self,
        constraints: &mut [Constraint<N, D>],
        is_backwards: bool,
        bodies: &mut [Body<N, D>],
    ) {
        let count = constraints.len();
        let place = |n: usize| if is_backwards { count - 1 - n } else { n };
        for n in 0..count {
            constraints[place(n)].solve_friction(self.friction, bodies);
        }
        for n in 0..count {
            constraints[place(n)].solve_normal(bodies);
        }
    }

    fn constraint(
        &self,
        bodies: &[Body<N, D>],
        inertias: &[N::Inertia],
        contact: &Contact<N, D, K>,
        old: &Impulse<N, D>,
    ) -> Constraint<N, D> {
        let sides = [0, 1].map(|side| {
            let body = &bodies[contact.bodies[side]];
            let arm = contact.points[side] - N::point(&body.pose, &body.center);
            Side { arm, inverse_mass: body.inverse_mass, inertia: inertias[contact.bodies[side]] }
        });
        let rows = N::basis(&contact.normal).map(|direction| Row::new(direction, &sides));
        let mut impulses = rows.map(|row| row.direction.dot(&old.friction));
        impulses[0] = old.normal;
        let deep = max(contact.depth - self.slop, N::ZERO) * self.baumgarte;
        let way = if contact.depth < N::ZERO { contact.depth } else { deep };
        Constraint { bodies: contact.bodies, rows, impulses, parting: way / self.step }
    }
}

/// The data of a body at a contact.
struct Side<N: Turn<D>, const D: usize> {
    /// The vector from the centre of mass to the contact point.
    arm: Vector<N, D>,
    inverse_mass: N,
    inertia: N::Inertia,
}

/// A constraint along one direction at a contact (a row of the Jacobian).
#[derive(Clone, Copy)]
struct Row<N: Turn<D>, const D: usize> {
    direction: Vector<N, D>,
    /// The torques of a unit impulse along `direction` about the centre of each body.
    torques: [N::Spin; 2],
    /// The changes of angular velocity by these torques.
    responses: [N::Spin; 2],
    /// The effective mass: the impulse that changes the relative speed by 1.
    mass: N,
}

/// The constraints of a contact: a row along the normal, then the rows of friction.
struct Constraint<N: Turn<D>, const D: usize> {
    bodies: [usize; 2],
    rows: [Row<N, D>; D],
    impulses: [N; D],
    /// The minimum speed of separation along the normal; negative while there is a gap, which may
    /// close.
    parting: N,
}

impl<N: Turn<D>, const D: usize> Row<N, D> {
    fn new(direction: Vector<N, D>, sides: &[Side<N, D>; 2]) -> Self {
        let torques = [0, 1].map(|side| N::torque(&sides[side].arm, &direction));
        let responses = [0, 1].map(|side| N::response(&sides[side].inertia, torques[side]));
        let softness = [0, 1].map(|n| sides[n].inverse_mass + N::dot(torques[n], responses[n]));
        let total = softness[0] + softness[1];
        let mass = if total > N::ZERO { N::ONE / total } else { N::ZERO };
        Self { direction, torques, responses, mass }
    }

    /// Returns the speed of the second body relative to the first along the row.
    fn speed(&self, [first, second]: [&Body<N, D>; 2]) -> N {
        self.direction.dot(&(second.velocity - first.velocity))
            + N::dot(self.torques[1], second.spin)
            - N::dot(self.torques[0], first.spin)
    }

    /// Applies an impulse along the row to the second body, and the opposite impulse to the first.
    fn push(&self, impulse: N, numbers: [usize; 2], bodies: &mut [Body<N, D>]) {
        for (side, impulse) in [-impulse, impulse].into_iter().enumerate() {
            let body = &mut bodies[numbers[side]];
            body.velocity += self.direction * (impulse * body.inverse_mass);
            body.spin += self.responses[side] * impulse;
        }
    }
}

impl<N: Turn<D>, const D: usize> Constraint<N, D> {
    fn warm_start(&self, bodies: &mut [Body<N, D>]) {
        for (row, impulse) in self.rows.iter().zip(self.impulses) {
            row.push(impulse, self.bodies, bodies);
        }
    }

    fn solve_normal(&mut self, bodies: &mut [Body<N, D>]) {
        let speed = self.rows[0].speed(self.bodies.map(|n| &bodies[n]));
        let wanted = self.impulses[0] + (self.parting - speed) * self.rows[0].mass;
        self.change([max(wanted, N::ZERO)].into_iter(), 0, bodies);
    }

    /// Reduces the sliding velocity, with impulses within the friction cone.
    fn solve_friction(&mut self, friction: N, bodies: &mut [Body<N, D>]) {
        let pair = self.bodies.map(|n| &bodies[n]);
        let mut wanted: [N; D] = core::array::from_fn(|n| {
            self.impulses[n] - self.rows[n].speed(pair) * self.rows[n].mass
        });
        wanted[0] = N::ZERO;
        let length = wanted.iter().fold(N::ZERO, |sum, x| sum + *x * *x).sqrt();
        let limit = friction * self.impulses[0];
        let scale = if length > limit { limit / length } else { N::ONE };
        self.change(wanted.into_iter().skip(1).map(|x| x * scale), 1, bodies);
    }

    /// Replaces the accumulated impulses of the rows from `first` on, and applies the differences.
    fn change(&mut self, wanted: impl Iterator<Item = N>, first: usize, bodies: &mut [Body<N, D>]) {
        for (n, wanted) in (first..).zip(wanted) {
            self.rows[n].push(wanted - self.impulses[n], self.bodies, bodies);
            self.impulses[n] = wanted;
        }
    }

    fn impulse(&self) -> Impulse<N, D> {
        let tangents = self.rows.iter().zip(self.impulses).skip(1);
        let friction = tangents
            .fold(Vector::<N, D>::zeros(), |sum, (row, impulse)| sum + row.direction * impulse);
        Impulse { normal: self.impulses[0], friction }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{ContactSource, Kind, Stack, Stage, bodies_of, play};
    use impinge::math::Real;
    use impinge_scenes::{Placement, SceneShape};

    /// A source of contacts that needs no library: the corners of boxes (in 2D squares) that are at
    /// most 0.02 above the half-space `y <= 0`, which is the first body.
    struct Corners;

    impl<N: Stage<D>, const D: usize> ContactSource<N, D> for Corners {
        type Id = (usize, usize);

        fn contacts(&mut self, bodies: &[Body<N, D>]) -> Vec<Contact<N, D, Self::Id>> {
            let corners = (1..bodies.len()).flat_map(|body| (0..1 << D).map(move |n| (body, n)));
            let corners = corners.map(|(number, n)| {
                let sign = |axis: usize| if n >> axis & 1 == 0 { -N::HALF } else { N::HALF };
                let local = Vector::<N, D>::from_fn(|axis, _| sign(axis));
                let point = N::point(&bodies[number].pose, &local);
                let mut normal = Vector::<N, D>::zeros();
                normal[1] = N::ONE;
                let foot = point - normal * point[1];
                let bodies = [0, number];
                Contact { bodies, points: [foot, point], normal, depth: -point[1], id: (number, n) }
            });
            corners.filter(|contact| contact.depth > N::lit(-0.02)).collect()
        }
    }

    fn boxes<const D: usize>() -> Stack<D> {
        let up = core::array::from_fn(|axis| if axis == 1 { 1.0 } else { 0.0 });
        let ground = SceneShape::Plane { normal: up };
        let cube = SceneShape::Cuboid { half_extents: [0.5; D] };
        let at = core::array::from_fn(|axis| if axis == 1 { 0.5 } else { 0.0 });
        Stack::new("box", Kind::Rest).fixed(ground, [0.0; D]).with(cube, Placement::at(at))
    }

    fn solver<N: Stage<D>, const D: usize>() -> Solver<N, D, (usize, usize)> {
        Solver::new(Memory::by_ids())
    }

    fn rests<N: Stage<D>, const D: usize>() {
        let outcome = play::<N, D, _>(&boxes(), &mut Corners, solver(), 240);
        assert!(outcome.energy < 1e-9 && outcome.drift < 1e-3, "{outcome:?}");
        assert_eq!((outcome.counts.new, outcome.counts.points()), (0, (1 << (D - 1)) as f64));
    }

    /// Tilts gravity by `slope`, and asserts that a box slides only if the slope exceeds the
    /// friction coefficient, with the acceleration that remains after friction.
    fn slides<N: Stage<D>, const D: usize>() {
        for slope in [0.4, 0.6] {
            let mut bodies: Vec<Body<N, D>> = bodies_of(&boxes());
            let mut solver = solver();
            solver.gravity[0] = N::lit(10.0 * slope);
            for _ in 0..60 {
                let contacts = Corners.contacts(&bodies);
                solver.step(&mut bodies, &contacts);
            }
            let (speed, wanted) =
                (bodies[1].velocity[0].as_f64(), 10.0 * f64::max(slope - 0.5, 0.0));
            assert!((speed - wanted).abs() < 1e-2, "slope {slope}: {speed} after a second");
        }
    }

    /// Asserts that a collision of two free bodies conserves the total momentum and the total
    /// angular momentum about the origin.
    fn keeps_momentum<N: Stage<D>, const D: usize>() {
        let mut bodies: Vec<Body<N, D>> = bodies_of(&boxes::<D>());
        bodies[0] = bodies[1];
        bodies[0].pose = N::pose_of(&Placement::at([-0.6; D]));
        bodies[0].velocity[0] = N::lit(3.0);
        let mut normal = Vector::<N, D>::zeros();
        (normal[0], normal[1]) = (N::lit(0.8), N::lit(0.6));
        let point = Vector::<N, D>::from_fn(|axis, _| N::lit(0.1 * axis as f64));
        let contact =
            Contact { bodies: [0, 1], points: [point; 2], normal, depth: N::ZERO, id: (0, 0) };
        let mut solver = solver();
        solver.gravity = Vector::<N, D>::zeros();
        solver.step = N::lit(1e-6);
        let before = momenta(&bodies);
        solver.step(&mut bodies, &[contact]);
        let after = momenta(&bodies);
        let speed = bodies[1].velocity.norm().as_f64();
        assert!(speed > 0.1, "the second was pushed: {speed}");
        let off = before.iter().zip(&after).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-4, "{before:?} {after:?}");
    }

    /// Returns the total momentum, and the total angular momentum about three axes through the
    /// origin.
    fn momenta<N: Stage<D>, const D: usize>(bodies: &[Body<N, D>]) -> Vec<f64> {
        let axes = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]].map(|axis| axis.map(N::lit));
        let mut sums = vec![0.0; D + axes.len()];
        for body in bodies {
            let center = N::point(&body.pose, &body.center);
            let momentum = body.velocity / body.inverse_mass;
            let around = N::torque(&center, &momentum);
            for axis in 0..D {
                sums[axis] += momentum[axis].as_f64();
            }
            for (n, axis) in axes.iter().enumerate() {
                // The moment of inertia of a unit cube about every axis through its centre is a
                // sixth of its mass.
                let own = N::dot(body.spin, N::spin(*axis)) / (N::lit(6.0) * body.inverse_mass);
                sums[D + n] += (own + N::dot(around, N::spin(*axis))).as_f64();
            }
        }
        sums
    }

    fn all<N: Real>() {
        rests::<N, 2>();
        rests::<N, 3>();
        slides::<N, 2>();
        slides::<N, 3>();
        keeps_momentum::<N, 2>();
        keeps_momentum::<N, 3>();
    }

    #[test]
    fn boxes_rest_slide_and_keep_their_momentum() {
        all::<f32>();
        #[cfg(feature = "f64")]
        all::<f64>();
    }
}
