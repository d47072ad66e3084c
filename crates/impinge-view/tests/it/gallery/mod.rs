//! The pictures of the README and the guide. Each shows a world as a user would create it, drawn
//! from results of the library.

mod composites;
mod contacts;
mod events;
mod groups;
mod introduction;
mod own_shapes;
mod pipeline;
mod queries;
mod shapes;
mod starts;
mod terrain;

use impinge::debug_render::{Color, DebugDrawing, DebugOptions, DebugRender, Drawn, Style};
use impinge::dim2;
use impinge::math::{Pose, Real, Space, Vector};
use impinge::shape::ShapeHandle;
use impinge_view::{Golden, PngPicture, SvgPicture};

const SLATE: Color = Color::rgb(124, 146, 176);
const CLAY: Color = Color::rgb(204, 128, 104);
const SAGE: Color = Color::rgb(150, 178, 146);
const GOLD: Color = Color::rgb(212, 176, 106);
const MAUVE: Color = Color::rgb(160, 136, 170);
const SAND: Color = Color::rgb(214, 196, 160);
const RED: Color = Color::rgb(196, 54, 60);
const AMBER: Color = Color::rgb(196, 116, 20);
const BLUE: Color = Color::rgb(52, 92, 160);
const VIOLET: Color = Color::rgb(126, 74, 176);
const GREEN: Color = Color::rgb(76, 140, 84);
const GRAY: Color = Color::rgb(140, 146, 156);
const INK: Color = Color::rgb(62, 70, 82);

/// The width of the 2D pictures of the guide in pixels, about that of its text.
const WIDTH: u32 = 720;

/// Returns the drawing options from which most pictures start. Boxes, tree nodes, manifolds and
/// proximities are off.
fn options<N: Real>() -> DebugOptions<N> {
    let style = |color, size| Some(Style { color, size: N::lit(size) });
    let mut options = DebugOptions {
        object: style(SLATE, 0.1),
        contact_point: style(RED, 0.1),
        contact_normal: style(AMBER, 0.5),
        query: style(BLUE, 0.1),
        query_hit: style(RED, 0.5),
        ..DebugOptions::none()
    };
    options.mesh.subdivisions = 48;
    options
}

/// Draws each shape in its own colour with its name below, in rows along two axes.
fn draw_grid<N: Space<D>, const D: usize>(
    shapes: &[(&str, ShapeHandle<N, D>, Color)],
    columns: usize,
    axes: [Vector<N, D>; 2],
    renderer: &mut dyn DebugRender<N, D>,
) {
    let mut options = options::<N>();
    options.mesh.half_space_extent = N::ONE;
    let mut drawing = DebugDrawing::new(options);
    let [right, down] = axes;
    for (index, (name, shape, color)) in shapes.iter().enumerate() {
        let at = right * N::lit((index % columns) as f64) + down * N::lit((index / columns) as f64);
        let position = N::isometry(&Pose::from_translation(at));
        renderer.mesh(drawing.mesh(shape), &position, *color, Drawn::Object);
        let below = at - right * N::lit(0.42) + down * N::lit(0.56);
        renderer.text(&below.into(), name, INK, Drawn::Object);
    }
}

/// Returns a pose in 2D with a rotation by `angle` radians. The library computes sine and cosine
/// with the same bits on every machine.
fn turned2(x: f64, y: f64, angle: f64) -> dim2::math::Isometry<f64> {
    let (sine, cosine) = angle.sine_cosine();
    let rotation = dim2::math::Rotation::new_unchecked(dim2::na::Complex::new(cosine, sine));
    dim2::math::Isometry::from_parts(dim2::math::Vector::new(x, y).into(), rotation)
}

/// Writes a line of text at a point of a 2D picture.
fn note(picture: &mut SvgPicture, at: [f64; 2], text: &str) {
    let at = dim2::math::Point::from(at);
    DebugRender::<f64, 2>::text(picture, &at, text, INK, Drawn::Object);
}

/// The maximum size of a picture in bytes, since a page of the guide loads all of its pictures at
/// once.
const MAX_BYTES: usize = 60_000;

fn golden() -> Golden {
    Golden::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../guide/pictures"))
}

fn check_svg(name: &str, picture: &SvgPicture) {
    assert_eq!(picture.left_out(), 0, "{name}: everything has a place");
    let svg = picture.to_svg();
    roxmltree::Document::parse(&svg).expect("well-formed");
    assert!(svg.len() <= MAX_BYTES, "{name}: {} bytes", svg.len());
    for (ending, text) in [("svg", &svg), ("uri", &data_uri(&svg))] {
        let found = golden().check_text(&format!("{name}.{ending}"), text);
        assert!(found.is_ok(), "{name}: {}", found.err().map_or(String::new(), |e| e.to_string()));
    }
}

/// Returns the picture as a data URI, which can be the destination of a Markdown link in angle
/// brackets. Pages of `rustdoc` cannot refer to separate files.
fn data_uri(svg: &str) -> String {
    let mut uri = "data:image/svg+xml,".to_owned();
    for character in svg.chars() {
        if "%#<>\\&\n".contains(character) {
            uri.push_str(&format!("%{:02X}", u32::from(character)));
        } else {
            uri.push(character);
        }
    }
    uri
}

fn check_png(name: &str, picture: &PngPicture, colors: usize) {
    assert_eq!(picture.left_out(), 0, "{name}: everything has a place");
    let image = picture.to_image().with_colors(colors);
    let bytes = image.to_png().len();
    assert!(bytes <= MAX_BYTES, "{name}: {bytes} bytes");
    let found = golden().check(name, &image);
    assert!(found.is_ok(), "{name}: {}", found.err().map_or(String::new(), |e| e.to_string()));
}
