//! Compares pictures with golden images.

use crate::scenes::{boxes, glass, hills, plane};
use impinge::dim3::math::Vector;
use impinge_view::{Camera, Golden, PngPicture};

fn check(name: &str, camera: Camera, draw: fn(&mut PngPicture)) {
    let mut picture = PngPicture::new(camera, [320, 240]);
    draw(&mut picture);
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/golden");
    let found = Golden::new(folder).check(name, &picture.to_image());
    assert!(found.is_ok(), "{name}: {}", found.err().map_or(String::new(), |e| e.to_string()));
}

#[test]
fn boxes_from_above() {
    let camera = Camera::look_along(&Vector::new(-0.55, -0.5, -1.0), &Vector::y());
    check("boxes", camera, boxes::<f64>);
}

#[test]
fn glass_in_perspective() {
    let camera = Camera::look_along(&Vector::new(0.5, -0.45, -1.0), &Vector::y());
    check("glass", camera.perspective(0.6), glass::<f64>);
}

#[test]
fn hills_in_perspective() {
    let camera = Camera::look_along(&Vector::new(-0.4, -0.55, -1.0), &Vector::y());
    check("hills", camera.perspective(0.7), hills::<f64>);
}

#[test]
fn polygons_in_2d() {
    check("plane", Camera::plane(), plane::<f64>);
}
