//! Tests robots: joints, meshes of packages, and disabled pairs of links.

use std::f64::consts::FRAC_PI_2;
use std::fmt::Write;
use std::fs;
use std::path::Path;

use impinge::dim3::math::{Isometry, Point};
use impinge_files::{Problem, Scene, SceneWorld, load};

use crate::cube::stl_binary;

const PREFIX: &str = r#"<robot name="arm">"#;

/// Returns the world of a robot in `folder`. `more` contains further members of the robot, such as
/// joint values.
fn world(folder: &Path, urdf: &str, more: &str) -> SceneWorld<f64, 3> {
    scene(folder, urdf, more).world().unwrap_or_else(|error| panic!("{error}"))
}

fn scene(folder: &Path, urdf: &str, more: &str) -> Scene {
    fs::write(folder.join("arm.urdf"), urdf).expect("it is written");
    let text = format!(r#"{{"dimension": 3, "robots": [{{"urdf": "arm.urdf"{more}}}]}}"#);
    Scene::from_json(folder.join("scene.json"), &text).unwrap_or_else(|error| panic!("{error}"))
}

fn position(world: &SceneWorld<f64, 3>, name: &str) -> Isometry<f64> {
    let handle = world.handle(name).unwrap_or_else(|| panic!("no {name}"));
    *world.collision_object(handle).expect("it lives").position()
}

fn assert_at(world: &SceneWorld<f64, 3>, name: &str, expected: [f64; 3]) {
    let found = position(world, name).translation.vector;
    let apart = (found - Point::from(expected).coords).norm();
    assert!(apart < 1e-12, "{name} is at {found:?}, not {expected:?}");
}

/// Returns the URDF text of a link with a small ball.
fn link(name: &str) -> String {
    format!(
        r#"<link name="{name}"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>"#
    )
}

fn joint(name: &str, kind: &str, links: [&str; 2], more: &str) -> String {
    let [parent, child] = links;
    format!(
        r#"<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>
        <limit lower="-3" upper="3" effort="1" velocity="1"/>{more}</joint>"#
    )
}

#[test]
fn joints_of_all_types_move_their_links() {
    let folder = tempfile::tempdir().expect("a folder");
    let names = ["base", "turn", "spin", "slide", "weld", "float", "plane", "follow"];
    let mut urdf = PREFIX.to_owned();
    names.iter().for_each(|name| urdf += &link(name));
    let along_x = r#"<origin xyz="1 0 0"/><axis xyz="0 0 1"/>"#;
    urdf += &joint("j1", "revolute", ["base", "turn"], along_x);
    urdf += &joint("j2", "continuous", ["turn", "spin"], along_x);
    urdf +=
        &joint("j3", "prismatic", ["spin", "slide"], r#"<origin xyz="1 0 0"/><axis xyz="2 0 0"/>"#);
    urdf += &joint(
        "j4",
        "fixed",
        ["slide", "weld"],
        r#"<origin xyz="0 0 1" rpy="1.5707963267948966 0 0"/>"#,
    );
    urdf += &joint("j5", "floating", ["weld", "float"], r#"<origin xyz="0 0 1"/>"#);
    urdf += &joint("j6", "planar", ["weld", "plane"], r#"<origin xyz="0 1 0"/>"#);
    let mimic = r#"<origin xyz="0 0 0"/><axis xyz="1 0 0"/><mimic joint="j3" multiplier="-2" offset="0.5"/>"#;
    urdf += &joint("j7", "prismatic", ["base", "follow"], mimic);
    urdf += "</robot>";
    let joints = format!(r#", "joints": {{"j1": {FRAC_PI_2}, "j2": {FRAC_PI_2}, "j3": 0.5}}"#);
    let world = world(folder.path(), &urdf, &joints);
    assert_at(&world, "arm/turn", [1.0, 0.0, 0.0]);
    assert_at(&world, "arm/spin", [1.0, 1.0, 0.0]);
    assert_at(&world, "arm/slide", [-0.5, 1.0, 0.0]);
    assert_at(&world, "arm/weld", [-0.5, 1.0, 1.0]);
    // The link is rotated about z by half a turn, then about x by a quarter turn: its z axis is y
    // of the world.
    assert_at(&world, "arm/float", [-0.5, 2.0, 1.0]);
    assert_at(&world, "arm/plane", [-0.5, 1.0, 2.0]);
    assert_at(&world, "arm/follow", [-0.5, 0.0, 0.0]);
}

#[test]
fn joints_beyond_their_limits_are_placed_and_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    let links = ["base", "a", "b", "c", "d"].map(link).concat();
    let mimic = r#"<origin xyz="0 0 0"/><axis xyz="1 0 0"/><mimic joint="slide" multiplier="2"/>"#;
    let joints = [
        joint("turn", "revolute", ["base", "a"], r#"<axis xyz="0 0 1"/>"#),
        joint("slide", "prismatic", ["a", "b"], r#"<axis xyz="1 0 0"/>"#),
        joint("spin", "continuous", ["b", "c"], r#"<axis xyz="0 0 1"/>"#),
        joint("follow", "prismatic", ["base", "d"], mimic),
    ];
    let urdf = format!("{PREFIX}{links}{}</robot>", joints.concat());
    let joints = r#", "name": "r", "joints": {"turn": -3, "slide": 2.5, "spin": 100}"#;
    let scene = scene(folder.path(), &urdf, joints);
    let found = scene.joints_beyond_limits().iter().map(ToString::to_string);
    let expected = ["the joint follow of r is at 5, outside its limits -3 to 3"];
    assert_eq!(
        found.collect::<Vec<_>>(),
        expected,
        "limits count as within, continuous joints have none"
    );
    assert_at(&scene.world().expect("a world"), "r/d", [5.0, 0.0, 0.0]);
}

/// Returns the URDF text of an arm with six axes, whose links are meshes of a package.
fn six_axes(folder: &Path) -> String {
    let meshes = folder.join("arm_description/meshes");
    fs::create_dir_all(&meshes).expect("it is made");
    fs::create_dir_all(folder.join("arm_description/urdf")).expect("it is made");
    let mut urdf = String::from("<?xml version=\"1.0\"?>\n<robot name=\"six\">\n");
    for index in 0..7 {
        fs::write(meshes.join(format!("link{index}.stl")), stl_binary(b"link"))
            .expect("it is written");
        // The scaled and translated cube is a box of 0.1 x 0.1 x 0.3 around the z axis.
        writeln!(
            urdf,
            r#"<link name="link{index}"><collision><origin xyz="-0.05 -0.05 0"/><geometry>
            <mesh filename="package://arm_description/meshes/link{index}.stl" scale="0.05 0.05 0.15"/>
            </geometry></collision></link>"#
        )
        .expect("to a string");
    }
    for index in 0..6 {
        let axis = if index % 2 == 0 { "0 0 1" } else { "0 1 0" };
        let more = format!(r#"<origin xyz="0 0 0.3"/><axis xyz="{axis}"/>"#);
        let links = [format!("link{index}"), format!("link{}", index + 1)];
        let links = [links[0].as_str(), links[1].as_str()];
        urdf += &joint(&format!("joint{}", index + 1), "revolute", links, &more);
    }
    urdf + "</robot>\n"
}

#[test]
fn a_six_axis_arm_with_meshes() {
    let folder = tempfile::tempdir().expect("a folder");
    let urdf = six_axes(folder.path());
    let path = folder.path().join("arm_description/urdf/six.urdf");
    fs::write(&path, &urdf).expect("it is written");
    fs::write(folder.path().join("arm_description/package.xml"), "<package/>")
        .expect("it is written");
    let upright = load(&path).expect("the package is found above the file");
    assert_eq!(upright.names().len(), 7, "the links");
    assert_eq!(upright.mesh_files().count(), 7, "their meshes");
    let mut world = upright.world::<f64, 3>().expect("a world");
    world.step(0.0).expect("nothing moves");
    assert_eq!(world.contact_manifolds().count(), 0, "links touch their neighbors alone");
    let top = position(&world, "six/link6") * Point::new(0.05, 0.05, 0.3);
    assert!((top - Point::new(0.0, 0.0, 2.1)).norm() < 1e-12, "seven links on each other: {top}");

    // Joints 2 and 4 are bent by 170 degrees, so link 2 lies beside link 1 and reaches link 0.
    let folder = folder.path();
    let fold = r#", "packages": ["."], "name": "r", "joints": {"joint2": 2.967, "joint4": 2.967}"#;
    let mut folded: SceneWorld<f64, 3> = scene(folder, &urdf, fold).world().expect("a world");
    folded.step(0.0).expect("nothing moves");
    let pairs: Vec<[String; 2]> =
        folded.contact_manifolds().map(|(a, b, _)| [a.data().clone(), b.data().clone()]).collect();
    assert!(pairs.contains(&["r/link0".to_owned(), "r/link2".to_owned()]), "{pairs:?}");
    let index = |name: &str| name.trim_start_matches("r/link").parse::<usize>().expect("a number");
    assert!(pairs.iter().all(|[a, b]| index(a).abs_diff(index(b)) > 1), "no neighbors: {pairs:?}");
}

#[test]
fn disabled_pairs_and_links_without_solids() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    // All balls overlap. A joint connects a and b; b and c are connected through a link without a
    // shape; the SRDF file disables a and d.
    let bare = r#"<link name="bare"/>"#;
    let links = [link("a"), link("b"), bare.to_owned(), link("c"), link("d")].concat();
    let joints = [
        joint("1", "fixed", ["a", "b"], ""),
        joint("2", "fixed", ["b", "bare"], ""),
        joint("3", "fixed", ["bare", "c"], ""),
        joint("4", "fixed", ["c", "d"], ""),
    ];
    let urdf = format!("{PREFIX}{links}{}</robot>", joints.concat());
    let srdf = "<robot name=\"arm\">\n<disable_collisions link1=\"a\" link2=\"d\" reason=\"Never\"/>\n</robot>";
    fs::write(folder.join("arm.srdf"), srdf).expect("it is written");
    let mut world = world(folder, &urdf, r#", "srdf": "arm.srdf""#);
    world.step(0.0).expect("nothing moves");
    let pairs = world.contact_manifolds().map(|(a, b, _)| format!("{} {}", a.data(), b.data()));
    let mut pairs: Vec<String> = pairs.collect();
    pairs.sort_unstable();
    assert_eq!(pairs, ["arm/a arm/c", "arm/b arm/d"], "the others are kept apart");

    fs::write(folder.join("arm.srdf"), srdf.replace("\"d\"", "\"e\"")).expect("it is written");
    let text = r#"{"dimension": 3, "robots": [{"urdf": "arm.urdf", "srdf": "arm.srdf"}]}"#;
    let error = Scene::from_json(folder.join("scene.json"), text).expect_err("no link e");
    assert_eq!(*error.problem, Problem::UnknownLink("e".to_owned()), "{error}");
    assert_eq!((error.line, error.file.ends_with("arm.srdf")), (Some(2), true), "{error}");
}

#[test]
fn links_meet_what_is_around_them() {
    let folder = tempfile::tempdir().expect("a folder");
    let links = [link("a"), link("b")].concat();
    let urdf = format!("{PREFIX}{links}{}</robot>", joint("1", "fixed", ["a", "b"], ""));
    fs::write(folder.path().join("arm.urdf"), urdf).expect("it is written");
    let ball = r#""shape": {"ball": {"radius": 1}}"#;
    let text = format!(
        r#"{{"dimension": 3, "robots": [{{"urdf": "arm.urdf"}}], "objects": [
        {{"name": "plain", {ball}}}, {{"name": "grouped", {ball}, "groups": {{"membership": [29], "whitelist": [5]}}}}]}}"#
    );
    let scene = Scene::from_json(folder.path().join("scene.json"), &text).expect("a scene");
    let mut world = scene.collision_world::<f64, 3>().expect("a world");
    world.update();
    let pairs = world.contact_manifolds().map(|(a, b, _)| format!("{} {}", a.data(), b.data()));
    let mut pairs: Vec<String> = pairs.collect();
    pairs.sort_unstable();
    let expected =
        ["grouped arm/a", "grouped arm/b", "plain arm/a", "plain arm/b", "plain grouped"];
    assert_eq!(pairs, expected, "only the links are kept apart, whatever groups others have");
}

/// Asserts that a robot with so many links that its pairs need all groups is refused: without a
/// group of its own, an object beside it would touch nothing.
#[test]
fn a_group_is_left_for_what_is_around() {
    let folder = tempfile::tempdir().expect("a folder");
    let open = |links: usize| {
        let names: Vec<String> = (0..links).map(|index| format!("l{index}")).collect();
        let joint_of = |at: &[String]| joint(&at[0], "fixed", [&at[0], &at[1]], "");
        let joints: String = names.windows(2).map(joint_of).collect();
        let links: String = names.iter().map(|name| link(name)).collect();
        let urdf = format!("{PREFIX}{links}{joints}</robot>");
        fs::write(folder.path().join("arm.urdf"), urdf).expect("it is written");
        let text = r#"{"dimension": 3, "robots": [{"urdf": "arm.urdf"}],
            "objects": [{"name": "floor", "shape": {"ball": {"radius": 1}}}]}"#;
        Scene::from_json(folder.path().join("scene.json"), text)
    };
    let mut world = open(59).expect("a scene").collision_world::<f64, 3>().expect("a world");
    world.update();
    let floor = |name: &str| name == "floor";
    let met = world.contact_manifolds().filter(|(a, b, _)| floor(a.data()) || floor(b.data()));
    assert_eq!(met.count(), 59, "the floor meets each link");
    let error = open(60).expect_err("30 groups are needed");
    assert!(matches!(*error.problem, Problem::TooMany { limit: 29, .. }), "{error}");
}

#[test]
fn what_a_robot_looks_like_refuses_none() {
    let folder = tempfile::tempdir().expect("a folder");
    let looks =
        r#"<visual><geometry><mesh/></geometry><material name="ä"><texture/></material></visual>"#;
    let shown = link("base").replace("<collision>", &format!("{looks}<collision>"));
    let urdf = format!(r#"{PREFIX}<material name="red"><texture/></material>{shown}</robot>"#);
    assert_at(&world(folder.path(), &urdf, ""), "arm/base", [0.0; 3]);
}

#[test]
fn broken_robots_are_refused_with_the_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.urdf");
    let two = format!("{PREFIX}\n{}\n{}\n", link("a"), link("b"));
    let fixed = |name: &str, links: [&str; 2]| joint(name, "fixed", links, "");
    let slide = |name: &str, of: &str, links: [&str; 2]| {
        joint(name, "prismatic", links, &format!(r#"<axis xyz="1 0 0"/><mimic joint="{of}"/>"#))
    };
    let links = ["a", "b"];
    let chain = |of: &str| {
        let [first, second] = [slide("1", "2", links), slide("2", of, ["b", "c"])];
        format!("{two}{}\n{first}\n{second}", link("c"))
    };
    let cases = [
        (format!("{two}{}", fixed("1", ["a", "c"])), Some(4), Problem::UnknownLink("c".to_owned())),
        (two.clone(), Some(3), Problem::NotATree { link: "b".to_owned() }),
        (
            format!("{two}{}\n{}", fixed("1", links), fixed("2", ["b", "a"])),
            Some(2),
            Problem::NotATree { link: "a".to_owned() },
        ),
        (format!("{two}{}", slide("1", "1", links)), Some(4), Problem::MimicCycle("1".to_owned())),
        (
            format!("{two}{}", slide("1", "2", links)),
            Some(4),
            Problem::UnknownJoint("2".to_owned()),
        ),
        // The first joint is right: the second mimics itself, or a joint that does not exist.
        (chain("2"), Some(7), Problem::MimicCycle("2".to_owned())),
        (chain("3"), Some(7), Problem::UnknownJoint("3".to_owned())),
    ];
    for (urdf, line, problem) in cases {
        fs::write(&path, format!("{urdf}</robot>")).expect("it is written");
        let error = load(&path).expect_err("it is broken");
        assert_eq!(*error.problem, problem, "{error}");
        assert_eq!((error.line, &error.file), (line, &path), "{error}");
    }
    let negative = link("a").replace("0.1", "-0.1");
    fs::write(&path, format!("{PREFIX}\n{negative}</robot>")).expect("it is written");
    let error = load(&path).expect_err("no radius");
    assert_eq!(error.line, Some(2), "{error}");
    assert!(error.to_string().contains("the radius is -0.1, below zero"), "{error}");
    let nested = "<a>".repeat(100_000) + &"</a>".repeat(100_000);
    fs::write(&path, format!("{PREFIX}{nested}</robot>")).expect("it is written");
    assert!(load(&path).is_err(), "nested too deep");
}

#[test]
fn joints_and_packages_that_do_not_exist() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let urdf = format!(
        "{PREFIX}{}{}{}</robot>",
        link("a"),
        link("b"),
        joint("1", "fixed", ["a", "b"], "")
    );
    fs::write(folder.join("arm.urdf"), &urdf).expect("it is written");
    let text =
        "{\"dimension\": 3, \"robots\": [{\"urdf\": \"arm.urdf\",\n \"joints\": {\"1\": 0.5}}]}";
    let error = Scene::from_json(folder.join("scene.json"), text).expect_err("it is fixed");
    assert_eq!(*error.problem, Problem::UnknownJoint("1".to_owned()), "{error}");
    assert_eq!((error.line, error.path.as_str()), (Some(2), "robots[0].joints.1"), "{error}");
    let mesh = urdf.replacen(
        "<sphere radius=\"0.1\"/>",
        "<mesh filename=\"package://nowhere/a.stl\"/>",
        1,
    );
    fs::write(folder.join("arm.urdf"), mesh).expect("it is written");
    let error = load(&folder.join("arm.urdf")).expect_err("no package");
    assert_eq!(*error.problem, Problem::UnknownPackage("nowhere".to_owned()), "{error}");
}
