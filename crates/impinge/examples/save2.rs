//! Saving and restoring: contacts follow from the objects, so that a saved game is a list of shapes and positions, here
//! as text. Rust prints numbers so that they parse to the same bits, and the contacts of the restored world are the
//! same bits too, now and in later steps. The output is the saved text: there is nothing about contacts in it.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::fmt::Write as _;

use impinge::dim2::prelude::*;

/// The data is the spin of an object in radians a step.
type World = CollisionWorld<f64, f64>;

fn add(world: &mut World, shape: ShapeHandle<f64>, position: Isometry<f64>, spin: f64) {
    world.add(position, shape, CollisionGroups::new(), ContactQuery::new(0.05), spin);
}

/// One line for each object, in the order of the handles: the shape, its sizes, the position, the spin.
fn save(world: &World) -> String {
    let mut text = String::new();
    for object in world.collision_objects() {
        let (place, turn) = (object.position().translation, object.position().rotation);
        let shape = match (
            object.shape().as_shape::<Ball<f64>>(),
            object.shape().as_shape::<Cuboid<f64>>(),
        ) {
            (Some(ball), _) => format!("ball {} 0", ball.radius()),
            (_, Some(cuboid)) => {
                format!("box {} {}", cuboid.half_extents().x, cuboid.half_extents().y)
            }
            _ => unreachable!("this program adds no others"),
        };
        let pose = format!("{} {} {} {}", place.x, place.y, turn.re, turn.im);
        writeln!(text, "{shape} {pose} {}", object.data())
            .expect("strings take all that is written");
    }
    text
}

/// The world of a saved text; `None` if a line is damaged.
fn restore(text: &str) -> Option<World> {
    let mut world = World::new(0.02);
    for line in text.lines() {
        let (kind, numbers) = line.split_once(' ')?;
        let numbers: Result<Vec<f64>, _> = numbers.split(' ').map(str::parse).collect();
        let &[a, b, x, y, cos, sin, spin] = numbers.ok()?.as_slice() else { return None };
        // `try_new` refuses what no shape can be: saved games come from anywhere.
        let shape = match kind {
            "ball" => ShapeHandle::new(Ball::try_new(a).ok()?),
            "box" => ShapeHandle::new(Cuboid::try_new(Vector::new(a, b)).ok()?),
            _ => return None,
        };
        let turn = Rotation::from_cos_sin_unchecked(cos, sin);
        add(&mut world, shape, Isometry::from_parts(Vector::new(x, y).into(), turn), spin);
    }
    Some(world)
}

/// Turns everything by its spin.
fn step(world: &mut World) {
    let turned = world.collision_objects().map(|object| {
        let mut position = *object.position();
        position.rotation *= Rotation::new(*object.data());
        (object.handle(), position)
    });
    let turned: Vec<_> = turned.collect();
    world.set_positions(&turned);
    world.update();
}

/// All contacts, to be compared bit by bit.
fn contacts(world: &World) -> Vec<(usize, usize, Contact<f64>)> {
    let all = world.contact_views().flat_map(|(object1, object2, manifold)| {
        let pair = (object1.handle().uid(), object2.handle().uid());
        manifold.contacts().map(move |point| (pair.0, pair.1, point.contact))
    });
    all.collect()
}

fn main() {
    // Three cogs in a row, and a ball between two of their teeth.
    let mut world = World::new(0.02);
    for n in 0..3_u8 {
        let shape = ShapeHandle::new(Cuboid::new(Vector::new(0.75, 0.5)));
        let spin = if n % 2 == 0 { 0.1 } else { -0.1 };
        add(&mut world, shape, Isometry::translation(1.2 * f64::from(n), 0.0), spin);
    }
    add(&mut world, ShapeHandle::new(Ball::new(0.3)), Isometry::translation(0.6, 0.7), 0.0);
    for _ in 0..10 {
        step(&mut world);
    }

    let saved = save(&world);
    print!("{saved}");
    let mut restored = restore(&saved).expect("it was saved a moment ago");
    restored.update();
    // Contacts that go on in the saved world begin in the restored one, whose first update finds them.
    let begun = restored.contact_events().len();
    println!("{} contacts of {begun} pairs", contacts(&restored).len());
    assert_eq!(
        begun,
        world.contact_pairs().filter(|(_, _, pair)| pair.num_contacts() > 0).count(),
        "all pairs"
    );

    let mut compared = 0;
    for _ in 0..100 {
        assert_eq!(contacts(&world), contacts(&restored), "the same bits");
        assert_eq!(save(&world), save(&restored), "in the same places");
        compared += contacts(&world).len();
        step(&mut world);
        step(&mut restored);
    }
    assert!(compared > 200, "there was something to compare: {compared}");
    assert!(restore("ball -1 0 0 0 1 0 0").is_none(), "a damaged line is refused");
}
