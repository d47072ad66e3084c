//! Tests recordings: played forwards and backwards, changed by hand, packed, and growing.

use impinge::shape::Ball;
use impinge_page::Viewed;
use impinge_record::{Registry, pack};
use serde_json::{Value, json};

use crate::support::{Asker, Scene, place};

/// The number of steps of the recording.
const STEPS: usize = 10;

/// Returns the recording of a ball of radius 1 that moves from x = -5 by 1 per step, through a ball
/// of radius 0.5 at the origin.
fn scene<N: Viewed<D>, const D: usize>() -> Vec<u8> {
    let mut scene = Scene::<N, D>::new(Registry::new());
    let ball = scene.add([-5.0, 0.0, 0.0], Ball::new(N::ONE));
    scene.add([0.0; 3], Ball::new(N::HALF));
    for x in -4_i32..5 {
        scene.0.update();
        scene.0.set_position(ball, place::<N, D>([x.into(), 0.0, 0.0])).expect("it is there");
    }
    scene.finish()
}

/// Returns the x coordinate of the moving ball after update `step`, counted from 1.
fn x_at(step: usize) -> f64 {
    f64::from(u32::try_from(step).expect("a small step")) - 6.0
}

fn seek(asker: &mut Asker, step: usize) -> Value {
    asker.ask(&format!(r#"{{"do": "seek", "step": {step}}}"#))
}

fn frame(asker: &mut Asker) -> (Value, Vec<u8>) {
    let layers = r#"["object", "tight box", "contact", "normal"]"#;
    asker.ask_with(&format!(r#"{{"do": "frame", "layers": {layers}, "known": 0}}"#), &[])
}

fn there_and_back<N: Viewed<D>, const D: usize>() {
    let mut asker = Asker::of(&scene::<N, D>());
    let mut frames = Vec::new();
    for step in 1..=STEPS {
        assert_eq!(seek(&mut asker, step)["step"], step, "it is there");
        let object = asker.ask(r#"{"do": "object", "object": 0}"#);
        assert_eq!(object["translation"][0], x_at(step), "step {step}");
        frames.push(frame(&mut asker));
    }
    for step in (1..=STEPS).rev() {
        let status = seek(&mut asker, step);
        assert_eq!(status["diverged"], Value::Null, "step {step}");
        let touches = x_at(step).abs() <= 1.5;
        assert_eq!(status["contacts"], u32::from(touches), "step {step}");
        assert_eq!(frame(&mut asker).1, frames[step - 1].1, "step {step}");
    }
    let events = &seek(&mut asker, 5)["events"];
    assert_eq!(*events, json!([{"kind": "contact", "started": true, "a": 0, "b": 1}]), "at x = -1");
}

#[test]
fn steps_backwards_show_what_was() {
    there_and_back::<f32, 2>();
    there_and_back::<f64, 2>();
    there_and_back::<f32, 3>();
    there_and_back::<f64, 3>();
}

#[test]
fn info_has_the_time_line() {
    let (info, _) =
        Asker::default().ask_with(r#"{"do": "open", "kind": "recording"}"#, &scene::<f64, 2>());
    assert_eq!(
        (&info["kind"], &info["dimension"], &info["scalar"]),
        (&json!("recording"), &json!(2), &json!("f64"))
    );
    assert_eq!(
        (&info["steps"], &info["step"], &info["complete"]),
        (&json!(STEPS), &json!(1), &json!(true))
    );
    assert!(info["written_by"].as_str().is_some_and(|text| text.starts_with("impinge ")), "{info}");
    let marks = info["marks"].as_array().expect("a list");
    let [added, started, stopped] = marks.as_slice() else { panic!("three steps: {marks:?}") };
    assert_eq!((&added["step"], &added["added"]), (&json!(1), &json!(2)));
    assert_eq!((&started["step"], &started["started"]), (&json!(5), &json!(1)));
    assert_eq!((&stopped["step"], &stopped["stopped"]), (&json!(8), &json!(1)), "at x = 2");
    let bounds = [[-6.0, -1.0, 0.0], [0.5, 1.0, 0.0]];
    for (corner, expected) in bounds.iter().flatten().enumerate() {
        let found = info["bounds"][corner / 3][corner % 3].as_f64().expect("a number");
        assert!((found - expected).abs() < 1e-9, "{found} for {expected}");
    }
}

fn by_hand<N: Viewed<D>, const D: usize>() {
    let mut asker = Asker::of(&scene::<N, D>());
    seek(&mut asker, 3);
    let before = frame(&mut asker);
    let moved = asker.ask(r#"{"do": "drag", "object": 0, "translation": [0.25, 0, 0]}"#);
    assert_eq!((&moved["contacts"], &moved["step"]), (&json!(1), &json!(3)), "now they touch");
    assert_eq!(
        asker.ask(r#"{"do": "pair", "a": 0, "b": 1}"#)["contact"]["depth"],
        1.25,
        "1.5 less 0.25"
    );
    assert_ne!(frame(&mut asker).1, before.1, "it is seen");

    let again = seek(&mut asker, 3);
    assert_eq!((&again["contacts"], &again["diverged"]), (&json!(0), &Value::Null), "no longer");
    assert_eq!(frame(&mut asker).1, before.1, "as it was recorded");
    asker.ask(r#"{"do": "drag", "object": 0, "translation": [0, 9, 0]}"#);
    let on = asker.ask(r#"{"do": "advance", "steps": 2}"#);
    assert_eq!((&on["contacts"], &on["diverged"]), (&json!(1), &Value::Null), "step 5 as recorded");
}

#[test]
fn changes_by_hand_last_until_the_next_seek() {
    by_hand::<f32, 2>();
    by_hand::<f64, 2>();
    by_hand::<f32, 3>();
    by_hand::<f64, 3>();
}

#[test]
fn a_drag_may_turn() {
    let mut asker = Asker::of(&scene::<f64, 2>());
    asker.ask(r#"{"do": "drag", "object": 0, "translation": [0, 0, 0], "rotation": [0, 0, 3, 4]}"#);
    let object = asker.ask(r#"{"do": "object", "object": 0}"#);
    let [z, w] = [2, 3].map(|part| object["rotation"][part].as_f64().expect("a number"));
    assert!((z - 0.6).abs() < 1e-12 && (w - 0.8).abs() < 1e-12, "of length 1: {z} {w}");
    let refused = asker
        .ask(r#"{"do": "drag", "object": 0, "translation": [0, 0, 0], "rotation": [0, 0, 0, 0]}"#);
    assert!(
        refused["error"].as_str().is_some_and(|text| text.contains("no rotation")),
        "{refused}"
    );
}

#[test]
fn packed_recordings_open() {
    let bytes = scene::<f32, 3>();
    let packed = pack(&bytes).expect("it was just written");
    let status = seek(&mut Asker::of(&packed), 5);
    assert_eq!(status, seek(&mut Asker::of(&bytes), 5));
}

#[test]
fn a_recording_of_a_program_that_died_is_played_to_its_last_update() {
    let bytes = scene::<f64, 3>();
    let whole = seek(&mut Asker::of(&bytes), STEPS);
    // Removes the last record: a kind of 1 byte, a length of 4, a number of 8, and a checksum of 4
    // bytes.
    let end = bytes.len() - (1 + 4 + 8 + 4);
    let lossless = "The recording has no end: its program did not finish it.";
    let last = format!(
        "The recording has no end: its last 3 bytes cannot be read, at byte {}: the bytes end early.",
        end + 1
    );
    for (cut, note) in [(end, lossless), (end + 3, last.as_str())] {
        let mut asker = Asker::default();
        let (info, _) = asker.ask_with(r#"{"do": "open", "kind": "recording"}"#, &bytes[..cut]);
        assert_eq!(info["notes"], json!([note]));
        assert_eq!((&info["steps"], &info["complete"]), (&json!(STEPS), &json!(false)));
        assert_eq!(seek(&mut asker, STEPS), whole, "the same world");
    }
    let packed = pack(&bytes[..end]).expect("its records are whole");
    let (info, _) = Asker::default().ask_with(r#"{"do": "open", "kind": "recording"}"#, &packed);
    assert_eq!(info["notes"], json!([lossless]), "packed as well");
}

#[test]
fn streams_grow_whatever_their_pieces_are() {
    let bytes = scene::<f64, 2>();
    for size in [1, 7, 1000] {
        let mut asker = Asker::default();
        asker.ask(r#"{"do": "open", "kind": "stream"}"#);
        let mut steps = 0;
        for piece in bytes.chunks(size) {
            let (info, _) = asker.ask_with(r#"{"do": "push"}"#, piece);
            assert_eq!(info["error"], Value::Null, "pieces of {size}");
            let now = info["steps"].as_u64().expect("a number");
            assert!(now >= steps, "it grows");
            steps = now;
        }
        assert_eq!(steps, STEPS as u64);
        let status = seek(&mut asker, 7);
        assert_eq!(status, seek(&mut Asker::of(&bytes), 7), "pieces of {size}");
        let (info, _) = asker.ask_with(r#"{"do": "push"}"#, &[]);
        assert_eq!((&info["kind"], &info["complete"]), (&json!("stream"), &json!(true)));
        assert_eq!((&info["dimension"], &info["scalar"]), (&json!(2), &json!("f64")));
        let (after, _) = asker.ask_with(r#"{"do": "push"}"#, &[1, 2, 3]);
        assert_ne!(after["error"], Value::Null, "nothing follows the end");
    }
}

#[test]
fn a_stream_with_bad_bytes_changes_nothing() {
    let (bytes, bad) = (scene::<f64, 2>(), [7; 64]);
    let mut asker = Asker::of(&bytes);
    let before = seek(&mut asker, 7);
    let (answer, _) = asker.ask_with(r#"{"do": "open", "kind": "stream"}"#, &bad);
    assert_ne!(answer["error"], Value::Null, "no header");
    assert_eq!(seek(&mut asker, 7), before, "the recording is still open");

    asker.ask(r#"{"do": "open", "kind": "stream"}"#);
    let (answer, _) = asker.ask_with(r#"{"do": "push"}"#, &bad);
    assert_ne!(answer["error"], Value::Null, "no header");
    let (info, _) = asker.ask_with(r#"{"do": "push"}"#, &bytes);
    assert_eq!((&info["error"], &info["steps"]), (&Value::Null, &json!(STEPS)), "as if alone");
    assert_eq!(seek(&mut asker, 7), before, "the same stream");
}
