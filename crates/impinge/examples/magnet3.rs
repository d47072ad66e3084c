//! A magnet among scrap. A query finds the three iron objects nearest to it, and each of them moves
//! along the line between the closest points until it touches the magnet. Distances are between
//! surfaces, not between centers: a long bar whose end is near comes before a ball whose center is
//! nearer. The output is the list of objects by distance.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim3::prelude::*;

struct Scrap {
    name: &'static str,
    is_iron: bool,
}

type World = CollisionWorld<f64, Scrap>;

/// The maximum distance of an object that the magnet attracts, and the radius of the magnet.
const RANGE: f64 = 4.0;
const RADIUS: f64 = 1.0;

/// Builds scrap around the magnet, which is at the origin.
fn build() -> World {
    let mut world = World::new(0.02);
    let pieces = [
        ("ball", true, [3.5, 0.0, 0.0], ShapeHandle::new(Ball::new(0.5))),
        ("bar", true, [0.0, 0.0, 5.0], ShapeHandle::new(Cuboid::new(Vector::new(0.25, 0.25, 2.5)))),
        ("brass ring", false, [-2.0, 0.0, 0.0], ShapeHandle::new(Cylinder::new(0.25, 0.5))),
        ("can", true, [0.0, -4.0, 0.0], ShapeHandle::new(Cylinder::new(0.75, 0.5))),
        ("die", true, [3.0, 3.0, 2.0], ShapeHandle::new(Cuboid::new(Vector::repeat(0.5)))),
        ("anvil", true, [-9.0, 0.0, 0.0], ShapeHandle::new(Cuboid::new(Vector::repeat(1.0)))),
    ];
    for (name, is_iron, [x, y, z], shape) in pieces {
        let (position, scrap) = (Isometry::translation(x, y, z), Scrap { name, is_iron });
        world.add(position, shape, CollisionGroups::new(), ProximityQuery::default(), scrap);
    }
    world
}

fn main() {
    let mut world = build();
    let (here, magnet) = (Isometry::identity(), Ball::new(RADIUS));
    let is_iron = |object: &CollisionObject<f64, Scrap>| object.data().is_iron;
    let iron = QueryFilter::new().predicate(&is_iron);

    let in_range = world.objects_within(&here, &magnet, RANGE, &iron);
    for found in &in_range {
        println!("{:.4}  {}", found.distance, found.object.data().name);
    }
    let names: Vec<_> = in_range.iter().map(|found| found.object.data().name).collect();
    // By hand, the distances from the center: the bar 5 − 2.5, the ball 3.5 − 0.5, the can 4 −
    // 0.75; the nearest corner of the die is at (2.5, 2.5, 1.5), √14.75 away. The radius of the
    // magnet is subtracted from each.
    let by_hand = [1.5, 2.0, 2.25, 14.75_f64.sqrt() - 1.0];
    assert_eq!(
        names,
        ["bar", "ball", "can", "die"],
        "brass does not count, and the anvil is too far"
    );
    for (found, distance) in in_range.iter().zip(by_hand) {
        assert!(
            (found.distance - distance).abs() < 1e-12,
            "{} from the magnet",
            found.object.data().name
        );
    }

    // The three nearest objects: `nearest_objects` ends its search when it has found them.
    let nearest = world.nearest_objects(&here, &magnet, 3, RANGE, &iron);
    let drawn = nearest.iter().filter_map(|found| {
        let ClosestPoints::WithinMargin(on_magnet, on_object) = found.points else { return None };
        let mut position = *found.object.position();
        position.translation.vector += on_magnet - on_object;
        Some((found.object.handle(), position))
    });
    let drawn: Vec<_> = drawn.collect();
    world.set_positions(&drawn);

    // Queries use the new positions immediately, without an update.
    let touching = world.objects_within(&here, &magnet, 1e-12, &iron);
    let names: Vec<_> = touching.iter().map(|found| found.object.data().name).collect();
    println!("The magnet holds: {}.", names.join(", "));
    let mut sorted = names.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, ["ball", "bar", "can"], "the three nearest");
    assert_eq!(
        world.nearest_objects(&here, &magnet, 9, RANGE, &iron).len(),
        4,
        "the die stayed where it was"
    );
    // Each attracted object moved by its distance: the bar along z, to 3.5.
    let bar =
        world.collision_objects().find(|object| object.data().name == "bar").expect("it is there");
    assert!(
        (bar.position().translation.vector - Vector::z() * 3.5).norm() < 1e-12,
        "along the line"
    );
}
