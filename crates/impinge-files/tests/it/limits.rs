//! Tests that files that would need too much memory or time are refused ([`Limits`]), and that data
//! used several times are read and stored once.

use std::fs::{self, File};
use std::path::Path;

use impinge_files::{Limit, Limits, MeshFile, Problem, ReadOptions, Scene, load, load_with};

use crate::cube::{glb_with, gltf_with, obj};

/// Returns the default options for reading, but with these limits.
fn limited(limits: Limits) -> ReadOptions {
    ReadOptions::new().with_limits(limits)
}

fn assert_beyond<T>(found: Result<T, impinge_files::FileError>, expected: Limit) {
    let error = found.err().expect("beyond a limit");
    assert!(
        matches!(*error.problem, Problem::Limit { limit, .. } if limit == expected),
        "{error:?}"
    );
    assert!(error.to_string().contains(&format!("`Limits::{}`", expected.name())), "{error}");
}

/// Returns a glTF file with `nodes` nodes that use the same mesh. The mesh has `primitives`
/// primitives with the same accessors.
fn instances(nodes: usize, primitives: usize) -> String {
    let node = "{\"mesh\": 0}";
    let two = "{\"scale\": [-1, 1, 1], \"children\": [1]}, {\"name\": \"cube\", \"mesh\": 0, \"translation\": [-2, 0, 0]}";
    let primitive = "{\"attributes\": {\"POSITION\": 0}, \"indices\": 1}";
    let all: Vec<String> = (0..nodes).map(|node| node.to_string()).collect();
    gltf_with("")
        .replace(two, &vec![node; nodes].join(","))
        .replace("{\"nodes\": [0]}", &format!("{{\"nodes\": [{}]}}", all.join(",")))
        .replace(primitive, &vec![primitive; primitives].join(","))
}

#[test]
fn nodes_and_primitives_of_one_mesh_count_each() {
    let path = Path::new("many.gltf");
    let few = MeshFile::parse(path, instances(50, 1).as_bytes()).expect("fifty cubes");
    assert_eq!(few.parts().len(), 50, "each is a part");
    let read = |nodes, primitives| MeshFile::parse(path, instances(nodes, primitives).as_bytes());
    // A cube has 8 vertices and 36 corners.
    assert_beyond(read(120_000, 1), Limit::Elements);
    assert_beyond(read(100, 2000), Limit::Elements);
    let shared = read(1, 1000).expect("36 000 corners of the 8 vertices");
    assert_eq!(shared.parts()[0].report.duplicate_vertices.count, 0, "primitives share vertices");
    assert_eq!(shared.parts()[0].report.duplicate_triangles.count, 12 * 999);
}

#[test]
fn a_limit_can_be_raised_and_lowered() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("many.gltf");
    let text = instances(200, 1);
    fs::write(&path, &text).expect("it is written");
    let read =
        |elements| MeshFile::read_with(&path, &limited(Limits { elements, ..Limits::default() }));
    assert_eq!(read(200 * 44).expect("as many as there are").parts().len(), 200);
    assert_beyond(read(200 * 44 - 1), Limit::Elements);
    let bytes = Limits { bytes: text.len(), ..Limits::default() };
    assert!(MeshFile::read_with(&path, &limited(bytes)).is_ok());
    let bytes = Limits { bytes: text.len() - 1, ..Limits::default() };
    assert_beyond(MeshFile::read_with(&path, &limited(bytes)), Limit::Bytes);
}

#[test]
fn buffers_of_one_chunk_or_file_are_read_once() {
    // Twenty thousand copies of the chunk of 1 MiB would take 20 GB.
    let buffers = vec!["{\"byteLength\": 168}"; 20_000].join(",");
    let blob = MeshFile::parse("blob.glb".as_ref(), &glb_with(&buffers, 1 << 20));
    assert_eq!(blob.expect("a cube").parts()[0].triangles.len(), 12);

    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("named.gltf");
    let names = ["big.bin", "./big.bin", "%62ig.bin", "x/../big.bin"];
    fs::create_dir(folder.path().join("x")).expect("it is made");
    let buffers =
        (0..300).map(|n| format!("{{\"uri\": \"{}\", \"byteLength\": 1000}}", names[n % 4]));
    let text = gltf_with(&format!(",{}", buffers.collect::<Vec<_>>().join(",")));
    fs::write(&path, &text).expect("it is written");
    fs::write(folder.path().join("big.bin"), vec![0; 100_000]).expect("it is written");
    let once = Limits { bytes: text.len() + 100_000, ..Limits::default() };
    assert!(MeshFile::read_with(&path, &limited(once)).is_ok(), "read once");
    let less = Limits { bytes: text.len() + 99_999, ..Limits::default() };
    assert_beyond(MeshFile::read_with(&path, &limited(less)), Limit::Bytes);
}

#[test]
fn a_file_of_any_length_is_not_read_beyond_the_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    for name in ["huge.obj", "huge.json", "huge.urdf", "huge.glb"] {
        let path = folder.path().join(name);
        // A sparse file with a length of one terabyte and no content.
        File::create(&path).and_then(|file| file.set_len(1 << 40)).expect("a sparse file");
        assert_beyond(load(&path), Limit::Bytes);
    }
}

#[test]
fn a_mesh_that_many_objects_name_is_one_shape() {
    let folder = tempfile::tempdir().expect("a folder");
    // Ten cubes with 44 elements each.
    let cubes: String =
        (0..10).map(|index| obj().replace("v 2 ", &format!("v {} ", index + 1))).collect();
    fs::write(folder.path().join("cubes.obj"), cubes).expect("it is written");
    let world = |scale: fn(usize) -> usize| {
        let objects = (0..300).map(|index| {
            let path = if index % 2 == 0 { "cubes.obj" } else { "./cubes.obj" };
            let scale = scale(index);
            format!(
                "{{\"name\": \"{index}\", \"shape\": {{\"mesh_file\": {{\"path\": \"{path}\", \"scale\": {scale}}}}}}}"
            )
        });
        let objects = objects.collect::<Vec<_>>().join(",");
        let text = format!("{{\"dimension\": 3, \"objects\": [{objects}]}}");
        let limits = Limits { elements: 50_000, ..Limits::default() };
        let path = folder.path().join("scene.json");
        let scene = Scene::from_json_with(path, &text, &limited(limits)).expect("a scene");
        scene.collision_world::<f64, 3>()
    };
    let shared = world(|_| 2).expect("one shape");
    let mut shapes = shared.collision_objects().map(|object| &**object.shape());
    let [first, second] = [shapes.next(), shapes.next()].map(|shape| shape.expect("300 objects"));
    let of_path = |index: usize| if index.is_multiple_of(2) { second } else { first };
    assert!(shapes.enumerate().all(|(index, shape)| core::ptr::addr_eq(shape, of_path(index + 1))));
    assert_beyond(world(|index| index + 1).map(|_| ()), Limit::Elements);
}

#[test]
fn objects_and_their_names_are_counted_before_they_are_made() {
    let scene = |name: &str, count: &str| {
        format!(
            "{{\"dimension\": 3, \"objects\": [{{\"name\": \"{name}\", \"shape\": {{\"ball\": {{\"radius\": 1}}}},
            \"repeat\": {{\"count\": {count}, \"spacing\": [1, 1, 1]}}}}]}}"
        )
    };
    let read = |text: &str, limits| Scene::from_json_with("a.json", text, &limited(limits));
    for count in ["[1000, 1000, 1]", "[18446744073709551615, 3, 2]", "[131073, 1, 1]"] {
        assert_beyond(read(&scene("b", count), Limits::default()), Limit::Objects);
    }
    assert_beyond(
        read(&scene(&"b".repeat(10_000), "[10000, 1, 1]"), Limits::default()),
        Limit::Names,
    );
    let more = Limits { objects: 200_000, ..Limits::default() };
    assert_eq!(read(&scene("b", "[200, 1000, 1]"), more).expect("a scene").names().len(), 200_000);
}

#[test]
fn the_name_of_a_robot_counts_for_each_link() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("arm.urdf");
    let link = |index: usize| {
        format!(
            "<link name=\"{index}\"><collision><geometry><sphere radius=\"1\"/></geometry></collision></link>"
        )
    };
    let joint = |index: usize| {
        format!(
            "<joint name=\"{index}\" type=\"fixed\"><parent link=\"0\"/><child link=\"{}\"/></joint>",
            index + 1
        )
    };
    let links: String = (0..500).map(link).chain((0..499).map(joint)).collect();
    let name = "r".repeat(200_000);
    fs::write(&path, format!("<robot name=\"{name}\">{links}</robot>")).expect("it is written");
    assert_beyond(load(&path), Limit::Names);
    let more = Limits { names: 1 << 28, ..Limits::default() };
    assert_eq!(load_with(&path, &limited(more)).expect("a robot").names().len(), 500);
}

#[test]
fn elements_without_properties_take_no_time_and_no_memory() {
    let kinds = |format: &str, count: usize| {
        let kinds: String = (0..2000).map(|kind| format!("element k{kind} {count}\n")).collect();
        format!("ply\nformat {format} 1.0\n{kinds}end_header\n")
    };
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let text = kinds(format, 60_000) + &"\n".repeat(100_000);
        let error = MeshFile::parse("kinds.ply".as_ref(), text.as_bytes()).expect_err("too many");
        assert!(matches!(*error.problem, Problem::TooMany { .. }), "{error}");
        // The file has enough bytes for this number of elements, but the elements are empty.
        let text = kinds(format, 20) + &"\n".repeat(40_000);
        let error =
            MeshFile::parse("kinds.ply".as_ref(), text.as_bytes()).expect_err("no triangle");
        assert_eq!(*error.problem, Problem::EmptyMesh, "{error}");
    }
}

#[test]
fn polygons_of_very_many_corners_are_refused() {
    let polygon = |corners: usize| {
        let vertices: String = (0..corners)
            .map(|index| format!("v {} {} 0\n", index * 7919 % 65_537, index * 104_729 % 65_521))
            .collect();
        let face: String = (1..=corners).map(|corner| format!(" {corner}")).collect();
        format!("{vertices}f{face}\n")
    };
    // Without the limit, triangulating this polygon would take too long.
    let text = polygon(1 << 20);
    let error = MeshFile::parse("star.obj".as_ref(), text.as_bytes()).expect_err("too many");
    assert_eq!(error.line, Some((1 << 20) + 1), "{error}");
    assert_beyond(MeshFile::parse("star.obj".as_ref(), text.as_bytes()), Limit::Corners);
    assert!(MeshFile::parse("star.obj".as_ref(), polygon(500).as_bytes()).is_ok());
}
