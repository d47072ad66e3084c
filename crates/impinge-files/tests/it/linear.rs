//! Tests large inputs on which an algorithm of quadratic time would take too long.

use std::fmt::Write;
use std::fs;
use std::path::Path;

use impinge_files::{MeshFile, Problem, Scene, load};

const FACET: &str =
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn read(name: &str, text: &str) -> MeshFile {
    MeshFile::parse(name.as_ref(), text.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn parts_of_one_name() {
    let count = 60_000;
    let solids = format!("solid\n{FACET}endsolid\n").repeat(count);
    let file = read("solids.stl", &solids);
    assert_eq!(file.parts()[count - 1].name, format!("part.{count}"));
    let groups = format!("{TRIANGLE}{}", "o a\nf 1 2 3\n".repeat(count));
    assert_eq!(read("groups.obj", &groups).parts()[count - 1].name, format!("a.{count}"));
}

#[test]
fn numbers_that_are_taken_are_left_out() {
    let names = ["a", "a.2", "a", "a", "a.2", "", "part", ""];
    let text: String = names.iter().map(|name| format!("o {name}\nf 1 2 3\n")).collect();
    let file = read("names.obj", &format!("{TRIANGLE}{text}"));
    let found: Vec<&str> = file.parts().iter().map(|part| part.name.as_str()).collect();
    let expected = ["a", "a.2", "a.3", "a.4", "a.2.2", "part", "part.2", "part.3"];
    assert_eq!(found, expected);
    assert!(expected.iter().all(|name| file.part(name).is_some_and(|part| part.name == **name)));
}

#[test]
fn groups_of_a_large_file_have_their_own_vertices() {
    // The time for a group is proportional to its faces, independent of the number of vertices of
    // the file.
    let count = 100_000;
    let mut text = String::new();
    for index in 0..count {
        writeln!(text, "v {index} 0 0\nv {index} 1 0\nv {index} 0 1").expect("to a string");
    }
    for index in 0..count {
        writeln!(text, "g {index}\nf {} {} {}", 3 * index + 1, 3 * index + 2, 3 * index + 3)
            .expect("to a string");
    }
    let file = read("groups.obj", &text);
    assert_eq!(file.parts().len(), count);
    assert_eq!(file.parts()[7].vertices, [[7.0, 0.0, 0.0], [7.0, 1.0, 0.0], [7.0, 0.0, 1.0]]);
}

#[test]
fn lines_without_end() {
    let long = "x".repeat(32 << 20);
    let ply = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
               property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (name, text) in [
        ("name.stl", format!("solid {long}\n{FACET}endsolid\n")),
        ("name.obj", format!("o {long}\n{TRIANGLE}f 1 2 3\n")),
        ("comment.obj", format!("# {long}\n{TRIANGLE}f 1 2 3\n")),
        ("blanks.obj", format!("{TRIANGLE}f 1 2 3{}\n", long.replace('x', " "))),
        ("comment.ply", format!("ply\nformat ascii 1.0\ncomment {long}\n{ply}")),
    ] {
        assert_eq!(read(name, &text).parts()[0].triangles.len(), 1, "{name}");
    }
    for (name, text) in [
        ("word.stl", format!("solid a\n{long}\nendsolid\n")),
        ("word.obj", format!("v {long} 0 0\n")),
        ("word.ply", format!("ply\n{long}\n")),
        ("value.ply", format!("ply\nformat ascii 1.0\n{ply}").replace("1 0 0", &long)),
    ] {
        let error = MeshFile::parse(name.as_ref(), text.as_bytes()).expect_err("no number");
        let Problem::Syntax(message) = &*error.problem else { panic!("{error}") };
        assert!(message.len() < 1000 && error.to_string().len() < 1000, "{name} is quoted whole");
    }
}

/// Returns the URDF text of a robot with these links and joints.
fn robot(links: impl Iterator<Item = String>, joints: impl Iterator<Item = String>) -> String {
    format!(
        "<robot name=\"r\">\n{}{}</robot>",
        links.collect::<String>(),
        joints.collect::<String>()
    )
}

fn ball(index: usize) -> String {
    format!(
        "<link name=\"l{index}\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link>\n"
    )
}

fn bare(index: usize) -> String {
    format!("<link name=\"l{index}\"/>\n")
}

fn joint(index: usize, parent: usize, more: &str) -> String {
    let child = index + 1;
    format!(
        "<joint name=\"j{index}\" type=\"prismatic\"><parent link=\"l{parent}\"/><child link=\"l{child}\"/>
        <axis xyz=\"1 0 0\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/>{more}</joint>\n"
    )
}

fn write(folder: &Path, urdf: &str) -> std::path::PathBuf {
    let path = folder.join("robot.urdf");
    fs::write(&path, urdf).expect("it is written");
    path
}

#[test]
fn pairs_of_an_srdf_file() {
    let folder = tempfile::tempdir().expect("a folder");
    write(folder.path(), &robot((0..20).map(ball), (0..19).map(|index| joint(index, 0, ""))));
    let pair = |index: usize| {
        let (link1, link2) = (index % 20, index / 20 % 20);
        format!("<disable_collisions link1=\"l{link1}\" link2=\"l{link2}\" reason=\"Never\"/>\n")
    };
    let pairs: String = (0..150_000).map(pair).collect();
    let text = r#"{"dimension": 3, "robots": [{"urdf": "robot.urdf", "srdf": "robot.srdf"}]}"#;
    let scene = || Scene::from_json(folder.path().join("scene.json"), text);
    fs::write(folder.path().join("robot.srdf"), format!("<robot name=\"r\">\n{pairs}</robot>"))
        .expect("it is written");
    assert_eq!(scene().expect("a scene").names().len(), 20);
    let last = "<disable_collisions link1=\"l0\" link2=\"nobody\"/>";
    fs::write(
        folder.path().join("robot.srdf"),
        format!("<robot name=\"r\">\n{pairs}{last}</robot>"),
    )
    .expect("it is written");
    let error = scene().expect_err("no such link");
    assert_eq!(
        (error.line, error.problem),
        (Some(150_002), Box::new(Problem::UnknownLink("nobody".into())))
    );
}

#[test]
fn chains_of_joints_that_mimic() {
    let folder = tempfile::tempdir().expect("a folder");
    let count = 20_000;
    let mimic = |index: usize| match index {
        0 => String::new(),
        _ => format!("<mimic joint=\"j{}\" multiplier=\"-1\" offset=\"0.5\"/>", index - 1),
    };
    let joints = (0..count).map(|index| joint(index, 0, &mimic(index)));
    let path = write(folder.path(), &robot((0..=count).map(bare), joints));
    let scene = load(&path).expect("a robot");
    assert_eq!(scene.joints_beyond_limits(), [], "0 and 0.5 by turns");
    let text = r#"{"dimension": 3, "robots": [{"urdf": "robot.urdf", "joints": {"j0": 2}}]}"#;
    let scene = Scene::from_json(folder.path().join("scene.json"), text).expect("a scene");
    let beyond = scene.joints_beyond_limits();
    assert_eq!(beyond.len(), count, "2 and -1.5 by turns");
    assert!(beyond.iter().all(|joint| [2.0, -1.5].contains(&joint.value)));
    // Each joint follows the joint before it, and the first joint follows the last: a cycle.
    let joints = (0..count).map(|index| {
        let of = (index + count - 1) % count;
        joint(index, 0, &format!("<mimic joint=\"j{of}\"/>"))
    });
    let error = load(&write(folder.path(), &robot((0..=count).map(bare), joints)));
    assert_eq!(*error.expect_err("a ring").problem, Problem::MimicCycle("j0".into()));
}

#[test]
fn links_below_a_long_chain_without_solids() {
    let folder = tempfile::tempdir().expect("a folder");
    // A link with a ball, a chain of links without shapes, and at its end many links with balls.
    // Only links without shapes lie between the first link and each of these balls, so their
    // contacts with the first ball are disabled.
    let (chain, leaves) = (20_000, 20_000);
    let links = (0..=chain + leaves)
        .map(|index| if (1..=chain).contains(&index) { bare(index) } else { ball(index) });
    let joints = (0..chain + leaves).map(|index| joint(index, index.min(chain), ""));
    let scene = load(&write(folder.path(), &robot(links, joints))).expect("one group parts them");
    assert_eq!(scene.names().len(), leaves + 1);
}

#[test]
fn elements_with_very_many_attributes() {
    let folder = tempfile::tempdir().expect("a folder");
    let attributes: String = (0..500_000).map(|index| format!(" a{index}='1'")).collect();
    let path =
        write(folder.path(), &format!("<robot name=\"r\"{attributes}><link name=\"a\"/></robot>"));
    let error = load(&path).expect_err("too many");
    assert!(
        matches!(*error.problem, Problem::TooMany { what: "attributes of an element", .. }),
        "{error}"
    );
}

#[test]
fn equals_signs_outside_of_tags_are_no_attributes() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = "=".repeat(300);
    let comment = format!("<!-- {line} -->");
    let section = format!("<gazebo><![CDATA[{line}]]></gazebo>");
    let instruction = format!("<?tool {line}?>");
    for banner in [comment, section, instruction] {
        let urdf = format!("<robot name=\"r\">{banner}<link name=\"a\"/></robot>");
        let found = load(&write(folder.path(), &urdf));
        assert!(found.is_ok(), "{banner}: {found:?}");
    }
    // Each of these ends before the element, whatever begins within it.
    let attributes: String = (0..300).map(|index| format!(" a{index}='1'")).collect();
    for before in ["<?tool <!-- ?>", "<!-- <![CDATA[ -->", "<!-- <?tool -->"] {
        let urdf = format!("{before}<robot name=\"r\"{attributes}><link name=\"a\"/></robot>");
        let error = load(&write(folder.path(), &urdf)).expect_err("too many");
        let is_counted = matches!(*error.problem, Problem::TooMany { given: 301, .. });
        assert!(is_counted, "{before}: {error:?}");
    }
}
