//! Tests which meshes cannot become solid, and which properties a solid mesh keeps.

use super::{at, ball, cuboid, inverted, joined, skin, solid};
use impinge::dim2;
use impinge::math::{Point, Vector};
use impinge::query::{distance, mass_properties};
use impinge::shape::{Ball, EdgeNeighbor, MeshError, Polyline, Shape, TriMesh};

#[test]
fn a_solid_is_closed_and_the_error_names_the_edge() {
    let (corners, triangles) = cuboid::<f32>([1.0; 3], [0.0; 3]);
    let open = TriMesh::new(corners.clone(), triangles[..11].to_vec());
    let refused = open.clone().try_solid().expect_err("a triangle is missing");
    let MeshError::NotClosed { part, edge } = refused else { panic!("{refused:?}") };
    let sides = [0, 1, 2].map(|side| [side, (side + 1) % 3].map(|at| triangles[part][at]));
    let side = sides.iter().position(|&side| side == edge).expect("a side of the part");
    let part = u32::try_from(part).expect("few");
    assert_eq!(open.neighbor(part, u32::try_from(side).expect("few")), EdgeNeighbor::Border);
    let text = refused.to_string();
    assert!(
        text.contains(&format!("from vertex {} to {} of part {part}", edge[0], edge[1])),
        "{text}"
    );

    let mut turned = triangles.clone();
    turned[5].swap(0, 1);
    let refused = TriMesh::new(corners, turned).try_solid().expect_err("a triangle is turned");
    assert!(matches!(refused, MeshError::NotOriented { .. }), "{refused:?}");
}

#[test]
fn fronts_are_outside_but_in_cavities() {
    let outer = || cuboid::<f64>([2.0; 3], [0.0; 3]);
    let refused = skin(inverted(outer())).try_solid().expect_err("inside out");
    assert_eq!(refused, MeshError::InsideOut { part: 0 });
    let beside = joined(&[outer(), inverted(cuboid([1.0; 3], [9.0, 0.0, 0.0]))]);
    assert_eq!(skin(beside).try_solid().err(), Some(MeshError::InsideOut { part: 12 }));
    let hollow = joined(&[inverted(cuboid([1.0; 3], [0.5, 0.0, 0.0])), outer()]);
    assert!(skin(hollow).try_solid().is_ok(), "a cavity that comes first");
    // Two equal triangles with opposite windings are closed, although they enclose nothing.
    let sheet = TriMesh::new(outer().0, vec![[0, 1, 2], [0, 2, 1]]);
    let sheet = sheet.try_solid().expect("closed");
    assert_eq!(
        distance(&at([0.0; 3]), &sheet, &at([0.0; 3]), &Ball::new(0.5)),
        1.5,
        "the box is hollow"
    );
}

/// Returns the rotations of a list of numbers.
fn rotations<T: Copy>(list: &[T]) -> impl Iterator<Item = Vec<T>> + '_ {
    (0..list.len()).map(|by| [&list[by..], &list[..by]].concat())
}

/// Asserts that a hole flush with a wall is a cavity, and that a reversed box that touches the wall
/// from outside is none, whatever the order of their triangles and corners.
#[test]
fn pieces_that_touch_are_told_apart_in_any_order() {
    let wall = joined(&[cuboid([2.0; 3], [0.0; 3]), cuboid([2.0; 3], [8.0, 0.0, 0.0])]);
    let hole = inverted(cuboid::<f64>([0.5; 3], [1.5, 0.0, 0.0]));
    let beside = inverted(cuboid::<f64>([0.125, 0.5, 0.5], [2.125, 0.0, 0.0]));
    for ((corners, triangles), expected) in
        [(hole, None), (beside, Some(MeshError::InsideOut { part: 24 }))]
    {
        for (at, order) in (0..).zip(rotations(&triangles)) {
            let order =
                order.iter().map(|&[a, b, c]| [[a, b, c], [b, c, a], [c, a, b]][at % 3]).collect();
            let mesh = skin(joined(&[wall.clone(), (corners.clone(), order)]));
            assert_eq!(mesh.try_solid().err(), expected, "rotated by {at}");
        }
    }
}

#[test]
fn outlines_that_touch_are_told_apart_in_any_order() {
    type Line = Polyline<f64, 2>;
    let ring = |low: [f64; 2], high: [f64; 2]| [low, [high[0], low[1]], high, [low[0], high[1]]];
    let reversed = |ring: [[f64; 2]; 4]| [ring[3], ring[2], ring[1], ring[0]];
    let wall = [ring([0.0, 0.0], [4.0, 4.0]), ring([6.0, 0.0], [10.0, 4.0])].concat();
    let hole = reversed(ring([3.0, 1.5], [4.0, 2.5]));
    let beside = reversed(ring([4.0, 1.5], [4.5, 2.5]));
    for (piece, expected) in [(hole, None), (beside, Some(MeshError::InsideOut { part: 8 }))] {
        for piece in rotations(&piece) {
            let first = piece[0];
            let corners = [wall.clone(), piece].concat().into_iter().map(Point::from).collect();
            let loops = (0..12).map(|at| [at, if at % 4 == 3 { at - 3 } else { at + 1 }]);
            let line = Line::new(corners, loops.collect());
            assert_eq!(line.try_solid().err(), expected, "from {first:?}");
        }
    }
}

#[test]
#[should_panic(expected = "a solid is closed")]
fn solid_panics_where_try_solid_refuses() {
    let (corners, triangles) = cuboid::<f32>([1.0; 3], [0.0; 3]);
    let _ = TriMesh::new(corners, triangles[1..].to_vec()).solid();
}

#[test]
fn lines_name_the_vertex() {
    type Line = Polyline<f64, 2>;
    let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]].map(Point::from).to_vec();
    let segments = |list: &[[u32; 2]]| Line::new(square.clone(), list.to_vec()).try_solid().err();
    let closed = [[0, 1], [1, 2], [2, 3], [3, 0]];
    assert_eq!(segments(&closed), None);
    assert_eq!(segments(&closed[..3]), Some(MeshError::NotClosed { part: 0, edge: [0, 0] }));
    let turned = [[0, 1], [2, 1], [2, 3], [3, 0]];
    assert_eq!(segments(&turned), Some(MeshError::NotOriented { part: 0, edge: [1, 1] }));
    let clockwise = [[1, 0], [2, 1], [3, 2], [0, 3]];
    assert_eq!(segments(&clockwise), Some(MeshError::InsideOut { part: 0 }));
}

#[test]
fn what_a_solid_keeps() {
    let block = solid(cuboid::<f64>([1.0, 2.0, 3.0], [0.0; 3]));
    assert!(
        block.is_solid()
            && block.is_one_sided()
            && !skin(cuboid::<f64>([1.0; 3], [0.0; 3])).is_solid()
    );
    let mass = |mesh: &TriMesh<f64, 3>| mass_properties(mesh, 2.0).expect("closed");
    assert_eq!(mass(&block), mass(&skin(cuboid([1.0, 2.0, 3.0], [0.0; 3]))));
    let mirrored = block.try_scaled(&Vector::<f64, 3>::new(-2.0, 1.0, 1.0)).expect("no zero");
    let (here, there, probe) = (at([0.0; 3]), at([1.5, 0.0, 0.0]), Ball::new(0.125));
    assert!(mirrored.is_solid() && distance(&here, &mirrored, &there, &probe) == 0.0);
    let scaled = block.scaled(&Vector::<f64, 3>::new(2.0, 2.0, 2.0)).expect("no zero");
    assert_eq!(distance(&here, &*scaled, &there, &probe), 0.0);
    assert!(!block.clone().flipped().is_solid());
    assert!(block.clone().with_vertices_merged().is_solid());

    let mut soft = block.clone();
    let moved: Vec<_> =
        block.vertices().iter().map(|v| v + Vector::<f64, 3>::new(9.0, 0.0, 0.0)).collect();
    soft.set_vertices(&moved);
    assert!(soft.is_solid());
    assert_eq!(distance(&here, &soft, &at([9.5, 0.0, 0.0]), &probe), 0.0);
    let soup = block
        .triangles()
        .iter()
        .flatten()
        .map(|&v| block.vertices()[v as usize])
        .collect::<Vec<_>>();
    let numbers = (0..12).map(|part| [3 * part, 3 * part + 1, 3 * part + 2]).collect();
    let mut soup = TriMesh::new(soup, numbers).solid();
    assert_eq!(distance(&here, &soup, &here, &probe), 0.0, "vertices at one position are one");
    let mut torn = soup.vertices().to_vec();
    torn[0].x *= 1.5;
    soup.set_vertices(&torn);
    assert!(!soup.is_solid() && distance(&here, &soup, &here, &probe) > 0.0, "torn open");
}

#[test]
fn a_ball_mesh_of_dim2_is_filled_anyway() {
    let mesh = dim2::shape::TriMesh::<f64>::new(
        [[0.0, 0.0], [4.0, 0.0], [0.0, 4.0]].map(Point::from).to_vec(),
        vec![[0, 1, 2]],
    );
    assert!(!mesh.is_solid());
    let sphere = solid(ball::<f64>(1.0, 8));
    assert!(sphere.is_solid() && sphere.is_volume());
}

/// Asserts that a solid stays solid if a vertex that belongs to no part stays where a corner was.
#[test]
fn vertices_of_no_part_hold_nothing_together() {
    let (corners, triangles) = cuboid::<f32>([1.0; 3], [0.0; 3]);
    let named = triangles.iter().map(|corners| corners.map(|corner| corner + 1)).collect();
    let at = |x: f32| {
        let moved = corners.iter().map(|corner| corner + Vector::<f32, 3>::new(x, 0.0, 0.0));
        [corners[0]].into_iter().chain(moved).collect::<Vec<_>>()
    };
    let mut block = TriMesh::new(at(0.0), named).solid();
    block.set_vertices(&at(1.0));
    assert!(block.is_solid() && mass_properties(&block, 1.0).is_ok(), "all corners moved alike");

    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let at = |x: f64| {
        let moved = square.iter().map(|corner| Point::<f64, 2>::new(corner[0] + x, corner[1]));
        [Point::<f64, 2>::origin()].into_iter().chain(moved).collect::<Vec<_>>()
    };
    let mut line = Polyline::new(at(0.0), vec![[1, 2], [2, 3], [3, 4], [4, 1]]).solid();
    line.set_vertices(&at(1.0));
    assert!(line.is_solid(), "all corners moved alike");
}
