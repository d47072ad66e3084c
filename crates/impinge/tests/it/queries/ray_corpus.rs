//! Runs the ray and point queries of the corpus, which other libraries got wrong, and compares the
//! results with those of the corpus.

use impinge::bounding_volume::Aabb;
use impinge::math::na::{Quaternion, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::query::{PointQuery, Ray, RayCast, RayIntersection};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, Cylinder, HeightField, Segment, Shape, ShapeHandle, TriMesh,
    Triangle,
};
use serde_json::Value;

fn cases() -> Vec<Value> {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/regression_cases.json");
    let text = std::fs::read_to_string(path).expect("the corpus is there");
    let all: Value = serde_json::from_str(&text).expect("it is JSON");
    all["cases"].as_array().expect("it is a list").clone()
}

fn of_kind(query: &str) -> Vec<Value> {
    cases().into_iter().filter(|case| case["query"] == query).collect()
}

fn number<N: Real>(value: &Value) -> N {
    N::lit(value.as_f64().unwrap_or(f64::NAN))
}

fn vector<N: Real, const D: usize>(value: &Value) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| number(&value[axis]))
}

fn point<N: Real, const D: usize>(value: &Value) -> Point<N, D> {
    Point::from(vector(value))
}

fn tolerance<N: Real>(case: &Value) -> f64 {
    let name = if N::EPSILON.as_f64() < 1e-10 { "f64" } else { "f32" };
    case["tolerance"][name].as_f64().unwrap_or(0.0)
}

fn common<N: Space<D>, const D: usize>(shape: &Value) -> Option<ShapeHandle<N, D>> {
    let [a, b, c] = ["a", "b", "c"].map(|name| point::<N, D>(&shape[name]));
    Some(match shape["type"].as_str()? {
        "segment" => ShapeHandle::new(Segment::new(a, b)),
        "triangle" => ShapeHandle::new(Triangle::new(a, b, c)),
        "ball" => ShapeHandle::new(Ball::new(number(&shape["radius"]))),
        "capsule" => {
            let capsule = Capsule::try_from_ends(a, b, number(&shape["radius"]));
            ShapeHandle::new(capsule.expect("the corpus holds good numbers"))
        }
        _ => return None,
    })
}

fn pose2<N: Real>(value: &Value) -> Isometry2<N> {
    Isometry2::new(vector(&value["t"]), number(&value["angle"]))
}

fn pose3<N: Real>(value: &Value) -> Isometry3<N> {
    let q: Vec<N> = (0..4).map(|i| number(&value["q"][i])).collect();
    let rotation = UnitQuaternion::from_quaternion(Quaternion::new(q[3], q[0], q[1], q[2]));
    Isometry3::from_parts(vector::<N, 3>(&value["t"]).into(), rotation)
}

/// Returns a flat height field or a mesh; `None` for other types of shapes.
fn surface<N: Real>(shape: &Value) -> Option<ShapeHandle<N, 3>> {
    match shape["type"].as_str()? {
        "heightfield" => {
            let count = |name: &str| usize::try_from(shape[name].as_u64()?).ok();
            assert_eq!(shape["heights"], "all 0", "flat");
            let (rows, columns) = (count("rows")?, count("cols")?);
            let heights = vec![N::ZERO; rows * columns];
            let size = vector(&shape["size"]);
            Some(ShapeHandle::new(HeightField::<N, 3>::new(rows, columns, heights, size)))
        }
        "trimesh" => Some(ShapeHandle::new(tri_mesh(shape))),
        _ => None,
    }
}

fn tri_mesh<N: Real>(shape: &Value) -> TriMesh<N, 3> {
    let name = |index: &Value| index.as_u64().and_then(|name| u32::try_from(name).ok());
    let names = |corners: &Value| [0, 1, 2].map(|at| name(&corners[at]).expect("a vertex"));
    let triangles = shape["indices"].as_array().expect("a list").iter().map(names);
    TriMesh::new(corners(&shape["vertices"]), triangles.collect())
}

/// Returns a cylinder or cone along y, and the rotation that takes y to the axis of the case;
/// `None` for other types of shapes.
fn round<N: Real>(shape: &Value) -> Option<(ShapeHandle<N, 3>, Isometry3<N>)> {
    let (half_height, radius) = (number::<N>(&shape["half_height"]), number(&shape["radius"]));
    let handle = match shape["type"].as_str()? {
        "cylinder" => ShapeHandle::new(Cylinder::new(half_height, radius)),
        "cone" => ShapeHandle::new(Cone::new(half_height, radius)),
        _ => return None,
    };
    let axis = match shape["axis"].as_str()? {
        "x" => Vector::<N, 3>::x(),
        "y" => Vector::<N, 3>::y(),
        _ => Vector::<N, 3>::z(),
    };
    let turn = UnitQuaternion::rotation_between(&Vector::<N, 3>::y(), &axis);
    let turn = turn.expect("no two of the axes are opposite");
    Some((handle, Isometry3::from_parts(Vector::<N, 3>::zeros().into(), turn)))
}

fn check_ray<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    case: &Value,
    shape: &ShapeHandle<N, D>,
    m: &Isometry<N, R, D>,
) {
    let (params, expected) = (&case["params"], &case["expected"]);
    let ray = Ray::new(point(&params["origin"]), vector(&params["dir"]));
    let solid = params["solid"].as_bool().unwrap_or(true);
    let found = shape.toi_and_normal_with_ray(m, &ray, solid);
    let what = format!("{}: {found:?}", case["id"]);
    let close = tolerance::<N>(case);
    if case["id"] == "parry-171-ridge-graze" {
        // A ray along a ridge may miss it or hit the front at that time, but never the back.
        let in_front = |hit: &RayIntersection<N, D>| {
            hit.toi == N::lit(5.0) && hit.normal.dot(&ray.dir) <= N::ZERO && hit.normal[2] > N::ZERO
        };
        assert!(found.as_ref().is_none_or(in_front), "{what}");
        return;
    }
    assert_eq!(found.is_some(), expected["hit"].as_bool().expect("yes or no"), "{what}");
    if let (Some(found), Some(t)) = (found, expected["t"].as_f64()) {
        assert!((found.toi.as_f64() - t).abs() <= close, "{what}");
    }
    if let (Some(found), Some(_)) = (found, expected["normal"].as_array()) {
        let normal: Vector<N, D> = vector(&expected["normal"]);
        assert!((found.normal - normal).norm().as_f64() <= close, "{what}");
    }
    if let Some(t) = expected["non_solid_t"].as_f64() {
        let found = shape.toi_with_ray(m, &ray, false).expect("the ray leaves");
        assert!((found.as_f64() - t).abs() <= close, "{found} hollow: {what}");
    }
}

fn rays<N: Real>() {
    let mut checked = 0;
    for case in of_kind("ray") {
        let (shape, pose) = (&case["shape1"], &case["pose1"]);
        if case["dim"] == 2 {
            check_ray(&case, &common::<N, 2>(shape).expect("a known shape"), &pose2(pose));
        } else if let Some(surface) = surface::<N>(shape) {
            check_ray(&case, &surface, &pose3(pose));
        } else if let Some((shape, turn)) = round::<N>(shape) {
            check_ray(&case, &shape, &(pose3(pose) * turn));
        } else {
            check_ray(&case, &common::<N, 3>(shape).expect("a known shape"), &pose3(pose));
        }
        checked += 1;
    }
    assert_eq!(checked, 19, "all of them");
}

#[test]
fn rays_of_the_corpus() {
    rays::<f64>();
    rays::<f32>();
}

fn boxes<N: Space<3>>() {
    let cases = of_kind("ray_aabb");
    assert_eq!(cases.len(), 3, "all of them");
    for case in cases {
        let (shape, params, expected) = (&case["shape1"], &case["params"], &case["expected"]);
        let aabb = Aabb::<N, 3>::new(point(&shape["mins"]), point(&shape["maxs"]));
        let ray = Ray::new(point(&params["origin"]), vector(&params["dir"]));
        let found = aabb.toi_with_ray(&ray, true);
        assert_eq!(found.is_some(), expected["hit"] == true, "{}: {found:?}", case["id"]);
        if let (Some(found), Some(t)) = (found, expected["t"].as_f64()) {
            assert!((found.as_f64() - t).abs() <= tolerance::<N>(&case), "{}", case["id"]);
        }
    }
}

#[test]
fn boxes_of_the_corpus() {
    boxes::<f64>();
    boxes::<f32>();
}

fn check_point<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    case: &Value,
    shape: &ShapeHandle<N, D>,
    m: &Isometry<N, R, D>,
) {
    let (params, expected) = (&case["params"], &case["expected"]);
    let (asked, close) = (point::<N, D>(&params["point"]), tolerance::<N>(case));
    let solid = params["solid"].as_bool().expect("yes or no");
    let distance = shape.distance_to_point(m, &asked, solid).as_f64();
    let found = shape.project_point(m, &asked, solid);
    let what = format!("{}: {distance} {found:?}", case["id"]);
    let expected_distance = expected["distance"].as_f64().expect("a number");
    assert!((distance.abs() - expected_distance).abs() <= close, "{what}");
    if let Some(contains) = expected["contains"].as_bool() {
        assert_eq!(shape.contains_point(m, &asked), contains, "{what}");
    }
    if expected["point"].is_array() {
        let nearest: Point<N, D> = point(&expected["point"]);
        assert!((found.point - nearest).norm().as_f64() <= 10.0 * close, "{what}");
    }
}

/// Returns the case with the corners of its triangle in every order.
fn reordered(case: &Value) -> Vec<Value> {
    let orders = ["abc", "acb", "bac", "bca", "cab", "cba"];
    let reorder = |order: &str| {
        let mut other = case.clone();
        for (to, from) in ["a", "b", "c"].iter().zip(order.chars()) {
            other["shape1"][*to] = case["shape1"][from.to_string()].clone();
        }
        other
    };
    orders.iter().map(|order| reorder(order)).collect()
}

/// Compares the signed distance of a point from a closed mesh, and whether the mesh contains it,
/// with the case. The result must not depend on the windings, so the mesh is also tested with
/// reversed windings.
fn check_mesh<N: Real>(case: &Value) {
    let (params, expected) = (&case["params"], &case["expected"]);
    let asked = point::<N, 3>(&params["point"]);
    let (distance, contains) = (number::<f64>(&expected["distance"]), expected["contains"] == true);
    let signed = if contains { -distance } else { distance };
    let mesh = tri_mesh::<N>(&case["shape1"]);
    for mesh in [mesh.clone(), mesh.flipped()] {
        let found = mesh.signed_distance(&asked).expect("a closed mesh").as_f64();
        assert!((found - signed).abs() <= tolerance::<N>(case), "{}: {found}", case["id"]);
        assert_eq!(mesh.encloses(&asked), Some(contains), "{}", case["id"]);
        let surface = mesh.distance_to_point(&Isometry3::identity(), &asked, false);
        assert_eq!(surface.as_f64(), found.abs(), "{}: as a surface", case["id"]);
    }
}

fn points<N: Real>() {
    let cases = of_kind("point_projection");
    let (meshes, triangles): (Vec<_>, Vec<_>) =
        cases.iter().partition(|case| case["shape1"]["type"] == "trimesh");
    assert_eq!((meshes.len(), triangles.len()), (4, 4), "all of them");
    meshes.into_iter().for_each(check_mesh::<N>);
    for case in triangles.into_iter().flat_map(reordered) {
        let (shape, pose) = (&case["shape1"], &case["pose1"]);
        if case["dim"] == 2 {
            check_point(&case, &common::<N, 2>(shape).expect("a known shape"), &pose2(pose));
        } else {
            check_point(&case, &common::<N, 3>(shape).expect("a known shape"), &pose3(pose));
        }
    }
}

#[test]
fn points_of_the_corpus() {
    points::<f64>();
    points::<f32>();
}

fn corners<N: Real>(list: &Value) -> Vec<Point<N, 3>> {
    list.as_array().expect("a list").iter().map(point).collect()
}

/// Compares points in the hulls of the cases' cube meshes with the same expected results: signs and
/// distances must not depend on the faces of the meshes.
fn convex_meshes<N: Space<3>>() {
    let mut checked = 0;
    for case in cases() {
        let id = case["id"].as_str().expect("a name");
        if case["query"] != "point_projection" || !id.starts_with("trimesh-73") {
            continue;
        }
        let hull = ConvexHull::from_points(&corners::<N>(&case["shape1"]["vertices"]));
        let m = Isometry3::<N>::identity();
        check_point(&case, &ShapeHandle::new(hull), &m);
        checked += 1;
    }
    assert_eq!(checked, 4, "all of the cube");
}

/// Compares, on a grid of points, whether a tetrahedron contains a point, as a hull and as a mesh,
/// with the signs of its four planes at the point.
fn tetrahedron<N: Space<3>>() {
    let all = cases();
    let case = all.iter().find(|case| case["query"] == "point_sign_grid").expect("it is there");
    let hull = ConvexHull::from_points(&corners::<N>(&case["shape1"]["vertices"]));
    let mesh = tri_mesh::<N>(&case["shape1"]);
    let mut inside = 0;
    for index in 0..21_u32.pow(3) {
        let at = |power: u32| f64::from(index / 21_u32.pow(power) % 21) * 0.25 - 2.0;
        let (x, y, z) = (at(0), at(1), at(2));
        let margin = x.min(y).min(z).min(1.0 - x - y - z);
        if margin == 0.0 {
            continue;
        }
        let asked = Point::from(Vector::<f64, 3>::new(x, y, z).map(N::lit));
        let (found, _) = hull.project_local_point(&asked);
        assert_eq!(found.is_inside, margin > 0.0, "{asked}: {found:?}");
        assert_eq!(mesh.encloses(&asked), Some(margin > 0.0), "{asked} and the mesh");
        let signed = mesh.signed_distance(&asked).expect("a closed mesh");
        assert_eq!(signed < N::ZERO, margin > 0.0, "{signed} from the mesh to {asked}");
        inside += u32::from(found.is_inside);
    }
    assert_eq!(inside, 1, "only (1/4, 1/4, 1/4) is not on the surface");
}

fn hull_box<N: Space<3>>() {
    let all = of_kind("local_aabb");
    assert_eq!(all.len(), 1, "all of them");
    for case in all {
        let hull = ConvexHull::from_points(&corners::<N>(&case["shape1"]["points"]));
        let (aabb, expected) = (hull.local_aabb(), &case["expected"]);
        let corners = (*aabb.mins(), *aabb.maxs());
        assert_eq!(corners, (point(&expected["mins"]), point(&expected["maxs"])), "{case}");
    }
}

#[test]
fn hulls_of_the_corpus() {
    convex_meshes::<f64>();
    convex_meshes::<f32>();
    tetrahedron::<f64>();
    tetrahedron::<f32>();
    hull_box::<f64>();
    hull_box::<f32>();
}
