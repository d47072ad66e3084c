//! Rigid bodies that fall, collide and come to rest: a minimal solver for the samples with piles
//! and stacks.
//!
//! The library computes contacts and leaves motion to its users. The method is sequential impulses
//! with warm starts (Catto, "Iterative dynamics with temporal coherence", 2005). In each of several
//! rounds, each contact point in turn gets the impulse that stops its approach. Its initial impulse
//! is that of the contact with the same id in the previous step.

use std::collections::BTreeMap;

use impinge::math::{Matrix, Pose, Space, Vector, max, min, unit_or};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::{ContactId, ContactPoint};
use impinge_record::Recordable;

use crate::place::pose_of;
use crate::{Isometry, SampleError, TIME_STEP, World};

const ITERATIONS: usize = 20;
const GRAVITY: f32 = 10.0;
const FRICTION: f32 = 0.5;
/// The penetration depth up to which penetrations are not corrected, so that contacts persist.
const SLOP: f32 = 0.005;
/// The share of the penetration beyond [`SLOP`] that is corrected in a step.
const RECOVERY: f32 = 0.2;
/// A body keeps its position while the norms of its velocity and of its spin are both below this
/// value.
const REST_SPEED: f32 = 0.03;

/// A moving body. It has the moment of inertia of a cube (2D: a square), which is equal about every
/// axis.
#[derive(Clone, Debug)]
struct Body<const D: usize> {
    /// The object in the world.
    object: CollisionObjectHandle,
    /// The inverse of the mass.
    inverse_mass: f32,
    /// The inverse of the moment of inertia.
    inverse_inertia: f32,
    /// The velocity of the centre in lengths per second.
    velocity: Vector<f32, D>,
    /// The angular velocity as an antisymmetric matrix, which maps a vector from the centre to the
    /// velocity at its end.
    spin: Matrix<f32, D>,
}

/// A contact point of the solver.
#[derive(Clone, Debug)]
struct Row<const D: usize> {
    id: ContactId,
    /// The indices of the two bodies; `None` for an object that does not move.
    bodies: [Option<usize>; 2],
    /// The vectors from the centres of both bodies to the contact point.
    arms: [Vector<f32, D>; 2],
    normal: Vector<f32, D>,
    /// The target speed of separation along the normal; negative while there is a gap.
    speed: f32,
    impulse: Impulse<D>,
}

/// The accumulated impulse of a contact point, on the second body.
#[derive(Clone, Copy, Debug)]
struct Impulse<const D: usize> {
    /// The component along the normal; never negative.
    normal: f32,
    /// The component tangential to the contact.
    friction: Vector<f32, D>,
}

/// The moving bodies of a world. All other objects are at rest.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bodies<const D: usize> {
    /// The bodies in the order in which they were added.
    bodies: Vec<Body<D>>,
    /// The index in `bodies` for each object.
    indices: BTreeMap<CollisionObjectHandle, usize>,
    /// The impulses of the last step by contact id. The id persists while the contact moves.
    impulses: BTreeMap<ContactId, Impulse<D>>,
}

impl<const D: usize> Bodies<D>
where
    f32: Recordable<D>,
{
    /// Adds an object as a falling body. Its mass and moment of inertia are those of a cube (2D: a
    /// square) of density 1 with this half width.
    pub(crate) fn add(&mut self, object: CollisionObjectHandle, half_width: f32) {
        let mass = (0..D).fold(1.0, |mass, _| mass * 2.0 * half_width);
        let body = Body {
            object,
            inverse_mass: 1.0 / mass,
            inverse_inertia: 6.0 / (mass * 4.0 * half_width * half_width),
            velocity: Vector::<f32, D>::zeros(),
            spin: Matrix::<f32, D>::zeros(),
        };
        self.indices.insert(object, self.bodies.len());
        self.bodies.push(body);
    }

    /// Sets the velocity of a body. An object that is not a body is ignored.
    pub(crate) fn push(&mut self, object: CollisionObjectHandle, velocity: Vector<f32, D>) {
        if let Some(index) = self.indices.get(&object) {
            self.bodies[*index].velocity = velocity;
        }
    }

    /// Returns the largest speed of all bodies.
    pub(crate) fn speed(&self) -> f32 {
        self.bodies.iter().map(|body| body.velocity.norm()).fold(0.0, max)
    }

    /// Advances the bodies by a step under gravity, with the contacts of the last update.
    pub(crate) fn advance(&mut self, world: &mut World<D>) -> Result<(), SampleError> {
        for body in &mut self.bodies {
            body.velocity[1] -= GRAVITY * TIME_STEP;
        }
        let mut rows = self.rows(world);
        for row in &rows {
            // Warm start: applies the impulse of the previous step.
            let push = row.normal * row.impulse.normal + row.impulse.friction;
            self.apply(row, &push);
        }
        for _ in 0..ITERATIONS {
            for row in &mut rows {
                self.solve(row);
            }
        }
        self.impulses = rows.iter().map(|row| (row.id, row.impulse)).collect();
        // All positions are set in one call: the world accepts all or none.
        let moved: Vec<_> = self.bodies.iter_mut().filter_map(|body| body.moved(world)).collect();
        Ok(world.set_positions(&moved)?)
    }

    fn rows(&self, world: &World<D>) -> Vec<Row<D>> {
        let mut rows = Vec::new();
        for (object1, object2, manifold) in world.contact_views() {
            let handles = [object1.handle(), object2.handle()];
            let bodies = handles.map(|handle| self.indices.get(&handle).copied());
            if bodies == [None, None] {
                continue;
            }
            let centers = handles.map(|handle| pose_of(world, handle).translation);
            rows.extend(manifold.contacts().map(|point| self.row(bodies, centers, &point)));
        }
        rows
    }

    fn row(
        &self,
        bodies: [Option<usize>; 2],
        centers: [Vector<f32, D>; 2],
        point: &ContactPoint<f32, D>,
    ) -> Row<D> {
        let contact = &point.contact;
        // The contact acts at the midpoint of the two surface points. Opposite impulses at one
        // point preserve angular momentum.
        let middle = (contact.world1.coords + contact.world2.coords) * 0.5;
        let depth = contact.depth;
        // A gap may close within a step. A penetration is corrected slowly, which keeps piles
        // stable.
        let closing = if depth < 0.0 { depth } else { RECOVERY * max(depth - SLOP, 0.0) };
        let none = Impulse { normal: 0.0, friction: Vector::<f32, D>::zeros() };
        Row {
            id: point.id,
            bodies,
            arms: centers.map(|center| middle - center),
            normal: contact.normal.into_inner(),
            speed: min(closing / TIME_STEP, 3.0),
            impulse: self.impulses.get(&point.id).copied().unwrap_or(none),
        }
    }

    /// Corrects the impulse of a contact point. The normal impulse is never negative, and bounds
    /// the friction (Coulomb).
    fn solve(&mut self, row: &mut Row<D>) {
        let normal = row.normal;
        let parting = self.relative_velocity(row).dot(&normal);
        let wanted = row.impulse.normal + (row.speed - parting) * self.mass(row, &normal);
        let wanted = max(wanted, 0.0);
        self.apply(row, &(normal * (wanted - row.impulse.normal)));
        row.impulse.normal = wanted;

        let velocity = self.relative_velocity(row);
        // Friction reduces the remaining tangential velocity.
        let sliding = velocity - normal * velocity.dot(&normal);
        let direction = unit_or(&sliding, Vector::<f32, D>::zeros());
        let friction = row.impulse.friction - sliding * self.mass(row, &direction);
        let bound = FRICTION * row.impulse.normal;
        let excess = friction.norm() / max(bound, f32::MIN_POSITIVE);
        let friction = if excess > 1.0 { friction / excess } else { friction };
        self.apply(row, &(friction - row.impulse.friction));
        row.impulse.friction = friction;
    }

    /// Returns the velocity of the second body relative to the first, at the contact point.
    fn relative_velocity(&self, row: &Row<D>) -> Vector<f32, D> {
        let velocity = |side: usize| {
            let body = row.bodies[side].map(|index| &self.bodies[index]);
            let velocity = body.map(|body| body.velocity + body.spin * row.arms[side]);
            velocity.unwrap_or_else(Vector::<f32, D>::zeros)
        };
        velocity(1) - velocity(0)
    }

    /// Returns the effective mass: the impulse along `direction` that changes the relative speed
    /// along it by 1. `direction` is a unit vector.
    fn mass(&self, row: &Row<D>, direction: &Vector<f32, D>) -> f32 {
        let inverse = |side: usize| {
            let body = row.bodies[side].map(|index| &self.bodies[index]);
            let (arm, along) = (row.arms[side], row.arms[side].dot(direction));
            let across = arm.norm_squared() - along * along;
            body.map_or(0.0, |body| body.inverse_mass + body.inverse_inertia * across)
        };
        1.0 / (inverse(0) + inverse(1))
    }

    /// Applies an impulse to the second body at the contact point, and the opposite impulse to the
    /// first.
    fn apply(&mut self, row: &Row<D>, impulse: &Vector<f32, D>) {
        for (side, sign) in [(0, -1.0), (1, 1.0)] {
            if let Some(index) = row.bodies[side] {
                let (body, push) = (&mut self.bodies[index], impulse * sign);
                body.velocity += push * body.inverse_mass;
                // The impulse rotates the body in the plane of `arms[side]` and `push`: an
                // antisymmetric matrix in 2D and 3D.
                let moment = push * row.arms[side].transpose();
                body.spin += (moment - moment.transpose()) * body.inverse_inertia;
            }
        }
    }
}

impl<const D: usize> Body<D>
where
    f32: Recordable<D>,
{
    /// Damps the motion and returns the position after a step; `None` for a body that keeps its
    /// position because it is slower than [`REST_SPEED`].
    fn moved(&mut self, world: &World<D>) -> Option<(CollisionObjectHandle, Isometry<D>)> {
        // The damping is small, like that of air.
        self.velocity *= 0.998;
        self.spin *= 0.99;
        if self.velocity.norm() < REST_SPEED && self.spin.norm() < REST_SPEED {
            return None;
        }
        let pose = pose_of(world, self.object);
        let turned = pose.rotation + self.spin * pose.rotation * TIME_STEP;
        let pose = Pose {
            rotation: orthonormal(turned),
            translation: pose.translation + self.velocity * TIME_STEP,
        };
        Some((self.object, f32::isometry(&pose)))
    }
}

/// Orthonormalizes the columns of a matrix, the first column first (Gram-Schmidt).
fn orthonormal<const D: usize>(mut matrix: Matrix<f32, D>) -> Matrix<f32, D> {
    for column in 0..D {
        let mut axis = matrix.column(column).into_owned();
        for before in 0..column {
            let other = matrix.column(before).into_owned();
            axis -= other * axis.dot(&other);
        }
        matrix.set_column(column, &(axis / axis.norm()));
    }
    matrix
}
