//! Tests the content and the size of frames.

use impinge::bounding_volume::Ray;
use impinge::math::Vector;
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Ball, Cuboid, Ellipsoid, HalfSpace};
use impinge_page::Viewed;
use impinge_record::{Query, Question, RayQuestion, Registry};
use serde_json::{Value, json};

use crate::support::{Asker, Scene, all, floats, three, words};

const OBJECTS_ONLY: &str = r#"{"do": "frame", "layers": ["object"]}"#;

fn frame(asker: &mut Asker, layers: &Value, selected: &[u32]) -> (Value, Vec<u8>) {
    let asked = json!({"do": "frame", "layers": layers, "selected": selected});
    asker.ask_with(&asked.to_string(), &[])
}

/// Records two overlapping boxes with one shape handle, of which the second is rotated by a quarter
/// turn, and a sensor beside them. The first box is at x = `at`.
fn scene<N: Viewed<D>, const D: usize>(at: f64) -> Asker {
    let mut scene = Scene::<N, D>::new(Registry::new());
    let cube = scene.add([at, 0.0, 0.0], Cuboid::new(all::<N, D>(1.0)));
    let twin = scene.0.collision_object(cube).expect("it is there").shape().clone();
    let half = core::f64::consts::FRAC_1_SQRT_2;
    let turned = N::placed(&vector([at + 1.5, 0.0, 0.0]), [0.0, 0.0, half, half]);
    let contacts = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    scene
        .0
        .add(turned, twin, Default::default(), contacts, Vec::new())
        .expect("the world takes it");
    let sensor = scene.add([at, 8.0, 0.0], Ball::new(N::ONE));
    scene.0.set_query_type(sensor, GeometricQueryType::Proximity(N::ZERO)).expect("it is there");
    Asker::of(&scene.finish())
}

fn vector<N: Viewed<D>, const D: usize>(at: [f64; 3]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(at[axis]))
}

fn instances<N: Viewed<D>, const D: usize>() {
    let mut asker = scene::<N, D>(0.0);
    let (text, payload) = asker.ask_with(OBJECTS_ONLY, &[]);
    let shown = &text["instances"];
    assert_eq!(shown["count"], 3, "every object");
    assert_eq!(words(&shown["mesh"], &payload), [0, 0, 1], "two share a shape");
    assert_eq!(words(&shown["object"], &payload), [0, 1, 2], "in order");
    assert_eq!(words(&shown["flags"], &payload), [1, 1, 2], "two touch, one is a sensor");
    let pose = floats(&shown["pose"], &payload);
    assert_eq!(pose[..7], [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0], "not turned");
    let half = core::f32::consts::FRAC_1_SQRT_2;
    for (found, expected) in pose[7..14].iter().zip([1.5, 0.0, 0.0, 0.0, 0.0, half, half]) {
        assert!((found - expected).abs() < 1e-6, "{found} for {expected}");
    }
    let alpha = |color: u32| color >> 24;
    let colors = words(&shown["color"], &payload);
    assert!(alpha(colors[0]) == 255 && alpha(colors[2]) < 255, "sensors are transparent");
    let corners = floats(&text["meshes"][0]["vertices"], &payload);
    assert_eq!(corners.len(), 3 << D, "the corners of a box");
    for corner in corners.chunks(3) {
        let extents = [1.0, 1.0, if corner[2] == 0.0 { 0.0 } else { 1.0 }];
        assert_eq!([corner[0].abs(), corner[1].abs(), corner[2].abs()], extents, "a corner");
    }
    let edges = words(&text["meshes"][0]["lines"], &payload);
    assert_eq!(edges.len(), 2 * (D << (D - 1)), "two ends for each edge");

    let known = asker.ask(r#"{"do": "frame", "layers": ["object"], "known": 1}"#);
    let ids: Vec<_> =
        known["meshes"].as_array().expect("a list").iter().map(|mesh| &mesh["id"]).collect();
    assert_eq!(ids, [1], "the page has the first");
    assert_eq!(asker.ask(r#"{"do": "frame"}"#)["instances"]["count"], 0, "of no layer");
}

#[test]
fn objects_are_instances_of_meshes() {
    instances::<f32, 2>();
    instances::<f64, 2>();
    instances::<f32, 3>();
    instances::<f64, 3>();
}

fn layers<N: Viewed<D>, const D: usize>() {
    let mut asker = scene::<N, D>(0.0);
    let names = ["object", "tight box", "loosened box", "tree", "contact", "normal"];
    let edges = D << (D - 1);
    let (text, payload) = frame(&mut asker, &json!(["tight box"]), &[]);
    assert_eq!(text["lines"]["count"], 3 * edges, "the boxes of all");
    assert_eq!(words(&text["lines"]["layer"], &payload), vec![1; 3 * edges], "of that layer");
    for (number, name) in names.iter().enumerate() {
        assert_eq!(text["layers"][number], *name, "layer {number}");
    }
    let (text, payload) = frame(&mut asker, &json!(["contact"]), &[]);
    let contacts =
        asker.ask(r#"{"do": "advance", "steps": 0}"#)["contacts"].as_u64().expect("a number");
    assert_eq!(text["points"]["count"], 2 * contacts, "on both shapes");
    let x = floats(&text["points"]["at"], &payload).into_iter().step_by(3);
    x.for_each(|x| assert!((0.499..=1.001).contains(&x), "between the faces: {x}"));

    let (text, payload) = frame(&mut asker, &json!(["object"]), &[2]);
    assert_eq!(text["lines"]["count"], 2 * edges, "both boxes of the one that is selected");
    assert_eq!(
        words(&text["instances"]["flags"], &payload),
        [1, 1, 6],
        "a sensor that is selected"
    );
    let (text, _) = frame(&mut asker, &json!(["tight box"]), &[2]);
    assert_eq!(text["lines"]["count"], 3 * edges + edges, "none of them twice");
}

#[test]
fn layers_have_what_they_name() {
    layers::<f32, 2>();
    layers::<f64, 2>();
    layers::<f32, 3>();
    layers::<f64, 3>();
}

#[test]
fn what_is_far_away_is_drawn_as_what_is_near() {
    let [near, far] = [0.0, 1e9].map(|at| {
        let mut asker = scene::<f64, 3>(at);
        let (text, payload) = asker.ask_with(OBJECTS_ONLY, &[]);
        let pose = floats(&text["instances"]["pose"], &payload);
        (three(&text["origin"]), pose)
    });
    assert_eq!(near.0, [0.0; 3], "the origin of the world");
    assert!((far.0[0] - 1e9).abs() < 10.0, "{:?}", far.0);
    let gap = |pose: &[f32]| [pose[7] - pose[0], pose[15] - pose[1]];
    assert_eq!(gap(&far.1), gap(&near.1), "the same distances to the bit");
}

#[test]
fn endless_objects_are_a_patch_beyond_the_others() {
    let mut scene = Scene::<f32, 3>::new(Registry::new());
    scene.add([0.0; 3], HalfSpace::new(Vector::y_axis()));
    for x in [-20.0, 20.0] {
        scene.add([x, 1.0, 0.0], Ball::new(1.0));
    }
    let mut asker = Asker::of(&scene.finish());
    assert_eq!(asker.ask(r#"{"do": "object", "object": 0}"#)["tight_box"], Value::Null, "no end");
    let (text, payload) = asker.ask_with(OBJECTS_ONLY, &[]);
    let corners = floats(&text["meshes"][0]["vertices"], &payload);
    let reach = corners.iter().fold(0.0_f32, |far, x| far.max(x.abs()));
    assert!((21.0..100.0).contains(&reach), "{reach}");
}

fn recorded_queries<N: Viewed<D>, const D: usize>() {
    let mut scene = Scene::<N, D>::new(Registry::new());
    scene.add([0.0; 3], Ball::new(N::ONE));
    scene.0.update();
    let ray = Ray::new(vector::<N, D>([-4.0, 0.0, 0.0]).into(), vector([1.0, 0.0, 0.0]));
    let ray = RayQuestion { ray, max_time: N::lit(8.0), solid: true };
    scene.0.ask(&Query::new(Question::RayHits(ray))).expect("it can be written");
    let mut asker = Asker::of(&scene.finish());
    let both = json!(["query", "query hit"]);
    assert_eq!(
        frame(&mut asker, &both, &[]).0["lines"]["count"],
        0,
        "asked after the first update"
    );
    asker.ask(r#"{"do": "seek", "step": 2}"#);
    let (text, payload) = frame(&mut asker, &both, &[]);
    let ends = floats(&text["lines"]["ends"], &payload);
    assert_eq!(ends[..6], [-4.0, 0.0, 0.0, 4.0, 0.0, 0.0], "the ray");
    assert_eq!(floats(&text["points"]["at"], &payload), [-1.0, 0.0, 0.0], "its hit");
    assert_eq!(frame(&mut asker, &json!([]), &[]).0["lines"]["count"], 0, "the layer is off");
}

#[test]
fn recorded_queries_are_drawn_where_they_were_asked() {
    recorded_queries::<f32, 2>();
    recorded_queries::<f64, 2>();
    recorded_queries::<f32, 3>();
    recorded_queries::<f64, 3>();
}

/// Tests that balls, boxes and ellipsoids of different sizes are instances of two meshes, with
/// their radii, half extents and half axes as scale factors.
fn sizes<N: Viewed<D>, const D: usize>() {
    let mut scene = Scene::<N, D>::new(Registry::new());
    let lengths = Vector::<N, D>::from_fn(|axis, _| N::lit([0.5, 2.0, 3.0][axis]));
    scene.add([0.0; 3], Ball::new(N::lit(0.25)));
    scene.add([4.0, 0.0, 0.0], Cuboid::new(lengths));
    scene.add([8.0, 0.0, 0.0], Cuboid::new(all::<N, D>(4.0)));
    scene.add([16.0, 0.0, 0.0], Ellipsoid::new(lengths));
    let mut asker = Asker::of(&scene.finish());
    let (text, payload) = asker.ask_with(OBJECTS_ONLY, &[]);
    let shown = &text["instances"];
    assert_eq!(words(&shown["mesh"], &payload), [0, 1, 1, 0], "a unit ball and a unit box");
    let third = |size: f32| if D == 3 { size } else { 1.0 };
    let expected = [
        [0.25, 0.25, third(0.25)],
        [0.5, 2.0, third(3.0)],
        [4.0, 4.0, third(4.0)],
        [0.5, 2.0, third(3.0)],
    ];
    assert_eq!(floats(&shown["scale"], &payload), expected.as_flattened(), "radii and half axes");
    let corners = floats(&text["meshes"][1]["vertices"], &payload);
    assert!(corners.iter().all(|x| *x == 0.0 || x.abs() == 1.0), "of size 1: {corners:?}");
}

#[test]
fn sizes_are_scales_of_unit_meshes() {
    sizes::<f32, 2>();
    sizes::<f64, 2>();
    sizes::<f32, 3>();
    sizes::<f64, 3>();
}

#[test]
fn ten_thousand_boxes_of_any_size_are_a_frame_of_57_bytes_each() {
    let mut scene = Scene::<f32, 3>::new(Registry::new());
    for index in 0..10_000_u32 {
        let [x, y] = [f64::from(index % 100), f64::from(index / 100)];
        scene.add([x, y, 0.0], Cuboid::new(all::<f32, 3>(0.1 + 0.00001 * f64::from(index))));
    }
    let mut asker = Asker::of(&scene.finish());
    let (text, payload) = asker.ask_with(OBJECTS_ONLY, &[]);
    assert_eq!(text["instances"]["count"], 10_000, "each is drawn");
    assert_eq!(text["meshes"].as_array().map(Vec::len), Some(1), "of one mesh");
    assert!(payload.len() < 570_000, "{} bytes", payload.len());
}
