//! Tests that each sample opens, runs and is drawn, and that a control accepts valid and rejects
//! invalid values.

use impinge_samples::entries;
use serde_json::{Value, json};

use crate::support::Asker;

const ALL_LAYERS: &str = r#"{"do": "frame", "layers": ["object", "tight box", "loosened box", "tree", "contact",
    "normal", "manifold", "proximity", "query", "query hit"], "selected": [0]}"#;

#[test]
fn every_sample_opens_and_runs() {
    let mut asker = Asker::default();
    let gallery = asker.ask(r#"{"do": "samples"}"#);
    let samples = gallery["samples"].as_array().expect("a list");
    assert_eq!(samples.len(), entries().len());
    for sample in samples {
        let name = &sample["name"];
        let info = asker.ask(&json!({"do": "open", "kind": "sample", "name": name}).to_string());
        assert_eq!((&info["name"], &info["dimension"]), (name, &sample["dimension"]), "{info}");
        assert_eq!((&info["title"], &info["steps"]), (&sample["title"], &Value::Null));
        let frame = asker.ask(ALL_LAYERS);
        assert!(frame["instances"]["count"].as_u64() > Some(0), "{name}: {}", frame["error"]);
        let status = asker.ask(r#"{"do": "advance", "steps": 2}"#);
        assert_eq!(status["step"], 2, "{name}: {status}");
        assert_eq!(asker.ask(ALL_LAYERS)["error"], Value::Null, "{name}");
        assert_eq!(asker.ask(r#"{"do": "object", "object": 0}"#)["object"], 0, "{name}");
        assert_eq!(asker.ask(r#"{"do": "reset"}"#)["step"], 0, "{name}");
    }
}

#[test]
fn controls_are_set_and_refused() {
    let mut asker = Asker::default();
    let info = asker.ask(r#"{"do": "open", "kind": "sample", "name": "stack3"}"#);
    let number = info["controls"]
        .as_array()
        .into_iter()
        .flatten()
        .find(|control| control["kind"] == "number");
    let number = number.expect("the stack has a number of boxes");
    let set = |value: &Value| {
        json!({"do": "control", "name": number["name"], "value": value}).to_string()
    };
    let status = asker.ask(&set(&number["min"]));
    assert_eq!(
        (&status["error"], &status["controls"]),
        (&Value::Null, &json!([])),
        "the page knows it"
    );
    asker.ask(r#"{"do": "open", "kind": "sample", "name": "nothing"}"#);
    let again = asker.ask(r#"{"do": "advance", "steps": 0}"#);
    assert_eq!(again["error"], Value::Null, "what was open stays");

    let refused = [json!("two"), json!([1]), json!(1e300), json!(true), Value::Null];
    for value in refused {
        let answer = asker.ask(&set(&value));
        assert!(answer["error"].is_string(), "{value}: {answer}");
    }
    let unknown = asker.ask(r#"{"do": "control", "name": "nonsense", "value": 1}"#);
    assert!(unknown["error"].as_str().is_some_and(|text| text.contains("nonsense")), "{unknown}");
    for message in [r#"{"do": "seek", "step": 3}"#, r#"{"do": "push"}"#] {
        assert!(asker.ask(message)["error"].is_string(), "{message}");
    }
}
