//! Tests a mesh file with 10 000 parts.

use core::fmt::Write as _;

use serde_json::json;

use crate::support::Desk;

/// The number of parts along each side of the square.
const SIDE: usize = 100;
/// The sides of a cube: the first corner of each side and its two directions, counter-clockwise
/// seen from outside.
const SIDES: [[[usize; 3]; 3]; 6] = [
    [[0, 0, 0], [0, 1, 0], [1, 0, 0]],
    [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
    [[0, 0, 0], [1, 0, 0], [0, 0, 1]],
    [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
    [[0, 0, 0], [0, 0, 1], [0, 1, 0]],
    [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
];

/// Writes a unit cube of 12 triangles with its lowest corner at `at`. `first` is the index of its
/// first vertex. Returns the number of vertices.
fn write_cube(text: &mut String, at: [f64; 3], first: usize) -> usize {
    let mut vertices = 0;
    for [start, along, up] in SIDES {
        let corner = first + vertices;
        for [row, column] in [[0, 0], [0, 1], [1, 0], [1, 1]] {
            let x = |axis: usize| {
                at[axis] + (start[axis] + along[axis] * column + up[axis] * row) as f64
            };
            let _ = writeln!(text, "v {} {} {}", x(0), x(1), x(2));
        }
        let _ = writeln!(text, "f {corner} {} {} {}", corner + 1, corner + 3, corner + 2);
        vertices += 4;
    }
    vertices
}

/// Returns an OBJ file with a square of unit cubes, whose gaps are 1/128 along x and 1/2 along z.
fn parts() -> String {
    let (mut text, mut first) = (String::new(), 1);
    for part in 0..SIDE * SIDE {
        let (column, row) = ((part % SIDE) as f64, (part / SIDE) as f64);
        let _ = writeln!(text, "g part{part}");
        first += write_cube(&mut text, [column * (1.0 + 1.0 / 128.0), 0.0, row * 1.5], first);
    }
    text
}

#[test]
#[ignore = "takes long without optimisation"]
fn ten_thousand_parts_are_checked() {
    let desk = Desk::new();
    desk.write("parts.obj", parts());
    let report = desk.json("check parts.obj --clearance 0.01", 1);
    assert_eq!(report["objects"], SIDE * SIDE);
    assert_eq!(report["near"], (SIDE - 1) * SIDE, "neighbors along x");
    assert_eq!(
        (&report["touching"], &report["pairs"][0]["distance"]),
        (&json!(0), &json!(0.0078125))
    );
}
