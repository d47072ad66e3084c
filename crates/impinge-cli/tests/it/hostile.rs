//! Tests that files that would need too much memory, or that name files outside their folder, are
//! refused, that the command does not wait for pipes and devices, and that no control character of
//! a file reaches the terminal.

use std::fs;
use std::process::Command;

use serde_json::json;

use crate::support::{Desk, Ran};

/// Returns a scene of `count` balls at the same position.
fn coincident(count: usize) -> String {
    let repeat = json!({"count": [count, 1, 1], "spacing": [0, 0, 0]});
    let ball = json!({"name": "b", "shape": {"ball": {"radius": 1}}, "repeat": repeat});
    json!({"dimension": 3, "objects": [ball]}).to_string()
}

/// Asserts that the output contains no control characters except line feeds, no characters that
/// change the direction of text or have no width, and that each stream has less than 4000 bytes.
fn assert_printable(ran: &Ran) {
    for text in [&ran.out, &ran.err] {
        let obeyed =
            |c: &char| c.is_control() && *c != '\n' || "\u{202e}\u{2066}\u{200b}".contains(*c);
        assert_eq!(text.chars().find(obeyed), None, "{text:?}");
        assert!(text.len() < 4000, "{} bytes", text.len());
    }
}

#[test]
fn pairs_are_counted_and_not_kept() {
    let desk = Desk::new();
    desk.write("many.json", coincident(150));
    let report = desk.json("check many.json --limit 3", 1);
    assert_eq!((&report["touching"], &report["omitted"]), (&json!(11_175), &json!(11_172)));
    assert_eq!(report["pairs"].as_array().map(Vec::len), Some(3));
    assert_eq!(report["pairs"][0]["first"], "b[0,0,0]", "names decide between equals");
    assert_eq!(report["pairs"][2]["second"], "b[100,0,0]", "in their order");
    let all = desk.run("check many.json --all");
    assert_eq!(all.out.lines().count(), 2 * 11_175 + 1);
    // Verbs that store pairs have a limit. `check` stores only the printed pairs, so its limit
    // matters with `--all` only.
    for verb in [
        "check many.json --all",
        "record many.json -o many.implog --steps 1",
        "render many.json -o many.png --layers object --size 20x20",
        "bench many.json --steps 1 --runs 1",
        "ray many.json --from 0,9,0 --to 0,0,0",
    ] {
        let ran = desk.run(&format!("{verb} --max-pairs 11174"));
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{verb}");
        assert!(
            ran.err.contains("more than 11174 pairs") && ran.err.contains("--max-pairs"),
            "{ran:?}"
        );
        let more = desk.run(&format!("{verb} --max-pairs 11175"));
        assert!(more.code < 2, "{verb}: {more:?}");
    }
    assert_eq!(desk.run("check many.json --max-pairs 0").code, 1);
}

#[test]
fn objects_that_meet_later_have_the_limit_too() {
    let desk = Desk::new();
    let ball = |name: String, x: f64| {
        json!({"name": name, "shape": {"ball": {"radius": 1}}, "position": {"translation": [x, 0, 0]},
               "motion": {"velocity": [-x, 0, 0]}})
    };
    let balls: Vec<_> =
        (0..50).map(|index| ball(index.to_string(), 5.0 * f64::from(index))).collect();
    desk.write("meet.json", json!({"dimension": 3, "objects": balls}).to_string());
    let record = "record meet.json -o meet.implog --steps 4 --dt 0.25 --max-pairs";
    let ran = desk.run(&format!("{record} 1000"));
    assert_eq!(ran.code, 2, "all are at one place in the end: {ran:?}");
    assert!(ran.err.contains("more than 1000 pairs"), "{ran:?}");
    assert_eq!(desk.run(&format!("{record} 1225")).code, 0);
}

/// Asserts that `check` succeeds with an address space of 300 000 kilobytes. The command alone
/// takes about a tenth of this; storing all of the million pairs would take about twice as much.
#[cfg(unix)]
#[test]
fn the_memory_of_a_check_does_not_grow_with_the_pairs() {
    let desk = Desk::new();
    desk.write("many.json", coincident(1500));
    let command =
        format!("ulimit -v 300000; exec {} check many.json --json", env!("CARGO_BIN_EXE_impinge"));
    let output = Command::new("sh").args(["-c", &command]).current_dir(desk.path("")).output();
    let output = output.expect("a shell");
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["touching"], 1500 * 1499 / 2);
}

#[test]
fn limits_name_the_flag_that_raises_them() {
    let desk = Desk::new();
    desk.write(
        "many.json",
        coincident(1_000_000).replace("\"spacing\":[0,0,0]", "\"spacing\":[3,0,0]"),
    );
    for (arguments, words) in [
        ("check many.json", ["more than 131072 objects", "--max-objects"]),
        ("check many.json --max-objects 1000000 --max-names 10", ["bytes of names", "--max-names"]),
        ("check parts.obj --max-bytes 100", ["more than 100 bytes", "--max-bytes"]),
        ("check parts.obj --max-corners 2", ["more than 2 corners of a polygon", "--max-corners"]),
    ] {
        let ran = desk.run(arguments);
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{arguments}: {ran:?}");
        for word in words {
            assert!(ran.err.contains(word), "{arguments}: no {word:?} in {}", ran.err);
        }
    }
    let ran = desk.run_with("check - --max-bytes 20", coincident(2).as_bytes());
    assert!(ran.code == 2 && ran.err.contains("--max-bytes"), "{ran:?}");
}

#[test]
fn files_outside_need_a_root() {
    let desk = Desk::new();
    fs::create_dir(desk.path("in")).expect("a folder");
    let scene = json!({"dimension": 3, "meshes": [{"path": "../parts.obj"}]}).to_string();
    desk.write("in/scene.json", &scene);
    let ran = desk.run("check in/scene.json");
    assert_eq!(ran.code, 2, "{ran:?}");
    assert!(ran.err.contains("parts.obj") && ran.err.contains("--root"), "{ran:?}");
    assert_eq!(desk.run("check in/scene.json --root .").code, 0);
    let stdin = scene.replace("../", "");
    assert_eq!(desk.run_with("check -", stdin.as_bytes()).code, 0, "from the current folder");
    assert_eq!(desk.run_with("check -", scene.as_bytes()).code, 2, "and not beside it");
}

#[cfg(unix)]
#[test]
fn pipes_and_devices_are_not_waited_for() {
    let desk = Desk::new();
    for name in ["pipe.json", "pipe.implog"] {
        assert!(Command::new("mkfifo").arg(desk.path(name)).status().expect("it runs").success());
        for verb in ["check", "inspect", "replay", "validate", "view"] {
            let ran = desk.run(&format!("{verb} {name}"));
            assert!(ran.code == 2 && ran.err.starts_with(&format!("error: {name}: ")), "{ran:?}");
        }
    }
    assert_eq!(desk.run("replay /dev/zero").code, 2);
}

#[test]
fn texts_of_files_do_not_reach_the_terminal() {
    let desk = Desk::new();
    let hostile = format!(
        "\u{1b}[2J\u{1b}]0;title\u{7}\nerror: forged\r\u{9b}31m\u{202e}{}",
        "x".repeat(100_000)
    );
    let ball = |name: &str| json!({"name": name, "shape": {"ball": {"radius": 1}}});
    let second = format!("second{hostile}");
    let scene = json!({"dimension": 3, "objects": [ball(&hostile), ball(&second)]});
    desk.write("names.json", scene.to_string());
    for arguments in [
        "check names.json",
        "inspect names.json",
        "ray names.json --from 0,9,0 --to 0,0,0",
        "cast names.json --shape ball:1 --from 0,9,0 --to 0,0,0",
        "distance names.json nobody second",
    ] {
        let ran = desk.run(arguments);
        assert!(ran.code == 1 || !arguments.contains("check"), "{arguments}");
        assert_printable(&ran);
        assert!(ran.err.is_empty() || arguments.starts_with("distance"), "{ran:?}");
        assert!(!ran.out.lines().any(|line| line.starts_with("error: forged")), "{ran:?}");
    }
    let json = desk.json("check names.json", 1);
    assert_eq!(json["pairs"][0]["first"], hostile, "programs get the name as it is");

    assert_eq!(desk.run("record names.json -o names.implog --steps 1").code, 0);
    for arguments in
        ["replay names.implog --step 1", "inspect names.implog", "validate names.implog"]
    {
        assert_printable(&desk.run(arguments));
    }
}

#[test]
fn errors_quote_little_of_a_file() {
    let desk = Desk::new();
    let hostile = format!("\u{1b}[31m{}\u{7}", "q".repeat(1_000_000));
    let text = serde_json::to_string(&hostile).expect("JSON");
    let object = |members: &str| format!("{{\"dimension\": 3, \"objects\": [{{{members}}}]}}");
    let ball = "\"shape\": {\"ball\": {\"radius\": 1}}";
    desk.write("field.json", format!("{{\"dimension\": 3, {text}: 1}}"));
    desk.write("shape.json", object(&format!("\"name\": \"a\", \"shape\": {text}")));
    desk.write("kind.json", object(&format!("\"name\": \"a\", \"shape\": {{{text}: {{}}}}")));
    desk.write(
        "value.json",
        object(&format!("\"name\": \"a\", \"shape\": {{\"ball\": {{\"radius\": {text}}}}}")),
    );
    let twice = format!("{{\"name\": {text}, {ball}}}");
    desk.write("twice.json", format!("{{\"dimension\": 3, \"objects\": [{twice}, {twice}]}}"));
    desk.write("path.json", format!("{{\"dimension\": 3, \"meshes\": [{{\"path\": {text}}}]}}"));
    desk.write("word.obj", format!("v {hostile} 0 0\n"));
    desk.write("word.stl", format!("solid a\n{hostile}\n"));
    desk.write("word.ply", format!("ply\n{hostile}\n"));
    desk.write(
        "word.urdf",
        format!("<robot name=\"r\"><link name=\"a\"/><joint name=\"{hostile}\"/></robot>"),
    );
    desk.write("uri.gltf", format!(
        "{{\"asset\": {{\"version\": \"2.0\"}}, \"buffers\": [{{\"uri\": {text}, \"byteLength\": 1}}]}}"
    ));
    for name in [
        "field.json",
        "shape.json",
        "kind.json",
        "value.json",
        "twice.json",
        "path.json",
        "word.obj",
        "word.stl",
        "word.ply",
        "word.urdf",
        "uri.gltf",
    ] {
        let ran = desk.run(&format!("check {name}"));
        assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{name}: {ran:?}");
        assert!(
            ran.err.starts_with(&format!("error: {name}")) || name == "path.json",
            "{name}: {ran:?}"
        );
        assert_printable(&ran);
        assert_eq!(ran.err.lines().count(), 1, "{name}: {ran:?}");
    }
}
