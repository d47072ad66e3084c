//! Tests invalid input: the exit code is 2, standard output is empty, and the error contains the
//! expected words, such as the file or the value.

use crate::support::Desk;

/// Asserts that a command fails, and that its error contains these words.
fn refused(desk: &Desk, arguments: &str, words: &[&str]) {
    let ran = desk.run(arguments);
    assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{arguments}: {ran:?}");
    for word in words {
        assert!(ran.err.contains(word), "{arguments}: no {word:?} in {}", ran.err);
    }
}

#[test]
fn files_that_are_not_there() {
    let desk = Desk::new();
    for verb in ["check", "inspect", "validate", "replay", "bench"] {
        refused(&desk, &format!("{verb} missing.json"), &["error: missing.json: "]);
    }
    refused(&desk, "render missing.json -o a.png", &["error: missing.json: "]);
    refused(&desk, "render boxes.json -o missing/a.png", &["a.png: cannot be written"]);
    refused(
        &desk,
        "record boxes.json -o missing/a.implog --steps 1",
        &["a.implog: cannot be written"],
    );
}

#[test]
fn scenes_with_the_place_of_the_mistake() {
    let desk = Desk::new();
    desk.write("cut.json", "{\"dimension\": 3,\n \"objects\": [");
    refused(&desk, "check cut.json", &["error: cut.json:2:"]);
    let negative = r#"{"dimension": 2, "objects": [
        {"name": "disc", "shape": {"ball": {"radius": -1}}}
    ]}"#;
    desk.write("negative.json", negative);
    refused(
        &desk,
        "check negative.json",
        &["negative.json:2:", "objects[0].shape.ball.radius", "-1"],
    );
    desk.write("member.json", r#"{"dimension": 2, "colour": 1}"#);
    refused(&desk, "check member.json", &["member.json:1:", "colour"]);
    desk.write("dimension.json", r#"{"dimension": 4}"#);
    refused(&desk, "check dimension.json", &["dimension.json:1:", "4"]);
    let ran = desk.run_with("check -", b"{]");
    assert_eq!((ran.code, ran.out.as_str()), (2, ""), "{ran:?}");
    assert!(ran.err.starts_with("error: stdin:1:2"), "{ran:?}");
    let ran = desk.run_with("check -", b"{\"dimension\": \xff}");
    assert!(ran.code == 2 && ran.err.contains("stdin: cannot be read: invalid utf-8"), "{ran:?}");
}

#[test]
fn meshes_that_are_none() {
    let desk = Desk::new();
    desk.write("nan.obj", "v 0 0 0\nv 1 0 0\nv 0 NaN 0\nf 1 2 3\n");
    refused(&desk, "check nan.obj", &["nan.obj"]);
    desk.write("empty.obj", "");
    refused(&desk, "check empty.obj", &["empty.obj"]);
    desk.write("unknown.xyz", "1 2 3");
    refused(&desk, "check unknown.xyz", &["unknown.xyz", "xyz"]);
}

#[test]
fn names_of_objects() {
    let desk = Desk::new();
    let words = ["balls.json", "no object has the name \"lefd\"", "did you mean \"left\"?"];
    refused(&desk, "distance balls.json lefd right", &words);
    refused(&desk, "distance balls.json left zzzzzzzz", &["\"zzzzzzzz\""]);
    refused(&desk, "cast balls.json --object nobody --by 1,0,0", &["\"nobody\""]);
}

#[test]
fn numbers_on_the_command_line() {
    let desk = Desk::new();
    refused(&desk, "check boxes.json --clearance -1", &["-1 is negative"]);
    refused(&desk, "check boxes.json --clearance NaN", &["NaN is not finite"]);
    refused(&desk, "check boxes.json --clearance near", &["\"near\" is not a number"]);
    refused(&desk, "ray boxes.json --from 0,0 --direction 1,0,0", &["--from 0,0", "3 numbers"]);
    refused(&desk, "ray boxes.json --from 0,inf,0 --to 1,0,0", &["inf is not finite"]);
    refused(&desk, "ray boxes.json --from 0,0,0", &["--to"]);
    refused(&desk, "render boxes.json -o a.png --size 0x10", &["\"0x10\""]);
    refused(&desk, "render boxes.json -o a.png --size 8193x10", &["\"8193x10\"", "8192"]);
    refused(&desk, "render boxes.json -o a.png --angle -1", &["-1 is negative"]);
    refused(&desk, "bench boxes.json --steps 0", &["0"]);
    refused(&desk, "record boxes.json -o a.implog --key-frames 0", &["--key-frames", "0"]);
    refused(&desk, "record boxes.json -o a.implog --steps 1 --dt inf", &["inf is not finite"]);
}

#[test]
fn directions_of_length_zero() {
    let desk = Desk::new();
    let words = ["--direction 0,0,0", "a direction must not be zero"];
    refused(&desk, "ray balls.json --from 1,0,0 --direction 0,0,0", &words);
    let words = ["--to 1,0,0", "is where the ray starts"];
    refused(&desk, "ray balls.json --from 1,0,0 --to 1,0,0", &words);
    refused(&desk, "render balls.json -o a.png --look 0,0,0", &["--look 0,0,0"]);
    refused(&desk, "render balls.json -o a.png --up 0,0,0", &["--up 0,0,0"]);
}

#[test]
fn numbers_beyond_the_scalar() {
    let desk = Desk::new();
    refused(&desk, "check squares.json --clearance 1e300", &["--clearance", "1e300"]);
    refused(&desk, "ray squares.json --from 1e300,0 --direction 1,0", &["--from", "1e300"]);
    refused(&desk, "cast squares.json --shape ball:1e300 --from 9,0 --to 0,0", &["--shape"]);
}

#[test]
fn shapes_on_the_command_line() {
    let desk = Desk::new();
    let cast = |shape: &str| format!("cast boxes.json --shape {shape} --from 9,9,9 --to 0,0,0");
    refused(&desk, &cast("cube:1"), &["\"cube:1\""]);
    refused(&desk, &cast("ball:-1"), &["--shape", "-1"]);
    refused(&desk, &cast("ball:1,2"), &["a ball has a radius"]);
    refused(&desk, &cast("box:1,2"), &["a box has 3 half extents"]);
    refused(&desk, &cast("capsule:1"), &["a capsule has"]);
    refused(&desk, "cast boxes.json --shape ball:1 --from 0,0,0", &["--to"]);
    refused(&desk, "cast boxes.json", &["--shape"]);
}

#[test]
fn pictures_of_other_formats() {
    let desk = Desk::new();
    refused(&desk, "render boxes.json -o boxes.gif", &["boxes.gif", ".png or .svg"]);
    refused(&desk, "render boxes.json -o a.png --step 3", &["--step 3", "only recordings"]);
}

#[test]
fn verbs_and_flags() {
    let desk = Desk::new();
    refused(&desk, "chekc boxes.json", &["chekc", "check"]);
    refused(&desk, "check boxes.json --jsno", &["--jsno", "--json"]);
    refused(&desk, "check boxes.json --all --limit 3", &["--limit"]);
    refused(&desk, "validate boxes.json", &["boxes.json", "not a recording"]);
}
