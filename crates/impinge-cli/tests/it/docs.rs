//! Runs the examples of the help texts and of `README.md`, and tests that the help texts document
//! all fields of `--json`.

use std::fs;

use snapbox::assert_data_eq;

use crate::support::{Desk, Ran, root};

/// Returns the verbs that `impinge --help` lists.
fn verbs(desk: &Desk) -> Vec<String> {
    let help = desk.run("--help").out;
    let list = help.split("Commands:\n").nth(1).expect("a list").split("\n\n").next();
    let names = list.expect("its lines").lines().filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Runs a line such as `impinge check - < boxes.json`.
fn run_line(desk: &Desk, line: &str) -> Ran {
    let arguments = line.strip_prefix("impinge").expect("the command");
    match arguments.split_once(" < ") {
        Some((arguments, file)) => {
            let input = fs::read(desk.path(file.trim())).expect("a file");
            desk.run_with(arguments, &input)
        }
        None => desk.run(arguments),
    }
}

#[test]
fn every_verb_has_examples_that_run() {
    let desk = Desk::recorded();
    let verbs = verbs(&desk);
    assert!(verbs.len() >= 15, "{verbs:?}");
    for verb in verbs {
        let help = desk.run(&format!("{verb} --help"));
        assert_eq!((help.code, help.err.as_str()), (0, ""), "{verb}");
        let lines = help.out.lines().filter_map(|line| line.strip_prefix("  impinge "));
        // Two spaces separate an example from its description.
        let commands = lines.filter_map(|line| line.split("  ").next());
        let mut count = 0;
        for command in commands {
            let ran = run_line(&desk, &format!("impinge {command}"));
            assert!(ran.code < 2 && ran.err.is_empty(), "{command}: {ran:?}");
            count += 1;
        }
        assert!(count > 0 || verb == "schema", "{verb} has no example");
    }
}

#[test]
fn the_fields_of_json_are_documented() {
    let desk = Desk::recorded();
    for arguments in [
        "check boxes.json",
        "distance balls.json left right",
        "cast balls.json --object left --by 2,0,0",
        "ray balls.json --from -5,0,0 --to 5,0,0",
        "record balls.json -o again.implog --steps 2",
        "replay balls.implog --step 20",
        "validate balls.implog",
        "inspect parts.obj",
        "inspect balls.implog",
        "bench balls.json --steps 2 --runs 1",
        "export balls.implog -o balls.html",
        "samples",
    ] {
        let verb = arguments.split(' ').next().expect("a verb");
        let help = desk.run(&format!("{verb} --help")).out;
        let documented = help.split("Fields of --json:").nth(1).expect("a list of fields");
        let is_word = |c: char| c.is_alphanumeric() || c == '_';
        let words: Vec<_> = documented.split(|c| !is_word(c)).collect();
        let ran = desk.run(&format!("{arguments} --json"));
        let report = serde_json::from_str(&ran.out).expect("JSON");
        for key in keys(&report) {
            assert!(words.contains(&key.as_str()), "{verb}: {key} is not documented");
        }
    }
}

/// Returns the names of all members of a JSON value, at any depth; a name may occur several times.
fn keys(value: &serde_json::Value) -> Vec<String> {
    match value {
        serde_json::Value::Object(members) => {
            let inner = members.iter().flat_map(|(name, value)| {
                let mut names = keys(value);
                names.push(name.clone());
                names
            });
            inner.collect()
        }
        serde_json::Value::Array(list) => list.iter().flat_map(keys).collect(),
        _ => Vec::new(),
    }
}

#[test]
fn the_readme_shows_what_is_printed() {
    let desk = Desk::new();
    let text = fs::read_to_string(root().join("README.md")).expect("the page");
    let blocks = text.split("```console\n").skip(1).map(|rest| rest.split("```").next());
    let mut count = 0;
    for block in blocks {
        for step in block.expect("an end").split("$ ").skip(1) {
            let (command, expected) = step.split_once('\n').expect("a line");
            let ran = run_line(&desk, command);
            assert!(ran.err.is_empty() || ran.code == 2, "{command}: {ran:?}");
            assert_data_eq!(format!("{}{}", ran.out, ran.err), expected.to_owned());
            count += 1;
        }
    }
    assert!(count >= 12, "an example of each verb: {count}");
}

#[test]
fn exit_codes_are_in_the_help() {
    let help = Desk::new().run("--help").out;
    for line in ["0  nothing touches", "1  something touches", "2  the input"] {
        assert!(help.contains(line), "{line}");
    }
}
