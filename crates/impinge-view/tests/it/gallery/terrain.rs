//! The picture of the README: solids on hills.

use super::{CLAY, GOLD, MAUVE, SAGE, SAND, SLATE, check_png};
use impinge::debug_render::{Color, DebugDrawing, DebugOptions};
use impinge::dim3::math::{Isometry, Rotation, Vector};
use impinge::dim3::na::Quaternion;
use impinge::dim3::query::ImpactOptions;
use impinge::dim3::shape::{
    Ball, Capsule, Cone, Cuboid, Cylinder, Ellipsoid, HeightField, ShapeHandle,
};
use impinge::dim3::world::{CollisionGroups, CollisionWorld, ContactQuery, QueryFilter};
use impinge_view::{Camera, PngPicture};

type World = CollisionWorld<f64, Color>;

const COLORS: [Color; 5] = [SLATE, CLAY, SAGE, GOLD, MAUVE];

/// Returns a height field of size 12 along x and 8 along z, with 36 by 24 cells.
fn hills() -> HeightField<f64> {
    let (rows, columns) = (25_u32, 37_u32);
    let height = |row: u32, column: u32| {
        let (x, z) = (f64::from(column) * 0.34, f64::from(row) * 0.31);
        0.55 * wave(x) * wave(z + 1.0) + 0.25 * wave(0.5 * x + z)
    };
    let heights = (0..rows).flat_map(|row| (0..columns).map(move |column| height(row, column)));
    HeightField::new(25, 37, heights.collect(), Vector::new(12.0, 1.0, 8.0))
}

/// Returns the value at `x` of a wave of period 4. It consists of parabolas, so that it is the same
/// on every machine.
fn wave(x: f64) -> f64 {
    let phase = x - 4.0 * (x / 4.0).floor();
    let half = if phase < 2.0 { phase } else { phase - 2.0 };
    let arch = half * (2.0 - half);
    if phase < 2.0 { arch } else { -arch }
}

/// Drops a shape vertically at the x and z coordinates `at`, and adds it where it first touches an
/// object, lowered by 0.02. `turned` is the vector part of the quaternion of its rotation, divided
/// by the real part.
fn drop_shape(world: &mut World, shape: &ShapeHandle<f64>, at: [f64; 2], turned: Vector<f64>) {
    // No sines of the platform are used, so that the picture is the same on every machine.
    let rotation = Rotation::from_quaternion(Quaternion::new(1.0, turned.x, turned.y, turned.z));
    let start = Isometry::from_parts(Vector::new(at[0], 9.0, at[1]).into(), rotation);
    let (options, down) = (ImpactOptions::new(), -Vector::y());
    let hit = world.cast_shape(&start, &down, &**shape, &options, &QueryFilter::new());
    let fall = hit.expect("the hills are below").1.toi;
    let mut place = start;
    place.translation.vector.y -= fall + 0.02;
    let color = COLORS[world.len() % COLORS.len()];
    world.add(place, shape.clone(), CollisionGroups::new(), ContactQuery::default(), color);
}

/// Returns a world with hills on which solids of six kinds have fallen, one after the other.
fn terrain() -> World {
    let mut world = World::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    world.add(Isometry::identity(), ShapeHandle::new(hills()), everybody, contacts, SAND);
    let solids = [
        ShapeHandle::new(Cuboid::new(Vector::new(0.5, 0.3, 0.4))),
        ShapeHandle::new(Ball::new(0.4)),
        ShapeHandle::new(Cylinder::new(0.4, 0.35)),
        ShapeHandle::new(Capsule::new(0.4, 0.25)),
        ShapeHandle::new(Cone::new(0.45, 0.4)),
        ShapeHandle::new(Ellipsoid::new(Vector::new(0.55, 0.3, 0.4))),
    ];
    for number in 0..34_u32 {
        let n = f64::from(number);
        // Evenly distributed points: the sequence R2 (M. Roberts, 2018).
        let at = [(n * 0.754_877_7).fract() * 10.0 - 5.0, (n * 0.569_840_3).fract() * 6.4 - 3.2];
        let turned = Vector::new(0.2 * wave(n), wave(0.7 * n), 0.2 * wave(1.3 * n));
        drop_shape(&mut world, &solids[number as usize % solids.len()], at, turned);
    }
    world.update();
    world
}

#[test]
fn terrain_with_contacts() {
    let world = terrain();
    let colors: Vec<_> = world.collision_objects().map(|o| (o.handle(), *o.data())).collect();
    let color_of = move |handle| colors.iter().find(|(own, _)| *own == handle).map(|(_, c)| *c);
    let mut drawing = DebugDrawing::new(DebugOptions::default()).with_object_color(color_of);
    let camera = Camera::look_along(&Vector::new(-0.45, -0.75, -1.0), &Vector::y());
    let mut picture =
        PngPicture::new(camera.perspective(0.5), [640, 340]).with_margin(0.02).without_texts();
    drawing.world(&world, &mut picture);
    let touching = world.contact_manifolds().count();
    assert!(touching >= 34, "each solid that fell touches something: {touching}");
    check_png("terrain", &picture, 36);
}
