//! Tests which normals a filled 2D mesh admits.

use impinge::math::{Real, Vector};
use impinge::shape::{CompositeShape, FeatureId, TriMesh};

use super::{corner_at, grid, mesh, soup, surface, unit};

fn floor<N: Real>() -> TriMesh<N, 2> {
    let (vertices, triangles) = grid(3, |x, y| [x, y]);
    mesh(&vertices, &triangles)
}

/// Returns the outward normal of a side on the border of the square; `None` for an inner side.
fn border(mesh: &TriMesh<f64, 2>, part: u32, side: usize) -> Option<Vector<f64, 2>> {
    let corners = mesh.triangles()[part as usize].map(|v| mesh.vertices()[v as usize]);
    let (a, b) = (corners[side], corners[(side + 1) % 3]);
    let on = |axis: usize, at: f64| a[axis] == at && b[axis] == at;
    let normals = [(0, 0.0, [-1.0, 0.0]), (0, 3.0, [1.0, 0.0]), (1, 0.0, [0.0, -1.0])];
    let all = normals.into_iter().chain([(1, 3.0, [0.0, 1.0])]);
    all.into_iter().find(|&(axis, at, _)| on(axis, at)).map(|(.., normal)| unit(normal))
}

#[test]
fn only_the_border_of_a_filled_square_has_normals() {
    let mixed = floor::<f64>();
    let (vertices, triangles) = grid(3, |x, y| [x, y]);
    let turned: Vec<_> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
    for mesh in [soup(&mixed), mesh(&vertices, &turned), mixed] {
        for part in 0..mesh.num_parts() {
            for side in 0..3 {
                let expected = border(&mesh, part, side);
                let face = FeatureId::Face(u32::try_from(side).expect("three"));
                for normal in [[0.0, 1.0], [0.0, -1.0], [1.0, 0.0], [-1.0, 0.0], [1.0, -1.0]] {
                    let normal = unit(normal);
                    let found = surface(&mesh).admits(part, face, &normal);
                    assert_eq!(found, expected == Some(normal), "{part} {face:?} {normal:?}");
                }
            }
        }
    }
}

#[test]
fn corners_of_a_filled_square() {
    let floor = floor::<f64>();
    for part in 0..floor.num_parts() {
        for (at, vertex) in (0..).zip(floor.triangles()[part as usize]) {
            let corner = floor.vertices()[vertex as usize];
            let admits =
                |x: f64, y: f64| surface(&floor).admits(part, FeatureId::Vertex(at), &unit([x, y]));
            let is_top_right = corner.x == 3.0 && corner.y == 3.0;
            assert_eq!(admits(1.0, 1.0), is_top_right, "{corner}: outwards");
            assert_eq!(admits(1.0, 0.01), is_top_right, "{corner}: outwards");
            assert!(!admits(0.01, 1.0) || is_top_right, "{corner}: a little to the right");
            let is_inside = corner.iter().all(|&x| x > 0.0 && x < 3.0);
            assert!(!(is_inside && admits(0.0, 1.0)), "{corner}: inside");
            let has_top = (0..3).any(|side| border(&floor, part, side) == Some(unit([0.0, 1.0])));
            if corner.y == 3.0 && corner.x < 3.0 && corner.x > 0.0 {
                assert_eq!(admits(0.0, 1.0), has_top, "{corner}: as a face");
            }
        }
    }
}

#[test]
fn a_hollow_corner_has_only_the_normals_of_its_sides() {
    let vertices = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    let angle = mesh::<f32, 2>(&vertices, &[[0, 1, 3], [1, 2, 3], [0, 3, 4], [0, 4, 5]]);
    for part in 0..4 {
        if !angle.triangles()[part as usize].contains(&3) {
            continue;
        }
        let corner = corner_at(&angle, part, [1.0, 1.0]);
        let admits = |x: f64, y: f64| surface(&angle).admits(part, corner, &unit([x, y]));
        assert!(!admits(1.0, 1.0) && !admits(1.0, 0.2) && !admits(-1.0, 1.0), "{part}");
        assert_eq!(admits(0.0, 1.0), part == 1, "{part}: the top of the foot");
        assert_eq!(admits(1.0, 0.0), part == 2, "{part}: the side of the back");
    }
}

#[test]
fn snapping_finds_the_border_in_reach() {
    let floor = floor::<f64>();
    let whole = surface(&floor);
    // The last square: its first triangle is at the right border, its second triangle at the top.
    let snapped = |part, x, y| whole.snapped(part, &unit([x, y]));
    assert_eq!(snapped(17, 0.5, 1.0), Some(unit([0.0, 1.0])), "on top");
    assert_eq!(snapped(16, 0.5, 1.0), Some(unit([1.0, 0.0])), "its only border");
    assert_eq!(snapped(16, -0.5, 1.0), None, "not against the normal");
    assert_eq!(snapped(8, 0.0, 1.0), None, "inside");
    assert!(whole.faces(8, &impinge::math::Point::<f64, 2>::new(9.0, 9.0)), "always");
}

#[test]
fn a_filler_without_area_is_no_border() {
    let vertices = [[0.0, 0.0], [2.0, 0.0], [1.0, 2.0], [1.0, 0.0], [0.0, -2.0], [2.0, -2.0]];
    let triangles = [[0, 1, 2], [0, 3, 1], [0, 4, 3], [3, 4, 5], [3, 5, 1]];
    let filled = mesh::<f64, 2>(&vertices, &triangles);
    let whole = surface(&filled);
    for (part, feature) in [(0, 0), (2, 2), (4, 2)] {
        for y in [-1.0, 1.0] {
            let found = whole.admits(part, FeatureId::Face(feature), &unit([0.0, y]));
            assert!(!found, "{part}: {y}");
        }
    }
    for part in 1..5 {
        let corner = corner_at(&filled, part, [1.0, 0.0]);
        assert!(!whole.admits(part, corner, &unit([0.0, 1.0])), "{part}: the first is above");
    }
}

#[test]
fn two_layers_have_the_border_of_one() {
    let once = [[0.0, 0.0], [2.0, 0.0], [1.0, 2.0]];
    let twice = mesh::<f64, 2>(&once, &[[0, 1, 2], [0, 1, 2]]);
    assert!(surface(&twice).admits(0, FeatureId::Face(0), &unit([0.0, -1.0])), "below");
    assert!(surface(&twice).admits(1, FeatureId::Vertex(2), &unit([0.0, 1.0])), "the tip");
}

#[test]
fn internal_sides_may_be_kept() {
    let floor = floor::<f32>().with_internal_edges_kept();
    assert!(floor.surface().is_none(), "triangles on their own");
}
