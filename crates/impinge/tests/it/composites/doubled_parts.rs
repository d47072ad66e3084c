//! Tests that parts that are listed twice, or lie on other parts, do not change the depth of
//! contacts. Meshes from modelling tools often have such duplicates.

use crate::support::samples::samples;
use crate::support::{query_support, slides};

use impinge::math::na::{Translation2, Translation3};
use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::{Ball, Cuboid, Polyline, Shape, TriMesh};
use query_support::random::Random;
use slides::{Sliding, lowest, solids3};

fn v<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn mesh<N: Space<3>>(corners: &[[f64; 3]], triangles: &[[u32; 3]]) -> TriMesh<N, 3> {
    let corners = corners.iter().map(|&[x, y, z]| Point::from(v(x, y, z)));
    TriMesh::new(corners.collect(), triangles.to_vec())
}

const SQUARE: [[f64; 3]; 4] =
    [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.0, 1.0], [-1.0, 0.0, 1.0]];
/// A square as two triangles, and the same square with triangles that occur twice or lie on each
/// other.
const SHEETS: [&[[u32; 3]]; 6] = [
    &[[0, 2, 1], [0, 3, 2]],
    &[[0, 2, 1], [0, 3, 2], [0, 2, 1], [0, 3, 2]],
    &[[0, 2, 1], [0, 3, 2], [2, 1, 0], [3, 2, 0]],
    &[[0, 2, 1], [0, 3, 2], [0, 2, 1]],
    &[[0, 2, 1], [0, 3, 2], [0, 3, 1], [1, 3, 2]],
    &[[0, 2, 1], [0, 2, 1], [0, 3, 2], [0, 2, 1], [0, 3, 2], [0, 3, 2]],
];

/// Returns `true` if two depths differ by at most `room`, or both are `None`. `room` covers
/// rounding, and for curved solids the error of an iteration.
fn are_same_up_to(room: f64, [one, other]: [Option<f64>; 2]) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => (one - other).abs() <= room,
        (one, other) => one == other,
    }
}

/// Index of the sheet that is cut along the other diagonal.
const OTHER_CUT: usize = 4;

/// Tests that contacts with sheet 0, in which each triangle is listed once, are as deep as contacts
/// with the other sheets.
fn rims<N: Space<3, Isometry = Isometry3<N>>>() {
    let random = &mut Random(41, false);
    let (mut met, mut at_rim, rounds) = (0, 0, samples(40));
    let sheets = SHEETS.map(|triangles| mesh::<N>(&SQUARE, triangles));
    let one_sided = sheets.each_ref().map(|sheet| sheet.clone().one_sided());
    for round in 0..rounds {
        // Positions around the rim; solids are tilted about z by up to 0.6 radians, or rotated at
        // random.
        let angle = [0.25, 0.0, 0.004, -0.6][round % 4];
        let turn =
            if round % 3 == 0 { v(0.0, 0.0, angle) } else { random.turn3::<N>().scaled_axis() };
        let at =
            v::<N>(random.within(0.6, 1.5), random.within(-0.5, 0.5), random.within(-1.4, 1.4));
        let pose = Isometry3::new(at, turn);
        for (name, solid) in solids3::<N>() {
            for sheets in [&sheets, &one_sided] {
                let depth = |sheet: &TriMesh<N, 3>| {
                    let found = contact(&Isometry3::identity(), sheet, &pose, &*solid, N::lit(0.1));
                    found.map(|found| (found.depth.as_f64(), found.normal.map(N::as_f64)))
                };
                let once = depth(&sheets[0]);
                met += usize::from(once.is_some());
                at_rim += usize::from(once.is_some_and(|(_, normal)| normal.y.abs() < 0.99));
                // The depth below a face depends on how the square is cut into triangles. So the
                // sheet with the other diagonal is compared for shallow contacts only.
                let is_deep = once.is_some_and(|(depth, _)| depth > 0.05);
                let is_asked = |index: usize| !(index == OTHER_CUT && is_deep);
                let others = sheets.iter().enumerate().skip(1);
                for (index, sheet) in others.filter(|(index, _)| is_asked(*index)) {
                    let again = depth(sheet);
                    let is_same = are_same_up_to(
                        64.0 * N::EPSILON.as_f64() + 1e-11,
                        [once, again].map(|found| found.map(|(depth, _)| depth)),
                    );
                    assert!(is_same, "{name} {index}: {once:?}, then {again:?} at {pose:?}");
                }
            }
        }
    }
    assert!(2 * met > 5 * rounds && at_rim > rounds, "{met} met, {at_rim} at the rim");
}

#[test]
fn sheets_that_are_listed_twice_keep_their_rims() {
    rims::<f32>();
    rims::<f64>();
}

#[test]
fn the_rim_of_a_doubled_sheet_by_its_report() {
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.3, 0.9, 0.3));
    let pose = Isometry3::new(v(1.30, -0.0454, 0.1), v(0.0, 0.0, 0.25));
    let sheet = mesh::<f64>(&SQUARE, SHEETS[1]);
    let found = contact(&Isometry3::identity(), &sheet, &pose, &cuboid, 0.0).expect("they overlap");
    assert!((found.depth - 0.0206).abs() < 1e-4, "{found:?}");
    assert!((found.normal.x - 0.969).abs() < 1e-3, "{found:?}");
}

/// Asserts that the deepest contact is at the rim of the sheet, even if the same mesh also has a
/// floor below it.
#[test]
fn the_rim_above_a_floor_is_touched() {
    let mut corners = SQUARE.map(|[x, _, z]| [x, 1.0, z]).to_vec();
    corners.extend(SQUARE.map(|[x, _, z]| [9.0 * x, 0.0, 9.0 * z]));
    for sheet in SHEETS {
        let floor: [[u32; 3]; 2] = [[4, 6, 5], [4, 7, 6]];
        let room = mesh::<f64>(&corners, &[sheet, &floor].concat());
        let (at, ball) = (Isometry3::translation(1.15, 0.549, 0.1), Ball::new(0.55));
        let manifolds = Sliding::<f64, 3>::new()
            .update((&Isometry3::identity(), &room), (&at, &ball), 0.01)
            .iter()
            .flat_map(|manifold| manifold.contacts())
            .map(|tracked| tracked.contact.depth)
            .fold(0.0, f64::max);
        assert!((manifolds - 0.0757).abs() < 2e-3, "{manifolds} deep with {sheet:?}");
    }
}

/// Tests that a ball whose centre is slightly beyond the rim of a sheet has a normal close to the
/// face normal.
fn shallow<N: Space<3, Isometry = Isometry3<N>>>() {
    for (index, sheet) in SHEETS.map(|triangles| mesh::<N>(&SQUARE, triangles)).iter().enumerate() {
        for (x, z) in [(0.004, 0.0), (0.004, 0.004), (0.0, 0.004)] {
            let at = Isometry3::from_parts(
                Translation3::from(v::<N>(1.0 + x, 0.99, z + if z > 0.0 { 1.0 } else { 0.3 })),
                Default::default(),
            );
            let found = contact(&Isometry3::identity(), sheet, &at, &Ball::new(N::ONE), N::ZERO)
                .expect("a contact");
            let lean = (found.normal.x.as_f64(), found.normal.z.as_f64());
            let off = (lean.0 - x).abs() + (lean.1 - z).abs();
            assert!(off < 2e-4, "{lean:?} at {x} {z} of sheet {index}");
        }
    }
}

#[test]
fn rims_have_normals_close_to_that_of_the_face() {
    shallow::<f32>();
    shallow::<f64>();
}

/// Tests that lines in 2D whose segments are listed twice have contacts of the same depth at their
/// ends and corner as a line that lists each segment once.
fn lines<N: Space<2, Isometry = Isometry2<N>>>() {
    let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x), N::lit(y));
    let corners = || vec![p(2.0, 0.0), p(0.0, 0.0), p(-2.0, 1.0)];
    let parts: [&[[u32; 2]]; 3] =
        [&[[0, 1], [1, 2]], &[[0, 1], [1, 2], [0, 1], [1, 2]], &[[0, 1], [1, 2], [1, 2]]];
    let lines = parts.map(|parts| Polyline::<N, 2>::new(corners(), parts.to_vec()));
    let one_sided = lines.each_ref().map(|line| line.clone().one_sided());
    let random = &mut Random(42, false);
    let solids: [Box<dyn Shape<N, 2>>; 2] = [
        Box::new(Ball::new(N::HALF)),
        Box::new(Cuboid::new(Vector::<N, 2>::new(N::lit(0.3), N::lit(0.6)))),
    ];
    for round in 0..600 {
        let x = [2.0, -2.0, 0.0][round % 3] + random.signed() * [0.003, 0.5][round % 2];
        let turn = N::lit([0.0, 0.003, 0.7][round / 2 % 3]);
        let at = Vector::<N, 2>::new(N::lit(x), N::lit(random.within(-0.4, 1.6)));
        let pose = Isometry2::new(at, turn);
        for solid in &solids {
            let depth = |line: &Polyline<N, 2>| {
                let found = contact(&Isometry2::identity(), line, &pose, &**solid, N::lit(0.1));
                found.map(|found| found.depth.as_f64())
            };
            for lines in [&lines, &one_sided] {
                let [once, twice, some] = lines.each_ref().map(depth);
                for other in [twice, some] {
                    let is_same = are_same_up_to(64.0 * N::EPSILON.as_f64(), [once, other]);
                    assert!(is_same, "{once:?} and {other:?} at {pose:?}");
                }
            }
        }
    }
}

#[test]
fn lines_that_are_listed_twice_keep_their_ends() {
    lines::<f32>();
    lines::<f64>();
}

/// Tests that a triangle without area that extends beyond a shared edge has a contact of the same
/// depth there as on its own, even if the solid also touches a floor below.
fn sticking_out<N: Space<3, Isometry = Isometry3<N>>>() {
    let mut corners = SQUARE.to_vec();
    corners.push([1.0, 0.0, 3.0]);
    corners.extend(SQUARE.map(|[x, _, z]| [9.0 * x, -0.3, 9.0 * z]));
    let thin: [[u32; 3]; 4] = [[2, 1, 4], [1, 2, 4], [4, 2, 1], [4, 1, 2]];
    let random = &mut Random(43, false);
    let (mut met, rounds) = (0, samples(40));
    for round in 0..rounds {
        let turn = [v(0.0, 0.0, 0.0), random.turn3::<N>().scaled_axis()][round % 2];
        let (x, z) = (random.within(0.6, 1.4), random.within(1.6, 2.4));
        let solids: [Box<dyn Shape<N, 3>>; 2] =
            [Box::new(Ball::new(N::lit(0.35))), Box::new(Cuboid::new(v(0.3, 0.25, 0.2)))];
        for (solid, thin) in solids.iter().flat_map(|solid| thin.map(|thin| (solid, thin))) {
            let turned = Isometry3::new(v(0.0, 0.0, 0.0), turn);
            let height = N::lit(-0.301) - lowest(&**solid, &turned);
            let pose = Isometry3::new(Vector::<N, 3>::new(N::lit(x), height, N::lit(z)), turn);
            let depth = |triangles: &[[u32; 3]]| {
                let mesh = mesh::<N>(&corners, triangles);
                let found = contact(&Isometry3::identity(), &mesh, &pose, &**solid, N::lit(0.05));
                found.map(|found| (found.depth.as_f64(), found.normal.map(N::as_f64)))
            };
            let floor = [[5, 7, 6], [5, 8, 7]];
            let whole = depth(&[[0, 2, 1], [0, 3, 2], thin, floor[0], floor[1]]);
            let Some((alone, normal)) = depth(&[thin]).filter(|(depth, _)| *depth > 0.002) else {
                continue;
            };
            met += 1;
            let is_same =
                whole.is_some_and(|(other, _)| (alone - other).abs() < 64.0 * N::EPSILON.as_f64());
            let what = format!("{thin:?} in the mesh {whole:?} at {pose:?} {solid:?}");
            assert!(is_same, "{alone} along {normal:?}, {what}");
        }
    }
    assert!(met > rounds, "{met} met");
}

#[test]
fn triangles_without_area_are_met_where_they_stick_out() {
    sticking_out::<f32>();
    sticking_out::<f64>();
}

/// Asserts that filled meshes in 2D whose triangles are listed twice have contacts of the same
/// depth as a mesh that lists each triangle once.
#[test]
fn filled_triangles_that_are_listed_twice_are_there_once() {
    let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(Point::<f64, 2>::from);
    let parts: [&[[u32; 3]]; 3] = [
        &[[0, 1, 2], [0, 2, 3]],
        &[[0, 1, 2], [0, 2, 3], [1, 2, 0], [0, 2, 3]],
        &[[0, 1, 2], [0, 2, 3], [0, 1, 2]],
    ];
    let meshes = parts.map(|parts| TriMesh::<f64, 2>::new(corners.to_vec(), parts.to_vec()));
    let random = &mut Random(44, false);
    for _ in 0..400 {
        let at = [random.within(-1.6, 1.6), random.within(0.9, 1.4)];
        let pose = Isometry2::from_parts(Translation2::new(at[0], at[1]), random.turn2());
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(0.4, 0.2));
        let [one, two, three] = meshes.each_ref().map(|mesh| {
            contact(&Isometry2::identity(), mesh, &pose, &cuboid, 0.1).map(|found| found.depth)
        });
        for other in [two, three] {
            let is_same = match (one, other) {
                (Some(one), Some(other)) => (one - other).abs() < 1e-13,
                (one, other) => one == other,
            };
            assert!(is_same, "{one:?} and {other:?} at {pose:?}");
        }
    }
}
