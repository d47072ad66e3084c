//! A picture of a pile of boxes with all of its contacts.

use super::{CLAY, GOLD, MAUVE, SAGE, SAND, SLATE, check_png, options};
use impinge::debug_render::{Color, DebugDrawing};
use impinge::dim3::prelude::*;
use impinge_view::{Camera, PngPicture};

const COLORS: [Color; 4] = [SLATE, SAGE, GOLD, MAUVE];

/// Returns a floor with four layers of boxes, each with a row and a column less than the layer
/// below, and two balls. All touching objects penetrate by 0.01.
fn pyramid() -> CollisionWorld<f64, Color> {
    let mut world = CollisionWorld::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let floor = ShapeHandle::new(Cuboid::new(Vector::new(3.2, 0.2, 2.6)));
    world.add(Isometry::translation(0.0, -0.2, 0.0), floor, everybody, contacts, SAND);
    let brick = ShapeHandle::new(Cuboid::new(Vector::new(0.48, 0.35, 0.48)));
    for layer in 0..4_u8 {
        let (count, y) = (4 - layer, f64::from(layer) * 0.69 + 0.34);
        for (row, column) in (0..count).flat_map(|row| (0..count).map(move |column| (row, column)))
        {
            let at = |index: u8| f64::from(index) - f64::from(count - 1) * 0.5;
            let place = Isometry::translation(at(column), y, at(row));
            let color = COLORS[usize::from(2 * row + column + layer) % COLORS.len()];
            world.add(place, brick.clone(), everybody, contacts, color);
        }
    }
    let ball = ShapeHandle::new(Ball::new(0.4));
    world.add(Isometry::translation(0.0, 3.15, 0.0), ball.clone(), everybody, contacts, CLAY);
    world.add(Isometry::translation(2.55, 0.39, 1.2), ball, everybody, contacts, CLAY);
    world.update();
    world
}

#[test]
fn pile() {
    let world = pyramid();
    // 16 boxes touch the floor. Each of the 9 + 4 + 1 boxes above them touches four boxes, one with
    // each corner. Each of the two balls touches one object.
    assert_eq!(world.contact_manifolds().count(), 16 + 56 + 2, "each pair that touches");
    let mut options = options::<f64>();
    options.contact_normal = None;
    options.mesh.subdivisions = 64;
    let colors: Vec<_> = world.collision_objects().map(|o| (o.handle(), *o.data())).collect();
    let color_of = move |handle| colors.iter().find(|(own, _)| *own == handle).map(|(_, c)| *c);
    let mut drawing = DebugDrawing::new(options).with_object_color(color_of);
    let camera = Camera::look_along(&Vector::new(-0.6, -0.55, -1.0), &Vector::y());
    let mut picture = PngPicture::new(camera.perspective(0.5), [720, 440])
        .with_margin(10.0)
        .with_legend()
        .without_texts();
    drawing.world(&world, &mut picture);
    check_png("pile", &picture, 128);
}
