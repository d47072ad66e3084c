//! Signed distance of a point from a solid in closed form, independent of the algorithms under
//! test.

use serde_json::Value;

use super::solids::{number, vector};
use crate::math::{Vector, cross};

/// Returns the signed distance of a point from the solid of an entry of the test data: negative
/// inside.
pub(super) fn off(shape: &Value, point: &Vector<f64, 3>) -> f64 {
    let corner = |name: &str| vector::<f64, 3>(&shape[name]);
    let [height, radius] = ["half_height", "r"].map(|name| shape[name].as_f64().unwrap_or(0.0));
    let half_plane = [point.x.hypot(point.z), point.y];
    match shape["type"].as_str().expect("a kind") {
        "ball" => point.norm() - radius,
        "segment" => to_segment(point, [corner("a"), corner("b")]),
        "triangle" => to_triangle(point, &["a", "b", "c"].map(corner)),
        "capsule_y" => {
            let end = Vector::<f64, 3>::new(0.0, height, 0.0);
            to_segment(point, [end, -end]) - radius
        }
        "cuboid" => to_box(point, &vector(&shape["half_extents"])),
        "cylinder_y" => {
            let profile = Vector::<f64, 3>::new(half_plane[0], half_plane[1], 0.0);
            to_box(&profile, &Vector::<f64, 3>::new(radius, height, f64::INFINITY))
        }
        "cone_y" => to_cone(half_plane, [height, radius]),
        other => panic!("no closed form for a {other}"),
    }
}

fn to_segment(point: &Vector<f64, 3>, [a, b]: [Vector<f64, 3>; 2]) -> f64 {
    let edge = b - a;
    let along = (point - a).dot(&edge) / edge.norm_squared();
    (point - a - edge * along.clamp(0.0, 1.0)).norm()
}

fn to_triangle(point: &Vector<f64, 3>, &[a, b, c]: &[Vector<f64, 3>; 3]) -> f64 {
    let sides = [[a, b], [b, c], [c, a]];
    let normal = cross(&(b - a), &(c - a));
    let beside =
        |[from, to]: [Vector<f64, 3>; 2]| cross(&(to - from), &(point - from)).dot(&normal) < 0.0;
    if sides.into_iter().any(beside) {
        return sides.map(|side| to_segment(point, side)).into_iter().fold(f64::INFINITY, f64::min);
    }
    (point - a).dot(&normal).abs() / normal.norm()
}

fn to_box(point: &Vector<f64, 3>, half_extents: &Vector<f64, 3>) -> f64 {
    let beyond = point.abs() - half_extents;
    beyond.map(|x| x.max(0.0)).norm() + beyond.max().min(0.0)
}

/// Returns the signed distance from a cone, which is a triangle in the half-plane of radial
/// distance and height.
fn to_cone([radial, y]: [f64; 2], [height, radius]: [f64; 2]) -> f64 {
    let at = |radial: f64, y: f64| Vector::<f64, 3>::new(radial, y, 0.0);
    let (point, apex, rim, middle) =
        (at(radial, y), at(0.0, height), at(radius, -height), at(0.0, -height));
    let outward = at(2.0 * height, radius);
    let inside = y >= -height && (point - apex).dot(&outward) <= 0.0;
    let distance = to_segment(&point, [rim, apex]).min(to_segment(&point, [middle, rim]));
    if inside { -distance } else { distance }
}

#[test]
fn by_hand() {
    use serde_json::json;
    let cone = json!({ "type": "cone_y", "half_height": 2.0, "r": 3.0 });
    let cylinder = json!({ "type": "cylinder_y", "half_height": 2.0, "r": 3.0 });
    let triangle = json!({ "type": "triangle", "a": [0.0, 0.0, 0.0], "b": [4.0, 0.0, 0.0], "c": [0.0, 4.0, 0.0] });
    let cases = [
        (&cone, [0.0, 3.0, 0.0], 1.0),
        (&cone, [0.0, -1.5, 0.0], -0.5),
        (&cone, [0.0, -1.5, 6.0], 9.25_f64.sqrt()),
        (&cylinder, [0.0, 1.0, 6.0], 3.0),
        (&cylinder, [0.0, 1.0, 0.0], -1.0),
        (&cylinder, [3.0, 6.0, 4.0], 20.0_f64.sqrt()),
        (&triangle, [1.0, 1.0, -2.0], 2.0),
        (&triangle, [4.0, 4.0, 0.0], 8.0_f64.sqrt()),
    ];
    for (shape, point, expected) in cases {
        let found = off(shape, &Vector::<f64, 3>::from(point));
        assert!((found - expected).abs() < 1e-15 * 8.0, "{found}, {expected}: {shape}");
    }
    assert_eq!(number(&cone["r"]), 3.0, "the radius is the base's");
}
