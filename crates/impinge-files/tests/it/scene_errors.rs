//! Tests invalid scenes: the line, the column, the path and the value of each error.

use impinge::dim3::shape::{MeshError, TriMesh};
use impinge_files::{Problem, Scene};
use impinge_record::LibraryError;

/// Returns the error of reading a scene, or of creating its world.
fn error(text: &str) -> impinge_files::FileError {
    match Scene::from_json("bad.json", text) {
        Err(error) => error,
        Ok(scene) => match scene.dimension().number() {
            2 => scene.collision_world::<f32, 2>().map(|_| ()).expect_err(text),
            _ => scene.collision_world::<f32, 3>().map(|_| ()).expect_err(text),
        },
    }
}

/// Returns the error of an object with these members, which start at column 2 of the third line.
fn object_error(dimension: usize, members: &str) -> impinge_files::FileError {
    error(&format!(
        "{{\"dimension\": {dimension}, \"objects\": [\n{{\"name\": \"a\",\n {members}}}]}}"
    ))
}

/// For each invalid object: the dimension, its members, the path of the invalid value, and the
/// value.
const REFUSED: &[(usize, &str, &str, &str)] = &[
    (2, r#""shape": {"ball": {"radius": -2}}"#, "shape.ball.radius", "-2"),
    (
        3,
        r#""shape": {"cuboid": {"half_extents": [1, -1, 1]}}"#,
        "shape.cuboid.half_extents",
        "[1, -1, 1]",
    ),
    (3, r#""shape": {"cuboid": {"half_extents": [1, 1]}}"#, "shape.cuboid.half_extents", "[1, 1]"),
    (3, r#""shape": {"cone": {"half_height": 1, "radius": -1}}"#, "shape.cone.radius", "-1"),
    (
        2,
        r#""shape": {"cone": {"half_height": 1, "radius": 1}}"#,
        "shape.cone",
        r#"{"half_height": 1, "radius": 1}"#,
    ),
    (
        3,
        r#""shape": {"half_space": {"normal": [0, 0, 0]}}"#,
        "shape.half_space.normal",
        "[0, 0, 0]",
    ),
    (2, r#""shape": "disk""#, "shape", "\"disk\""),
    (2, r#""shape": {"capsule": {"radius": 1}}"#, "shape.capsule", r#"{"radius": 1}"#),
    (2, r#""shape": {"ball": {"radius": 1e300}}"#, "shape.ball.radius", "1e300"),
    (
        2,
        r#""shape": {"compound": {"children": [{"shape": {"ball": {"radius": -3}}}]}}"#,
        "shape.compound.children[0].shape.ball.radius",
        "-3",
    ),
    (
        2,
        r#""shape": {"ball": {"radius": 1}}, "groups": {"blacklist": [30]}"#,
        "groups.blacklist",
        "[30]",
    ),
    (
        2,
        r#""shape": {"ball": {"radius": 1}}, "query": {"proximity": -1}"#,
        "query",
        r#"{"proximity": -1}"#,
    ),
    (
        2,
        r#""shape": {"ball": {"radius": 1}}, "motion": {"velocity": [1]}"#,
        "motion.velocity",
        "[1]",
    ),
    (
        2,
        r#""shape": {"ball": {"radius": 1}}, "motion": {"angular_velocity": [1, 0, 0]}"#,
        "motion.angular_velocity",
        "[1, 0, 0]",
    ),
    (
        3,
        r#""shape": {"ball": {"radius": 1}}, "position": {"rotation": {"degrees": 5}}"#,
        "position.rotation",
        r#"{"degrees": 5}"#,
    ),
    (
        3,
        r#""shape": {"ball": {"radius": 1}}, "position": {"rotation": {"quaternion": [0, 0, 0, 0]}}"#,
        "position.rotation.quaternion",
        "[0, 0, 0, 0]",
    ),
    (
        2,
        r#""shape": {"ball": {"radius": 1}}, "repeat": {"count": [2000, 2000], "spacing": [1, 1]}"#,
        "repeat.count",
        "[2000, 2000]",
    ),
    (
        2,
        r#""shape": {"ball": {"radius": 1}}, "repeat": {"count": [3, 0], "spacing": [1, 1]}"#,
        "repeat.count",
        "[3, 0]",
    ),
    (
        2,
        r#""shape": {"height_field": {"heights": [0, 1], "scale": [1, 1], "holes": [7]}}"#,
        "shape.height_field.holes[0]",
        "7",
    ),
    (
        2,
        r#""shape": {"height_field": {"heights": [0, 1], "scale": [1, 1], "ghosts": [0, 9]}}"#,
        "shape.height_field.ghosts[1]",
        "9",
    ),
];

#[test]
fn refused_values_have_their_place() {
    for &(dimension, members, path, value) in REFUSED {
        let error = object_error(dimension, members);
        // The members begin in the second column.
        let column = members.rfind(value).expect("it is in the text") + 2;
        assert_eq!(error.path, format!("objects[0].{path}"), "{error}");
        assert_eq!((error.line, error.column), (Some(3), Some(column)), "{error}");
        assert_eq!(error.value.as_deref(), Some(value), "{error}");
    }
}

#[test]
fn members_of_another_type_or_name_have_their_place() {
    let cases = [
        (r#""shape": {"ball": {"radius": "big"}}"#, "shape.ball.radius"),
        (r#""shape": {"ball": {"radius": 1, "color": 2}}"#, "shape.ball.color"),
        (r#""shape": {"ball": {"radius": 1}}, "mass": 1"#, "mass"),
        (
            r#""shape": {"ball": {"radius": 1}}, "position": {"rotation": {"degrees": [1]}}"#,
            "position.rotation.degrees",
        ),
        (
            r#""shape": {"ball": {"radius": 1}}, "motion": {"angular_velocity": [1]}"#,
            "motion.angular_velocity",
        ),
        (r#""shape": {"blob": {}}"#, "shape"),
    ];
    for (members, path) in cases {
        let error = object_error(2, members);
        assert!(matches!(*error.problem, Problem::Syntax(_)), "{error:?}");
        assert!(error.path.starts_with(&format!("objects[0].{path}")), "{error}");
        assert_eq!(error.line, Some(3), "{error}");
    }
}

#[test]
fn shapes_by_name_are_refused_where_they_stand() {
    let text = "{\"dimension\": 2,\n\"shapes\": {\"big\": {\"ball\": {\"radius\": -1}}},\n\
                \"objects\": [{\"name\": \"a\", \"shape\": \"big\"}]}";
    let error1 = error(text);
    assert_eq!(
        (error1.line, error1.path.as_str()),
        (Some(2), "shapes.big.ball.radius"),
        "{error1}"
    );
    let cycle = r#"{"dimension": 2, "shapes": {
        "a": {"rounded": {"shape": "b", "radius": 1}},
        "b": {"compound": {"children": [{"shape": "a"}]}}}}"#;
    let error2 = error(cycle);
    let names = ["a", "b", "a"].map(str::to_owned).to_vec();
    assert_eq!(*error2.problem, Problem::ShapeCycle(names), "{error2}");
    assert_eq!(error2.line, Some(3), "{error2}: in b");
}

#[test]
fn shapes_that_double_at_each_level_cost_no_memory() {
    let mut shapes = String::from(r#""s0": {"ball": {"radius": 1}}"#);
    for level in 1..=14 {
        let child = format!(r#"{{"shape": "s{}"}}"#, level - 1);
        let children = vec![child; 8].join(",");
        shapes += &format!(",\n\"s{level}\": {{\"compound\": {{\"children\": [{children}]}}}}");
    }
    let error = error(&format!("{{\"dimension\": 2, \"shapes\": {{{shapes}}}}}"));
    assert!(matches!(*error.problem, Problem::TooMany { what: "parts", .. }), "{error}");
}

#[test]
fn names_occur_once() {
    let ball = r#""shape": {"ball": {"radius": 1}}"#;
    let text = format!(
        "{{\"dimension\": 2, \"objects\": [\n{{\"name\": \"a\", {ball}}},\n{{\"name\": \"a\", {ball}}}]}}"
    );
    let error1 = error(&text);
    assert_eq!(*error1.problem, Problem::DuplicateName("a".to_owned()), "{error1}");
    assert_eq!((error1.line, error1.path.as_str()), (Some(3), "objects[1].name"), "{error1}");
    let twice = error(
        "{\"dimension\": 2, \"shapes\": {\n\"a\": {\"ball\": {\"radius\": 1}},\n\"a\": {\"ball\": {\"radius\": 1}}}}",
    );
    assert!(twice.to_string().contains("\"a\" occurs twice"), "{twice}");
    assert_eq!(twice.line, Some(3), "{twice}");
}

#[test]
fn worlds_have_the_dimension_of_the_scene() {
    let scene = Scene::from_json("plane.json", r#"{"dimension": 2}"#).expect("a scene");
    let error = scene.collision_world::<f64, 3>().map(|_| ()).expect_err("of 2D");
    assert_eq!(
        error.to_string(),
        "plane.json: the scene is of 2D, a world of 3D was asked for",
        "both are named"
    );
}

#[test]
fn files_that_are_missing_are_named() {
    let text = r#"{"dimension": 3, "meshes": [{"path": "no/such.obj"}]}"#;
    let error = Scene::from_json("here/scene.json", text).expect_err("no mesh");
    assert!(error.file.ends_with("no/such.obj") && error.file.starts_with("here"), "{error}");
    assert!(
        matches!(*error.problem, Problem::Io { kind: std::io::ErrorKind::NotFound, .. }),
        "{error:?}"
    );
}

#[test]
fn a_surface_with_a_hole_is_not_solid() {
    let folder = tempfile::tempdir().expect("a folder");
    let open = crate::cube::obj().replacen("f 1/1/1 4/1/1", "# f 1/1/1 4/1/1", 1);
    std::fs::write(folder.path().join("open.obj"), open).expect("it is written");
    let text = r#"{"dimension": 3, "objects": [
        {"name": "a", "shape": {"mesh_file": {"path": "open.obj", "as": "solid"}}}]}"#;
    let scene = Scene::from_json(folder.path().join("scene.json"), text).expect("a scene");
    let error = scene.collision_world::<f64, 3>().map(|_| ()).expect_err("it is open");
    assert_eq!(error.path, "objects[0].shape.mesh_file.as", "{error}");
    assert!(matches!(*error.problem, Problem::NotSolid { boundary_edges: 4, .. }), "{error}");
}

#[test]
fn a_part_whose_faces_were_dropped_opens_no_solid() {
    let folder = tempfile::tempdir().expect("a folder");
    // The second part has one face, without area: vertices 1 and 1 coincide.
    let text = format!("{}g sliver\nf 1 1 2\n", crate::cube::obj());
    std::fs::write(folder.path().join("cube.obj"), text).expect("it is written");
    let shape = |part: &str| {
        let text = format!(
            r#"{{"dimension": 3, "shapes": {{"a": {{"mesh_file": {{"path": "cube.obj", "as": "solid"{part}}}}}}}}}"#
        );
        let scene = Scene::from_json(folder.path().join("scene.json"), &text).expect("a scene");
        scene.shape::<f64, 3>("a")
    };
    let solid = shape("").expect("the cube is closed");
    assert!(solid.as_shape::<TriMesh<f64>>().expect("a mesh").is_solid());
    let error = shape(r#", "part": "sliver""#).map(|_| ()).expect_err("it has no triangle");
    assert!(
        matches!(*error.problem, Problem::Library(LibraryError::Mesh(MeshError::Empty))),
        "{error:?}"
    );
}
