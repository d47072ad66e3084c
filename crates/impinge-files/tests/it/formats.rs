//! Tests that every mesh format gives the same cube, and tests the shapes and objects made of mesh
//! files.

use std::fs;

use impinge::dim3::math::{Isometry, Point};
use impinge::dim3::query::distance;
use impinge::dim3::shape::{Ball, Cuboid, ShapeHandle, TriMesh};
use impinge_files::{MeshFile, Scene, load};

use crate::cube::{gltf_sparse, obj, obj_inside_out, samples, stl_binary};

/// The byte order mark U+FEFF in UTF-8, which some editors write before a text.
const MARK: &[u8] = b"\xef\xbb\xbf";

#[test]
fn each_format_gives_the_same_solid() {
    for sample in samples() {
        let name = sample.name;
        let file = MeshFile::parse(&sample.path(), &sample.bytes)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let [part] = file.parts() else { panic!("{name}: one part, not {}", file.parts().len()) };
        let report = &part.report;
        assert_eq!((report.vertices, report.triangles), (8, 12), "{name}: welded and cut");
        assert!(report.is_solid() && report.is_clean(), "{name}: {report}");
        assert_eq!(report.volume, Some(8.0), "{name}: two to the third, outside in front");
        assert_eq!(report.components, 1, "{name}: one piece");
    }
}

#[test]
fn a_byte_order_mark_before_a_text_is_ignored() {
    for sample in samples().into_iter().filter(|sample| !sample.bytes.contains(&0)) {
        let name = sample.name;
        let marked = [MARK, sample.bytes.as_slice()].concat();
        let file = MeshFile::parse(&sample.path(), &marked)
            .unwrap_or_else(|error| panic!("{name}: {error}"));
        let [part] = file.parts() else { panic!("{name}: one part, not {}", file.parts().len()) };
        assert_eq!(part.report.volume, Some(8.0), "{name}: {}", part.report);
        assert!(part.report.is_clean(), "{name}: {}", part.report);
    }
    // The first line of an OBJ file counts.
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 1 3 4\n";
    let marked = [MARK, square.as_bytes()].concat();
    let file = MeshFile::parse("square.obj".as_ref(), &marked).expect("two triangles");
    assert_eq!(file.parts()[0].triangles.len(), 2, "no vertex is lost");
    assert!(file.parts()[0].vertices.contains(&[0.0; 3]), "{:?}", file.parts()[0].vertices);
    // The header of a binary STL file has no encoding.
    let header = [MARK, b"a header"].concat();
    let file = MeshFile::parse("cube.stl".as_ref(), &stl_binary(&header)).expect("a cube");
    assert_eq!(file.parts()[0].report.volume, Some(8.0), "all 84 bytes are skipped");
}

#[test]
fn a_byte_order_mark_before_a_scene_is_ignored() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = "\u{feff}{\"dimension\": 2, \"objects\": []}";
    assert_eq!(Scene::from_json("scene.json", text).expect("a scene").names().len(), 0);
    let path = folder.path().join("scene.json");
    fs::write(&path, text).expect("it is written");
    assert_eq!(load(&path).expect("a scene").names().len(), 0);
    let path = folder.path().join("arm.urdf");
    let robot = include_str!("../../scenes/arm.urdf");
    fs::write(&path, format!("\u{feff}{robot}")).expect("it is written");
    assert!(load(&path).expect("a robot").names().len() > 0);
    let error = Scene::from_json("scene.json", "\u{feff}{x").expect_err("no name");
    assert_eq!((error.line, error.column), (Some(1), Some(2)), "{error}");
}

#[test]
fn the_shape_is_a_box_at_every_distance() {
    let folder = tempfile::tempdir().expect("a folder");
    let cuboid = ShapeHandle::new(Cuboid::new([1.0; 3].into()));
    let at = Isometry::translation(1.0, 1.0, 1.0);
    let ball = Ball::new(0.25);
    for sample in samples() {
        let path = folder.path().join(sample.name);
        fs::write(&path, &sample.bytes).expect("it is written");
        let scene = load(&path).expect("it is a cube");
        let world = scene.collision_world::<f64, 3>().expect("of three dimensions");
        let mesh = world.collision_objects().next().expect("one object").shape().clone();
        for step in 0..40 {
            // The points lie around the cube, at increasing distances.
            let (angle, far) = (f64::from(step), 2.5 + 0.1 * f64::from(step));
            let point = [1.0 + far * angle.cos(), 1.0 + far * angle.sin(), 1.0 + 0.3 * angle.cos()];
            let place = Isometry::translation(point[0], point[1], point[2]);
            let [of_mesh, of_cuboid] = [
                distance(&Isometry::identity(), &*mesh, &place, &ball),
                distance(&at, &*cuboid, &place, &ball),
            ];
            assert!((of_mesh - of_cuboid).abs() < 1e-12, "{}: {of_mesh} {of_cuboid}", sample.name);
        }
    }
}

#[test]
fn a_solid_has_an_inside_and_a_hull_of_it_is_convex() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("cube.obj"), obj()).expect("it is written");
    let scene = r#"{"dimension": 3, "shapes": {
        "solid": {"mesh_file": {"path": "cube.obj", "as": "solid", "scale": [-0.5, 1, 1]}},
        "hull": {"mesh_file": {"path": "cube.obj", "as": "convex_hull"}},
        "parts": {"mesh_file": {"path": "cube.obj", "as": "convex_parts", "part": "cube"}}
    }}"#;
    let scene = Scene::from_json(folder.path().join("scene.json"), scene).expect("a scene");
    let solid = scene.shape::<f64, 3>("solid").expect("it is closed");
    let mesh = solid.as_shape::<TriMesh<f64>>().expect("a mesh");
    assert!(mesh.is_one_sided() && mesh.is_volume(), "mirrored, and turned back");
    assert_eq!(mesh.encloses(&Point::new(-0.5, 1.0, 1.0)), Some(true), "within");
    assert_eq!(mesh.encloses(&Point::new(0.5, 1.0, 1.0)), Some(false), "on the other side");
    let [hull, parts] =
        ["hull", "parts"].map(|name| scene.shape::<f64, 3>(name).expect("it spans space"));
    let place = Isometry::translation(4.0, 1.0, 1.0);
    for shape in [hull, parts] {
        let gap = distance(&Isometry::identity(), &*shape, &place, &Ball::new(0.5));
        assert!((gap - 1.5).abs() < 1e-12, "4 - 2 - 0.5, not {gap}");
    }
}

#[test]
fn a_room_keeps_its_fronts_unless_it_shall_be_solid() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("room.obj"), obj_inside_out()).expect("it is written");
    // A ball of radius 0.5 overlaps the wall x = 0 of the room by 0.1 if it is at x = 0.4 (inside)
    // or x = -0.4 (outside).
    let touches = |kind: &str, scale: [f64; 3], x: f64| {
        let text = format!(
            r#"{{"dimension": 3, "meshes": [{{"path": "room.obj", "as": "{kind}", "scale": {scale:?}}}],
            "objects": [{{"name": "ball", "shape": {{"ball": {{"radius": 0.5}}}},
                "position": {{"translation": [{x}, 1, 1]}}}}]}}"#
        );
        let scene = Scene::from_json(folder.path().join("scene.json"), &text).expect("a scene");
        let mut world = scene.collision_world::<f64, 3>().expect("a world");
        world.update();
        world.contact_manifolds().count() == 1
    };
    let plain = [1.0; 3];
    assert!(touches("one_sided", plain, 0.4) && !touches("one_sided", plain, -0.4), "from inside");
    assert!(touches("solid", plain, -0.4), "from outside");
    assert!(touches("solid", plain, 0.4) && touches("solid", plain, 1.0), "a body, not a room");
    assert!(!touches("one_sided", plain, 1.0), "a room is hollow");
    assert!(touches("surface", plain, 0.4) && touches("surface", plain, -0.4), "from both sides");
    let mirrored = [-1.0, 1.0, 1.0];
    assert!(
        touches("one_sided", mirrored, -0.4) && !touches("one_sided", mirrored, 0.4),
        "mirrored"
    );
}

#[test]
fn sparse_elements_replace_those_of_the_view() {
    // One sparse element with index 6 replaces that position of the view by the first corner.
    let text = gltf_sparse()
        .replace("\"count\": 7, \"indices\": {", "\"count\": 1, \"indices\": {\"byteOffset\": 5, ")
        .replace("\"byteOffset\": 12}}", "\"byteOffset\": 0}}, \"bufferView\": 0");
    let file = MeshFile::parse("moved.gltf".as_ref(), text.as_bytes()).expect("it can be read");
    let vertices = &file.parts()[0].vertices;
    assert_eq!(vertices.len(), 7, "two corners are one: {vertices:?}");
    // The nodes mirror the cube at the plane x = 1.
    assert!(!vertices.contains(&[0.0, 2.0, 2.0]), "corner 6 has moved to corner 0: {vertices:?}");
}

#[test]
fn groups_and_solids_become_objects() {
    let folder = tempfile::tempdir().expect("a folder");
    let two = format!("{}g second\nf 1 2 3\nf 3 4 1\no cube\nf 5 6 7\n", obj());
    fs::write(folder.path().join("two.obj"), two).expect("it is written");
    let scene = load(&folder.path().join("two.obj")).expect("three groups");
    assert_eq!(scene.names().collect::<Vec<_>>(), ["cube", "second", "cube.2"], "names are apart");
    let solids = ["a b", ""].map(|name| {
        format!(
            "solid {name}\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n\
             endfacet\nendsolid {name}\n"
        )
    });
    let file = MeshFile::parse("two.stl".as_ref(), solids.concat().as_bytes()).expect("two solids");
    let names: Vec<&str> = file.parts().iter().map(|part| part.name.as_str()).collect();
    assert_eq!(names, ["a b", "part"], "a solid without a name is a part");
}

#[test]
fn buffers_beside_a_gltf_file_are_found() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = crate::cube::gltf_text();
    let (before, rest) = text.split_once("data:").expect("a data URI");
    let (_, after) = rest.split_once('"').expect("its end");
    let glb = crate::cube::glb();
    fs::write(folder.path().join("a cube.bin"), &glb[glb.len() - 168..]).expect("it is written");
    let path = folder.path().join("cube.gltf");
    fs::write(&path, format!("{before}a%20cube.bin\"{after}")).expect("it is written");
    let file = MeshFile::read(&path).expect("the buffer is there");
    assert_eq!(file.parts()[0].report.volume, Some(8.0), "the same cube");
    fs::remove_file(folder.path().join("a cube.bin")).expect("it was there");
    let error = MeshFile::read(&path).expect_err("no buffer");
    assert!(error.to_string().contains("a%20cube.bin"), "{error} names the buffer");
}
