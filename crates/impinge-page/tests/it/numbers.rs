//! Compares distances, points, contacts, ray hits, boxes and picked objects with values computed by
//! hand.

use impinge::shape::{Ball, Cuboid};
use impinge_page::Viewed;
use impinge_record::Registry;
use serde_json::{Value, json};

use crate::support::{Asker, Scene, all, three};

/// Opens the recording of a ball of radius 1 at the origin, a ball of radius 0.5 at x = 4, a box of
/// half extents 1 at x = 10, and a box of half extents 0.5 that overlaps the larger box by 0.25.
fn scene<N: Viewed<D>, const D: usize>() -> Asker {
    let mut scene = Scene::<N, D>::new(Registry::new());
    scene.add([0.0; 3], Ball::new(N::ONE));
    scene.add([4.0, 0.0, 0.0], Ball::new(N::HALF));
    scene.add([10.0, 0.0, 0.0], Cuboid::new(all::<N, D>(1.0)));
    scene.add([11.25, 0.0, 0.0], Cuboid::new(all::<N, D>(0.5)));
    Asker::of(&scene.finish())
}

fn pairs<N: Viewed<D>, const D: usize>() {
    let mut asker = scene::<N, D>();
    let balls = asker.ask(r#"{"do": "pair", "a": 0, "b": 1}"#);
    assert_eq!(balls["distance"], 2.5, "4 less both radii");
    assert_eq!(balls["points"], json!([[1.0, 0.0, 0.0], [3.5, 0.0, 0.0]]), "on both");
    assert_eq!(
        (&balls["contact"], &balls["proximity"]),
        (&Value::Null, &json!("disjoint")),
        "apart"
    );
    let mixed = asker.ask(r#"{"do": "pair", "a": 2, "b": 1}"#);
    assert_eq!(mixed["distance"], 4.5, "from x = 4.5 to 9");
    assert_eq!(three(&mixed["points"][0])[0], 9.0, "on the first of the question");

    for (a, b, direction) in [(2, 3, 1.0), (3, 2, -1.0)] {
        let boxes = asker.ask(&format!(r#"{{"do": "pair", "a": {a}, "b": {b}}}"#));
        assert_eq!(
            (&boxes["distance"], &boxes["points"]),
            (&json!(0.0), &Value::Null),
            "they overlap"
        );
        assert_eq!(boxes["contact"]["depth"], 0.25, "{a} {b}");
        assert_eq!(boxes["contact"]["normal"], json!([direction, 0.0, 0.0]), "{a} {b}");
        assert_eq!(boxes["proximity"], "intersecting", "{a} {b}");
        let manifold = boxes["manifolds"][0]["contacts"].as_array().expect("they touch");
        assert_eq!(manifold.len(), 1 << (D - 1), "the corners of the smaller face");
        let on_first = if a == 2 { 11.0 } else { 10.75 };
        for point in manifold {
            assert_eq!(
                (&point["depth"], three(&point["a"])[0]),
                (&json!(0.25), on_first),
                "{point}"
            );
            assert!(point["features"].as_str().is_some_and(|text| text.contains(',')), "{point}");
        }
    }
}

#[test]
fn pairs_have_the_numbers_of_closed_forms() {
    pairs::<f32, 2>();
    pairs::<f64, 2>();
    pairs::<f32, 3>();
    pairs::<f64, 3>();
}

fn objects<N: Viewed<D>, const D: usize>(scalar: &str, third: f64) {
    let mut asker = scene::<N, D>();
    let object = asker.ask(r#"{"do": "object", "object": 3}"#);
    assert_eq!((&object["object"], &object["label"]), (&json!(3), &json!("thing")), "{object}");
    let halves = vec!["0.5"; D].join(" × ");
    assert_eq!(
        object["shape"],
        json!({"kind": "cuboid", "text": format!("cuboid, half extents {halves}")}),
        "the arguments of the constructor"
    );
    assert_eq!(object["translation"], json!([11.25, 0.0, 0.0]), "where it is");
    assert_eq!(object["rotation"], json!([0.0, 0.0, 0.0, 1.0]), "not turned");
    let tight = [[10.75, -0.5, -third], [11.75, 0.5, third]];
    for (corner, expected) in tight.iter().enumerate() {
        for (axis, expected) in expected.iter().enumerate() {
            let found = three(&object["tight_box"][corner])[axis];
            assert!((found - expected).abs() <= 1e-5, "{scalar}: {found} for {expected}");
        }
    }
    let loosened = three(&object["loosened_box"][0])[0];
    assert!((10.5..10.75).contains(&loosened), "{scalar}: beyond the tight box, {loosened}");
    assert_eq!(object["groups"]["membership"], "all", "of new groups");
    assert_eq!(object["groups"]["blacklist"], json!([]), "of new groups");
    assert_eq!(
        object["query"],
        json!({"kind": "contacts", "linear": 0.0, "angular": 0.0}),
        "as it was added"
    );
    let contacts = 1 << (D - 1);
    let pair = json!({"kind": "contacts", "object": 2, "contacts": contacts, "depth": 0.25, "touching": true});
    assert_eq!(object["pairs"], json!([pair]), "with the other box");
}

#[test]
fn objects_are_described() {
    objects::<f32, 2>("f32", 0.0);
    objects::<f64, 2>("f64", 0.0);
    objects::<f32, 3>("f32", 0.5);
    objects::<f64, 3>("f64", 0.5);
}

fn questions<N: Viewed<D>, const D: usize>() {
    let mut asker = scene::<N, D>();
    let ray =
        asker.ask(r#"{"do": "ray", "from": [-5, 0, 0], "direction": [2, 0, 0], "longest": 7}"#);
    let hits = ray["hits"].as_array().expect("a list");
    let found: Vec<_> =
        hits.iter().map(|hit| (hit["object"].as_u64(), hit["time"].as_f64())).collect();
    let expected = [(0, 2.0), (1, 4.25), (2, 7.0)].map(|(object, time)| (Some(object), Some(time)));
    assert_eq!(found, expected, "times are halves of lengths, up to the longest");
    assert_eq!(hits[0]["normal"], json!([-1.0, 0.0, 0.0]), "towards the ray");
    assert_eq!(hits[2]["point"], json!([9.0, 0.0, 0.0]), "the face of the box");

    let near = asker.ask(r#"{"do": "nearest", "point": [6, 0, 0], "count": 2}"#);
    assert_eq!(
        near["nearest"][0],
        json!({"object": 1, "distance": 1.5, "point": [4.5, 0.0, 0.0]}),
        "a ball"
    );
    assert_eq!(near["nearest"][1]["distance"], 3.0, "the box at 9");
    assert_eq!(near["nearest"].as_array().map(Vec::len), Some(2), "no more than asked for");
}

#[test]
fn rays_and_points_have_the_numbers_of_closed_forms() {
    questions::<f32, 2>();
    questions::<f64, 2>();
    questions::<f32, 3>();
    questions::<f64, 3>();
}

#[test]
fn picking_is_by_a_ray_in_3d_and_by_a_point_in_2d() {
    let mut space = scene::<f64, 3>();
    let picked = space.ask(r#"{"do": "pick", "from": [4, 0, 9], "direction": [0, 0, -1]}"#);
    let expected =
        json!({"object": 1, "point": [4.0, 0.0, 0.5], "normal": [0.0, 0.0, 1.0], "time": 8.5});
    assert_eq!(picked, expected);
    let missed = space.ask(r#"{"do": "pick", "from": [4, 0, 9], "direction": [0, 0, 1]}"#);
    assert_eq!(missed["object"], Value::Null);

    let mut plane = scene::<f32, 2>();
    assert_eq!(plane.ask(r#"{"do": "pick", "from": [0.5, 0.5, 0]}"#)["object"], 0, "it is inside");
    let beside = r#"{"do": "pick", "from": [4, 0.75, 0], "reach": REACH}"#;
    assert_eq!(plane.ask(&beside.replace("REACH", "0.25"))["object"], 1, "within reach");
    assert_eq!(plane.ask(&beside.replace("REACH", "0.125"))["object"], Value::Null, "beyond");
    let overlap = plane.ask(r#"{"do": "pick", "from": [10.875, 0, 0]}"#);
    assert_eq!(overlap["object"], 3, "of two, the one that is drawn later");
}
