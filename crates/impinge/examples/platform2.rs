//! A one-way platform: the player jumps through it from below, lands on it from above, and drops
//! through it on demand. A pair filter rejects the pair while the player passes. The world does not
//! notice when the result of a filter changes. So the program registers the filter again after each
//! change. The output is the height of the feet over time.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;

#[derive(Clone, Copy, PartialEq)]
enum Thing {
    Floor,
    Platform,
    Player { passes: bool },
}

type World = CollisionWorld<f64, Thing>;
type Object = CollisionObject<f64, Thing>;

const STEP: f64 = 1.0 / 64.0;
const GRAVITY: f64 = 10.0;

/// Returns `false` for the platform and a player who passes.
fn may_touch(object1: &Object, object2: &Object) -> bool {
    let things = [*object1.data(), *object2.data()];
    !(things.contains(&Thing::Platform) && things.contains(&Thing::Player { passes: true }))
}

/// Sets whether the player passes the platform. Registering the filter again makes the next update
/// filter all pairs.
fn let_pass(world: &mut World, player: CollisionObjectHandle, passes: bool) {
    let object = world.collision_object_mut(player).expect("the player is never removed");
    *object.data_mut() = Thing::Player { passes };
    world.register_broad_phase_pair_filter("one-way platforms", may_touch);
}

/// Builds a floor at height 0, a platform from 1.75 to 2, and a player of width and height 1.
fn build() -> (World, CollisionObjectHandle) {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
    let floor = ShapeHandle::new(Plane::new(Vector::y_axis()));
    world.add(Isometry::identity(), floor, groups, query, Thing::Floor);
    let platform = ShapeHandle::new(Cuboid::new(Vector::new(4.0, 0.125)));
    world.add(Isometry::translation(0.0, 1.875), platform, groups, query, Thing::Platform);
    let body = ShapeHandle::new(Cuboid::new(Vector::new(0.5, 0.5)));
    let position = Isometry::translation(0.0, 0.5);
    let player = world.add(position, body, groups, query, Thing::Player { passes: false });
    world.register_broad_phase_pair_filter("one-way platforms", may_touch);
    (world, player)
}

/// Returns the depth of the player in the object that supports the player: the depth of the deepest
/// contact whose normal, which points away from the player, points down.
fn sunk(world: &World, player: CollisionObjectHandle) -> Option<f64> {
    let below = world.contacts_with(player).filter(|(_, point)| point.contact.normal.y < -0.5);
    below.map(|(_, point)| point.contact.depth).reduce(f64::max)
}

fn main() {
    let (mut world, player) = build();
    let (mut feet, mut speed, mut trace) = (0.0, 0.0, Vec::new());
    for step in 0..192 {
        match step {
            16 => {
                speed = 8.0; // it rises by 8² / 20 = 3.2
                let_pass(&mut world, player, true);
            }
            128 => let_pass(&mut world, player, true), // the player presses "down"
            _ => {}
        }
        let was_rising = speed > 0.0;
        speed -= GRAVITY * STEP;
        if was_rising && speed <= 0.0 {
            let_pass(&mut world, player, false); // at the top it becomes solid again
        }
        feet += speed * STEP;
        world.set_position(player, Isometry::translation(0.0, feet + 0.5));
        world.update();
        if let (Some(depth), true) = (sunk(&world, player), speed <= 0.0) {
            feet += depth;
            speed = 0.0;
        }
        trace.push(feet);
    }

    // Time runs to the right, three steps per column; a row is a quarter high.
    for row in (0..14).rev() {
        let low = f64::from(row) * 0.25 - 0.125;
        let is_here = |feet: &f64| (low..low + 0.25).contains(feet);
        let blank = if row == 8 { '=' } else { ' ' };
        let mark = |steps: &[f64]| if steps.iter().any(is_here) { 'o' } else { blank };
        println!("{}", trace.chunks(3).map(mark).collect::<String>());
    }
    println!("{}", "#".repeat(64));

    let highest = trace.iter().copied().fold(0.0, f64::max);
    assert!((highest - 3.2).abs() < 0.07, "the jump went through: {highest}");
    assert!((trace[127] - 2.0).abs() < 1e-12, "it came to rest on the platform: {}", trace[127]);
    assert!(trace[191].abs() < 1e-12, "and dropped to the floor: {}", trace[191]);
}
