//! A bullet that does not tunnel. In one step it flies more than eight times the thickness of a
//! wall. If it is only moved and tested for contacts, it passes the wall between two steps; if it
//! is cast along its path, it bounces off. The number of bounces and the end point are checked by
//! unfolding the room: mirror images of the room are laid side by side, and the path becomes a
//! straight line.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;

type World = CollisionWorld<f64, &'static str>;

const RADIUS: f64 = 0.125;
/// Half the size of the room, and half the size of the square to which the center of a bullet is
/// limited.
const ROOM: f64 = 5.0;
const FREE: f64 = ROOM - RADIUS;
const STEP: f64 = 1.0 / 64.0;
const STEPS: u32 = 256;

/// Builds four walls around the origin, each an eighth thick.
fn build() -> World {
    let mut world = World::new(0.02);
    let thin = 1.0 / 16.0;
    for outward in [Vector::x(), -Vector::x(), Vector::y(), -Vector::y()] {
        // The wall is thin along `outward`, and across `outward` long enough to close the corners.
        let half =
            outward.abs() * thin + (Vector::repeat(1.0) - outward.abs()) * (ROOM + 2.0 * thin);
        let position = Isometry::new(outward * (ROOM + thin), 0.0);
        let wall = ShapeHandle::new(Cuboid::new(half));
        world.add(position, wall, CollisionGroups::new(), ContactQuery::default(), "wall");
    }
    world
}

/// Moves the bullet by one step and reflects its velocity at each wall on the way. Returns the
/// number of bounces.
fn fly(world: &World, center: &mut Vector<f64>, velocity: &mut Vector<f64>) -> u32 {
    let (bullet, all) = (Ball::new(RADIUS), QueryFilter::new());
    let (mut left, mut bounces) = (STEP, 0);
    // At this speed a step meets at most two walls, in a corner.
    while bounces < 4 {
        let options = ImpactOptions::new().with_max_time(left);
        let position = Isometry::new(*center, 0.0);
        let Some((_, hit)) = world.cast_shape(&position, velocity, &bullet, &options, &all) else {
            break;
        };
        *center += *velocity * hit.toi;
        // A shape that touches a wall and moves away from it has no impact, so the next cast leaves
        // the wall.
        *velocity -= *hit.normal * (2.0 * velocity.dot(&hit.normal));
        left -= hit.toi;
        bounces += 1;
    }
    *center += *velocity * left;
    bounces
}

/// Returns the number of steps after which a bullet is in contact, if it is moved without casts.
fn contacts_when_only_moved(world: &mut World, velocity: Vector<f64>) -> u32 {
    let bullet = ShapeHandle::new(Ball::new(RADIUS));
    let groups = CollisionGroups::new();
    let bullet = world.add(Isometry::identity(), bullet, groups, ContactQuery::default(), "bullet");
    let mut found = 0;
    for step in 1..=STEPS {
        let center = velocity * (STEP * f64::from(step));
        world.set_position(bullet, Isometry::new(center, 0.0));
        world.update();
        found += u32::from(world.contacts_with(bullet).next().is_some());
    }
    world.remove(&[bullet]);
    found
}

/// Returns the end point of a straight path of length `way` from 0, folded into the range from
/// −FREE to FREE, and the number of reflections.
fn unfold(way: f64) -> (f64, f64) {
    let rooms = ((way + FREE) / (2.0 * FREE)).floor();
    let along = way - rooms * 2.0 * FREE;
    (if rooms.rem_euclid(2.0) == 0.0 { along } else { -along }, rooms.abs())
}

fn main() {
    let mut world = build();
    let thrown = Vector::new(60.0, 35.0); // about 1.1 units per step
    let missed = contacts_when_only_moved(&mut world, thrown);
    println!(
        "Only moved: {missed} contacts, and it is {:.0} away.",
        thrown.norm() * STEP * f64::from(STEPS)
    );

    let (mut center, mut velocity, mut bounces, mut farthest) = (Vector::zeros(), thrown, 0, 0.0);
    for _ in 0..STEPS {
        bounces += fly(&world, &mut center, &mut velocity);
        farthest = f64::max(farthest, center.amax());
    }
    println!("Cast: {bounces} bounces, and it is at ({:.6}, {:.6}).", center.x, center.y);

    let way = thrown * (STEP * f64::from(STEPS));
    let ((x, bounces_x), (y, bounces_y)) = (unfold(way.x), unfold(way.y));
    assert_eq!(missed, 0, "it flew past the wall between two steps");
    assert_eq!(
        f64::from(bounces),
        bounces_x + bounces_y,
        "each room of the unfolded path is a bounce"
    );
    assert!((center - Vector::new(x, y)).norm() < 1e-9, "where the unfolded path ends");
    assert!(farthest <= FREE + 1e-9, "it never left the room");
    assert!((velocity.norm() - thrown.norm()).abs() < 1e-9, "nor did it gain or lose speed");
}
