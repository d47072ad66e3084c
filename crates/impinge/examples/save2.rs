//! Saving and restoring a world, with one call each, in any format of serde; here as text and as
//! bytes. After the same calls the restored world has the same bits as the saved one, with the same
//! contact ids and events.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;
use impinge::query::ContactId;

/// The data is the rotation of an object per step, in radians. It is an `f32`, which the text
/// format preserves too.
type World = CollisionWorld<f64, f32>;

fn add(world: &mut World, shape: ShapeHandle<f64>, x: f64, y: f64, spin: f32) {
    let (at, query) = (Isometry::translation(x, y), ContactQuery::new(0.05));
    world.add(at, shape, CollisionGroups::new(), query, spin);
}

/// Rotates all objects and updates the world.
fn step(world: &mut World) {
    let turned = world.collision_objects().map(|object| {
        let mut position = *object.position();
        position.rotation *= Rotation::new(f64::from(*object.data()));
        (object.handle(), position)
    });
    let turned: Vec<_> = turned.collect();
    world.set_positions(&turned);
    world.update();
}

/// Returns all contacts with their ids, for a comparison bit by bit.
fn contacts(world: &World) -> Vec<(ContactId, Contact<f64>)> {
    let points = world.contact_views().flat_map(|(_, _, manifold)| manifold.contacts());
    points.map(|point| (point.id, point.contact)).collect()
}

fn main() {
    // Three boxes in a row, which share a shape, and a ball between two of them.
    let mut world = World::new(0.02);
    let cog = ShapeHandle::new(Cuboid::new(Vector::new(0.75, 0.5)));
    for (x, spin) in [(0.0, 0.1), (1.2, -0.1), (2.4, 0.1)] {
        add(&mut world, cog.clone(), x, 0.0, spin);
    }
    add(&mut world, ShapeHandle::new(Ball::new(0.3)), 0.6, 0.7, 0.0);
    for _ in 0..10 {
        step(&mut world);
    }

    let text = serde_json::to_string(&world).expect("all of it can be saved");
    let bytes = postcard::to_allocvec(&world).expect("all of it can be saved");
    println!("{} characters, or {} bytes", text.len(), bytes.len());
    let mut of_text: World = serde_json::from_str(&text).expect("it was saved a moment ago");
    let mut of_bytes: World = postcard::from_bytes(&bytes).expect("it was saved a moment ago");

    let shapes: Vec<_> = of_text.collision_objects().map(CollisionObject::shape).collect();
    assert!(shapes[0].is_same(shapes[2]) && !shapes[0].is_same(shapes[3]), "shared as they were");

    let mut compared = 0;
    for _ in 0..100 {
        assert_eq!(contacts(&world), contacts(&of_text), "the same bits");
        assert_eq!(contacts(&world), contacts(&of_bytes), "the same bits");
        compared += contacts(&world).len();
        [&mut world, &mut of_text, &mut of_bytes].into_iter().for_each(step);
        let events = [&world, &of_text, &of_bytes].map(|world| world.contact_events().len());
        assert_eq!(events, [events[0]; 3], "nothing begins again");
    }
    assert!(compared > 200, "there was something to compare: {compared}");

    // Saved games may come from anywhere. Data that does not describe a valid world is rejected
    // with an error.
    let damages = [("\"0.3\"", "\"-0.3\""), ("\"objects\":[0,1]", "\"objects\":[0,9]")];
    for (old, new) in damages {
        let damaged = text.replacen(old, new, 1);
        assert!(damaged != text && serde_json::from_str::<World>(&damaged).is_err(), "{new}");
    }
    assert!(postcard::from_bytes::<World>(&bytes[..bytes.len() / 2]).is_err(), "cut short");
}
