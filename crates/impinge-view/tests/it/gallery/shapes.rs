//! Pictures of all shapes with their names.

use super::{CLAY, GOLD, MAUVE, SAGE, SLATE, WIDTH, check_png, check_svg, draw_grid};
use impinge::debug_render::Color;
use impinge::math::{Real, Vector};
use impinge::shape::ShapeHandle;
use impinge::{dim2, dim3};
use impinge_view::{Camera, PngPicture, SvgPicture};

/// Adds a colour to each shape, by its index.
fn colored<N: impinge::math::Space<D>, const D: usize>(
    shapes: Vec<(&'static str, ShapeHandle<N, D>)>,
) -> Vec<(&'static str, ShapeHandle<N, D>, Color)> {
    let colors = [SLATE, CLAY, SAGE, GOLD, MAUVE];
    let color = |index: usize| colors[index % colors.len()];
    shapes
        .into_iter()
        .enumerate()
        .map(|(index, (name, shape))| (name, shape, color(index)))
        .collect()
}

fn convex2() -> Vec<(&'static str, ShapeHandle<f64, 2>)> {
    use dim2::prelude::*;
    let at = |x: f64, y: f64| Point::new(x, y);
    let pentagon = [[0.0, 1.0], [-0.95, 0.3], [-0.6, -0.8], [0.6, -0.8], [0.95, 0.3]];
    vec![
        ("Ball", ShapeHandle::new(Ball::new(0.9))),
        ("Cuboid", ShapeHandle::new(Cuboid::new(Vector::new(0.95, 0.7)))),
        ("Capsule", ShapeHandle::new(Capsule::new(0.5, 0.45))),
        ("TaperedCapsule", ShapeHandle::new(TaperedCapsule::new(0.45, 0.55, 0.3))),
        ("Ellipse", ShapeHandle::new(Ellipse::new(Vector::new(1.0, 0.6)))),
        ("ConvexPolygon", ShapeHandle::new(ConvexPolygon::from_points(&pentagon.map(Point::from)))),
        ("Triangle", ShapeHandle::new(Triangle::new(at(-0.9, -0.8), at(0.9, -0.8), at(0.3, 0.9)))),
        ("Segment", ShapeHandle::new(Segment::new(at(-0.9, -0.6), at(0.9, 0.6)))),
        ("Rounded", ShapeHandle::new(Rounded::new(Cuboid::new(Vector::new(0.6, 0.4)), 0.35))),
        ("HalfSpace", ShapeHandle::new(HalfSpace::new(Vector::y_axis()))),
    ]
}

fn composites2() -> Vec<(&'static str, ShapeHandle<f64, 2>)> {
    use dim2::prelude::*;
    let wheel = ShapeHandle::new(Ball::new(0.32));
    let cart = Compound::new(vec![
        (Isometry::translation(-0.5, -0.5), wheel.clone()),
        (Isometry::translation(0.5, -0.5), wheel),
        (Isometry::translation(0.0, 0.15), ShapeHandle::new(Cuboid::new(Vector::new(0.95, 0.35)))),
    ]);
    let arrow =
        [[-0.9, -0.3], [0.1, -0.3], [0.1, -0.8], [0.95, 0.0], [0.1, 0.8], [0.1, 0.3], [-0.9, 0.3]];
    let triangles = vec![[0, 1, 5], [0, 5, 6], [1, 2, 3], [1, 3, 5], [3, 4, 5]];
    let zigzag = [[-0.9, -0.5], [-0.5, 0.4], [0.0, -0.3], [0.4, 0.7], [0.9, -0.1]];
    let heights = vec![0.0, 0.5, 0.3, -0.2, 0.1, 0.6, 0.4];
    vec![
        ("Compound", ShapeHandle::new(cart)),
        ("TriMesh", ShapeHandle::new(TriMesh::new(arrow.map(Point::from).to_vec(), triangles))),
        ("Polyline", ShapeHandle::new(Polyline::open(zigzag.map(Point::from).to_vec()))),
        ("HeightField", ShapeHandle::new(HeightField::new(heights, Vector::new(2.0, 1.0)))),
    ]
}

#[test]
fn every_2d_shape() {
    let shapes = colored(convex2().into_iter().chain(composites2()).collect());
    let mut picture = SvgPicture::plane(WIDTH).without_legend().with_title(
        "The shapes in 2D",
        "Ten convex shapes, and four that are made of parts, each with its name.",
    );
    draw_grid(&shapes, 5, [Vector::from([2.7, 0.0]), Vector::from([0.0, -2.9])], &mut picture);
    check_svg("shapes2", &picture);
}

fn convex3() -> Vec<(&'static str, ShapeHandle<f64, 3>)> {
    use dim3::prelude::*;
    let at = |x: f64, y: f64, z: f64| Point::new(x, y, z);
    let [a, b] = [0.53, 0.85];
    let corners = |s: f64, t: f64| [[0.0, s * a, t * b], [s * a, t * b, 0.0], [t * b, 0.0, s * a]];
    let signs = [[1.0, 1.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0]];
    let icosahedron: Vec<_> =
        signs.iter().flat_map(|[s, t]| corners(*s, *t)).map(Point::from).collect();
    let tetrahedron =
        [at(-0.9, -0.7, 0.5), at(0.9, -0.7, 0.5), at(0.0, -0.7, -0.9), at(0.0, 0.9, 0.0)];
    vec![
        ("Ball", ShapeHandle::new(Ball::new(0.85))),
        ("Cuboid", ShapeHandle::new(Cuboid::new(Vector::new(0.8, 0.5, 0.6)))),
        ("Capsule", ShapeHandle::new(Capsule::new(0.5, 0.42))),
        ("TaperedCapsule", ShapeHandle::new(TaperedCapsule::new(0.45, 0.55, 0.28))),
        ("Cylinder", ShapeHandle::new(Cylinder::new(0.7, 0.6))),
        ("Cone", ShapeHandle::new(Cone::new(0.8, 0.7))),
        ("Ellipsoid", ShapeHandle::new(Ellipsoid::new(Vector::new(1.0, 0.55, 0.7)))),
        ("ConvexHull", ShapeHandle::new(ConvexHull::from_points(&icosahedron))),
        ("Tetrahedron", ShapeHandle::new(Tetrahedron::new(tetrahedron))),
        (
            "Triangle",
            ShapeHandle::new(Triangle::new(
                at(-0.9, -0.5, 0.3),
                at(0.9, -0.5, 0.0),
                at(0.1, 0.8, -0.2),
            )),
        ),
        ("Segment", ShapeHandle::new(Segment::new(at(-0.8, -0.6, 0.0), at(0.8, 0.6, 0.0)))),
        ("Rounded", ShapeHandle::new(Rounded::new(Cuboid::new(Vector::new(0.5, 0.3, 0.4)), 0.3))),
        ("HalfSpace", ShapeHandle::new(HalfSpace::new(Vector::y_axis()))),
    ]
}

/// Returns a torus around the y axis with 20 cells along the large circle and 10 along the small
/// circle.
fn torus() -> dim3::shape::TriMesh<f64> {
    use dim3::math::Point;
    let (around, across) = (20_u32, 10_u32);
    let turn = |index: u32, count: u32| {
        (f64::from(index) * std::f64::consts::TAU / f64::from(count)).sine_cosine()
    };
    let vertex = |i: u32, j: u32| {
        let ((sine, cosine), (up, out)) = (turn(i, around), turn(j, across));
        let radius = 0.65 + 0.28 * out;
        Point::new(radius * cosine, 0.28 * up, radius * sine)
    };
    let index = |i: u32, j: u32| i % around * across + j % across;
    let cells = (0..around).flat_map(|i| (0..across).map(move |j| (i, j)));
    let halves = |(i, j)| {
        let [a, b, c, d] = [index(i, j), index(i, j + 1), index(i + 1, j + 1), index(i + 1, j)];
        [[a, b, c], [a, c, d]]
    };
    let vertices = (0..around).flat_map(|i| (0..across).map(move |j| vertex(i, j))).collect();
    dim3::shape::TriMesh::new(vertices, cells.flat_map(halves).collect())
}

fn composites3() -> Vec<(&'static str, ShapeHandle<f64, 3>)> {
    use dim3::prelude::*;
    let leg = ShapeHandle::new(Cylinder::new(0.45, 0.1));
    let feet = [[-0.7, -0.5], [0.7, -0.5], [-0.7, 0.5], [0.7, 0.5]];
    let mut parts: Vec<_> =
        feet.map(|[x, z]| (Isometry::translation(x, -0.3, z), leg.clone())).to_vec();
    let top = ShapeHandle::new(Cuboid::new(Vector::new(0.9, 0.1, 0.65)));
    parts.push((Isometry::translation(0.0, 0.25, 0.0), top));
    let helix = (0..=48).map(|step| {
        let (sine, cosine) = (f64::from(step) * 0.4).sine_cosine();
        Point::new(0.7 * cosine, f64::from(step) / 30.0 - 0.8, 0.7 * sine)
    });
    let height = |row: i32, column: i32| {
        (f64::from(row) * 0.9).sine_cosine().0 * (f64::from(column) * 0.8).sine_cosine().1
    };
    let heights = (0..9).flat_map(|row| (0..9).map(move |column| height(row, column)));
    vec![
        ("Compound", ShapeHandle::new(Compound::new(parts))),
        ("TriMesh", ShapeHandle::new(torus())),
        ("Polyline", ShapeHandle::new(Polyline::open(helix.collect()))),
        (
            "HeightField",
            ShapeHandle::new(HeightField::new(9, 9, heights.collect(), Vector::new(1.9, 0.3, 1.9))),
        ),
    ]
}

#[test]
fn every_3d_shape() {
    let shapes = colored(convex3().into_iter().chain(composites3()).collect());
    let camera =
        Camera::look_along(&Vector::from([-0.5, -0.55, -1.0]), &Vector::from([0.0, 1.0, 0.0]));
    let axes = [camera.right() * 2.5, camera.up() * -2.8];
    let mut picture = PngPicture::new(camera, [720, 404]).with_margin(8.0);
    draw_grid(&shapes, 6, axes, &mut picture);
    check_png("shapes3", &picture, 160);
}
