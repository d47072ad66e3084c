use super::*;
use crate::collide::separation::hulls::tests::Random;
use crate::math::simd::Level;
use crate::shape::{ConvexHull, Cuboid, Shape, Triangle};

/// Returns triangles, boxes and hulls, including a flat box and a triangle that is a segment.
fn solids<N: Real>(random: &mut Random) -> Vec<Box<dyn Shape<N, 3>>> {
    let mut point = || Point::<N, 3>::from(random.vector::<N>());
    let many: Vec<_> = (0..48).map(|_| point()).collect();
    vec![
        Box::new(Cuboid::new(Vector::<N, 3>::new(N::ONE, N::HALF, N::lit(0.25)))),
        Box::new(Cuboid::new(Vector::<N, 3>::new(N::ONE, N::ONE, N::ZERO))),
        Box::new(ConvexHull::from_points(&many[..6])),
        Box::new(ConvexHull::from_points(&many)),
        Box::new(Triangle::new(many[0], many[1], many[2])),
        Box::new(Triangle::new(many[3], many[3], many[4])),
    ]
}

/// Returns poses of the second solid: rotated at random or aligned with the axes, at coordinates up
/// to 0.5, 1.5, 3 and 50, so that some pairs overlap and others are near each other or far apart.
fn poses<N: Real>(random: &mut Random, count: usize) -> Vec<Pose<N, 3>> {
    let pose = |round: usize| {
        let mut pose = random.turn::<N>();
        pose.translation = random.vector::<N>() * N::lit([0.5, 1.5, 3.0, 50.0][round % 4]);
        if round.is_multiple_of(5) {
            pose.rotation = Pose::identity().rotation;
            pose.translation = pose.translation.map(|x| (x * N::TWO).round() / N::TWO);
        }
        pose
    };
    (0..count).map(pose).collect()
}

/// Calls `visit` for each pair of solids whose kinds are in canonical order, with a list of one
/// [`Pair`] for each pose.
fn each_pair<N: Real>(mut visit: impl FnMut(&[Pair<'_, N, 3>])) {
    let random = &mut Random(9);
    let solids = solids::<N>(random);
    let poses = poses::<N>(random, 64);
    for (first, second) in solids.iter().flat_map(|a| solids.iter().map(move |b| (a, b))) {
        let (first, second) = (first.geometry(), second.geometry());
        if first.kind() > second.kind() {
            continue;
        }
        let pair = |&pose12| Pair { first: first.0, second: second.0, pose12 };
        visit(&poses.iter().map(pair).collect::<Vec<_>>());
    }
}

fn answers_are_those_of_the_test_of_axes<N: Real>() {
    let (mut apart, mut all) = (0, 0);
    each_pair::<N>(|pairs| {
        for pair in pairs {
            let expected = nearer(pair)(pair, N::INFINITY).expect("finite");
            let size = FlatPair::of(pair).expect("faceted").units.scale;
            let tolerance = N::lit(64.0) * N::EPSILON * size;
            all += usize::from(expected.distance > size * N::lit(MIN_GAP));
            let pose12 = &pair.pose12;
            match result(pair, N::INFINITY, true) {
                GapResult::Apart(found) => {
                    apart += 1;
                    let off = (found.distance - expected.distance).abs();
                    assert!(
                        off <= tolerance,
                        "{} and {} at {pose12:?}",
                        found.distance,
                        expected.distance
                    );
                    let between = found.point1 + found.normal * found.distance;
                    assert!(
                        (between - found.point2).norm() <= tolerance,
                        "the points lie across at {pose12:?}"
                    );
                }
                GapResult::Overlap => {
                    assert!(expected.distance < N::ZERO, "{} at {pose12:?}", expected.distance);
                }
                GapResult::Beyond => panic!("nothing is beyond infinity, at {pose12:?}"),
                GapResult::Unproved => {}
            }
        }
    });
    assert!(apart * 3 > all * 2 && apart <= all, "{apart} of {all} that are apart are proved");
}

fn lanes_have_the_bits_of_lone_pairs<N: Real>() {
    each_pair::<N>(|pairs| {
        let Level::Wide(vectors) = Level::new() else { return };
        for packet in pairs.chunks(7) {
            for (limit, with_overlap) in
                [(N::INFINITY, true), (N::INFINITY, false), (N::HALF, false)]
            {
                let found = packet::results(vectors, packet.iter(), limit, with_overlap);
                let found = found.expect("solids of the same kinds fit");
                for (pair, found) in packet.iter().zip(found) {
                    let expected = result(pair, limit, with_overlap);
                    assert_eq!(found, expected, "at {:?} with {vectors:?}", pair.pose12);
                }
            }
        }
    });
}

#[test]
fn what_is_proved_is_right() {
    answers_are_those_of_the_test_of_axes::<f32>();
    answers_are_those_of_the_test_of_axes::<f64>();
}

#[test]
fn a_lane_does_not_look_at_its_neighbours() {
    lanes_have_the_bits_of_lone_pairs::<f32>();
    lanes_have_the_bits_of_lone_pairs::<f64>();
}

#[test]
fn a_corner_beside_a_corner() {
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(1.0, 1.0, 1.0));
    let geometry = Shape::<f64, 3>::geometry(&cuboid).0;
    let pair = |x: f64, y: f64, z: f64| Pair {
        first: geometry,
        second: geometry,
        pose12: Pose::from_translation(Vector::<f64, 3>::new(x, y, z)),
    };
    let GapResult::Apart(found) = result(&pair(3.0, 4.0, 4.0), f64::INFINITY, false) else {
        panic!("two corners are unique")
    };
    assert_eq!((found.distance, found.point1), (3.0, Point::<f64, 3>::new(1.0, 1.0, 1.0)));
    let is_unproved = |pair| matches!(result(&pair, f64::INFINITY, false), GapResult::Unproved);
    assert!(is_unproved(pair(3.0, 0.5, 0.0)), "two faces have many pairs of nearest points");
    assert!(is_unproved(pair(3.0, 3.0, 0.0)), "so have two edges side by side");
    assert!(is_unproved(pair(0.0, 0.0, 0.0)), "no direction to begin with");
    assert!(matches!(result(&pair(3.0, 4.0, 4.0), 2.5, false), GapResult::Beyond), "the limit");
}

/// An edge along y of a box without thickness and an edge of another box face each other. There are
/// many nearest pairs of points, so the search proves nothing, and the result is in the middle.
#[test]
fn edges_of_flat_boxes_may_be_parallel() {
    let beam = Cuboid::new(Vector::<f64, 3>::new(1.0, 2.0, 1.0));
    let eighth = 0.5_f64.sqrt();
    let turn = crate::math::Matrix::<f64, 3>::from_columns(&[
        Vector::<f64, 3>::new(eighth, 0.0, -eighth),
        Vector::<f64, 3>::y(),
        Vector::<f64, 3>::new(eighth, 0.0, eighth),
    ]);
    for thickness in [0.0, 1e-3] {
        let pane = Cuboid::new(Vector::<f64, 3>::new(thickness, 1.0, 1.0));
        let pose12 = Pose { rotation: turn, translation: Vector::<f64, 3>::new(0.0, 0.5, 4.0) };
        let pair = Pair { first: pane.geometry().0, second: beam.geometry().0, pose12 };
        let found = result(&pair, f64::INFINITY, false);
        assert!(matches!(found, GapResult::Unproved), "{thickness} thick");
        let found = separation(&pair, f64::INFINITY).expect("finite");
        assert!(found.point1.y.abs() < 1e-12, "{} with the thickness {thickness}", found.point1);
    }
}
