//! Tests that flat solids touch if they share a corner to the bit, or meet in any other way on a
//! grid.

use crate::support::query_support;

use impinge::math::{Isometry2, Isometry3, Point, Real, Space};
use impinge::query::{Proximity, contact, distance, proximity, witness};
use impinge::shape::{
    Compound, ConvexHull, ConvexPolygon, Polyline, Segment, ShapeHandle, Tetrahedron, TriMesh,
    Triangle,
};
use query_support::random::Random;

/// Returns random points around a corner, on one side of a plane through it, and the corner itself.
fn around<N: Real, const D: usize>(
    random: &mut Random,
    corner: &[f64; D],
    side: &[f64; D],
    on_grid: bool,
) -> Vec<Point<N, D>> {
    let point = |at: [f64; D]| Point::<N, D>::from(at.map(N::lit));
    let mut points = vec![point(*corner)];
    while points.len() < 5 {
        let way: [f64; D] = std::array::from_fn(|_| {
            let x = random.signed() * 160.0;
            if on_grid { (x / 20.0).round() * 20.0 } else { x }
        });
        let height: f64 = way.iter().zip(side).map(|(x, y)| x * y).sum();
        // Clearly on that side, so that rounding does not move them to the other.
        if height > 20.0 {
            points.push(point(std::array::from_fn(|axis| corner[axis] + way[axis])));
        }
    }
    let first = random.bits() % 3;
    points.swap(0, usize::try_from(first).expect("small"));
    points
}

/// Returns two lists of points with a common corner, on opposite sides of a plane through it.
fn meeting<N: Real, const D: usize>(random: &mut Random, round: usize) -> [Vec<Point<N, D>>; 2] {
    let on_grid = round.is_multiple_of(2);
    let far = [1.0, 400.0, 1e5][round % 3];
    let corner = std::array::from_fn(|_| {
        let x = random.signed() * far;
        // A corner that both scalars represent exactly.
        N::lit(if on_grid { (x / 20.0).round() * 20.0 } else { x }).as_f64()
    });
    let side = random.direction::<f64, D>();
    let (side, other) = (side.into(), (-side).into());
    [around(random, &corner, &side, on_grid), around(random, &corner, &other, on_grid)]
}

/// Returns shapes with these points as corners; triangles and segments use the first three.
fn shapes2<N: Space<2>>(p: &[Point<N, 2>]) -> Vec<ShapeHandle<N, 2>> {
    let identity = N::isometry(&impinge::math::Pose::identity());
    let triangle = ShapeHandle::new(Triangle::new(p[0], p[1], p[2]));
    let mut shapes = vec![
        ShapeHandle::new(Compound::<N, 2>::new(vec![(identity, triangle.clone())])),
        triangle,
        ShapeHandle::new(TriMesh::<N, 2>::new(p.to_vec(), vec![[0, 1, 2], [3, 0, 1], [1, 2, 4]])),
        ShapeHandle::new(Polyline::<N, 2>::open(p.to_vec())),
        ShapeHandle::new(ConvexPolygon::from_points(p)),
    ];
    shapes
        .extend([[0, 1], [1, 2], [2, 0]].map(|[a, b]| ShapeHandle::new(Segment::new(p[a], p[b]))));
    shapes
}

fn shapes3<N: Space<3>>(p: &[Point<N, 3>]) -> Vec<ShapeHandle<N, 3>> {
    let identity = N::isometry(&impinge::math::Pose::identity());
    let triangle = ShapeHandle::new(Triangle::new(p[0], p[1], p[2]));
    let mut shapes = vec![
        ShapeHandle::new(Compound::<N, 3>::new(vec![(identity, triangle.clone())])),
        triangle,
        ShapeHandle::new(TriMesh::<N, 3>::new(p.to_vec(), vec![[0, 1, 2], [3, 0, 1], [1, 2, 4]])),
        ShapeHandle::new(Polyline::<N, 3>::open(p.to_vec())),
        ShapeHandle::new(Tetrahedron::new([p[0], p[1], p[2], p[3]])),
    ];
    shapes.extend(ConvexHull::try_from_points(p).ok().map(ShapeHandle::new));
    shapes
        .extend([[0, 1], [1, 2], [2, 0]].map(|[a, b]| ShapeHandle::new(Segment::new(p[a], p[b]))));
    shapes
}

/// Returns for each of four queries whether it reports that two shapes touch: distance, proximity,
/// contact and witness.
macro_rules! touch {
    ($isometry:ident, $one:expr, $other:expr, $zero:expr) => {{
        let (here, one, other) = ($isometry::identity(), &**$one, &**$other);
        let found = [
            distance(&here, one, &here, other) == $zero,
            proximity(&here, one, &here, other, $zero) == Proximity::Intersecting,
            contact(&here, one, &here, other, $zero).is_some(),
            witness(&here, one, &here, other, $zero).is_some_and(|found| found.distance <= $zero),
        ];
        found
    }};
}

fn corners2<N: Space<2, Isometry = Isometry2<N>>>() {
    let random = &mut Random(61, false);
    for round in 0..2000 {
        let [points1, points2] = meeting::<N, 2>(random, round);
        let has_corner = |points: &[Point<N, 2>]| {
            points[..3].iter().any(|point| points2.contains(point) && points1.contains(point))
        };
        assert!(has_corner(&points1) && has_corner(&points2), "they share it");
        for one in &shapes2(&points1) {
            for other in &shapes2(&points2) {
                let is_shared = is_in(one, &points2) && is_in(other, &points1);
                let found = touch!(Isometry2, one, other, N::ZERO);
                assert!(!is_shared || found == [true; 4], "{found:?} {one:?} {other:?}");
            }
        }
    }
}

/// Returns `true` if a shape made from one of two lists of points contains the corner that both
/// lists have; `points` is the other list. A segment contains the corner if one of its ends is
/// among `points`; every other shape contains it.
fn is_in<N: Space<D>, const D: usize>(shape: &ShapeHandle<N, D>, points: &[Point<N, D>]) -> bool {
    shape
        .as_shape::<Segment<N, D>>()
        .is_none_or(|segment| points.contains(segment.a()) || points.contains(segment.b()))
}

fn corners3<N: Space<3, Isometry = Isometry3<N>>>() {
    let random = &mut Random(62, false);
    for round in 0..1000 {
        let [points1, points2] = meeting::<N, 3>(random, round);
        for one in &shapes3(&points1) {
            for other in &shapes3(&points2) {
                let is_shared = is_in(one, &points2) && is_in(other, &points1);
                let found = touch!(Isometry3, one, other, N::ZERO);
                assert!(!is_shared || found == [true; 4], "{found:?} {one:?} {other:?}");
            }
        }
    }
}

#[test]
fn solids_of_the_plane_that_share_a_corner_touch() {
    corners2::<f32>();
    corners2::<f64>();
}

#[test]
fn solids_of_space_that_share_a_corner_touch() {
    corners3::<f32>();
    corners3::<f64>();
}

/// A point, a segment or a triangle with corners on a grid.
type Piece = Vec<[i64; 2]>;

/// Returns twice the signed area of a triangle, exactly.
fn turn(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn sides(piece: &Piece) -> Vec<[[i64; 2]; 2]> {
    let count = if piece.len() < 3 { 1 } else { 3 };
    (0..count).map(|at| [piece[at], piece[(at + 1) % piece.len()]]).collect()
}

/// Returns `true` if a point is on a segment, by exact integer arithmetic.
fn is_on([a, b]: [[i64; 2]; 2], p: [i64; 2]) -> bool {
    let is_within =
        |axis: usize| a[axis].min(b[axis]) <= p[axis] && p[axis] <= a[axis].max(b[axis]);
    turn(a, b, p) == 0 && is_within(0) && is_within(1)
}

/// Returns `true` if two segments have a point in common, by exact integer arithmetic.
fn cross(one: [[i64; 2]; 2], other: [[i64; 2]; 2]) -> bool {
    let parted = |[a, b]: [[i64; 2]; 2], [c, d]: [[i64; 2]; 2]| {
        turn(a, b, c).signum() * turn(a, b, d).signum() < 0
    };
    (parted(one, other) && parted(other, one))
        || other.iter().any(|&p| is_on(one, p))
        || one.iter().any(|&p| is_on(other, p))
}

fn holds(triangle: &Piece, p: [i64; 2]) -> bool {
    let signs = sides(triangle).into_iter().map(|[a, b]| turn(a, b, p).signum());
    let signs: Vec<i64> = signs.collect();
    triangle.len() == 3 && !(signs.contains(&1) && signs.contains(&-1))
}

/// Returns `true` if two pieces have a point in common, by exact integer arithmetic.
fn meet(one: &Piece, other: &Piece) -> bool {
    let mut pairs =
        sides(one).into_iter().flat_map(|a| sides(other).into_iter().map(move |b| (a, b)));
    pairs.any(|(a, b)| cross(a, b)) || holds(one, other[0]) || holds(other, one[0])
}

/// Asserts that pieces on a grid, which often meet at corners and on sides, touch exactly if
/// integer arithmetic finds a common point. Returns the number of pairs that touch.
fn grids<N: Space<2, Isometry = Isometry2<N>>>() -> u32 {
    let random = &mut Random(63, false);
    let mut touching = 0;
    for round in 0..40_000 {
        let step = [20, 1, 37][round % 3];
        let mut piece = |count: usize| -> Piece {
            let mut corner = || -> [i64; 2] {
                std::array::from_fn(|_| i64::try_from(random.bits() % 9).expect("small") * step)
            };
            (0..count).map(|_| corner()).collect()
        };
        let (one, other) = (piece(1 + round % 4 % 3), piece(3 - round / 4 % 3));
        if [&one, &other].iter().any(|p| p.len() == 3 && turn(p[0], p[1], p[2]) == 0) {
            continue;
        }
        let made = |piece: &Piece| {
            let point = |at: &[i64; 2]| {
                Point::<N, 2>::from(at.map(|x| N::lit(f64::from(i32::try_from(x).expect("small")))))
            };
            let p: Vec<_> = piece.iter().map(point).collect();
            match p.len() {
                3 => ShapeHandle::new(Triangle::new(p[0], p[1], p[2])),
                _ => ShapeHandle::new(Segment::new(p[0], p[p.len() - 1])),
            }
        };
        let (here, shapes) = (Isometry2::identity(), [made(&one), made(&other)]);
        let apart = distance(&here, &*shapes[0], &here, &*shapes[1]);
        let (found, expected) = (apart == N::ZERO, meet(&one, &other));
        touching += u32::from(expected);
        assert!(found == expected, "{one:?} {other:?}: {apart}, but they meet: {expected}");
    }
    touching
}

#[test]
fn pieces_of_a_grid_touch_by_integers() {
    let found = [grids::<f32>(), grids::<f64>()];
    assert!(found.iter().all(|&touching| touching > 7000), "{found:?} touch");
}

/// Asserts that two polygons with a common vertex touch however they are cut into triangles, with
/// the numbers of a bug report.
#[test]
fn polygons_that_share_a_vertex_touch() {
    let quad = |corners: [[f64; 2]; 4], triangles: [[u32; 3]; 2]| {
        TriMesh::<f64, 2>::new(corners.map(Point::from).to_vec(), triangles.to_vec())
    };
    let cuts = [[[0, 1, 2], [0, 2, 3]], [[0, 1, 3], [1, 2, 3]]];
    let one = [[140.0, 120.0], [160.0, 20.0], [20.0, 20.0], [20.0, 120.0]];
    let others = [
        [[140.0, 120.0], [140.0, 200.0], [240.0, 200.0], [240.0, 120.0]],
        [[240.0, 80.0], [140.0, 120.0], [180.0, 240.0], [280.0, 200.0]],
    ];
    for (cut1, cut2) in cuts.iter().flat_map(|cut1| cuts.map(|cut2| (*cut1, cut2))) {
        for other in others {
            let (one, other) =
                (ShapeHandle::new(quad(one, cut1)), ShapeHandle::new(quad(other, cut2)));
            assert_eq!(touch!(Isometry2, &one, &other, 0.0), [true; 4], "{cut1:?} {cut2:?}");
            assert_eq!(touch!(Isometry2, &other, &one, 0.0), [true; 4], "{cut1:?} {cut2:?}");
        }
    }
}
