//! A depth camera: one ray for each pixel, all cast in one call. The picture consists of
//! characters, shaded by the angle between normal and light. It shows a ball between two pyramids
//! on a floor. The scene is symmetric, and so must be the depths; only the light comes from one
//! side.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim3::prelude::*;
use impinge::dim3::query::RayBatch;

type World = CollisionWorld<f64, &'static str>;

const WIDTH: u32 = 73;
const HEIGHT: u32 = 27;
/// The characters from dark to bright.
const SHADES: [char; 8] = ['.', ':', '-', '=', '+', '*', '#', '@'];
const FAR: f64 = 40.0;

/// Builds a floor, a ball in the middle, and a pyramid on each side. The camera looks along −z from
/// the origin.
fn build() -> World {
    let mut world = World::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ProximityQuery::default());
    let floor = ShapeHandle::new(Plane::new(Vector::y_axis()));
    world.add(Isometry::translation(0.0, -1.5, 0.0), floor, groups, query, "floor");
    let ball = ShapeHandle::new(Ball::new(1.5));
    world.add(Isometry::translation(0.0, 0.0, -8.0), ball, groups, query, "ball");
    // A mesh of four faces without a base, counter-clockwise when seen from outside.
    let corners =
        [[0.0, 3.0, 0.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0], [-1.0, 0.0, -1.0]];
    let faces = vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]];
    let pyramid = ShapeHandle::new(TriMesh::new(corners.map(Point::from).to_vec(), faces));
    for x in [-3.5, 3.5] {
        let position = Isometry::translation(x, -1.5, -7.0);
        world.add(position, pyramid.clone(), groups, query, "pyramid");
    }
    world
}

/// Returns a ray for each pixel, row by row from the top left. Pixels are twice as high as wide.
/// All directions have z = −1, so the time of a hit is its depth.
fn rays() -> Vec<Ray<f64>> {
    let ray = |row, column| {
        let x = (f64::from(column) - f64::from(WIDTH - 1) / 2.0) / 50.0;
        let y = (f64::from(HEIGHT - 1) / 2.0 - f64::from(row)) / 25.0;
        Ray::new(Point::origin(), Vector::new(x, y, -1.0))
    };
    (0..HEIGHT).flat_map(|row| (0..WIDTH).map(move |column| ray(row, column))).collect()
}

/// Returns the character for a surface with this normal.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at least 0, at most 7")]
fn shade(normal: &Vector<f64>) -> char {
    let light = Vector::new(-3.0, 2.0, 2.0).normalize();
    SHADES[(normal.dot(&light).clamp(0.0, 1.0) * 7.0).round() as usize]
}

fn main() {
    let (world, rays) = (build(), rays());
    let mut hits = vec![None; rays.len()];
    world.cast_rays(&RayBatch::new(&rays).until(FAR), &QueryFilter::new(), &mut hits);

    let width = WIDTH as usize;
    for row in hits.chunks(width) {
        let pixel = |hit: &Option<(_, impinge::dim3::query::RayIntersection<f64>)>| {
            hit.as_ref().map_or(' ', |(_, hit)| shade(&hit.normal))
        };
        println!("{}", row.iter().map(pixel).collect::<String>());
    }

    let depth =
        |row: usize, column: usize| hits[row * width + column].as_ref().map(|(_, hit)| hit.toi);
    let (middle, bottom) = (HEIGHT as usize / 2, HEIGHT as usize - 1);
    assert_eq!(depth(middle, width / 2), Some(6.5), "the ball, 8 away and of radius 1.5");
    // The rays of the lowest row go down by 13/25 for each unit of depth, and the floor is 1.5
    // below the camera.
    let nearest = depth(bottom, width / 2).expect("the floor");
    assert!((nearest - 1.5 * 25.0 / 13.0).abs() < 1e-12, "{nearest}");
    assert_eq!(depth(0, width / 2), None, "the sky");
    for (row, column) in
        (0..HEIGHT as usize).flat_map(|row| (0..width).map(move |column| (row, column)))
    {
        let pair = [depth(row, column), depth(row, width - 1 - column)];
        let [left, right] = pair.map(|depth| depth.unwrap_or(FAR));
        assert!((left - right).abs() < 1e-9, "left and right at {row}, {column}: {left}, {right}");
    }
}
