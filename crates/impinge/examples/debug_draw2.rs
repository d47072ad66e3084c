//! Debug drawing by a back end of one's own: a scene in 2D as text. The back end has one method, which puts characters
//! along a line; the library calls it for shapes, contacts and a ray.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::debug_render::{Color, DebugRender, Drawn};
use impinge::dim2::debug_render::DebugDrawing;
use impinge::dim2::prelude::*;

const COLUMNS: i32 = 64;
const ROWS: i32 = 20;

/// A picture of 16 × 10 units, the origin in the middle of its lowest row. A character is 1/4 wide and 1/2 high.
struct Screen([[char; COLUMNS as usize]; ROWS as usize]);

impl Screen {
    fn put(&mut self, at: &Point<f64>, character: char) {
        let (column, row) = ((at.x * 4.0).floor() + 32.0, 19.0 - (at.y * 2.0).floor());
        // Numbers below the range become 0 and above it the greatest: what is outside is left out before.
        if (0.0..f64::from(COLUMNS)).contains(&column) && (0.0..f64::from(ROWS)).contains(&row) {
            self.0[row as usize][column as usize] = character;
        }
    }
}

impl DebugRender<f64, 2> for Screen {
    fn line(&mut self, [a, b]: [Point<f64>; 2], _: Color, what: Drawn) {
        let character = match what {
            Drawn::Object => '.',
            Drawn::ContactPoint => 'x',
            Drawn::ContactNormal => '|',
            Drawn::Query => '-',
            Drawn::QueryHit => 'o',
            _ => return,
        };
        // Eight points to a unit leave no gap.
        let steps = ((b - a).norm() * 8.0).ceil().max(1.0);
        for step in 0..=steps as u32 {
            self.put(&(a + (b - a) * (f64::from(step) / steps)), character);
        }
    }
}

fn main() {
    let mut world = CollisionWorld::new(0.02);
    let ground = HalfSpace::new(Unit::new_normalize(Vector::y()));
    let scene = [
        (ShapeHandle::new(ground), 0.0, 0.25),
        (ShapeHandle::new(Cuboid::new(Vector::new(2.0, 1.5))), -3.0, 1.7),
        (ShapeHandle::new(Ball::new(2.0)), 3.5, 2.2),
        (ShapeHandle::new(Capsule::new(1.0, 0.75)), -3.0, 4.875),
    ];
    for (shape, x, y) in scene {
        let position = Isometry::translation(x, y);
        world.add(position, shape, CollisionGroups::new(), ContactQuery::default(), ());
    }
    world.update();

    let mut screen = Screen([[' '; COLUMNS as usize]; ROWS as usize]);
    let mut drawing = DebugDrawing::default();
    drawing.world(&world, &mut screen);
    let ray = Ray::new(Point::new(-8.0, 5.25), Vector::x());
    let hits: Vec<_> = world.ray_hits(&ray, 20.0, &QueryFilter::new());
    let hits: Vec<_> = hits.into_iter().map(|(_, hit)| hit).collect();
    drawing.ray(&ray, f64::INFINITY, &hits, &mut screen);
    let lines: Vec<String> = screen.0.iter().map(|row| row.iter().collect()).collect();
    println!("{}", lines.join("\n"));

    // The ray hits the capsule at x = −3.75; the capsule touches the box at y = 3.2, the ball the ground at 0.25.
    let count = |character| lines.concat().chars().filter(|&other| other == character).count();
    assert!(lines[9].starts_with("-----------") && lines[9].contains('o'), "the ray and its hit");
    assert!(count('x') >= 4 && count('|') >= 4, "contacts of three pairs: {}", count('x'));
    assert!(lines[19].trim().len() > 60, "the ground is as wide as the picture");
}
