//! Tests that truncated, damaged and random messages have a response, and that damaged recordings
//! open up to the damage.

use impinge::shape::Ball;
use impinge_page::{Engine, message, parts};
use impinge_record::{Header, Registry};
use serde_json::Value;

use crate::support::{Asker, Scene};

fn recording() -> Vec<u8> {
    let mut scene = Scene::<f32, 2>::new(Registry::new());
    for x in [0.0, 1.5] {
        scene.add([x, 0.0, 0.0], Ball::new(1.0));
    }
    scene.0.update();
    scene.finish()
}

/// Checks that a response has the layout of responses and contains JSON, possibly an error. Returns
/// the JSON.
fn answered(engine: &mut Engine, bytes: &[u8]) -> Value {
    let answer = engine.call(bytes);
    let (text, payload) = parts(&answer).expect("an answer has the layout of a message");
    assert!(payload.len() % 4 == 0, "sections are aligned");
    let answer: Value = serde_json::from_slice(text).expect("its text is JSON");
    assert_eq!(answer["error"].is_string(), answer["code"].is_string(), "an error has a code");
    answer
}

/// A random number generator of the xorshift family (Marsaglia, 2003).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }
}

const MESSAGES: [&str; 12] = [
    r#"{"do": "samples"}"#,
    r#"{"do": "seek", "step": 2}"#,
    r#"{"do": "advance", "steps": 1}"#,
    r#"{"do": "reset"}"#,
    r#"{"do": "control", "name": "speed", "value": 1}"#,
    r#"{"do": "frame", "layers": ["object", "tree"], "selected": [0], "known": 0}"#,
    r#"{"do": "object", "object": 1}"#,
    r#"{"do": "pair", "a": 0, "b": 1}"#,
    r#"{"do": "pick", "from": [0, 0, 0], "direction": [0, 0, 1], "reach": 1}"#,
    r#"{"do": "ray", "from": [-3, 0, 0], "direction": [1, 0, 0], "longest": 9}"#,
    r#"{"do": "nearest", "point": [0, 0, 0], "count": 2}"#,
    r#"{"do": "drag", "object": 0, "translation": [0, 1, 0], "rotation": [0, 0, 0, 1]}"#,
];

#[test]
fn truncated_messages_are_errors() {
    let mut asker = Asker::of(&recording());
    for text in MESSAGES {
        let whole = message(text, &[]);
        for length in 0..whole.len() - whole.len() % 4 {
            let padding = whole[length..].iter().all(|byte| *byte == b' ');
            let answer = answered(&mut asker.0, &whole[..length]);
            assert!(answer["error"].is_string() || padding, "{length} bytes of {text}: {answer}");
        }
        let length = u32::try_from(text.len()).expect("it is short");
        for wrong in [u32::MAX, length + 64, 1 << 31] {
            let mut bytes = whole.clone();
            bytes[..4].copy_from_slice(&wrong.to_le_bytes());
            assert!(answered(&mut asker.0, &bytes)["error"].is_string(), "{wrong} for {length}");
        }
    }
}

#[test]
fn values_of_other_kinds_are_errors() {
    let mut asker = Asker::of(&recording());
    let values =
        ["null", "true", "-1", "1.5", "1e400", r#""x""#, "[]", "[1, 2]", "{}", "[[1], 2, 3]"];
    let fields = [
        r#"{"do": "seek", "step": V}"#,
        r#"{"do": "object", "object": V}"#,
        r#"{"do": "pair", "a": 0, "b": V}"#,
        r#"{"do": "ray", "from": V, "direction": [1, 0, 0]}"#,
        r#"{"do": "nearest", "point": V}"#,
        r#"{"do": "drag", "object": 0, "translation": V}"#,
        r#"{"do": "open", "kind": "sample", "name": V}"#,
        r#"{"do": "open", "kind": V}"#,
        r#"{"do": V}"#,
        "V",
    ];
    for field in fields {
        for value in values {
            let answer = asker.ask(&field.replace('V', value));
            assert!(answer["error"].is_string(), "{field} with {value}: {answer}");
        }
    }
    let steps = asker.ask(r#"{"do": "advance", "steps": 18446744073709551615}"#);
    assert!(
        steps["error"].as_str().is_some_and(|text| text.contains("18446744073709551615")),
        "{steps}"
    );
    assert_eq!(
        asker.ask(r#"{"do": "pair", "a": 1, "b": 1}"#)["error"],
        "object 1 and itself are no pair"
    );
    let nested = "[".repeat(100_000);
    assert!(asker.ask(&nested)["error"].is_string(), "deep nesting");
    assert_eq!(asker.ask(r#"{"do": "seek", "step": 1}"#)["objects"], 2, "nothing has changed");
}

#[test]
fn numbers_at_the_ends_of_their_range_are_answered() {
    let mut asker = Asker::of(&recording());
    for number in ["1e308", "-1e308", "1e-320", "3.5e38", "0"] {
        let vector = format!("[{number}, {number}, {number}]");
        let answers = [
            format!(
                r#"{{"do": "ray", "from": {vector}, "direction": {vector}, "longest": {number}}}"#
            ),
            format!(
                r#"{{"do": "pick", "from": {vector}, "direction": {vector}, "reach": {number}}}"#
            ),
            format!(r#"{{"do": "nearest", "point": {vector}, "count": 9}}"#),
        ];
        for text in answers {
            assert_eq!(asker.ask(&text)["error"], Value::Null, "{text}");
        }
        let moved =
            asker.ask(&format!(r#"{{"do": "drag", "object": 0, "translation": {vector}}}"#));
        let is_finite = number.parse::<f64>().is_ok_and(|x| x.abs() <= f32::MAX.into());
        assert_eq!(moved["error"].is_null(), is_finite, "{number}: {moved}");
        let (frame, _) =
            asker.ask_with(r#"{"do": "frame", "layers": ["object", "tight box"]}"#, &[]);
        assert_eq!(frame["instances"]["count"], 2, "{number}");
    }
}

#[test]
fn random_bytes_are_answered() {
    let mut random = Random(0x9e37_79b9_7f4a_7c15);
    let (mut asker, mut errors) = (Asker::of(&recording()), 0);
    for round in 0..4000 {
        let text = MESSAGES[round % MESSAGES.len()];
        let mut bytes = message(text, &[]);
        for _ in 0..1 + random.next() % 4 {
            let index = usize::try_from(random.next() % bytes.len() as u64).expect("an index");
            bytes[index] = random.next().to_le_bytes()[0];
        }
        errors += u32::from(answered(&mut asker.0, &bytes)["error"].is_string());
    }
    assert!(errors > 2000, "most are spoiled: {errors}");
    for length in 0..200 {
        let bytes: Vec<u8> = (0..length).map(|_| random.next().to_le_bytes()[0]).collect();
        assert!(answered(&mut asker.0, &bytes)["error"].is_string(), "{bytes:?}");
    }
}

/// Returns the length of the header of a recording in `f32`. The part that `Header::read` needs is
/// followed by a margin and a checksum of four bytes each.
fn header_bytes(bytes: &[u8]) -> usize {
    let is_whole = |length: &usize| Header::read(&bytes[..*length]).is_ok();
    (0..).find(is_whole).expect("the header of a recording is whole") + 8
}

#[test]
fn damaged_recordings_open_up_to_the_damage() {
    let bytes = recording();
    let open = r#"{"do": "open", "kind": "recording"}"#;
    let (header, mut asker) = (header_bytes(&bytes), Asker::default());
    let mut check = |damaged: &[u8], place: usize| {
        let (answer, _) = asker.ask_with(open, damaged);
        if place < header {
            assert!(answer["error"].is_string(), "byte {place} is of the header: {answer}");
            return None;
        }
        let note = answer["notes"][0].as_str().expect("a note says what is lost");
        assert!(note.starts_with("The recording has no end"), "byte {place}: {note}");
        assert_eq!(answer["complete"], false, "byte {place}");
        answer["steps"].as_u64()
    };
    // The recording has two updates. The later the damage is, the more updates remain.
    let truncated = (0..bytes.len()).filter_map(|length| check(&bytes[..length], length));
    let mut truncated: Vec<_> = truncated.collect();
    assert!(truncated.is_sorted(), "{truncated:?}");
    truncated.dedup();
    assert_eq!(truncated, [0, 1, 2], "as many updates as are whole");
    for index in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[index] ^= 0x20;
        check(&damaged, index);
    }
    // An engine that rejects a recording keeps its stage.
    let refused = asker.ask_with(open, &bytes[..header - 1]).0;
    assert!(refused["error"].is_string(), "{refused}");
    assert_eq!(asker.ask(MESSAGES[1])["step"], 2, "the recording before is still open");
}
