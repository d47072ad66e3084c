//! Bullets and their owners. Two ships shoot at each other, and each bullet starts inside the ship
//! that fires it. A pair filter rejects pairs of a bullet and its owner, and pairs of bullets. With
//! groups alone each ship would need its own group. Hits are contact events, and a bullet that hits
//! is removed. The output is the list of hits.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim3::prelude::*;

enum Thing {
    Ship { name: &'static str, hits: u32 },
    Bullet { owner: CollisionObjectHandle, velocity: Vector<f32> },
}

type World = CollisionWorld<f32, Thing>;
type Object = CollisionObject<f32, Thing>;

/// Returns `true` for a bullet and a ship that does not own it, and for two ships.
fn may_touch(object1: &Object, object2: &Object) -> bool {
    match (object1.data(), object2.data()) {
        (Thing::Bullet { .. }, Thing::Bullet { .. }) => false,
        (Thing::Bullet { owner, .. }, Thing::Ship { .. }) => *owner != object2.handle(),
        (Thing::Ship { .. }, Thing::Bullet { owner, .. }) => *owner != object1.handle(),
        (Thing::Ship { .. }, Thing::Ship { .. }) => true,
    }
}

fn add_ship(world: &mut World, name: &'static str, x: f32) -> CollisionObjectHandle {
    let hull = ShapeHandle::new(Capsule::new(1.0, 0.75));
    let lying = Vector::z() * std::f32::consts::FRAC_PI_2;
    let position = Isometry::new(Vector::new(x, 0.0, 0.0), lying);
    let ship = Thing::Ship { name, hits: 0 };
    world.add(position, hull, CollisionGroups::new(), ContactQuery::default(), ship)
}

fn fire(world: &mut World, owner: CollisionObjectHandle, velocity: Vector<f32>) {
    let ship = world.collision_object(owner).expect("ships are never removed");
    let position = Isometry::from(ship.position().translation);
    let ball = ShapeHandle::new(Ball::new(0.125));
    let bullet = Thing::Bullet { owner, velocity };
    world.add(position, ball, CollisionGroups::new(), ContactQuery::default(), bullet);
}

/// Moves all bullets by a step.
fn fly(world: &mut World) {
    let moved = world.collision_objects().filter_map(|object| {
        let Thing::Bullet { velocity, .. } = object.data() else { return None };
        let mut position = *object.position();
        position.translation.vector += velocity;
        Some((object.handle(), position))
    });
    let moved: Vec<_> = moved.collect();
    world.set_positions(&moved);
}

/// Counts the hits of the last update and removes the bullets that hit. Returns the lines to print.
fn strike(world: &mut World) -> Vec<String> {
    let (mut lines, mut spent) = (Vec::new(), Vec::new());
    for event in world.contact_events().to_vec() {
        let ContactEvent::Started(handle1, handle2) = event else { continue };
        for handle in [handle1, handle2] {
            // The bullets are removed after the loop, so all handles are still valid.
            match world.collision_object_mut(handle).expect("it has just been hit").data_mut() {
                Thing::Bullet { .. } => spent.push(handle),
                Thing::Ship { name, hits } => {
                    *hits += 1;
                    lines.push(format!("the {name} ship is hit"));
                }
            }
        }
    }
    world.remove(&spent);
    lines
}

fn main() {
    let mut world = World::new(0.05);
    world.register_broad_phase_pair_filter("owners", may_touch);
    let (red, blue) = (add_ship(&mut world, "red", -10.0), add_ship(&mut world, "blue", 10.0));

    let mut log = Vec::new();
    for step in 0..40 {
        if step % 10 == 0 {
            fire(&mut world, red, Vector::x());
        }
        if step == 5 {
            fire(&mut world, blue, -Vector::x());
            fire(&mut world, blue, Vector::y()); // upwards, away from both ships
        }
        world.update();
        log.extend(strike(&mut world).into_iter().map(|line| format!("step {step:2}: {line}")));
        fly(&mut world);
    }
    println!("{}", log.join("\n"));

    // The near end of a ship is 1.75 from its center, so a bullet of radius 0.125 touches it when
    // its center is 1.875 away. That is 18.125 from its start, which takes 19 steps of length 1.
    // The bullets fired at steps 0, 10 and 20 arrive before the end.
    let expected = [
        "step 19: the blue ship is hit",
        "step 24: the red ship is hit",
        "step 29: the blue ship is hit",
        "step 39: the blue ship is hit",
    ];
    assert_eq!(log, expected, "nobody hits itself, and bullets fly through each other");
    let hits = |ship| match world.collision_object(ship).map(Object::data) {
        Some(Thing::Ship { hits, .. }) => *hits,
        _ => unreachable!("ships are never removed"),
    };
    assert_eq!((hits(red), hits(blue)), (1, 3), "as the log says");
    assert_eq!(
        world.len(),
        4,
        "two ships, the bullet that hit nobody, and the last one on its way"
    );
}
