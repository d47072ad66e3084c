//! Tests the pictures of `render` by their pixels and elements: PNG and SVG, directions of view,
//! layers, and steps of recordings.

use std::fs;

use impinge_view::Image;

use crate::support::Desk;

fn rendered(desk: &Desk, arguments: &str, file: &str) -> Vec<u8> {
    let ran = desk.run(arguments);
    assert_eq!((ran.code, ran.out.as_str(), ran.err.as_str()), (0, "", ""), "{arguments}");
    fs::read(desk.path(file)).expect("it was written")
}

#[test]
fn surfaces_in_png() {
    let desk = Desk::new();
    let bytes = rendered(&desk, "render boxes.json -o a.png --size 160x120", "a.png");
    let image = Image::from_png(&bytes).expect("a PNG");
    assert_eq!(image.size(), [160, 120]);
    let background = image.pixel(0, 0);
    let drawn = image.pixels().iter().filter(|pixel| **pixel != background).count();
    assert!(drawn > 160 * 120 / 10, "the boxes are seen: {drawn} pixels");
    let again = rendered(&desk, "render boxes.json -o b.PNG --size 160x120", "b.PNG");
    assert_eq!(bytes, again, "the same bytes");
}

#[test]
fn the_direction_of_view_counts() {
    let desk = Desk::new();
    let seen = |look: &str| {
        let arguments = format!("render balls.json -o a.png --size 90x90 --angle 0 --look {look}");
        Image::from_png(&rendered(&desk, &arguments, "a.png")).expect("a PNG")
    };
    let columns = |image: &Image| {
        let background = image.pixel(0, 0);
        (0..90).filter(|x| (0..90).any(|y| image.pixel(*x, y) != background)).count()
    };
    // The balls are side by side along x. Together they are 4.5 wide and 2 high from the front, 2
    // by 2 from the side.
    let (front, side) = (seen("0,0,-1"), seen("-1,0,0"));
    let rows = (0..90).filter(|y| (0..90).any(|x| front.pixel(x, *y) != front.pixel(0, 0))).count();
    assert!(columns(&front) > 2 * rows, "{} by {rows}", columns(&front));
    assert!(side.pixel(45, 45) != side.pixel(0, 0), "one ball hides the other");
}

#[test]
fn lines_in_svg_with_layers() {
    let desk = Desk::new();
    let text =
        |arguments: &str| String::from_utf8(rendered(&desk, arguments, "a.svg")).expect("text");
    let plain = text("render squares.json -o a.svg --size 300x300 --layers object");
    assert!(plain.starts_with("<svg") || plain.starts_with("<?xml"), "{}", &plain[..40]);
    assert!(plain.contains("class=\"object\"") && !plain.contains("class=\"contact-point\""));
    assert!(plain.contains("squares.json"), "the title");
    let full = text("render squares.json -o a.svg --layers object,contacts,tight-boxes");
    assert!(full.contains("class=\"contact-point\"") && full.contains("class=\"tight-box\""));
}

#[test]
fn a_step_of_a_recording() {
    let desk = Desk::recorded();
    let at = |step: &str| {
        let arguments = format!("render balls.implog -o a.png --size 90x60 {step}");
        rendered(&desk, &arguments, "a.png")
    };
    assert_eq!(at("--step 30"), at(""), "the last by default");
    assert_ne!(at("--step 1"), at("--step 30"), "a ball has moved");
}
