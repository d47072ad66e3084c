//! Tests of `record`, `replay` and `validate`: steps are reported, replays have the same bits, and
//! changed, damaged or unfinished recordings are recognised.

use std::fs;

use impinge::dim3::bounding_volume::Aabb;
use impinge::dim3::math::Isometry;
use impinge::dim3::shape::{Ball, Geometry, ShapeHandle};
use impinge::dim3::world::{CollisionGroups, GeometricQueryType};
use impinge::shape::Shape;
use impinge_record::{Recorder, Registry, reseal};
use serde_json::{Value, json};

use crate::support::{Desk, numbers};

#[test]
fn a_recording_has_the_steps_and_objects_that_are_reported() {
    let desk = Desk::new();
    let report = desk.json("record balls.json -o balls.implog --steps 30", 0);
    let size = fs::metadata(desk.path("balls.implog")).expect("it was written").len();
    assert_eq!((&report["steps"], &report["objects"]), (&json!(30), &json!(2)), "{report}");
    assert_eq!(report["bytes"], size, "what was written");
    let touched = report["touched"].as_u64().expect("a number");
    assert!(touched == 15 || touched == 16, "at step 15 they touch up to rounding: {touched}");
}

#[test]
fn balls_that_meet_after_a_quarter_of_a_second() {
    let desk = Desk::recorded();
    let report = desk.json("replay balls.implog", 1);
    let steps = report["steps"].as_array().expect("a list");
    assert_eq!(steps.len(), 30);
    // At step 15 the distance is zero up to rounding, so whether the balls touch there is not
    // tested.
    assert!(steps[..14].iter().all(|step| step["touching"] == 0), "{report}");
    assert!(steps[15..].iter().all(|step| step["touching"] == 1), "{report}");
    let started: i64 = steps.iter().filter_map(|step| step["started"].as_i64()).sum();
    assert_eq!(started, 1, "one contact began");
    assert_eq!(desk.json("replay balls.implog --step 5", 0)["steps"][0]["touching"], 0);
}

/// Returns a scene in which a ball comes from the right, with the speed 1/4, and passes a ball at
/// the origin. Both have the radius 1/2 and the query type `query`.
fn passing(query: &Value) -> String {
    let ball = |name: &str, x: f64, speed: f64| {
        json!({
            "name": name,
            "shape": "ball",
            "position": {"translation": [x, 0, 0]},
            "motion": {"velocity": [speed, 0, 0]},
            "query": query,
        })
    };
    let objects = [ball("still", 0.0, 0.0), ball("passing", 1.6, -0.25)];
    let shapes = json!({"ball": {"ball": {"radius": 0.5}}});
    json!({"dimension": 3, "scalar": "f64", "shapes": shapes, "objects": objects}).to_string()
}

#[test]
fn a_predicted_contact_or_a_margin_starts_no_touch() {
    let desk = Desk::new();
    let predicted = json!({"contacts": {"linear": 0.25, "angular": 0.1}});
    for query in [predicted, json!({"proximity": 0.25})] {
        desk.write("passing.json", passing(&query));
        desk.json("record passing.json -o passing.implog --steps 12 --dt 1 --key-frames 4", 0);
        let steps = desk.json("replay passing.implog", 0)["steps"].clone();
        let steps = steps.as_array().expect("a list");
        let column = |name: &str| -> Vec<_> {
            steps.iter().map(|step| step[name].as_u64().expect("a number")).collect()
        };
        // After step n the passing ball is at 1.6 - n / 4. The balls touch from -1 to 1.
        assert_eq!(column("started"), [0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0], "{query}");
        assert_eq!(column("stopped"), [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0], "{query}");
        assert_eq!(column("near")[..3], [1, 1, 0], "{query}");
        for (step, row) in (1..).zip(steps) {
            let touches = (3..=10).contains(&step);
            let alone = desk.json(&format!("replay passing.implog --step {step}"), touches.into());
            assert_eq!(alone["steps"], json!([row]), "{query}");
        }
    }
}

#[test]
fn a_step_has_positions_and_pairs() {
    let desk = Desk::recorded();
    let report = desk.json("replay balls.implog --step 30", 1);
    let left = &report["positions"][0];
    assert_eq!(left["name"], "left");
    let x = numbers(&left["translation"])[0];
    assert!((x - (-1.25 + 2.0 * 0.5)).abs() < 1e-12, "half a second by 2 a second: {x}");
    assert_eq!(numbers(&left["rotation"]), [0.0, 0.0, 0.0, 1.0], "i, j, k, w");
    let pair = &report["pairs"][0];
    assert_eq!((&pair["first"], &pair["second"]), (&json!("left"), &json!("right")));
    assert_eq!((&pair["state"], &pair["contacts"]), (&json!("touch"), &json!(1)));
    let depth = pair["depth"].as_f64().expect("a depth");
    assert!((depth - 0.5).abs() < 1e-12, "{depth}");
}

#[test]
fn what_was_recorded_replays_to_the_same_bits() {
    let desk = Desk::recorded();
    let boxes = desk.run("record boxes.json -o boxes.implog --steps 7");
    assert_eq!(boxes.code, 0, "{boxes:?}");
    let report = desk.json("validate balls.implog boxes.implog", 0);
    let recordings = report["recordings"].as_array().expect("a list");
    let same: Vec<_> = recordings.iter().map(|one| &one["same"]).collect();
    assert_eq!(same, [&json!(true), &json!(true)]);
    assert_eq!(recordings[1]["steps"], 7);
    let text = desk.run("validate balls.implog");
    assert!(text.out.contains("same bits at all 30 steps"), "{text:?}");
}

#[test]
fn a_changed_number_is_found_with_its_step_and_object() {
    let desk = Desk::recorded();
    let mut bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    // The position of the right ball, which does not move, in the encoding of the recording.
    let at = bytes.windows(8).position(|window| window == 1.25_f64.to_le_bytes());
    let at = at.expect("it is there");
    bytes[at..at + 8].copy_from_slice(&1.5_f64.to_le_bytes());
    reseal(&mut bytes);
    desk.write("changed.implog", &bytes);
    let report = desk.json("validate balls.implog changed.implog", 1);
    let difference = &report["recordings"][1]["difference"];
    assert_eq!(report["recordings"][0]["same"], true);
    assert_eq!((&difference["object"], &difference["step"]), (&json!("right"), &json!(1)));
    assert_eq!(difference["field"], "position, groups or query type");
    let text = desk.run("validate changed.implog");
    assert!(text.out.contains("differs first at step 1: object right"), "{text:?}");
}

#[test]
fn a_recording_without_its_end_is_replayed_as_far_as_it_goes() {
    let desk = Desk::recorded();
    let whole = desk.json("replay balls.implog", 1)["steps"].clone();
    let whole = whole.as_array().expect("a list");
    let bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    let mut kept = Vec::new();
    for length in (0..bytes.len()).step_by(bytes.len() / 40 + 1) {
        desk.write("cut.implog", &bytes[..length]);
        let validated = desk.run("validate cut.implog");
        assert_eq!((validated.code, validated.out.as_str()), (2, ""), "{length}: {validated:?}");
        assert!(validated.err.starts_with("error: cut.implog: at byte "), "{validated:?}");
        let ran = desk.run("replay cut.implog --json");
        if kept.is_empty() && ran.code == 2 {
            assert!(ran.err.starts_with("error: cut.implog: at byte "), "a header is cut: {ran:?}");
            continue;
        }
        let report: Value = serde_json::from_str(&ran.out).expect("JSON");
        let steps = report["steps"].as_array().expect("a list");
        assert_eq!(steps[..], whole[..steps.len()], "the same steps");
        let touches = steps.last().is_some_and(|last| last["touching"] == 1);
        assert_eq!(ran.code, i32::from(touches), "{length}: {ran:?}");
        let note = "note: cut.implog: the end of the recording cannot be read (at byte ";
        let count = format!("{} steps are kept", steps.len());
        assert!(ran.err.starts_with(note) && ran.err.contains(&count), "{length}: {ran:?}");
        kept.push(steps.len());
    }
    assert!(kept.is_sorted() && kept[0] < 3 && kept[kept.len() - 1] > 27, "{kept:?}");
}

#[test]
fn what_follows_damage_is_left_out() {
    let desk = Desk::recorded();
    let mut bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    let middle = bytes.len() / 2;
    bytes[middle] ^= 16;
    desk.write("flipped.implog", &bytes);
    assert_eq!(desk.run("validate flipped.implog").code, 2, "a checksum");
    for (verb, words) in [
        ("replay flipped.implog --step 1", "the checksum is wrong"),
        ("inspect flipped.implog", "steps are kept"),
        ("render flipped.implog -o a.png --size 9x9", "bytes left out"),
    ] {
        let ran = desk.run(verb);
        assert_eq!(ran.code, 0, "{verb}: {ran:?}");
        assert!(ran.err.starts_with("note: flipped.implog: "), "{verb}: {ran:?}");
        assert!(ran.err.contains(words), "{verb}: {ran:?}");
    }
    let ran = desk.run("replay flipped.implog --step 29");
    assert!(ran.code == 2 && ran.err.contains("there is no step 29"), "{ran:?}");
}

/// A shape of a user type. A recording contains only the name under which the shape is registered.
#[derive(Debug)]
struct Pebble(Ball<f64>);

impl Shape<f64, 3> for Pebble {
    fn geometry(&self) -> Geometry<'_, f64> {
        Shape::<f64, 3>::geometry(&self.0)
    }

    fn local_aabb(&self) -> Aabb<f64> {
        self.0.local_aabb()
    }
}

/// Returns a recording of 3 updates with a pebble.
fn of_own_shape() -> Vec<u8> {
    let pebble = ShapeHandle::new(Pebble(Ball::new(1.0)));
    let registry = Registry::<f64, 3, String>::new().with_shape("pebble", pebble.clone());
    let mut recorder = Recorder::new(0.02, registry).expect("a margin");
    let query = GeometricQueryType::Proximity(0.0);
    let (at, groups) = (Isometry::identity(), CollisionGroups::new());
    recorder.add(at, pebble, groups, query, "pebble".to_owned()).expect("an object");
    (0..3).for_each(|_| recorder.update());
    recorder.finish().bytes
}

#[test]
fn an_unknown_shape_is_no_damage() {
    let desk = Desk::new();
    desk.write("own.implog", of_own_shape());
    for verb in ["replay own.implog", "validate own.implog", "inspect own.implog"] {
        let ran = desk.run(verb);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{verb}: {ran:?}");
        assert!(
            ran.err.starts_with("error: own.implog: ") && ran.err.contains("\"pebble\""),
            "{ran:?}"
        );
    }
    // The page shows another shape in its place.
    let ran = desk.run("export own.implog -o own.html");
    assert_eq!((ran.code, ran.err.as_str()), (0, ""));
}

#[test]
fn key_frames_are_written_every_so_many_updates() {
    let desk = Desk::recorded();
    let size = |key_frames: &str| {
        let record = format!("record balls.json -o frames.implog --steps 30 {key_frames}");
        let report = desk.json(&record, 0);
        assert_eq!(desk.run("validate frames.implog").code, 0, "{key_frames}");
        let steps = desk.json("replay frames.implog", 1)["steps"].clone();
        assert_eq!(steps, desk.json("replay balls.implog", 1)["steps"], "{key_frames}");
        report["bytes"].as_u64().expect("a number")
    };
    let plain = size("");
    assert_eq!(size("--key-frames 30"), plain, "the first one comes after 30 updates");
    let (one, two) = (size("--key-frames 15"), size("--key-frames 10"));
    assert!(plain < one && one < two, "{plain}, {one}, {two}");
    // The record that adds the left ball and each key frame contain its name once.
    let bytes = fs::read(desk.path("frames.implog")).expect("a recording");
    let names = bytes.windows(4).filter(|window| window == b"left").count();
    assert_eq!(names, 3, "added once, and in key frames after 10 and 20 updates");
}

#[test]
fn standard_input_may_be_a_recording() {
    let desk = Desk::recorded();
    let bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    for verb in ["inspect -", "replay - --step 5", "validate -", "render - -o a.png --size 9x9"] {
        let ran = desk.run_with(verb, &bytes);
        assert_eq!((ran.code, ran.err.as_str()), (0, ""), "{verb}");
    }
    let ran = desk.run_with("check -", &bytes);
    assert!(ran.code == 2 && ran.err.starts_with("error: stdin: "), "{ran:?}");
}

#[test]
fn a_step_that_is_not_there() {
    let desk = Desk::recorded();
    for verb in ["replay balls.implog --step 31", "render balls.implog -o a.png --step 31"] {
        let ran = desk.run(verb);
        assert_eq!(ran.code, 2, "{ran:?}");
        assert_eq!(ran.err, "error: balls.implog: there is no step 31, the last is 30\n");
    }
}
