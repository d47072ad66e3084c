//! A kinematic character walks to the right: up a flight of steps, down from a ledge, and against a
//! wall. In each frame its box is cast up, across and down, and stops at a small distance from any
//! obstacle. Contacts show whether the character stands on something. The output is the path of its
//! feet.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;

type World = CollisionWorld<f64, &'static str>;

/// Half the width and half the height of the character.
const HALF: [f64; 2] = [0.25, 0.75];
/// The distance kept from obstacles. A cast that stops at this distance never leaves the character
/// in contact, so the next cast does not start in contact.
const SKIN: f64 = 1.0 / 64.0;
/// The maximum height of a step that the character climbs, and the height by which it falls in a
/// frame.
const STEP: f64 = 0.375;
const FALL: f64 = 0.125;

/// Builds a floor at height 0, three steps of 0.25 from x = 2 on, a plateau until x = 7, and a wall
/// at x = 9.
fn build() -> World {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::new(SKIN));
    let floor = ShapeHandle::new(Plane::new(Vector::y_axis()));
    world.add(Isometry::identity(), floor, groups, query, "floor");
    // The left end, the right end and the height of each box.
    for [left, right, height] in
        [[2.0, 7.0, 0.25], [3.0, 7.0, 0.5], [4.0, 7.0, 0.75], [9.0, 10.0, 2.0]]
    {
        let half = Vector::new((right - left) / 2.0, height / 2.0);
        let position = Isometry::translation((left + right) / 2.0, half.y);
        world.add(position, ShapeHandle::new(Cuboid::new(half)), groups, query, "box");
    }
    world
}

/// Returns the position of a character after a straight motion, which stops at the distance `SKIN`
/// from an obstacle.
fn sweep(world: &World, character: CollisionObjectHandle, motion: Vector<f64>) -> Isometry<f64> {
    let object = world.collision_object(character).expect("the character is never removed");
    let options = ImpactOptions::new().with_max_time(1.0).with_target_distance(SKIN);
    let others = QueryFilter::new().exclude(character);
    let hit = world.cast_shape(object.position(), &motion, &**object.shape(), &options, &others);
    let time = hit.map_or(1.0, |(_, impact)| impact.toi);
    let mut position = *object.position();
    position.translation.vector += motion * time;
    position
}

/// Moves the character by one frame: up by a step, across, and down by a step and by the fall. On a
/// flat floor the character returns to the height of the floor. Before a low step it ends on top of
/// the step. A wall before it blocks the motion across.
fn walk(world: &mut World, character: CollisionObjectHandle, across: f64) {
    let before = world.collision_object(character).expect("never removed").position().translation.y;
    for motion in [Vector::new(0.0, STEP), Vector::new(across, 0.0)] {
        let position = sweep(world, character, motion);
        world.set_position(character, position);
    }
    // Under a low ceiling the character rises by less than a step.
    let risen =
        world.collision_object(character).expect("never removed").position().translation.y - before;
    let position = sweep(world, character, Vector::new(0.0, -risen - FALL));
    world.set_position(character, position);
}

/// Returns `true` if something supports the character: a contact whose normal, which points away
/// from the character, points down.
fn is_grounded(world: &World, character: CollisionObjectHandle) -> bool {
    world.contacts_with(character).any(|(_, point)| point.contact.normal.y < -0.7)
}

fn main() {
    let mut world = build();
    let shape = ShapeHandle::new(Cuboid::new(Vector::from(HALF)));
    let start = Isometry::translation(0.5, HALF[1] + SKIN);
    let query = ContactQuery::new(SKIN);
    let character = world.add(start, shape, CollisionGroups::new(), query, "character");

    let (mut feet, mut in_the_air) = (Vec::new(), 0);
    for _ in 0..100 {
        walk(&mut world, character, 0.125);
        world.update();
        in_the_air += u32::from(!is_grounded(&world, character));
        let center =
            world.collision_object(character).expect("never removed").position().translation.vector;
        feet.push(Point::new(center.x, center.y - HALF[1]));
    }

    for row in (0..6).rev() {
        let at = |column: u32| {
            let cell = Point::new(f64::from(column) * 0.25 + 0.125, f64::from(row) * 0.25 - 0.125);
            let on_path = |foot: &Point<f64>| (foot - cell).amax() <= 0.125 + SKIN;
            let solid =
                world.objects_containing(&cell, &QueryFilter::new().exclude(character)).next();
            if solid.is_some() {
                '#'
            } else if feet.iter().any(on_path) {
                'o'
            } else {
                ' '
            }
        };
        println!("{}", (0..40).map(at).collect::<String>());
    }
    let last = feet[feet.len() - 1];
    println!(
        "It ends at ({:.3}, {:.3}) and was in the air for {in_the_air} frames.",
        last.x, last.y
    );

    let highest = feet.iter().map(|foot| foot.y).fold(0.0, f64::max);
    assert!((highest - 0.75 - SKIN).abs() < 1e-9, "it walked over the plateau");
    assert!(
        (last - Point::new(9.0 - HALF[0] - SKIN, SKIN)).norm() < 1e-9,
        "it stands before the wall"
    );
    assert_eq!(in_the_air, 5, "from 0.75 down by 0.125 a frame, the last of which lands");
}
