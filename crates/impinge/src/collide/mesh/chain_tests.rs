//! Compares the contacts that the specialised path of chains computes with the contacts of the
//! generic path, which defines them. They must be equal bit for bit after each update.

use super::{
    CompositeContacts, PART_POINTS, contact_in_world, deepest, deepest_within, rounding,
    within::deepest_in_general,
};
use crate::collide::ManifoldRequest;
use crate::collide::pair::{Ordered, Placed};
use crate::collide::parts::Between;
use crate::collide::separation::hulls::tests::Random;
use crate::collide::separation::{of_ordered, placed};
use crate::convex::Separation;
use crate::math::{Matrix, Point, Pose, Real, Space, Vector};
use crate::shape::{
    Ball, Capsule, ConvexPolygon, Cuboid, HeightField, Polyline, Segment, Shape, Triangle,
};

/// Number of updates of each solid.
const STEPS: usize = 6;

/// Returns heights along a line: rough if `kind` is 0, gentle if it is 1, else flat with steps.
fn heights<N: Real>(random: &mut Random, kind: usize) -> Vec<N> {
    let mut height = N::ZERO;
    let mut next = |_| {
        let change = random.vector::<N>().x;
        height += match kind {
            0 => change * N::lit(0.3),
            1 => change * N::lit(0.03),
            _ if change > N::HALF => N::lit(0.25),
            _ if change < -N::HALF => N::lit(-0.25),
            _ => N::ZERO,
        };
        height
    };
    (0..13).map(&mut next).collect()
}

/// Returns a terrain around the origin: a height field, perhaps with a hole, or an open or closed
/// polyline, in either direction along x. It is one-sided or two-sided.
fn ground_of<N: Space<2>>(random: &mut Random, round: usize) -> Box<dyn Shape<N, 2>> {
    let heights = heights::<N>(random, round % 3);
    let is_one_sided = random.pick(3) == 0;
    if random.pick(2) == 0 {
        let extents = Vector::<N, 2>::new(N::lit([6.0, -6.0][random.pick(2)]), N::ONE);
        let hole = random.pick(20);
        let field = HeightField::<N, 2>::new(heights, extents).with_holes(|cell| cell == hole);
        return Box::new(if is_one_sided { field.one_sided() } else { field });
    }
    let vertex_at =
        |(n, height): (u32, &N)| Point::<N, 2>::new(N::lit(f64::from(n) * 0.5 - 3.0), *height);
    let mut points: Vec<_> = (0..).zip(&heights).map(vertex_at).collect();
    if random.pick(2) == 0 {
        points.reverse();
    }
    let is_closed = random.pick(4) == 0;
    let mut line =
        if is_closed { Polyline::closed(points.clone()) } else { Polyline::open(points.clone()) };
    if random.pick(4) == 0 {
        // Two vertices at one position that are not joined.
        points[9].x += N::HALF;
        points[6] = points[9];
        line.set_vertices(&points);
    }
    let line = if random.pick(5) == 0 { line.with_internal_edges_kept() } else { line };
    Box::new(if is_one_sided { line.one_sided() } else { line })
}

fn solid_of<N: Real>(random: &mut Random) -> Box<dyn Shape<N, 2>> {
    let half = random.vector::<N>().xy().abs() * N::HALF + Vector::<N, 2>::repeat(N::lit(0.05));
    let mut point = || Point::from(random.vector::<N>().xy() * N::lit(0.6));
    let points: Vec<_> = (0..7).map(|_| point()).collect();
    match random.pick(7) {
        0 | 1 => Box::new(Ball::new(half.x)),
        6 => Box::new(Segment::new(points[0], points[1])),
        2 => Box::new(Capsule::<N, 2>::new(half.x, half.y)),
        3 => Box::new(Triangle::new(points[0], points[1], points[2])),
        4 => Box::new(Cuboid::new(half)),
        _ => match ConvexPolygon::try_from_points(&points) {
            Ok(polygon) => Box::new(polygon),
            Err(_) => Box::new(Cuboid::new(half)),
        },
    }
}

fn pose_of<N: Real>(position: Vector<N, 2>, angle: N) -> Pose<N, 2> {
    let (sine, cosine) = angle.sine_cosine();
    Pose { rotation: Matrix::<N, 2>::new(cosine, -sine, sine, cosine), translation: position }
}

/// Asserts that two sets of contacts are equal, ids and reference points included.
pub(super) fn assert_same<N: Real, const D: usize>(
    quick: &CompositeContacts<N, D>,
    slow: &CompositeContacts<N, D>,
    what: impl Fn() -> String,
) {
    assert_eq!(quick.reference, slow.reference, "{}", what());
    assert_eq!(quick.patches.len(), slow.patches.len(), "{}", what());
    for (patch, expected) in quick.patches.iter().zip(&slow.patches) {
        assert_eq!(patch.normal, expected.normal, "{}", what());
        assert_eq!(patch.points.len(), expected.points.len(), "{}", what());
        for (point, expected) in patch.points.iter().zip(&expected.points) {
            assert_eq!((point.raw, point.parts), (expected.raw, expected.parts), "{}", what());
        }
    }
}

/// Asserts that the specialised path and the generic path find the same deepest contact within
/// `limit`. Up to rounding, the contact must not depend on whether the distance of the shapes is
/// computed first. Asserts that [`contact_in_world`] finds a contact in the same cases.
pub(super) fn assert_one_contact<N: Space<D>, const D: usize>(
    [placed1, placed2]: [&Placed<'_, N, D>; 2],
    limit: N,
    what: impl Fn() -> String,
) {
    let ordered = Ordered::new(placed1, placed2);
    let between = Between::of_ordered(&ordered);
    let nearest = of_ordered(&ordered, limit);
    let expected = nearest.and_then(|nearest| deepest(&between, nearest.distance, limit));
    let at_once = deepest_within(&between, limit);
    let found = at_once.map(|found| placed(&found, ordered.first, ordered.swapped));
    assert_eq!(contact_in_world(placed1, placed2, limit).is_some(), found.is_some(), "{}", what());
    let request = ManifoldRequest::new(limit, N::ZERO, PART_POINTS);
    let general = deepest_in_general(&between, &request);
    assert_eq!(at_once, general, "{}", what());
    let distance = |found: Option<Separation<N, D>>| found.map(|found| found.distance);
    match [at_once, expected].map(distance) {
        // [`deepest`] gives the contact the distance of the solids if the two distances differ only
        // by rounding.
        [Some(a), Some(b)] => assert!((a - b).abs() <= rounding(&between), "{a}, {b}: {}", what()),
        [a, b] => assert_eq!(a, b, "{}", what()),
    }
}

/// Moves one solid and asserts, at each step, that the contacts do not depend on whether
/// `update_quickly` is tried before the generic path, and that queries return the deepest contact.
/// Returns the number of updates by the specialised path, and the number of contact points.
fn follow<N: Space<2>>(random: &mut Random, round: usize) -> (usize, usize) {
    let (solid, terrain) = (solid_of::<N>(random), ground_of::<N>(random, round));
    let far = N::lit([0.0, 40.0][random.pick(2)]);
    let under = pose_of(Vector::<N, 2>::repeat(far), random.vector::<N>().x);
    let mut position = Vector::<N, 2>::new(random.vector::<N>().x * N::TWO, random.vector::<N>().y);
    let mut angle = random.vector::<N>().x * N::lit([0.0, 0.1, 3.0][random.pick(3)]);
    let request = ManifoldRequest::new(
        N::lit([0.002, 0.3][random.pick(2)]),
        N::lit([0.0, 0.2][random.pick(2)]),
        [2, 2, 1][random.pick(3)],
    );
    let (mut quick, mut slow) = (CompositeContacts::default(), CompositeContacts::default());
    let (mut done, mut points) = (0, 0);
    for step in 0..STEPS {
        let pose = under.compose(&pose_of(position, angle));
        let placed1 = Placed::of_pose(&pose, solid.geometry());
        let placed2 = Placed::of_pose(&under, terrain.geometry());
        let between = Between::of_ordered(&Ordered::new(&placed1, &placed2));
        let is_done = quick.update_quickly(&between, &request);
        if !is_done {
            quick.update_in_general(&between, false, &request);
        }
        slow.update_in_general(&between, false, &request);
        let what = || format!("{solid:?} on {terrain:?} at {pose:?}, step {step}");
        assert_same(&quick, &slow, what);
        assert_one_contact([&placed1, &placed2], request.prediction, what);
        (done, points) = (done + usize::from(is_done), points + quick.len());
        position += random.vector::<N>().xy() * N::lit(0.04);
        angle += random.vector::<N>().x * N::lit(0.02);
    }
    (done, points)
}

fn compare<N: Space<2>>(seed: u64) {
    let random = &mut Random(seed);
    let (mut done, mut points) = (0, 0);
    for round in 0..700 {
        let (of_one, found) = follow::<N>(random, round);
        (done, points) = (done + of_one, points + found);
    }
    assert!(done * 10 > 700 * STEPS * 8, "{done} updates by the quick path");
    assert!(points > 700 * STEPS / 2, "{points} points");
}

#[test]
fn chains_have_the_contacts_of_the_generic_path() {
    compare::<f32>(11);
    compare::<f64>(12);
}
