//! Tests that the surfaces of rounded 3D solids are closed, lie on the solid, and enclose the
//! expected volume.

use impinge::debug_render::{MeshOptions, ShapeMesh};
use impinge::dim3::math::{Isometry, Point, Vector};
use impinge::dim3::query::PointQuery;
use impinge::dim3::shape::{ConvexHull, Cuboid, Rounded, Shape, Tetrahedron, Triangle};
use impinge::math::Real;
use std::collections::BTreeMap;

fn mesh_of(shape: &dyn Shape<f64, 3>, turn: u32) -> ShapeMesh<f64, 3> {
    let options = MeshOptions { subdivisions: turn, ..MeshOptions::default() };
    ShapeMesh::of(shape, &options)
}

/// Checks that each side of a triangle is the reverse of exactly one side of another triangle, and
/// that all vertices are on the surface, to within 1e-14.
fn assert_closed(solid: &Rounded<f64>, turn: u32, name: &str) {
    let mesh = mesh_of(solid, turn);
    let mut sides = BTreeMap::new();
    for [a, b, c] in &mesh.triangles {
        for side in [[a, b], [b, c], [c, a]] {
            *sides.entry(side).or_insert(0) += 1;
        }
    }
    for ([a, b], count) in &sides {
        assert_eq!((*count, sides.get(&[*b, *a])), (1, Some(&1)), "{name}: from {a} to {b}");
    }
    for vertex in &mesh.vertices {
        let distance = solid.distance_to_point(&Isometry::identity(), vertex, false).abs();
        assert!(distance < 1e-14, "{name}: {vertex} is off by {distance}");
    }
}

/// Returns six times the volume inside a surface.
fn volume(mesh: &ShapeMesh<f64, 3>) -> f64 {
    let corner = |index: u32| mesh.vertices[index as usize].coords;
    let of = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(corner);
        a.cross(&b).dot(&c)
    };
    mesh.triangles.iter().map(of).sum()
}

/// Returns the convex hull of points in general position on a cylinder of radius 1 and height 3.
fn hull(count: u32) -> ConvexHull<f64> {
    let point = |index: u32| {
        let n = f64::from(index);
        let z = 2.0 * (n * 0.618_034).fract() - 1.0;
        let (sine, cosine) = (n * 2.4 + z).sine_cosine();
        Point::from(Vector::new(sine, cosine, z * 1.5))
    };
    ConvexHull::from_points(&(0..count).map(point).collect::<Vec<_>>())
}

fn corners(scale: f64) -> [Point<f64>; 4] {
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.2], [0.1, 0.0, 1.0], [0.2, 0.9, 0.3]]
        .map(|corner| Point::from(corner.map(|x| x * scale)))
}

#[test]
fn surfaces_are_closed() {
    for turn in [3, 8, 24, 48] {
        let [a, b, c, _] = corners(1.0);
        assert_closed(&Rounded::new(Cuboid::new(Vector::new(0.5, 1.0, 0.25)), 0.3), turn, "cuboid");
        assert_closed(&Rounded::new(Triangle::new(a, b, c), 0.2), turn, "triangle");
        assert_closed(&Rounded::new(Tetrahedron::new(corners(1.0)), 0.25), turn, "tetrahedron");
        for count in [5, 8, 20, 60] {
            assert_closed(&Rounded::new(hull(count), 0.1), turn, &format!("hull of {count}"));
        }
    }
}

#[test]
fn volumes_are_those_of_steiner() {
    // Steiner's formula for a box with sides a, b, c, rounded by r: abc + 2 r (ab + bc + ca) + pi
    // r^2 (a + b + c) + 4/3 pi r^3.
    let pi = std::f64::consts::PI;
    let (a, b, c, r) = (1.0, 2.0, 0.5, 0.3);
    let exact = a * b * c
        + 2.0 * r * (a * b + b * c + c * a)
        + pi * r * r * (a + b + c)
        + 4.0 / 3.0 * pi * r * r * r;
    let solid = Rounded::new(Cuboid::new(Vector::new(a, b, c) * 0.5), r);
    let [coarse, fine] = [24, 96].map(|turn| exact - volume(&mesh_of(&solid, turn)) / 6.0);
    assert!(coarse > 0.0 && coarse < 0.01 * exact, "inside the solid: {coarse} of {exact}");
    assert!(fine > 0.0 && fine < coarse / 10.0, "sixteen times better: {fine} of {coarse}");
}

#[test]
fn needles_and_flat_boxes_have_a_surface_too() {
    let needle = [[0.0, 0.0, 0.0], [1.0, 1e-9, 0.0], [2.0, 0.0, 0.0]].map(Point::from);
    let [a, b, c] = needle;
    let solids: [Rounded<f64>; 5] = [
        Rounded::new(Triangle::new(a, b, c), 0.2),
        Rounded::new(Triangle::new(a, a, c), 0.2),
        Rounded::new(Cuboid::new(Vector::new(1.0, 0.0, 1.0)), 0.2),
        Rounded::new(Cuboid::new(Vector::zeros()), 0.2),
        Rounded::new(Cuboid::new(Vector::new(1.0, 1.0, 1.0)), 0.0),
    ];
    for solid in solids {
        let mesh = mesh_of(&solid, 24);
        assert!(mesh.triangles.len() >= 12, "{solid:?}: {} triangles", mesh.triangles.len());
        for vertex in &mesh.vertices {
            let distance = solid.distance_to_point(&Isometry::identity(), vertex, false).abs();
            assert!(distance < 1e-8, "{solid:?}: {vertex} is off by {distance}");
        }
    }
}
