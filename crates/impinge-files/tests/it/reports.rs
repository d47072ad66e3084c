//! Tests the reports of mesh defects and their positions in the file.

use impinge_files::{Defect, Defects, MeshFile, MeshReport, Problem};

fn report(name: &str, text: &str) -> MeshReport {
    let file = MeshFile::parse(name.as_ref(), text.as_bytes());
    file.unwrap_or_else(|error| panic!("{error}")).parts()[0].report.clone()
}

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

#[test]
fn each_defect_is_counted_and_has_its_line() {
    let text = format!(
        "{SQUARE}v 1 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 9\nf 1 3 5\nf 1 2 6\nf 2 3 1\nf 1 4 3\nf 1 2\nf 0 1 2\n"
    );
    let report = report("broken.obj", &text);
    let at = |index, line| Defect { index, line: Some(line) };
    let lines =
        |defects: &Defects| defects.first.iter().map(|defect| defect.line).collect::<Vec<_>>();
    assert_eq!(lines(&report.out_of_range), [Some(8), Some(14)], "9 of 6, and 0");
    assert_eq!(report.degenerate.first, [at(1, 9)], "3 and 5 are one position");
    assert_eq!(report.duplicate_triangles.first, [at(3, 11)], "1 2 3 again");
    assert_eq!(report.non_finite_vertices.count, 1, "the sixth");
    assert_eq!(report.duplicate_vertices.count, 1, "the fifth");
    assert_eq!(report.inconsistent_edges.first, [at(0, 7)], "1 3 is run along twice");
    assert_eq!((report.triangles, report.boundary_edges.count), (2, 4), "a square is left");
    assert!(!report.is_clean() && !report.is_closed() && report.volume.is_none(), "{report}");
    assert!(report.to_string().contains("dropped: 1 (line 9)"), "{report}");
}

#[test]
fn edges_of_three_triangles_and_pieces_are_counted() {
    let fin = format!("{SQUARE}v 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n");
    let report1 = report("fin.obj", &fin);
    assert_eq!((report1.non_manifold_edges.count, report1.components), (1, 1), "{report1}");
    let pieces = format!("{SQUARE}v 5 0 0\nv 6 0 0\nv 6 1 0\nf 1 2 3 4\nf 5 6 7\n");
    assert_eq!(report("pieces.obj", &pieces).components, 2, "they share no edge");
}

#[test]
fn a_surface_inside_out_has_a_negative_volume() {
    let report = report("turned.obj", &crate::cube::obj_inside_out());
    assert_eq!(report.volume, Some(-8.0), "{report}");
    assert!(report.to_string().contains("inside out, volume 8"), "{report}");
}

#[test]
fn a_concave_polygon_is_cut_within_its_outline() {
    // An L-shaped polygon of area 3, in a tilted plane.
    let l = "v 0 0 0\nv 2 0 0\nv 2 1 1\nv 1 1 1\nv 1 2 2\nv 0 2 2\nf 1 2 3 4 5 6\n";
    let file = MeshFile::parse("l.obj".as_ref(), l.as_bytes()).expect("an L");
    let part = &file.parts()[0];
    assert_eq!((part.triangles.len(), part.report.polygons), (4, 1), "six corners");
    let cross = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|corner| part.vertices[corner as usize]);
        let [u, v] = [b, c].map(|p| [0, 1, 2].map(|axis| p[axis] - a[axis]));
        [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    };
    let sum =
        part.triangles.iter().map(cross).fold([0.0; 3], |sum, n| [0, 1, 2].map(|k| sum[k] + n[k]));
    assert_eq!(sum, [0.0, -6.0, 6.0], "twice the area in z, all in the direction of the outline");
    let areas = part.triangles.iter().map(|corners| cross(corners)[2]);
    assert!(
        areas.clone().all(|area| area > 0.0),
        "none is turned: {:?}",
        areas.collect::<Vec<_>>()
    );
}

#[test]
fn nothing_left_is_an_error() {
    for text in ["", "v 0 0 0\n", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "hello\n"] {
        let error =
            MeshFile::parse("empty.obj".as_ref(), text.as_bytes()).expect_err("no triangle");
        assert_eq!(*error.problem, Problem::EmptyMesh, "{text:?}");
    }
}

#[test]
fn an_error_of_a_parser_has_the_line() {
    let cases = [
        ("a.obj", "v 0 0 0\nv 1 x 0\n".to_owned(), 2),
        ("b.obj", format!("{SQUARE}f 1 2 3\nf 1 2 three\n"), 6),
        ("c.stl", crate::cube::stl_text().replacen("vertex 2 2 0", "vertex 2 two 0", 1), 6),
        ("d.stl", crate::cube::stl_text().replacen("endloop", "end", 1), 7),
        ("e.ply", crate::cube::ply_text().replacen("2 2 0 255", "2 y 0 255", 1), 14),
    ];
    for (name, text, line) in cases {
        let error = MeshFile::parse(name.as_ref(), text.as_bytes()).expect_err(name);
        assert_eq!(error.line, Some(line), "{error}");
        assert!(matches!(*error.problem, Problem::Syntax(_)), "{error:?}");
    }
}

#[test]
fn both_forms_of_stl_drop_facets_that_are_not_finite() {
    let facet = "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1e39 0 0\nvertex nan 1 0\nendloop\nendfacet\n";
    let text = crate::cube::stl_text().replace("endsolid", &format!("{facet}endsolid"));
    let mut binary = crate::cube::stl_binary(b"x");
    binary[80] += 1;
    binary.extend([0; 12]);
    let corners = [0.0, 0.0, 0.0, f32::INFINITY, 0.0, 0.0, f32::NAN, 1.0, 0.0];
    binary.extend(corners.iter().flat_map(|x| x.to_le_bytes()));
    binary.extend([0; 2]);
    let whole = report("cube.stl", &crate::cube::stl_text());
    for bytes in [text.as_bytes(), &binary] {
        let file = MeshFile::parse("broken.stl".as_ref(), bytes).expect("one bad facet");
        let report = &file.parts()[0].report;
        assert_eq!(report.non_finite_vertices.count, 2, "{report}");
        assert_eq!((report.triangles, report.volume), (whole.triangles, whole.volume), "{report}");
    }
}
