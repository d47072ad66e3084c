//! Tests files with a thousand groups and with a million triangles. To measure the time of reading
//! the latter: `cargo test --release -p impinge-files large -- --ignored --nocapture`.

use std::fmt::Write;
use std::time::Instant;

use impinge_files::{MeshFile, load};

#[test]
fn a_thousand_groups() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut text = String::new();
    for index in 0..1000 {
        writeln!(text, "g group{index}").expect("to a string");
        for [x, y, z] in crate::cube::CORNERS {
            writeln!(text, "v {} {y} {z}", x + 3.0 * index as f32).expect("to a string");
        }
        for quad in crate::cube::QUADS {
            let [a, b, c, d] = quad.map(|corner| i64::from(corner) - 8);
            writeln!(text, "f {a} {b} {c} {d}").expect("to a string");
        }
    }
    let path = folder.path().join("groups.obj");
    std::fs::write(&path, text).expect("it is written");
    let scene = load(&path).expect("a thousand cubes");
    assert_eq!(scene.names().len(), 1000, "each group is an object");
    let (_, file) = scene.mesh_files().next().expect("the file");
    assert!(file.parts().iter().all(|part| part.report.volume == Some(8.0)), "all are cubes");
    let mut world = scene.collision_world::<f64, 3>().expect("a world");
    world.update();
    assert_eq!(world.contact_events().len(), 0, "they are 1 apart");
}

#[test]
#[ignore = "takes a while without optimisation"]
#[expect(clippy::print_stdout, reason = "the times are to be read")]
fn a_million_triangles() {
    let side = 708;
    let mut text = String::new();
    for index in 0..side * side {
        let (x, z) = (index % side, index / side);
        let height = ((x * 7 + z * 13) % 17) as f64 * 0.125;
        writeln!(text, "v {x} {height} {z}").expect("to a string");
    }
    for index in 0..(side - 1) * (side - 1) {
        let corner = index / (side - 1) * side + index % (side - 1) + 1;
        writeln!(text, "f {corner} {} {}", corner + side, corner + 1).expect("to a string");
        writeln!(text, "f {} {} {}", corner + 1, corner + side, corner + side + 1)
            .expect("to a string");
    }
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("terrain.obj");
    std::fs::write(&path, text).expect("it is written");
    let start = Instant::now();
    let file = MeshFile::read(&path).expect("terrain");
    println!("read, welded and examined in {:?}", start.elapsed());
    assert_eq!(file.parts()[0].triangles.len(), 999_698, "two for each cell");
    assert_eq!(file.parts()[0].report.boundary_edges.count, 4 * (side - 1), "the outline");
    let start = Instant::now();
    let world = load(&path).expect("terrain").collision_world::<f64, 3>().expect("a world");
    println!("with the world: {:?}", start.elapsed());
    assert_eq!(world.len(), 1, "one mesh");
}
