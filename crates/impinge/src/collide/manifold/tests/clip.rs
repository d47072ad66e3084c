//! Tests that the contacts of two faces in 3D, with any number of corners, are the corners of their
//! overlap.

use super::super::build3;
use super::scene::fact;
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::math::{Isometry3, Point, Pose, Real, Vector};
use crate::shape::{Capsule, ConvexHull, Cuboid, Cylinder, Segment, Shape, Triangle};

pub(super) type Outline = Vec<[f64; 2]>;

/// Returns a regular polygon around a centre, counter-clockwise. `radius` is the distance of its
/// corners from the centre, `turn` the angle of the first corner in radians.
pub(super) fn regular(count: usize, [x, y]: [f64; 2], radius: f64, turn: f64) -> Outline {
    let corner = |at: usize| {
        let angle = turn + at as f64 * core::f64::consts::TAU / count as f64;
        let (sine, cosine) = Real::sine_cosine(angle);
        [x + radius * cosine, y + radius * sine]
    };
    (0..count).map(corner).collect()
}

/// Returns the prism over an outline in x and y, between two heights z.
pub(super) fn prism<N: Real>(outline: &Outline, [low, high]: [f64; 2]) -> ConvexHull<N> {
    let at = |z: f64| {
        let point = move |&[x, y]: &[f64; 2]| Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z));
        outline.iter().map(point)
    };
    ConvexHull::from_points(&at(low).chain(at(high)).collect::<Vec<_>>())
}

/// Returns the intersection of two convex outlines, by the method of Sutherland and Hodgman.
pub(super) fn common(one: &Outline, other: &Outline) -> Outline {
    let mut kept = one.clone();
    for (at, from) in other.iter().enumerate() {
        let to = other[(at + 1) % other.len()];
        let left = |p: &[f64; 2]| {
            (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0])
        };
        let mut next = Outline::new();
        for (at, a) in kept.iter().enumerate() {
            let b = kept[(at + 1) % kept.len()];
            let (in_a, in_b) = (left(a), left(&b));
            if in_a >= 0.0 {
                next.push(*a);
            }
            if in_a * in_b < 0.0 {
                let share = in_a / (in_a - in_b);
                next.push([a[0] + (b[0] - a[0]) * share, a[1] + (b[1] - a[1]) * share]);
            }
        }
        kept = next;
    }
    kept
}

fn manifold<N: Real>(pair: &Pair<'_, N, 3>, points: usize) -> RawManifold<N, 3> {
    let request = ManifoldRequest { prediction: N::lit(0.05), sine: N::ZERO, max_points: points };
    let mut out = RawManifold::default();
    build3(pair, &fact(pair), &request, &mut out);
    out
}

/// Asserts that each expected corner is the position of a contact, and each contact is at an
/// expected corner. Compares the x and y coordinates of the points on the first solid.
fn has_corners<N: Real>(found: &RawManifold<N, 3>, expected: &Outline, tolerance: f64, what: &str) {
    let off = |point: &Point<N, 3>, [x, y]: &[f64; 2]| {
        (point.x.as_f64() - x).abs().max((point.y.as_f64() - y).abs())
    };
    let positions = found.points.iter().map(|point| point.point1).collect::<Vec<_>>();
    for corner in expected {
        assert!(
            positions.iter().any(|position| off(position, corner) <= tolerance),
            "{what}: {corner:?} {found:?}"
        );
    }
    for position in &positions {
        assert!(
            expected.iter().any(|corner| off(position, corner) <= tolerance),
            "{what}: {position} {found:?}"
        );
    }
}

fn prisms<N: Real>(tolerance: f64) {
    for (count1, count2) in
        [(3, 3), (4, 7), (5, 8), (8, 8), (6, 9), (9, 9), (12, 17), (24, 3), (40, 33)]
    {
        for step in 0..8_u32 {
            let shift = 0.17 * f64::from(step);
            let one = regular(count1, [0.0, 0.0], 1.0, 0.1);
            let other = regular(count2, [shift, 0.31 * shift], 0.9, 0.4 + shift);
            let (below, above) = (prism::<N>(&one, [-1.0, 0.0]), prism::<N>(&other, [0.0, 1.0]));
            let pose12 =
                Pose::from_translation(Vector::<N, 3>::new(N::ZERO, N::ZERO, N::lit(0.01)));
            let pair = Pair { first: below.geometry().0, second: above.geometry().0, pose12 };
            let found = manifold(&pair, 128);
            let what = format!("{count1} and {count2} corners, {shift}");
            has_corners(&found, &common(&one, &other), tolerance, &what);
            assert!(
                found.points.iter().all(|p| (p.distance.as_f64() - 0.01).abs() < tolerance),
                "{what}"
            );
            let ids = found.points.iter().map(|p| (p.feature1, p.feature2)).collect::<Vec<_>>();
            assert!((1..ids.len()).all(|at| !ids[..at].contains(&ids[at])), "{what}: {ids:?}");
        }
    }
}

#[test]
fn faces_of_any_number_of_corners_are_clipped() {
    prisms::<f32>(1e-5);
    prisms::<f64>(1e-13);
}

/// Tests solids without width on a box, in both orders: the contacts of a segment or of a face
/// without width are its two ends, those of a box without height its four corners. An upright
/// cylinder whose radius is within rounding has one contact.
fn degenerate<N: Real>(tolerance: f64) {
    let p = |x: f64, y: f64| Point::<N, 3>::new(N::lit(x), N::lit(y), N::ZERO);
    let floor = Cuboid::new(Vector::<N, 3>::new(N::ONE, N::ONE, N::ONE));
    let flat = |half: [f64; 3]| Cuboid::new(Vector::<N, 3>::from(half.map(N::lit)));
    let tiny = N::EPSILON.as_f64() * 4.0;
    let line = vec![[-0.5, 0.0], [0.5, 0.0]];
    let area = vec![[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let tip = Capsule::<N, 3>::try_from_ends(p(-0.5, 0.0), p(0.5, 0.0), N::ZERO).expect("finite");
    let solids: [(Box<dyn Shape<N, 3>>, &Outline); 7] = [
        (Box::new(Segment::new(p(-0.5, 0.0), p(0.5, 0.0))), &line),
        (Box::new(tip), &line),
        (Box::new(flat([0.5, 0.0, 0.0])), &line),
        (Box::new(flat([0.5, tiny, tiny])), &line),
        (Box::new(Triangle::new(p(-0.5, 0.0), p(0.5, 0.0), p(0.1, 0.0))), &line),
        (Box::new(Triangle::new(p(-0.5, 0.0), p(0.5, 0.0), p(0.1, tiny))), &line),
        (Box::new(flat([0.5, 0.5, 0.0])), &area),
    ];
    for (at, (solid, expected)) in solids.iter().enumerate() {
        let pose12 = Pose::from_translation(Vector::<N, 3>::new(N::ZERO, N::ZERO, N::lit(1.01)));
        let pair = Pair { first: floor.geometry().0, second: solid.geometry().0, pose12 };
        has_corners(&manifold(&pair, 16), expected, tolerance, &format!("solid {at}"));
        let (first, second, pose12) = (pair.second, pair.first, pose12.inverse());
        let swapped = manifold(&Pair { first, second, pose12 }, 16);
        has_corners(&swapped, expected, tolerance, &format!("solid {at} below"));
    }
    let thin = Cylinder::new(N::HALF, N::lit(tiny));
    let turn = Isometry3::rotation(Vector::<N, 3>::x() * N::frac_pi_2());
    let mut pose12 = Pose::from_isometry(&turn);
    pose12.translation.z = N::lit(1.51);
    let pair = Pair { first: floor.geometry().0, second: thin.geometry().0, pose12 };
    has_corners(&manifold(&pair, 16), &vec![[0.0, 0.0]], tolerance, "a needle");
}

#[test]
fn what_has_no_width_is_a_segment_or_a_point() {
    degenerate::<f32>(1e-5);
    degenerate::<f64>(1e-13);
}
