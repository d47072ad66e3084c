//! Tests of `inspect`, `bench`, `schema`, `completions`, and the formatting of text.

use std::process::Stdio;

use serde_json::{Value, json};

use crate::support::{Desk, numbers};

#[test]
fn the_objects_of_a_scene() {
    let desk = Desk::new();
    let report = desk.json("inspect squares.json", 0);
    assert_eq!((&report["kind"], &report["dimension"]), (&json!("scene"), &json!(2)));
    assert_eq!(report["scalar"], "f32");
    let objects = report["objects"].as_array().expect("a list");
    let names: Vec<_> = objects.iter().map(|object| &object["name"]).collect();
    assert_eq!(names, ["left", "right", "disc"]);
    assert_eq!(numbers(&objects[2]["low"]), [-0.5, 2.5]);
    assert_eq!(numbers(&objects[2]["high"]), [0.5, 3.5]);
}

#[test]
fn a_sound_mesh_and_one_with_a_hole() {
    let desk = Desk::new();
    let sound = desk.json("inspect parts.obj", 0);
    assert_eq!(sound["meshes"].as_array().map(Vec::len), Some(3), "{sound}");
    let mesh = &sound["meshes"][0];
    assert_eq!((&mesh["name"], &mesh["problems"]), (&json!("base"), &json!([])));
    assert_eq!((&mesh["solid"], &mesh["volume"]), (&json!(true), &json!(1.0)), "a unit cube");
    // Removes one face of the cube.
    let whole = std::fs::read_to_string(desk.path("parts.obj")).expect("a mesh");
    desk.write("open.obj", whole.replacen("f 1 3 4 2\n", "", 1));
    let open = &desk.json("inspect open.obj", 0)["meshes"][0];
    assert_eq!((&open["closed"], &open["boundary_edges"]), (&json!(false), &json!(4)), "{open}");
    // Adds a face whose corners lie on one line.
    desk.write("flat.obj", whole.replacen("f 2 4 8 6\n", "f 2 4 8 6\nf 1 1 2\n", 1));
    let flat = desk.json("inspect flat.obj", 1);
    let problem = flat["meshes"][0]["problems"][0].as_str().expect("a problem");
    assert!(problem.contains("degenerate") && problem.contains("line 17"), "{problem}");
    // Reverses the order of the corners of all faces.
    let turned = whole.lines().map(|line| match line.strip_prefix("f ") {
        Some(corners) => {
            let corners: Vec<_> = corners.rsplit(' ').collect();
            format!("f {}\n", corners.join(" "))
        }
        None => format!("{line}\n"),
    });
    desk.write("turned.obj", turned.collect::<String>());
    let text = desk.run("inspect turned.obj");
    assert!(
        text.out.contains(
            "part base: 8 vertices, 12 triangles, 1 pieces, closed, inside out, volume 1"
        ),
        "{text:?}"
    );
}

#[test]
fn a_joint_beyond_its_limits() {
    let desk = Desk::new();
    let link = |name| {
        format!(
            "<link name=\"{name}\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link>"
        )
    };
    let joint = "<joint name=\"knee\" type=\"revolute\"><parent link=\"a\"/><child link=\"b\"/>\
                 <limit lower=\"0.5\" upper=\"2\" effort=\"1\" velocity=\"1\"/></joint>";
    desk.write(
        "leg.urdf",
        format!("<robot name=\"leg\">{}{}{joint}</robot>", link("a"), link("b")),
    );
    let message = "the joint knee of leg is at 0, outside its limits 0.5 to 2";
    let report = desk.json("inspect leg.urdf", 0);
    assert_eq!(report["joints_beyond_limits"], json!([message]), "it is no error");
    assert!(desk.run("inspect leg.urdf").out.contains(message), "the text has it too");
}

#[test]
fn the_header_of_a_recording() {
    let desk = Desk::new();
    assert_eq!(desk.run("record squares.json -o a.implog --steps 3").code, 0);
    let report = desk.json("inspect a.implog", 0);
    assert_eq!((&report["kind"], &report["steps"]), (&json!("recording"), &json!(3)));
    assert_eq!((&report["dimension"], &report["scalar"]), (&json!(2), &json!("f32")));
    assert!(report["writer"].as_str().is_some_and(|writer| writer.starts_with("impinge ")));
}

#[test]
fn times_are_positive_and_in_order() {
    let desk = Desk::new();
    let report = desk.json("bench balls.json --steps 4 --runs 2", 0);
    let scene = &report["scenes"][0];
    assert_eq!(
        (&scene["objects"], &scene["steps"], &scene["runs"]),
        (&json!(2), &json!(4), &json!(2))
    );
    let of = |field: &str| scene[field].as_f64().expect("a time");
    assert!(of("first_update_ms") > 0.0 && of("lower_quartile_ms") > 0.0, "{report}");
    assert!(of("lower_quartile_ms") <= of("median_ms"), "{report}");
    assert!(of("median_ms") <= of("upper_quartile_ms"), "{report}");
}

#[test]
fn the_schema_is_json() {
    let ran = Desk::new().run("schema");
    let schema: Value = serde_json::from_str(&ran.out).expect("JSON");
    assert_eq!(ran.code, 0);
    assert!(schema["properties"]["objects"].is_object(), "objects are a member");
}

#[test]
fn completions_name_the_verbs() {
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let ran = Desk::new().run(&format!("completions {shell}"));
        assert_eq!(ran.code, 0, "{ran:?}");
        assert!(ran.out.contains("validate") && ran.out.contains("clearance"), "{shell}");
    }
}

#[test]
fn colours_are_for_terminals() {
    let desk = Desk::new();
    let run = |variable: &str| {
        let mut command = desk.command();
        let output = command.args(["check", "boxes.json"]).env(variable, "1").output();
        String::from_utf8(output.expect("an end").stdout).expect("text")
    };
    assert!(!run("UNUSED").contains('\u{1b}'), "a pipe has no colours");
    assert!(run("CLICOLOR_FORCE").contains('\u{1b}'), "unless they are asked for");
}

#[test]
fn a_reader_that_is_gone_is_no_error() {
    let desk = Desk::new();
    let mut child = desk
        .command()
        .arg("schema")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    assert!(output.stderr.is_empty(), "{output:?}");
}
