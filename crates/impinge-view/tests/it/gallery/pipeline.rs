//! Pictures of the boxes and the tree of the broad phase.

use super::{CLAY, GREEN, SLATE, VIOLET, WIDTH, check_svg, options, turned2};
use impinge::debug_render::{Color, DebugDrawing, DebugOptions, DebugRender, Drawn, Style};
use impinge::dim2::prelude::*;
use impinge_view::SvgPicture;

/// Returns point `number` of a sequence that fills a rectangle evenly: R2 (M. Roberts, 2018).
fn spread(number: u32, size: [f64; 2]) -> [f64; 2] {
    let n = f64::from(number) + 0.5;
    [(n * 0.569_840_3).fract() * size[0], (n * 0.754_877_7).fract() * size[1]]
}

/// Returns a world with shapes of four kinds. The objects with even numbers have moved since the
/// first update, within their fat AABBs.
fn moving_world() -> CollisionWorld<f64, ()> {
    let mut world = CollisionWorld::new(0.14);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let shapes = [
        ShapeHandle::new(Ball::new(0.55)),
        ShapeHandle::new(Cuboid::new(Vector::new(0.7, 0.35))),
        ShapeHandle::new(Capsule::new(0.45, 0.25)),
        ShapeHandle::new(Triangle::new(
            Point::new(-0.7, -0.4),
            Point::new(0.7, -0.4),
            Point::new(0.0, 0.7),
        )),
    ];
    let place = |number: u32, shift: f64| {
        let [x, y] = spread(number, [10.5, 4.6]);
        turned2(x + shift, y + 0.6 * shift, f64::from(number) * 0.7)
    };
    let add = |number: u32| {
        let shape = shapes[number as usize * 5 / 3 % shapes.len()].clone();
        world.add(place(number, 0.0), shape, everybody, contacts, ())
    };
    let handles: Vec<_> = (0..26).map(add).collect();
    world.update();
    for (number, handle) in (0..).zip(&handles).step_by(2) {
        world.set_position(*handle, place(number, 0.1));
    }
    world.update();
    world
}

#[test]
fn loosened_boxes_and_the_pairs_they_propose() {
    let world = moving_world();
    let mut options = options::<f64>();
    options.contact_normal = None;
    options.tight_box = Some(Style { color: GREEN, size: 0.1 });
    options.loosened_box = Some(Style { color: CLAY, size: 0.1 });
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "Boxes of the broad phase",
        "Shapes with their tight and their loosened boxes. A line joins the objects of each pair whose loosened boxes overlap; \
         those that touch have red contact points.",
    );
    DebugDrawing::new(options).world(&world, &mut picture);
    let (mut proposed, mut touching) = (0, 0);
    for (object1, object2, pair) in world.contact_pairs() {
        let ends =
            [object1, object2].map(|object| Point::from(object.position().translation.vector));
        picture.line(ends, VIOLET, Drawn::Proximity);
        proposed += 1;
        touching += usize::from(pair.num_contacts() > 0);
    }
    assert!(touching > 3 && proposed > touching + 3, "{touching} of {proposed} touch");
    check_svg("broad-phase", &picture);
}

#[test]
fn nodes_of_the_tree() {
    let mut world = CollisionWorld::new(0.01_f64);
    let (everybody, contacts) = (CollisionGroups::new(), ContactQuery::default());
    let ball = ShapeHandle::new(Ball::new(0.07));
    for number in 0..240 {
        let [x, y] = spread(number, [12.0, 5.0]);
        // The coordinate x² / 12 makes the points denser towards the left.
        world.add(Isometry::translation(x * x / 12.0, y), ball.clone(), everybody, contacts, ());
    }
    world.update();
    let node = Some(Style { color: VIOLET, size: 0.1 });
    let mut drawing = DebugDrawing::new(DebugOptions { tree_node: node, ..DebugOptions::none() });
    let mut lines = Lines(0);
    drawing.world(&world, &mut lines);
    let nodes = lines.0 / 4;
    assert!((240 / 16..240).contains(&nodes), "{nodes} boxes of nodes");
    let mut picture = SvgPicture::plane(WIDTH).with_title(
        "The tree of the broad phase",
        "Small disks, and the boxes of the nodes that hold them, one inside the other.",
    );
    drawing.world(&world, &mut picture);
    for object in world.collision_objects() {
        let center = Point::from(object.position().translation.vector);
        picture.point(&center, 0.14, SLATE, Drawn::Object);
    }
    check_svg("tree", &picture);
}

/// A renderer that only counts the lines.
struct Lines(usize);

impl DebugRender<f64, 2> for Lines {
    fn line(&mut self, _: [Point<f64>; 2], _: Color, _: Drawn) {
        self.0 += 1;
    }
}
