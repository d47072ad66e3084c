//! Reads solids and poses from JSON.

use impinge_reference::geometry::{Pose, Solid};
use serde_json::Value;

pub(crate) fn read(name: &str) -> Value {
    let path = format!("{}/../impinge/tests/data/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("the corpus is part of the repository");
    serde_json::from_str(&text).expect("the corpus is JSON")
}

pub(crate) fn cases(corpus: &Value) -> &[Value] {
    corpus["cases"].as_array().expect("a list of cases")
}

pub(crate) fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("a number, not {value}"))
}

pub(crate) fn numbers<const N: usize>(value: &Value) -> [f64; N] {
    let list = value.as_array().unwrap_or_else(|| panic!("a list, not {value}"));
    std::array::from_fn(|i| number(&list[i]))
}

/// Returns the solid, and its pose in the frame of the shape; `None` if the type of the shape is
/// unknown. Cylinders and cones of the corpus may have the axis x, y or z; those of the reference
/// have the axis y.
pub(crate) fn solid<const D: usize>(shape: &Value) -> Option<(Solid<D>, Pose<D>)> {
    let radius = || number(shape.get("radius").unwrap_or(&shape["r"]));
    let points = |keys: &[&str]| keys.iter().map(|key| numbers(&shape[key])).collect();
    let on_axis = |sign: f64| {
        let height = number(&shape["half_height"]);
        std::array::from_fn(|i| if i == 1 { sign * height } else { 0.0 })
    };
    let found = match shape["type"].as_str()? {
        "ball" => Solid::ball(radius()),
        "point" => Solid::ball(0.0),
        "cuboid" => Solid::cuboid(numbers(&shape["half_extents"])),
        "round_cuboid" => Solid::round_cuboid(numbers(&shape["half_extents"]), radius()),
        "capsule" => Solid::capsule(numbers(&shape["a"]), numbers(&shape["b"]), radius()),
        "capsule_y" => Solid::capsule(on_axis(-1.0), on_axis(1.0), radius()),
        "segment" => Solid::polytope(points(&["a", "b"])),
        "triangle" => Solid::polytope(points(&["a", "b", "c"])),
        "convex" | "convex_polygon" | "convex_hull" => {
            Solid::polytope(shape["points"].as_array()?.iter().map(numbers).collect())
        }
        "halfspace" => Solid::half_space(numbers(&shape["normal"])),
        "cylinder" | "cylinder_y" => {
            Solid::Cylinder { half_height: number(&shape["half_height"]), radius: radius() }
        }
        "cone" | "cone_y" => {
            Solid::Cone { half_height: number(&shape["half_height"]), radius: radius() }
        }
        _ => return None,
    };
    let mut tilt = Pose::identity();
    match shape["axis"].as_str() {
        // Rotates y to x about z, or y to z about x.
        Some("x") => (tilt.rotation[0], tilt.rotation[1]) = (unit(1), unit(0).map(|x: f64| -x)),
        Some("z") => (tilt.rotation[1], tilt.rotation[2]) = (unit(2).map(|x: f64| -x), unit(1)),
        _ => (),
    }
    Some((found, tilt))
}

fn unit<const D: usize>(index: usize) -> [f64; D] {
    std::array::from_fn(|i| if i == index { 1.0 } else { 0.0 })
}

/// Reads poses, which have different members in 2D and 3D.
pub(crate) trait ReadPose: Sized {
    fn read(value: &Value) -> Self;
    /// Reads the pose of the second shape in the frame of the first.
    fn read_pos12(value: &Value) -> Self;
}

impl ReadPose for Pose<2> {
    fn read(value: &Value) -> Self {
        Self::from_angle(numbers(&value["t"]), number(&value["angle"]))
    }

    fn read_pos12(value: &Value) -> Self {
        let complex = [number(&value["cos"]), number(&value["sin"])];
        Self::from_complex(numbers(&value["translation"]), complex)
    }
}

impl ReadPose for Pose<3> {
    fn read(value: &Value) -> Self {
        Self::from_quaternion(numbers(&value["t"]), numbers(&value["q"]))
    }

    fn read_pos12(value: &Value) -> Self {
        Self::from_quaternion(numbers(&value["translation"]), numbers(&value["rotation_xyzw"]))
    }
}
