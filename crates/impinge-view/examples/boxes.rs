//! Draws a stair of boxes and writes it as a PNG. The argument is the path of the file; without it
//! a temporary file is written.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::debug_render::{Color, DebugRender, Drawn, ShapeMesh};
use impinge::dim3::math::{Isometry, Point, Vector};
use impinge_view::{Camera, PngPicture};
use std::path::PathBuf;
use std::{env, fs, io};

/// The faces of a box, counter-clockwise when seen from outside. Corner `i` is at the upper end of
/// axis `k` if bit `k` of `i` is set.
const FACES: [[u32; 4]; 6] =
    [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];

/// Returns the mesh of a box with half extents `half`.
fn box_mesh(id: u64, half: Vector<f32>) -> ShapeMesh<f32, 3> {
    let sign = |corner: u32, axis: u32| if corner >> axis & 1 == 1 { 1.0 } else { -1.0 };
    let corner = |corner| {
        let signs = Vector::new(sign(corner, 0), sign(corner, 1), sign(corner, 2));
        Point::from(half.component_mul(&signs))
    };
    let sides = |[a, b, c, d]: [u32; 4]| [[a, b], [b, c], [c, d], [d, a]];
    let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    ShapeMesh {
        id,
        vertices: (0..8).map(corner).collect(),
        lines: FACES.into_iter().flat_map(sides).collect(),
        triangles: FACES.into_iter().flat_map(halves).collect(),
    }
}

fn main() -> io::Result<()> {
    let camera = Camera::look_along(&Vector::new(-0.7, -0.6, -1.0), &Vector::y());
    let mut picture = PngPicture::new(camera.perspective(0.5), [640, 480]);
    let floor = box_mesh(1, Vector::new(3.0, 0.1, 1.5));
    let sand = Color::rgb(214, 190, 150);
    picture.mesh(&floor, &Isometry::translation(0.0, -0.1, 0.0), sand, Drawn::Object);
    let step = box_mesh(2, Vector::new(0.4, 0.25, 0.8));
    for (column, height) in [(0_u8, 5_u8), (1, 4), (2, 3), (3, 2), (4, 1)] {
        for level in 0..height {
            let (x, y) = (f32::from(column) * 0.9 - 1.8, f32::from(level) * 0.5 + 0.25);
            let slate = Color::rgb(124, 146, 176 + 8 * level);
            picture.mesh(&step, &Isometry::translation(x, y, 0.0), slate, Drawn::Object);
        }
    }
    let image = picture.to_image();
    let background = image.pixel(0, 0);
    let drawn = image.pixels().iter().filter(|pixel| **pixel != background).count();
    assert!(drawn > 640 * 480 / 4, "the stair fills its picture: {drawn} pixels");
    assert_eq!(picture.left_out(), 0, "everything has a place");

    let temporary = || env::temp_dir().join("impinge-boxes.png");
    let path = env::args_os().nth(1).map_or_else(temporary, PathBuf::from);
    fs::write(&path, image.to_png())?;
    println!("{}", path.display());
    Ok(())
}
