//! Tests the example scenes, the schema, mesh files of queries, groups, motions, rotations and
//! grids.

use std::path::{Path, PathBuf};
use std::{env, fs};

use impinge::dim2::math::Point as Point2;
use impinge::dim3::math::Isometry;
use impinge_files::{Dimension, Scene, SceneFile, SceneSpace};
use impinge_record::{Registry, validate};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

fn example(name: &str) -> Scene {
    Scene::read(&folder().join(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn examples() -> Vec<PathBuf> {
    let files =
        fs::read_dir(folder()).expect("the examples").map(|file| file.expect("a file").path());
    let mut scenes: Vec<PathBuf> =
        files.filter(|path| path.extension().is_some_and(|ending| ending == "json")).collect();
    scenes.sort();
    assert_eq!(scenes.len(), 6, "{scenes:?}");
    scenes
}

#[test]
fn the_schema_is_that_of_the_types() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scene.schema.json");
    if env::var_os("IMPINGE_BLESS").is_some() {
        fs::write(&path, SceneFile::schema()).expect("it is written");
    }
    let written = fs::read_to_string(&path).expect("the schema");
    assert_eq!(written, SceneFile::schema(), "IMPINGE_BLESS=1 writes it anew");
}

/// Asserts that the loader refuses the scenes in `data/refused.json`. The tests of the page assert
/// that the schema refuses the same scenes.
#[test]
fn scenes_that_the_schema_refuses_are_refused() {
    let refused: Vec<serde_json::Value> =
        serde_json::from_str(include_str!("../data/refused.json")).expect("JSON");
    assert_eq!(refused.len(), 7, "all are asked");
    for scene in refused {
        assert!(Scene::from_json("wrong.json", &scene.to_string()).is_err(), "{scene}");
    }
}

fn runs<N: SceneSpace<D>, const D: usize>(scene: &Scene, path: &Path) {
    let mut world = scene.world::<N, D>().unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(world.len(), scene.names().len(), "{}: all objects", path.display());
    for name in scene.names() {
        let handle = world.handle(name).expect("it has a handle");
        assert_eq!(world.name(handle), Some(name), "there and back");
    }
    for _ in 0..20 {
        world.step(0.1).expect("near the origin");
    }
    assert!((world.seconds() - 2.0).abs() < 1e-12, "{}", world.seconds());
    for query in scene.queries::<N, D>().expect("usable queries") {
        assert!(!query.query.ask(&world).is_empty(), "{}: {}", path.display(), query.name);
    }
    let recording = world.finish();
    let registry = Registry::<N, D, String>::new();
    assert_eq!(validate(&recording.bytes, &registry), Ok(None), "{}", path.display());
}

#[test]
fn every_example_runs_in_both_scalars_and_its_recording_is_valid() {
    for path in examples() {
        let scene = Scene::read(&path).unwrap_or_else(|error| panic!("{error}"));
        match scene.dimension() {
            Dimension::Two => {
                runs::<f64, 2>(&scene, &path);
                runs::<f32, 2>(&scene, &path);
            }
            Dimension::Three => {
                runs::<f64, 3>(&scene, &path);
                runs::<f32, 3>(&scene, &path);
            }
        }
    }
}

#[test]
fn mesh_files_of_queries_are_read() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["cube.obj", "other.obj"] {
        fs::write(folder.path().join(name), crate::cube::obj()).expect("it is written");
    }
    let text = r#"{"dimension": 3, "queries": {"push": {"cast": {
        "shape": {"rounded": {"shape": {"mesh_file": {"path": "cube.obj", "as": "convex_hull"}}, "radius": 0.5}},
        "velocity": [1, 0, 0]}}}}"#;
    let scene = Scene::from_json(folder.path().join("scene.json"), text).expect("a scene");
    assert_eq!(scene.queries::<f64, 3>().expect("the cube is read").len(), 1, "the cast");
    let shape = scene.shape::<f64, 3>(r#"{"mesh_file": {"path": "other.obj"}}"#);
    assert!(shape.is_ok(), "a file that the scene does not name: {shape:?}");
    let missing = scene.shape::<f64, 3>(r#"{"mesh_file": {"path": "none.obj"}}"#);
    let error = missing.map(|_| ()).expect_err("no such file");
    assert!(error.file.ends_with("none.obj"), "{error}");
}

#[test]
fn groups_decide_who_touches() {
    let scene = example("filters.json");
    let mut world = scene.world::<f64, 2>().expect("a scene of 2D");
    world.step(0.0).expect("nothing moves");
    let pairs = world.contact_manifolds().map(|(a, b, _)| [a.data().as_str(), b.data().as_str()]);
    let mut pairs: Vec<[&str; 2]> = pairs.collect();
    pairs.sort_unstable();
    let expected = [
        ["other red", "blue"],
        ["other red", "other blue"],
        ["red", "blue"],
        ["red", "other blue"],
    ];
    assert_eq!(pairs, expected, "reds touch blues alone, the ghost nobody");
}

#[test]
fn a_car_drives_into_the_zone_and_out_of_it() {
    let scene = example("sensors.json");
    assert!(scene.has_motion(), "the car");
    let mut world = scene.world::<f64, 2>().expect("a scene of 2D");
    let mut changes = Vec::new();
    world.step(0.0).expect("it stands");
    for _ in 0..64 {
        world.step(0.125).expect("it drives");
        let events = world.proximity_events().iter();
        changes.extend(events.map(|event| (world.seconds(), event.new_status)));
    }
    // The front of the car is at -3.25 + t. The car is within the margin from 1.75 on, in the zone
    // from 2.25 to 5.75, and beyond the margin after 6.25.
    use impinge::query::Proximity::{Disjoint, Intersecting, WithinMargin};
    let expected =
        [(1.75, WithinMargin), (2.25, Intersecting), (5.875, WithinMargin), (6.375, Disjoint)];
    assert_eq!(changes, expected, "touching counts");
}

#[test]
fn rotations_are_those_of_their_notation() {
    let at = |rotation: &str| {
        let text = format!(
            r#"{{"dimension": 3, "objects": [{{"name": "a", "shape": {{"ball": {{"radius": 1}}}},
                "position": {{"translation": [1, 2, 3], "rotation": {rotation}}}}}]}}"#
        );
        let scene = Scene::from_json("turned.json", &text).expect("a scene");
        let world = scene.collision_world::<f64, 3>().expect("a world");
        *world.collision_objects().next().expect("one").position()
    };
    let x = |angle: f64| Isometry::rotation([angle.to_radians(), 0.0, 0.0].into());
    let y = |angle: f64| Isometry::rotation([0.0, angle.to_radians(), 0.0].into());
    let z = |angle: f64| Isometry::rotation([0.0, 0.0, angle.to_radians()].into());
    let to = Isometry::translation(1.0, 2.0, 3.0);
    let cases = [
        (r#"{"euler": {"order": "xyz", "degrees": [10, 20, 30]}}"#, z(30.0) * y(20.0) * x(10.0)),
        (r#"{"euler": {"order": "XYZ", "degrees": [10, 20, 30]}}"#, x(10.0) * y(20.0) * z(30.0)),
        (r#"{"euler": {"order": "zxy", "degrees": [10, 20, 30]}}"#, y(30.0) * x(20.0) * z(10.0)),
        (r#"{"euler": {"order": "YZX", "degrees": [10, 20, 30]}}"#, y(10.0) * z(20.0) * x(30.0)),
        (r#"{"axis_angle": {"axis": [0, 0, -2], "degrees": 90}}"#, z(-90.0)),
        (r#"{"quaternion": [0, 3, 0, 3]}"#, y(90.0)),
        (r#"{"axis_angle": {"axis": [1, 0, 0], "degrees": -200}}"#, x(-200.0)),
    ];
    for (rotation, expected) in cases {
        let (found, expected) = (at(rotation), to * expected);
        let apart = (found.to_homogeneous() - expected.to_homogeneous()).norm();
        assert!(apart < 1e-14, "{rotation}: {found} is not {expected}");
    }
}

#[test]
fn quarter_turns_in_the_plane_are_exact() {
    for (degrees, image) in [(90, [0.0, 1.0]), (-90, [0.0, -1.0]), (540, [-1.0, 0.0])] {
        let text = format!(
            r#"{{"dimension": 2, "objects": [{{"name": "a", "shape": {{"ball": {{"radius": 1}}}},
                "position": {{"rotation": {{"degrees": {degrees}}}}}}}]}}"#
        );
        let scene = Scene::from_json("turned.json", &text).expect("a scene");
        let world = scene.collision_world::<f64, 2>().expect("a world");
        let at = world.collision_objects().next().expect("one").position();
        assert_eq!(at * Point2::new(1.0, 0.0), Point2::from(image), "{degrees} degrees");
    }
}

#[test]
fn a_grid_has_names_by_index_and_shares_its_shape() {
    let scene = example("pile.json");
    let names: Vec<&str> = scene.names().collect();
    assert_eq!(names.len(), 1 + 80 + 4 + 1, "floor, bricks, pebbles, ball");
    assert_eq!(
        (names[1], names[2], names[80]),
        ("brick[0,0,0]", "brick[0,0,1]", "brick[3,4,3]"),
        "z first"
    );
    let world = scene.collision_world::<f64, 3>().expect("a world");
    let bricks: Vec<_> = world.collision_objects().skip(1).take(80).collect();
    assert!(bricks.iter().all(|brick| brick.shape().is_same(bricks[0].shape())), "one handle");
    let last = bricks[79].position().translation.vector;
    assert_eq!(last.as_slice(), [1.5, 2.25, 0.75], "three, four and three steps on");
}
