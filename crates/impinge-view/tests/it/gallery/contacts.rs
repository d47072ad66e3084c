//! Pictures of contacts and manifolds.

use super::{AMBER, CLAY, RED, SAND, SLATE, WIDTH, check_png, check_svg, options, turned2};
use impinge::debug_render::{DebugDrawing, DebugRender, Drawn, Style};
use impinge::{dim2, dim3};
use impinge_view::{Camera, PngPicture, SvgPicture};

/// Returns a world with two pairs: a ball deep in a box, and a tilted box on another box, with one
/// lower corner inside the other box and the other lower corner above it.
fn touching_pairs() -> dim2::world::CollisionWorld<f64, ()> {
    use dim2::prelude::*;
    let mut world = CollisionWorld::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::new(0.1));
    let table = ShapeHandle::new(Cuboid::new(Vector::new(1.8, 0.5)));
    let brick = ShapeHandle::new(Cuboid::new(Vector::new(1.2, 0.6)));
    let shapes = [
        (table.clone(), Isometry::identity()),
        (ShapeHandle::new(Ball::new(1.0)), Isometry::translation(0.3, 1.0)),
        (table, Isometry::translation(4.8, 0.0)),
        (brick, turned2(4.8, 1.06, 0.08)),
    ];
    for (shape, place) in shapes {
        world.add(place, shape, everybody, contacts, ());
    }
    world.update();
    world
}

#[test]
fn contact_and_manifold_in_2d() {
    let world = touching_pairs();
    let mut options = options::<f64>();
    options.contact_normal = Some(Style { color: AMBER, size: 0.9 });
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Contacts in 2D",
        "Left: the contact of a ball that is 0.5 deep in a box. Right: the two contacts of a tilted box on another, one with a \
         positive and one with a negative depth.",
    );
    DebugDrawing::new(options).world(&world, &mut picture);
    let counts: Vec<_> = world.contact_manifolds().map(|(_, _, manifold)| manifold.len()).collect();
    assert_eq!(counts, [1, 2], "a point, and the two ends of an edge");
    let (_, _, manifold) = world.contact_manifolds().next().expect("the ball touches");
    let contact = manifold.deepest_contact().expect("not empty").contact;
    assert_eq!(contact.depth, 0.5, "the ball reaches from 0, the box to 0.5");
    let tip = contact.world1 + contact.normal.into_inner() * 0.9;
    let names =
        [(contact.world1, RED, "world1"), (contact.world2, RED, "world2"), (tip, AMBER, "normal")];
    for (at, color, name) in names {
        picture.text(&at, name, color, Drawn::ContactPoint);
    }
    check_svg("contacts2", &picture);
}

#[test]
fn manifold_in_3d() {
    use dim3::math::Rotation;
    use dim3::na::Quaternion;
    use dim3::prelude::*;
    let mut world = CollisionWorld::<f64, _>::new(0.02);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let table = ShapeHandle::new(Cuboid::new(Vector::new(1.5, 0.25, 1.1)));
    let brick = ShapeHandle::new(Cuboid::new(Vector::new(0.9, 0.4, 0.7)));
    world.add(Isometry::identity(), table, everybody, contacts, SAND);
    // A rotation by about 0.55 radians about the vertical axis.
    let turned = Rotation::from_quaternion(Quaternion::new(1.0, 0.0, 0.28, 0.0));
    let place = Isometry::from_parts(Vector::new(0.35, 0.6, 0.1).into(), turned);
    world.add(place, brick, everybody, contacts, SLATE.with_alpha(120));
    world.update();
    let (_, _, manifold) = world.contact_manifolds().next().expect("they touch");
    assert_eq!(manifold.len(), 4, "the best four corners of the common area");

    let mut options = options::<f64>();
    options.manifold = Some(Style { color: CLAY.with_alpha(170), size: 0.1 });
    options.contact_normal = Some(Style { color: AMBER, size: 0.6 });
    let colors: Vec<_> = world.collision_objects().map(|o| (o.handle(), *o.data())).collect();
    let color_of = move |handle| colors.iter().find(|(own, _)| *own == handle).map(|(_, c)| *c);
    let mut drawing = DebugDrawing::new(options).with_object_color(color_of);
    let camera = Camera::look_along(&Vector::new(-0.45, -0.7, -1.0), &Vector::y());
    let mut picture =
        PngPicture::new(camera.perspective(0.4), [640, 420]).with_margin(16.0).with_legend();
    drawing.world(&world, &mut picture);
    check_png("manifold3", &picture, 200);
}
