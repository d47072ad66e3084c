//! A kinematic character walks towards a slanted wall, slides along it, and climbs the stairs
//! behind it. Casts of its capsule limit each motion, and the rest of a blocked motion continues
//! along the wall. The output is the hall from above; digits are the height of the feet in quarters
//! of a unit.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim3::prelude::*;

type World = CollisionWorld<f64, &'static str>;

/// The capsule is 1.5 high and 0.5 wide.
const RADIUS: f64 = 0.25;
const HALF_HEIGHT: f64 = 0.5;
/// The distance kept from obstacles. A cast that stops at this distance never leaves the character
/// in contact, so the next cast does not start in contact.
const SKIN: f64 = 1.0 / 64.0;
const STEP: f64 = 0.375;

/// Builds a floor at height 0, a wall at 45° to the x and z axes, and from z = 8 on four steps of
/// 0.25 with a landing.
fn build() -> World {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::new(SKIN));
    let floor = ShapeHandle::new(Plane::new(Vector::y_axis()));
    world.add(Isometry::identity(), floor, groups, query, "floor");
    // The near side of the wall is on the line x + z = 4.
    let wall = ShapeHandle::new(Cuboid::new(Vector::new(4.0, 2.0, 0.5)));
    let middle = Vector::new(0.0, 2.0, 4.0) + Vector::new(1.0, 0.0, 1.0).normalize() * 0.5;
    let position = Isometry::new(middle, Vector::y() * std::f64::consts::FRAC_PI_4);
    world.add(position, wall, groups, query, "wall");
    for n in 0..4_u8 {
        // Each step extends to the end of the stairs at z = 13.
        let (height, start) = (0.25 * f64::from(n + 1), 8.0 + 0.5 * f64::from(n));
        let half = Vector::new(2.0, height / 2.0, (13.0 - start) / 2.0);
        let position = Isometry::translation(-4.0, half.y, 13.0 - half.z);
        world.add(position, ShapeHandle::new(Cuboid::new(half)), groups, query, "step");
    }
    world
}

/// Moves the capsule until it is `SKIN` away from an obstacle, then along this obstacle. Makes at
/// most four casts.
fn slide(world: &World, position: &mut Isometry<f64>, mut motion: Vector<f64>) {
    let (capsule, all) = (Capsule::new(HALF_HEIGHT, RADIUS), QueryFilter::new());
    let options = ImpactOptions::new().with_max_time(1.0).with_target_distance(SKIN);
    for _ in 0..4 {
        let Some((_, hit)) = world.cast_shape(position, &motion, &capsule, &options, &all) else {
            position.translation.vector += motion;
            return;
        };
        position.translation.vector += motion * hit.toi;
        // The normal points to the obstacle. The rest of the motion loses its component in this
        // direction.
        motion *= 1.0 - hit.toi;
        motion -= *hit.normal * motion.dot(&hit.normal).max(0.0);
    }
}

/// Moves the capsule straight, until it is `SKIN` away from an obstacle.
fn cast(world: &World, position: &mut Isometry<f64>, motion: Vector<f64>) {
    let (capsule, all) = (Capsule::new(HALF_HEIGHT, RADIUS), QueryFilter::new());
    let options = ImpactOptions::new().with_max_time(1.0).with_target_distance(SKIN);
    let hit = world.cast_shape(position, &motion, &capsule, &options, &all);
    position.translation.vector += motion * hit.map_or(1.0, |(_, impact)| impact.toi);
}

/// Moves the character by one frame: up by a step, across, and down again.
fn walk(world: &World, position: &mut Isometry<f64>, motion: Vector<f64>) {
    let before = position.translation.y;
    cast(world, position, Vector::y() * STEP);
    slide(world, position, motion);
    let risen = position.translation.y - before;
    cast(world, position, Vector::y() * -(risen + STEP));
}

fn main() {
    let (world, ahead) = (build(), Vector::z() * 0.125);
    let mut position = Isometry::translation(1.0, HALF_HEIGHT + RADIUS + SKIN, 0.0);
    let mut feet = Vec::new();
    for _ in 0..128 {
        walk(&world, &mut position, ahead);
        feet.push(position * Point::new(0.0, -HALF_HEIGHT - RADIUS, 0.0));
    }

    // The view from above: z to the right, x upwards. A row is half a unit, a column a quarter.
    for row in (-7..5).rev() {
        let at = |column: u32| {
            let (x, z) = (f64::from(row) * 0.5, f64::from(column) * 0.25);
            let is_here =
                |foot: &&Point<f64>| (foot.x - x).abs() < 0.25 && (foot.z - z).abs() <= 0.125;
            let height = feet.iter().find(is_here).map(|foot| format!("{:.0}", foot.y * 4.0));
            let eye = Point::new(x, 1.5, z);
            let is_wall = world.objects_containing(&eye, &QueryFilter::new()).next().is_some();
            height.unwrap_or_else(|| if is_wall { "#" } else { " " }.to_string())
        };
        println!("{}", (0..60).map(at).collect::<String>());
    }
    let last = feet[feet.len() - 1];
    println!("It ends at x = {:.3}, z = {:.3}, {:.3} high.", last.x, last.z, last.y);

    // While the capsule slides, its axis is RADIUS + SKIN from the wall, and its speed along z is
    // halved.
    let apart = |foot: &Point<f64>| (4.0 - foot.x - foot.z) / 2.0_f64.sqrt() - RADIUS - SKIN;
    let (early, late) = (feet[30], feet[50]);
    assert!(
        apart(&early).abs() < 1e-9 && apart(&late).abs() < 1e-9,
        "along the wall, {early}, {late}"
    );
    assert!(
        (late - early - Vector::new(-1.25, 0.0, 1.25)).norm() < 1e-9,
        "at half the speed: {late}"
    );
    assert!((last.y - 1.0 - SKIN).abs() < 1e-9, "it climbed all four steps");
}
