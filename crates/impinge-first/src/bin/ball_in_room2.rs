//! A ball bounces in a square room. The program prints which coloured areas the ball enters and
//! leaves.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::cell::Cell;

use impinge::dim2::events::{ContactEvent, Proximity, ProximityEvent};
use impinge::dim2::math::{Isometry, Unit, Vector};
use impinge::dim2::shape::{Ball, Cuboid, Plane, ShapeHandle};
use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};

/// The data of an object. Only the ball has a velocity, in units per second.
struct ObjectData {
    name: &'static str,
    velocity: Option<Cell<Vector<f32>>>,
}

type World = CollisionWorld<f32, ObjectData>;

/// The duration of a step, in seconds.
const STEP: f32 = 0.016;

fn fixed(name: &'static str) -> ObjectData {
    ObjectData { name, velocity: None }
}

/// Returns the groups of the ball and of all other objects. The ball is in group 1, the others are
/// in group 2 and interact with group 1 only.
fn groups() -> (CollisionGroups, CollisionGroups) {
    let mut ball = CollisionGroups::new();
    ball.set_membership(&[1]);
    let mut others = CollisionGroups::new();
    others.set_membership(&[2]);
    others.set_whitelist(&[1]);
    (ball, others)
}

/// Builds the world: the ball, four walls, and four areas.
fn build() -> World {
    let mut world = CollisionWorld::new(0.02);
    let (ball_groups, other_groups) = groups();
    let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    for inward in [Vector::x(), -Vector::x(), Vector::y(), -Vector::y()] {
        let wall = ShapeHandle::new(Plane::new(Unit::new_normalize(inward)));
        let position = Isometry::new(inward * -10.0, 0.0);
        world.add(position, wall, other_groups, contacts, fixed("wall"));
    }
    let area = ShapeHandle::new(Cuboid::new(Vector::new(4.9, 4.9)));
    let areas =
        [("purple", -5.0, 5.0), ("blue", 5.0, 5.0), ("green", 5.0, -5.0), ("yellow", -5.0, -5.0)];
    for (name, x, y) in areas {
        let position = Isometry::translation(x, y);
        let proximity = GeometricQueryType::Proximity(0.0);
        world.add(position, area.clone(), other_groups, proximity, fixed(name));
    }
    let ball = ShapeHandle::new(Ball::new(0.5));
    let data = ObjectData { name: "ball", velocity: Some(Cell::new(Vector::new(10.0, 5.0))) };
    world.add(Isometry::translation(5.0, 5.0), ball, ball_groups, contacts, data);
    world
}

/// Returns the line to print for an event of the ball and an area. `None` if the new status is
/// [`Proximity::WithinMargin`], or if neither object of the event is an area.
fn describe(world: &World, event: &ProximityEvent) -> Option<String> {
    let area = [event.collider1, event.collider2]
        .into_iter()
        .filter_map(|handle| world.collision_object(handle))
        .find(|object| object.data().velocity.is_none())?;
    let name = area.data().name;
    match event.new_status {
        Proximity::Intersecting => Some(format!("The ball enters the {name} area.")),
        Proximity::Disjoint => Some(format!("The ball leaves the {name} area.")),
        Proximity::WithinMargin => None,
    }
}

/// Reflects the ball's velocity along the normal of the deepest contact.
fn bounce(world: &World, event: &ContactEvent) {
    let ContactEvent::Started(handle1, handle2) = *event else { return };
    let pair = world.contact_pair(handle1, handle2).expect("contacts started");
    let mut manifolds = Vec::new();
    pair.contacts(&mut manifolds);
    let deepest = manifolds[0].deepest_contact().expect("contacts started").contact;
    for handle in [handle1, handle2] {
        let object = world.collision_object(handle).expect("it was not removed");
        if let Some(velocity) = &object.data().velocity {
            let old = velocity.get();
            velocity.set(old - *deepest.normal * (2.0 * old.dot(&deepest.normal)));
        }
    }
}

/// Moves the ball by one step.
fn advance(world: &mut World) {
    let moved = world.collision_objects().find_map(|object| {
        let velocity = object.data().velocity.as_ref()?.get();
        let position = object.position().translation.vector + velocity * STEP;
        Some((object.handle(), Isometry::new(position, 0.0)))
    });
    let (ball, position) = moved.expect("there is a ball");
    world.set_position(ball, position);
}

/// Runs the world until the ball has entered or left an area at least `lines` times. Returns a line
/// for each of these events.
pub(crate) fn run(lines: usize) -> Vec<String> {
    let mut world = build();
    let mut log = Vec::new();
    while log.len() < lines {
        world.update();
        log.extend(world.proximity_events().iter().filter_map(|event| describe(&world, event)));
        for event in world.contact_events() {
            bounce(&world, event);
        }
        advance(&mut world);
    }
    log
}

/// The first lines that [`run`] must return.
pub(crate) const EXPECTED: [&str; 13] = [
    "The ball enters the blue area.",
    "The ball enters the purple area.",
    "The ball leaves the blue area.",
    "The ball enters the yellow area.",
    "The ball leaves the purple area.",
    "The ball enters the green area.",
    "The ball leaves the yellow area.",
    "The ball enters the yellow area.",
    "The ball leaves the green area.",
    "The ball enters the purple area.",
    "The ball leaves the yellow area.",
    "The ball enters the blue area.",
    "The ball leaves the purple area.",
];

#[allow(dead_code, reason = "the tests run the program without it")]
fn main() {
    let log = run(40);
    for line in &log {
        println!("{line}");
    }
    assert_eq!(log[..EXPECTED.len()], EXPECTED, "the order of the first lines");
}
