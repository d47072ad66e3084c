//! Reads the files of the corpus.

use impinge::math::na::{Quaternion, Translation, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry, Point, Real, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, HeightField,
    Plane, Rounded, Segment, Shape, TriMesh, Triangle,
};
use serde_json::Value;

use super::Placed;
use super::solids;

/// Returns all cases of a corpus file, parsed from its text.
pub fn cases(text: &str) -> Vec<Value> {
    let file: Value = serde_json::from_str(text).expect("the corpus is JSON");
    file["cases"].as_array().expect("a list of cases").clone()
}

pub fn regression() -> Vec<Value> {
    cases(include_str!("../../../data/regression_cases.json"))
}

pub fn narrow_phase() -> Vec<Value> {
    cases(include_str!("../../../data/narrow_phase_cases.json"))
}

pub fn number<N: Real>(value: &Value) -> N {
    N::lit(value.as_f64().expect("a number"))
}

/// Returns the number with the first of two names, or with the second if the first is missing.
fn either<N: Real>(value: &Value, name1: &str, name2: &str) -> N {
    number(value.get(name1).unwrap_or(&value[name2]))
}

pub fn vector<N: Real, const D: usize>(value: &Value) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| number(&value[axis]))
}

fn point<N: Real, const D: usize>(value: &Value) -> Point<N, D> {
    Point::from(vector(value))
}

fn points<N: Real, const D: usize>(value: &Value) -> Vec<Point<N, D>> {
    value.as_array().expect("a list of points").iter().map(point).collect()
}

/// Returns a shape of a kind that exists in both dimensions; `None` for other kinds.
fn common<N: Real, const D: usize>(value: &Value) -> Option<Box<dyn Shape<N, D>>> {
    Some(match value["type"].as_str().expect("a name") {
        "ball" => Box::new(Ball::new(either(value, "radius", "r"))),
        "point" => Box::new(Ball::new(N::ZERO)),
        "cuboid" => Box::new(Cuboid::new(vector(&value["half_extents"]))),
        "capsule" => {
            let (a, b) = (point(&value["a"]), point(&value["b"]));
            Box::new(Capsule::try_from_ends(a, b, number(&value["radius"])).expect("finite"))
        }
        "capsule_y" => {
            Box::new(Capsule::<N, D>::new(number(&value["half_height"]), number(&value["r"])))
        }
        "segment" => Box::new(Segment::new(point(&value["a"]), point(&value["b"]))),
        "triangle" => {
            Box::new(Triangle::new(point(&value["a"]), point(&value["b"]), point(&value["c"])))
        }
        "halfspace" => Box::new(Plane::new(Unit::new_normalize(vector(&value["normal"])))),
        "round_cuboid" => {
            let cuboid = Cuboid::<N, D>::new(vector(&value["half_extents"]));
            Box::new(Rounded::new(cuboid, number(&value["r"])))
        }
        "ellipsoid" => Box::new(Ellipsoid::<N, D>::new(vector(&value["radii"]))),
        "round_cuboid by support" => {
            let half_extents = vector(&value["half_extents"]);
            Box::new(solids::RoundHull::<N, D>::cuboid(&half_extents, number(&value["r"])))
        }
        "ellipsoid by support" => {
            Box::new(solids::Ellipsoid::<N, D> { radii: vector(&value["radii"]) })
        }
        _ => return None,
    })
}

pub fn shape2<N: Real>(value: &Value) -> Option<Box<dyn Shape<N, 2>>> {
    common(value).or_else(|| match value["type"].as_str() {
        Some("convex_polygon") => Some(polygon(&points(&value["points"]))),
        _ => None,
    })
}

pub fn shape3<N: Real>(value: &Value) -> Option<Box<dyn Shape<N, 3>>> {
    common(value).or_else(|| match value["type"].as_str() {
        Some("cylinder" | "cylinder_y") => Some(Box::new(Cylinder::new(
            number(&value["half_height"]),
            either(value, "radius", "r"),
        ))),
        Some("cone" | "cone_y") => {
            Some(Box::new(Cone::new(number(&value["half_height"]), either(value, "radius", "r"))))
        }
        Some("convex" | "convex_hull") => Some(hull(&points(&value["points"]))),
        Some("heightfield") => Some(Box::new(height_field(value))),
        Some("trimesh") => Some(Box::new(tri_mesh(value))),
        _ => None,
    })
}

/// Returns a flat height field, optionally with all cells but the first removed.
fn height_field<N: Real>(value: &Value) -> HeightField<N, 3> {
    let count =
        |name: &str| usize::try_from(value[name].as_u64().expect("a whole number")).expect("few");
    let (rows, columns) = (count("rows"), count("cols"));
    assert!(value["heights"] == "all 0" || value["heights"] == 0.0, "flat");
    let heights = vec![N::ZERO; rows * columns];
    let field = HeightField::<N, 3>::new(rows, columns, heights, vector(&value["size"]));
    match value["holes"].as_str() {
        None => field,
        Some("all cells except (0,0)") => field.with_holes(|row, column| (row, column) != (0, 0)),
        Some(other) => panic!("no holes {other}"),
    }
}

/// Returns a mesh of vertices and triangles.
pub fn tri_mesh<N: Real>(value: &Value) -> TriMesh<N, 3> {
    let name = |index: &Value| u32::try_from(index.as_u64().expect("whole")).expect("few");
    let triangles = value["indices"].as_array().expect("a list").iter();
    let triangles = triangles.map(|corners| [0, 1, 2].map(|corner| name(&corners[corner])));
    TriMesh::new(points(&value["vertices"]), triangles.collect())
}

/// Returns the hull of points in 2D.
pub fn polygon<N: Real>(points: &[Point<N, 2>]) -> Box<dyn Shape<N, 2>> {
    Box::new(ConvexPolygon::from_points(points))
}

/// Returns the hull of points in 3D.
pub fn hull<N: Real>(points: &[Point<N, 3>]) -> Box<dyn Shape<N, 3>> {
    Box::new(ConvexHull::from_points(points))
}

/// Returns the rotation that takes the y axis to the axis of a shape in the corpus.
fn standing<N: Real>(shape: &Value) -> UnitQuaternion<N> {
    match shape.get("axis").and_then(Value::as_str) {
        Some("z") => UnitQuaternion::from_axis_angle(&Vector::<N, 3>::x_axis(), N::frac_pi_2()),
        Some("x") => UnitQuaternion::from_axis_angle(&Vector::<N, 3>::z_axis(), -N::frac_pi_2()),
        _ => UnitQuaternion::identity(),
    }
}

/// Returns the position, in the frame of the library, of the origin of a shape of the corpus:
/// height fields of the library are centred.
fn offset<N: Real>(shape: &Value) -> Translation<N, 3> {
    let size = shape.get("origin_corner").map(|_| vector::<N, 3>(&shape["size"]));
    let half = size.map(|size| Vector::<N, 3>::new(size.x, N::ZERO, size.z) * N::HALF);
    Translation::from(half.unwrap_or_else(Vector::<N, 3>::zeros))
}

/// Returns the translation of a pose, under either of its names; zero if there is none.
fn translation<N: Real, const D: usize>(pose: &Value) -> Translation<N, D> {
    let value = pose.get("t").or_else(|| pose.get("translation"));
    Translation::from(value.map_or_else(Vector::<N, D>::zeros, vector))
}

pub fn placed2<N: Real>(shape: &Value, pose: &Value) -> Option<Placed<N, UnitComplex<N>, 2>> {
    let rotation = match pose.get("cos") {
        Some(cos) => {
            let (cos, sin) = (cos.as_f64().expect("a number"), number::<f64>(&pose["sin"]));
            let length = cos.hypot(sin);
            UnitComplex::from_cos_sin_unchecked(N::lit(cos / length), N::lit(sin / length))
        }
        None => {
            let angle = pose.get("angle").map_or(0.0, number::<f64>);
            UnitComplex::from_cos_sin_unchecked(N::lit(angle.cos()), N::lit(angle.sin()))
        }
    };
    Some(Placed { shape: shape2(shape)?, pose: Isometry::from_parts(translation(pose), rotation) })
}

pub fn placed3<N: Real>(shape: &Value, pose: &Value) -> Option<Placed<N, UnitQuaternion<N>, 3>> {
    let value = pose.get("q").or_else(|| pose.get("rotation_xyzw"));
    let q = value.map_or_else(Vector::<f64, 4>::w, vector).normalize().map(N::lit);
    let rotation = UnitQuaternion::new_normalize(Quaternion::from(q)) * standing(shape);
    let pose = Isometry::from_parts(translation(pose), rotation) * offset(shape);
    Some(Placed { shape: shape3(shape)?, pose })
}
