//! Debug drawing with a custom back end: a 2D scene as text. The back end has one method, which
//! puts characters along a line. The library calls it for shapes, contacts and a ray.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::debug_render::{Color, DebugRender, Drawn};
use impinge::dim2::debug_render::DebugDrawing;
use impinge::dim2::prelude::*;

/// A picture of 16 × 10 units; the origin is in the middle of the lowest row. A character is 1/4
/// wide and 1/2 high.
struct Screen([[char; 64]; 20]);

impl DebugRender<f64, 2> for Screen {
    fn line(&mut self, [a, b]: [Point<f64>; 2], _: Color, what: Drawn) {
        let character = match what {
            Drawn::Object => '.',
            Drawn::ContactNormal => '|',
            Drawn::Query => '-',
            Drawn::QueryHit => 'o',
            _ => return,
        };
        // The ends in units of characters, from the lower left corner. A point is a line of length
        // zero.
        let [a, b] = [a, b].map(|end| Point::new(end.x * 4.0 + 32.0, end.y * 2.0));
        let segment = Segment::new(a, b);
        for (y, row) in (0_u8..).zip(self.0.iter_mut().rev()) {
            for (x, cell) in (0_u8..).zip(row) {
                let middle = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
                if segment.distance_to_point(&Isometry::identity(), &middle, true) <= 0.6 {
                    *cell = character;
                }
            }
        }
    }
}

fn main() {
    let mut world = CollisionWorld::new(0.02);
    let ground = HalfSpace::new(Unit::new_normalize(Vector::y()));
    let scene = [
        (ShapeHandle::new(ground), 0.0, 0.25),
        (ShapeHandle::new(Cuboid::new(Vector::new(2.0, 1.5))), -2.875, 1.7),
        (ShapeHandle::new(Ball::new(2.0)), 3.625, 2.2),
        (ShapeHandle::new(Capsule::new(1.0, 0.75)), -2.875, 4.875),
    ];
    for (shape, x, y) in scene {
        let position = Isometry::translation(x, y);
        world.add(position, shape, CollisionGroups::new(), ContactQuery::default(), ());
    }
    world.update();

    let mut screen = Screen([[' '; 64]; 20]);
    let mut drawing = DebugDrawing::default();
    drawing.world(&world, &mut screen);
    let ray = Ray::new(Point::new(-8.0, 5.25), Vector::x());
    let hits = world.ray_hits(&ray, 20.0, true, &QueryFilter::new());
    let hits: Vec<_> = hits.into_iter().map(|(_, hit)| hit).collect();
    drawing.ray(&ray, f64::INFINITY, &hits, &mut screen);
    let lines: Vec<String> = screen.0.iter().map(|row| row.iter().collect()).collect();
    println!("{}", lines.join("\n"));

    // The ray hits the capsule at x = -3.625. The box touches the ground in two points, the ball
    // and the capsule touch in one point each. A normal is one or two characters high.
    let normals = lines.concat().chars().filter(|&character| character == '|').count();
    assert!(lines[9].starts_with("-----------") && lines[9].contains('o'), "the ray and its hit");
    assert!((4..=16).contains(&normals), "contacts of three pairs: {normals}");
    assert!(lines[19].trim().len() > 60, "the ground is as wide as the picture");
}
