//! Terrain that deforms: shells blow craters into a height field on which a tank stands. If a shell
//! misses, the contacts of the tank keep their ids. If it hits, the terrain below the tank is
//! removed, and the tank falls until it touches the bottom. The output is the profile before and
//! after.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;

type World = CollisionWorld<f64, &'static str>;

/// Half the width and half the height of the tank.
const TANK: [f64; 2] = [1.0, 0.5];
/// The field is 32 wide around the origin, with 65 heights at a spacing of 0.5.
const WIDTH: f64 = 32.0;
const HEIGHTS: u32 = 65;

/// Returns the x coordinate of a height of the field.
fn x_of(index: usize) -> f64 {
    index as f64 * WIDTH / f64::from(HEIGHTS - 1) - WIDTH / 2.0
}

/// Lowers the heights up to 2 away from `x` by 1.5: a crater with a flat bottom and steep walls.
fn explode(world: &mut World, terrain: CollisionObjectHandle, x: f64) {
    world.deform(terrain, |field: &mut HeightField<f64>| {
        let lowered = |(index, height): (usize, &f64)| {
            if (x_of(index) - x).abs() <= 2.0 { height - 1.5 } else { *height }
        };
        let heights = field.heights().iter().enumerate().map(lowered).collect();
        field.set_heights(heights).expect("as many heights as before, all finite");
    });
}

/// Lets an object fall until it touches something. Returns the height of the fall.
fn fall(world: &mut World, object: CollisionObjectHandle) -> f64 {
    let tank = world.collision_object(object).expect("the tank is never removed");
    let (down, options) = (-Vector::y(), ImpactOptions::new().with_max_time(10.0));
    let others = QueryFilter::new().exclude(object);
    let hit = world.cast_shape(tank.position(), &down, &**tank.shape(), &options, &others);
    let (_, impact) = hit.expect("there is terrain below");
    let position = tank.position().translation.vector + down * impact.toi;
    world.set_position(object, Isometry::new(position, 0.0));
    impact.toi
}

/// Returns the sorted ids of the contacts of an object.
fn ids(world: &World, object: CollisionObjectHandle) -> Vec<impinge::dim2::query::ContactId> {
    let mut ids: Vec<_> = world.contacts_with(object).map(|(_, point)| point.id).collect();
    ids.sort();
    ids
}

/// Prints the solid cells of the world, half a unit wide and high. Cells below the height of the
/// terrain are `#`, and cells in the tank are `T`.
fn print(world: &World, terrain: CollisionObjectHandle) {
    let field = world.collision_object(terrain).expect("the terrain is never removed");
    let field = field.shape().as_shape::<HeightField<f64>>().expect("the terrain is a field");
    for row in (-4..3).rev() {
        let y = f64::from(row) * 0.5 + 0.25;
        let at = |column: i32| {
            let x = f64::from(column) * 0.5 - WIDTH / 2.0 + 0.25;
            let all_else = QueryFilter::new().exclude(terrain);
            let tank = world.objects_containing(&Point::new(x, y), &all_else).next();
            let is_ground = field.height_at(x).is_some_and(|height| y <= height);
            if tank.is_some() {
                'T'
            } else if is_ground {
                '#'
            } else {
                ' '
            }
        };
        println!("{}", (0..64).map(at).collect::<String>());
    }
}

fn main() {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.01));
    let flat = vec![0.0; HEIGHTS as usize];
    let field = ShapeHandle::new(HeightField::<f64>::new(flat, Vector::new(WIDTH, 1.0)));
    let terrain = world.add(Isometry::identity(), field, groups, query, "terrain");
    let shape = ShapeHandle::new(Cuboid::new(Vector::from(TANK)));
    let tank = world.add(Isometry::translation(4.0, TANK[1]), shape, groups, query, "tank");
    world.update();
    print(&world, terrain);
    let before = ids(&world, tank);
    assert_eq!(before.len(), 2, "it stands on two corners");

    explode(&mut world, terrain, -8.0);
    world.update();
    assert!(world.contact_events().is_empty(), "a miss is no news to the tank");
    assert_eq!(ids(&world, tank), before, "nor are its contacts others");

    explode(&mut world, terrain, 4.5);
    world.update();
    assert_eq!(
        world.contact_events(),
        [ContactEvent::Stopped(terrain, tank)],
        "it hangs in the air"
    );

    let fallen = fall(&mut world, tank);
    world.update();
    print(&world, terrain);
    println!("The tank fell by {fallen}.");
    assert!((fallen - 1.5).abs() < 1e-9, "to the bottom of the crater");
    assert_eq!(
        world.contact_events(),
        [ContactEvent::Started(terrain, tank)],
        "where it stands again"
    );
    assert_eq!(ids(&world, tank).len(), 2, "on two corners");
}
