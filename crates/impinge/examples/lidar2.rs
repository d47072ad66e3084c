//! A lidar: a robot in a room casts rays in all directions, in one call, and draws the points that
//! they hit, with one letter for each object. Areas hidden behind an object stay blank. Every ray
//! ends on a surface, since the room is closed.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim2::prelude::*;
use impinge::dim2::query::RayBatch;

/// The data of an object is the letter with which it is drawn.
type World = CollisionWorld<f64, char>;

const RAYS: u32 = 1440;
/// The width and the height of the picture in cells. A cell is 0.25 wide and 0.5 high.
const CELLS: [usize; 2] = [65, 17];

/// Builds a room of 16 × 8 with a round column, a box and a slanted plank.
fn build() -> World {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ProximityQuery::default());
    let corners = [[-8.0, -4.0], [8.0, -4.0], [8.0, 4.0], [-8.0, 4.0]].map(Point::from);
    let walls = ShapeHandle::new(Polyline::closed(corners.to_vec()));
    world.add(Isometry::identity(), walls, groups, query, '#');
    let column = ShapeHandle::new(Ball::new(1.0));
    world.add(Isometry::translation(4.0, 0.0), column, groups, query, 'c');
    let cupboard = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 0.5)));
    world.add(Isometry::translation(-4.0, 2.5), cupboard, groups, query, 'b');
    let plank = ShapeHandle::new(Segment::new(Point::new(-5.0, -3.0), Point::new(-3.0, -1.0)));
    world.add(Isometry::identity(), plank, groups, query, 'p');
    world
}

/// Returns rays in all directions. The directions have length 1, so times of impact are distances.
fn fan(origin: Point<f64>) -> Vec<Ray<f64>> {
    let turn = std::f64::consts::TAU / f64::from(RAYS);
    let directions = (0..RAYS).map(|n| Rotation::new(f64::from(n) * turn) * Vector::x());
    directions.map(|direction| Ray::new(origin, direction)).collect()
}

/// Returns the row and the column of the cell that contains a point.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "points are in the room"
)]
fn cell(point: &Point<f64>) -> [usize; 2] {
    [((4.25 - point.y) * 2.0) as usize, ((point.x + 8.125) * 4.0) as usize]
}

fn main() {
    let (world, robot) = (build(), Point::origin());
    let rays = fan(robot);
    let mut hits = vec![None; rays.len()];
    world.cast_rays(&RayBatch::new(&rays).until(20.0), &QueryFilter::new(), &mut hits);

    let mut picture = vec![vec![' '; CELLS[0]]; CELLS[1]];
    let mut seen = std::collections::BTreeMap::new();
    for (ray, hit) in rays.iter().zip(&hits) {
        let (handle, hit) = hit.as_ref().expect("the room is closed");
        let object = world.collision_object(*handle).expect("nothing is removed");
        let point = ray.point_at(hit.toi);
        let [row, column] = cell(&point);
        picture[row][column] = *object.data();
        *seen.entry(*object.data()).or_insert(0) += 1;
        let off = object.shape().distance_to_point(object.position(), &point, false).abs();
        assert!(off < 1e-12, "a ray ends on the surface of what it hits, not {off} away from it");
    }
    let [row, column] = cell(&robot);
    picture[row][column] = '@';
    for row in picture {
        println!("{}", row.into_iter().collect::<String>());
    }
    println!("of {RAYS} rays: {seen:?}");

    let toi = |degrees: usize| hits[degrees * 4].as_ref().expect("the room is closed").1.toi;
    assert_eq!(toi(0), 3.0, "the column, 4 away and of radius 1");
    assert!((toi(90) - 4.0).abs() < 1e-12 && (toi(180) - 8.0).abs() < 1e-12, "the walls");
    // The ray at 225° is parallel to the plank, which lies on the line y = x + 2, and does not meet
    // it. It ends at the wall.
    assert!((toi(225) - 4.0 * 2.0_f64.sqrt()).abs() < 1e-12, "past the plank");
    // From a distance of 4, a disk of radius 1 covers asin(1/4) = 14.48° on each side: 57 quarters
    // of a degree.
    assert_eq!(seen[&'c'], 115, "57 rays to each side, and the one in the middle");
}
