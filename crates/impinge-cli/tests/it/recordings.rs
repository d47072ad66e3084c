//! `record`, `replay` and `validate`.

use std::fs;

use impinge_record::reseal;
use serde_json::json;

use crate::support::{Desk, numbers};

/// The left ball moves by 2 a second; the gap of 0.5 is closed after a quarter of a second: 15 steps.
fn recorded() -> Desk {
    let desk = Desk::new();
    let report = desk.json("record balls.json -o balls.implog --steps 30", 0);
    let size = fs::metadata(desk.path("balls.implog")).expect("it was written").len();
    assert_eq!((&report["steps"], &report["objects"]), (&json!(30), &json!(2)), "{report}");
    assert_eq!(report["bytes"], size, "what was written");
    desk
}

#[test]
fn balls_that_meet_after_a_quarter_of_a_second() {
    let desk = recorded();
    let report = desk.json("replay balls.implog", 1);
    let steps = report["steps"].as_array().expect("a list");
    assert_eq!(steps.len(), 30);
    // At step 15 they touch up to rounding.
    assert!(steps[..14].iter().all(|step| step["touching"] == 0), "{report}");
    assert!(steps[15..].iter().all(|step| step["touching"] == 1), "{report}");
    let started: i64 = steps.iter().filter_map(|step| step["started"].as_i64()).sum();
    assert_eq!(started, 1, "one contact began");
    assert_eq!(desk.json("replay balls.implog --step 5", 0)["steps"][0]["touching"], 0);
}

#[test]
fn a_step_has_positions_and_pairs() {
    let desk = recorded();
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
    let desk = recorded();
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
    let desk = recorded();
    let mut bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    // The place of the right ball, which does not move, as the library writes it.
    let at = bytes.windows(8).position(|window| window == 1.25_f64.to_le_bytes());
    let at = at.expect("it is there");
    bytes[at..at + 8].copy_from_slice(&1.5_f64.to_le_bytes());
    reseal(&mut bytes);
    desk.write("changed.implog", &bytes);
    let report = desk.json("validate balls.implog changed.implog", 1);
    let difference = &report["recordings"][1]["difference"];
    assert_eq!(report["recordings"][0]["same"], true);
    assert_eq!((&difference["object"], &difference["step"]), (&json!("right"), &json!(0)));
    assert_eq!(difference["field"], "position, groups or query type");
    let text = desk.run("validate changed.implog");
    assert!(text.out.contains("differs first at step 0: object right"), "{text:?}");
}

#[test]
fn damaged_recordings_are_refused() {
    let desk = recorded();
    let bytes = fs::read(desk.path("balls.implog")).expect("a recording");
    for length in (0..bytes.len()).step_by(bytes.len() / 40 + 1) {
        desk.write("cut.implog", &bytes[..length]);
        for verb in ["validate", "replay"] {
            let ran = desk.run(&format!("{verb} cut.implog"));
            assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{length} bytes, {verb}: {ran:?}");
            assert!(ran.err.starts_with("error: cut.implog: at byte "), "{ran:?}");
        }
    }
    let mut flipped = bytes;
    let middle = flipped.len() / 2;
    flipped[middle] ^= 16;
    desk.write("flipped.implog", &flipped);
    assert_eq!(desk.run("validate flipped.implog").code, 2, "a checksum");
}

#[test]
fn a_step_that_is_not_there() {
    let desk = recorded();
    for verb in ["replay balls.implog --step 31", "render balls.implog -o a.png --step 31"] {
        let ran = desk.run(verb);
        assert_eq!(ran.code, 2, "{ran:?}");
        assert_eq!(ran.err, "error: balls.implog: there is no step 31, the last is 30\n");
    }
}
