//! Tests of `check` and `distance` on scenes with distances in closed form.

use serde_json::{Value, json};

use crate::support::{Desk, is_close, numbers};

/// Returns a scene of two equal boxes or balls of half width 1. The second is at `x` on the first
/// axis.
fn scene(dimension: usize, scalar: &str, shape: &str, x: f64) -> String {
    let extents = vec![1.0; dimension];
    let shape = match shape {
        "ball" => json!({"ball": {"radius": 1.0}}),
        _ => json!({"cuboid": {"half_extents": extents}}),
    };
    let mut at = vec![0.0; dimension];
    at[0] = x;
    let first = json!({"name": "a", "shape": shape});
    let second = json!({"name": "b", "shape": shape, "position": {"translation": at}});
    let objects = json!([first, second]);
    json!({"dimension": dimension, "scalar": scalar, "objects": objects}).to_string()
}

fn in_every_space(mut check: impl FnMut(&Desk, usize, &str)) {
    let desk = Desk::new();
    for (dimension, scalar) in [(2, "f32"), (2, "f64"), (3, "f32"), (3, "f64")] {
        check(&desk, dimension, scalar);
    }
}

#[test]
fn balls_half_a_unit_apart() {
    in_every_space(|desk, dimension, scalar| {
        desk.write("scene.json", scene(dimension, scalar, "ball", 2.5));
        let report = desk.json("check scene.json", 0);
        assert_eq!(report["pairs"], json!([]), "they do not touch");
        assert_eq!(report["dimension"], dimension);
        assert_eq!(report["scalar"], scalar);
        assert_eq!(report["objects"], 2);

        let report = desk.json("check scene.json --clearance 0.5", 1);
        let pair = &report["pairs"][0];
        assert_eq!((&report["touching"], &report["near"]), (&json!(0), &json!(1)));
        assert_eq!(pair["state"], "near");
        assert_eq!((&pair["distance"], &pair["depth"]), (&json!(0.5), &json!(0.0)));
        assert_eq!(numbers(&pair["point1"])[0], 1.0, "on the first");
        assert_eq!(numbers(&pair["point2"])[0], 1.5, "on the second");
        assert_eq!(numbers(&pair["normal"])[0], 1.0, "from the first to the second");

        let below = desk.json("check scene.json --clearance 0.4375", 0);
        assert_eq!(below["near"], 0, "a clearance below the distance");
        let measured = desk.json("distance scene.json a b", 0);
        assert_eq!((&measured["state"], &measured["distance"]), (&json!("apart"), &json!(0.5)));
        assert_eq!(
            (&measured["dimension"], &measured["scalar"]),
            (&json!(dimension), &json!(scalar))
        );
        let swapped = desk.json("distance scene.json b a --margin 0.5", 0);
        assert_eq!(swapped["state"], "near");
        assert_eq!(numbers(&swapped["normal"])[0], -1.0, "from the first named");
    });
}

#[test]
fn boxes_that_overlap_by_an_eighth() {
    in_every_space(|desk, dimension, scalar| {
        desk.write("scene.json", scene(dimension, scalar, "box", 1.875));
        let report = desk.json("check scene.json", 1);
        let pair = &report["pairs"][0];
        assert_eq!((&report["touching"], &report["near"]), (&json!(1), &json!(0)));
        assert_eq!((&pair["first"], &pair["second"]), (&json!("a"), &json!("b")));
        assert_eq!((&pair["state"], &pair["distance"]), (&json!("touch"), &json!(0.0)));
        assert_eq!(pair["depth"], 0.125);
        assert_eq!(numbers(&pair["normal"])[0], 1.0);
        let measured = desk.json("distance scene.json a b", 1);
        assert_eq!(measured["depth"], 0.125);
    });
}

#[test]
fn boxes_that_just_touch() {
    in_every_space(|desk, dimension, scalar| {
        desk.write("scene.json", scene(dimension, scalar, "box", 2.0));
        let pair = &desk.json("check scene.json", 1)["pairs"][0];
        assert_eq!((&pair["state"], &pair["depth"]), (&json!("touch"), &json!(0.0)));
    });
}

#[test]
fn numbers_are_those_of_the_scalar() {
    let desk = Desk::new();
    desk.write("scene.json", scene(2, "f64", "ball", 2.1));
    let of = |arguments: &str| desk.json(arguments, 0)["distance"].as_f64().expect("a number");
    let double = of("distance scene.json a b");
    let single = of("distance scene.json a b --scalar f32");
    assert!((double - 0.1).abs() < 1e-15, "{double}");
    assert!((single - 0.1).abs() < 1e-6 && single != double, "{single}");
}

fn names(report: &Value) -> Vec<(String, String)> {
    let pairs = report["pairs"].as_array().expect("a list").iter();
    let name = |pair: &Value, which: &str| pair[which].as_str().expect("a name").to_owned();
    pairs.map(|pair| (name(pair, "first"), name(pair, "second"))).collect()
}

#[test]
fn groups_are_respected_and_the_deepest_is_first() {
    let desk = Desk::new();
    let report = desk.json("check boxes.json --clearance 0.5", 1);
    let expected = [("floor", "box"), ("box", "lamp")];
    let expected = expected.map(|(first, second)| (first.to_owned(), second.to_owned()));
    assert_eq!(names(&report), expected, "nobody meets the ghost");
    let pairs = &report["pairs"];
    assert!(is_close(&pairs[0]["depth"], 0.1), "{report}");
    assert!(is_close(&pairs[1]["distance"], 0.25), "{report}");
    // `distance` ignores groups.
    let measured = desk.json("distance boxes.json box ghost", 1);
    assert!(is_close(&measured["depth"], 0.75), "{measured}");
}

#[test]
fn a_limit_leaves_pairs_out_and_counts_them() {
    let desk = Desk::new();
    let limited = desk.json("check boxes.json --clearance 0.5 --limit 1", 1);
    assert_eq!((names(&limited).len(), &limited["omitted"]), (1, &json!(1)));
    assert_eq!(limited["near"], 1, "it is counted");
    let all = desk.json("check boxes.json --clearance 0.5 --all", 1);
    assert_eq!((names(&all).len(), &all["omitted"]), (2, &json!(0)));
}

/// Returns a scene of one object that is tested against itself.
fn alone(dimension: usize, scalar: &str, shape: &Value) -> String {
    let object = json!({"name": "a", "shape": shape, "groups": {"self_collision": true}});
    json!({"dimension": dimension, "scalar": scalar, "objects": [object]}).to_string()
}

#[test]
fn a_convex_solid_does_not_touch_itself() {
    in_every_space(|desk, dimension, scalar| {
        desk.write("scene.json", alone(dimension, scalar, &json!({"ball": {"radius": 0.5}})));
        let report = desk.json("check scene.json --clearance 1", 0);
        assert_eq!((&report["touching"], &report["near"]), (&json!(0), &json!(0)));
    });
}

#[test]
fn parts_of_one_object_are_apart_or_overlap() {
    in_every_space(|desk, dimension, scalar| {
        let balls = |x: f64| {
            let at = |x: f64| [vec![x], vec![0.0; dimension - 1]].concat();
            let ball =
                |x| json!({"shape": {"ball": {"radius": 1.0}}, "position": {"translation": at(x)}});
            let shape = json!({"compound": {"children": [ball(0.0), ball(x)]}});
            alone(dimension, scalar, &shape)
        };
        desk.write("scene.json", balls(1.75));
        let report = desk.json("check scene.json", 1);
        let pair = &report["pairs"][0];
        assert_eq!(names(&report), [("a".to_owned(), "a".to_owned())]);
        assert_eq!((&pair["state"], &pair["depth"]), (&json!("touch"), &json!(0.25)));
        assert_eq!((&pair["part1"], &pair["part2"]), (&json!(0), &json!(1)));
        assert_eq!(numbers(&pair["normal"])[0], 1.0, "from the first part to the second");

        desk.write("scene.json", balls(2.5));
        assert_eq!(desk.json("check scene.json", 0)["touching"], 0);
        assert_eq!(desk.json("check scene.json --clearance 0.4375", 0)["near"], 0);
        let pair = &desk.json("check scene.json --clearance 0.5", 1)["pairs"][0];
        assert_eq!((&pair["state"], &pair["distance"]), (&json!("near"), &json!(0.5)));
        assert_eq!((&pair["part1"], &pair["part2"]), (&json!(0), &json!(1)));
    });
}

#[test]
fn parts_that_share_a_vertex_do_not_touch() {
    let desk = Desk::new();
    let rope = |end: f64| {
        let vertices = json!([[0, 0], [4, 0], [4, 1], [1, 1], [1, end]]);
        alone(2, "f64", &json!({"polyline": {"vertices": vertices}}))
    };
    desk.write("scene.json", rope(0.5));
    assert_eq!(desk.json("check scene.json", 0)["touching"], 0);
    desk.write("scene.json", rope(0.0));
    let pair = &desk.json("check scene.json", 1)["pairs"][0];
    assert_eq!((&pair["part1"], &pair["part2"]), (&json!(0), &json!(3)), "the end and the start");
}

#[test]
fn half_spaces_that_overlap_without_bound() {
    let desk = Desk::new();
    let pair = &desk.json("check planes.json", 1)["pairs"][0];
    assert_eq!((&pair["state"], &pair["depth"]), (&json!("touch"), &Value::Null));
    let text = desk.run("check planes.json");
    assert!(text.out.contains("without bound"), "{text:?}");
}

#[test]
fn the_groups_of_a_mesh_are_objects() {
    let desk = Desk::new();
    let report = desk.json("check parts.obj --clearance 0.01", 1);
    assert_eq!(report["objects"], 3);
    let pair = &report["pairs"][0];
    assert_eq!((&pair["state"], &pair["distance"]), (&json!("near"), &json!(0.0078125)));
    assert_eq!(names(&report), [("base".to_owned(), "lid".to_owned())]);
    assert_eq!(desk.json("check parts.obj", 0)["touching"], 0);
}

#[test]
fn standard_input_is_a_scene() {
    let desk = Desk::new();
    let scene = scene(3, "f64", "box", 1.875);
    let ran = desk.run_with("check - --json", scene.as_bytes());
    assert_eq!(ran.code, 1, "{ran:?}");
    let report: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(report["pairs"][0]["depth"], 0.125);
}

#[test]
fn an_empty_scene_is_clear() {
    let desk = Desk::new();
    desk.write("scene.json", r#"{"dimension": 3}"#);
    let ran = desk.run("check scene.json");
    assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{ran:?}");
    assert!(ran.out.contains("0 objects") && ran.out.contains("nothing touches"), "{ran:?}");
}
