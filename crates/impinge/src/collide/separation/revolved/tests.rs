//! Asserts that separations agree with the general algorithm within an accuracy, that no sampled
//! direction has less depth than the result, and that enough pairs need no fallback.

use super::*;
use crate::collide::separation as whole;
use crate::collide::separation::hulls::tests::Random;
use crate::collide::separation::revolved::cylinder_cylinder::tests::compare;
use crate::collide::separation::ridges::tests::{
    Make, Solids, blade, capsule, compare_each, cone, cuboid, cylinder, depth, hull, segment,
    triangle,
};
use crate::shape::Ball;

fn agree<N: Real>(seed: u64, rounds: usize, accuracy: f64) {
    compare_each!(
        separation, (seed, rounds, accuracy),
        segment cylinder, triangle cylinder, cuboid cylinder, hull cylinder, blade cylinder,
        segment cone, triangle cone, cuboid cone, hull cone, blade cone, cylinder cone, cone cone
    );
}

#[test]
fn answers_are_those_of_the_general_algorithm() {
    agree::<f64>(3, 600, 1e-12);
    agree::<f32>(4, 600, 3e-6);
}

/// Returns a pair at about the given signed distance: a random pair, moved three times along the
/// normal of its separation.
fn placed<'a, N: Real>(
    shapes: &'a Solids<N>,
    random: &mut Random,
    distance: f64,
) -> Pair<'a, N, 3> {
    let [first, second] = shapes.each_ref().map(|shape| shape.geometry().0);
    let mut pair = Pair { first, second, pose12: random.turn() };
    pair.pose12.translation = random.vector::<N>() * N::lit(2.0);
    for _ in 0..3 {
        let found = separation(&pair, N::INFINITY).expect("no limit");
        pair.pose12.translation += found.normal * (N::lit(distance) - found.distance);
    }
    pair
}

/// Returns the number of pairs at a signed distance that [`attempt`] decides, out of 100: the
/// smallest number over all combinations of kinds.
fn decided<N: Real>(distance: f64) -> usize {
    let random = &mut Random(7);
    let solids: [(Make<N>, Make<N>); 12] = [
        (segment, cylinder),
        (segment, cone),
        (capsule, cylinder),
        (capsule, cone),
        (triangle, cylinder),
        (triangle, cone),
        (cuboid, cylinder),
        (cuboid, cone),
        (hull, cylinder),
        (hull, cone),
        (cylinder, cone),
        (cone, cone),
    ];
    let mut decided = [0; 12];
    for (count, (first, second)) in decided.iter_mut().zip(solids) {
        for _ in 0..100 {
            let [size1, size2] =
                [(); 2].map(|()| random.vector::<N>().abs().map(|x| x + N::lit(0.1)));
            let shapes: Solids<N> = [first(size1), second(size2)];
            let pair = placed(&shapes, random, distance);
            *count += usize::from(attempt(&pair, N::INFINITY).is_some());
        }
    }
    decided.into_iter().fold(100, usize::min)
}

#[test]
fn most_pairs_are_decided() {
    for (distance, least) in [(1.0, 90), (0.05, 90), (0.001, 90), (-0.01, 30), (-0.2, 15)] {
        let [single, double] = [decided::<f32>(distance), decided::<f64>(distance)];
        assert!(single >= least && double >= least, "{single} and {double} of 100 at {distance}");
    }
}

/// Asserts for overlaps that [`attempt`] decides that no sampled direction has less depth than the
/// result.
fn none_is_better<N: Real>(accuracy: f64) {
    let random = &mut Random(9);
    let solids: [(Make<N>, Make<N>); 7] = [
        (segment, cone),
        (cuboid, cylinder),
        (cuboid, cone),
        (hull, cylinder),
        (hull, cone),
        (cylinder, cone),
        (cone, cone),
    ];
    let mut decided = 0;
    for round in 0..500 {
        let (first, second) = solids[round % solids.len()];
        let [size1, size2] = [(); 2].map(|()| random.vector::<N>().abs().map(|x| x + N::lit(0.05)));
        let shapes: Solids<N> = [first(size1), second(size2)];
        let pair = placed(&shapes, random, [-0.001, -0.01, -0.05, -0.2][round % 4]);
        let Some(Some(found)) = attempt(&pair, N::INFINITY) else { continue };
        if found.distance >= N::ZERO {
            continue;
        }
        decided += 1;
        let error = (depth(&pair, &found.normal) + found.distance).abs();
        assert!(error.as_f64() < accuracy, "round {round}: its own depth, {error}");
        for _ in 0..300 {
            let Some((normal, _)) = unit(&random.vector::<N>()) else { continue };
            let other = depth(&pair, &normal) + found.distance;
            assert!(other.as_f64() > -accuracy, "round {round}: {normal:?} is better by {other}");
        }
    }
    assert!(decided > 100, "{decided} are decided");
}

#[test]
fn no_direction_is_better() {
    none_is_better::<f64>(1e-13);
    none_is_better::<f32>(2e-6);
}

/// Asserts that the distance of a point equals the distance of a ball of radius zero, and that its
/// slope agrees with finite differences.
#[test]
fn projections_of_points() {
    let random = &mut Random(11);
    for round in 0..4000 {
        let size = random.vector::<f64>().abs().map(|x| x + 0.1);
        let solid = if round % 2 == 0 { cylinder(size) } else { cone(size) };
        let shapes: Solids<f64> = [Box::new(Ball::new(0.0)), solid];
        let [first, second] = shapes.each_ref().map(|shape| shape.geometry().0);
        let (point, along) = (random.vector::<f64>() * 2.0, random.vector::<f64>());
        let pair = Pair { first, second, pose12: Pose::from_translation(-point) };
        let truth = whole::separation(&pair, f64::INFINITY).expect("no limit").distance;
        let profile = Profile::new(Round::new(&second, 1.0).expect("it has a size"));
        let projected = profile.project(point);
        assert!(
            (projected.distance - truth).abs() < 1e-14,
            "round {round}: {projected:?}, not {truth}"
        );
        let moved = profile.project(point + along * 1e-6);
        if moved.part == projected.part && projected.distance.abs() > 0.01 {
            let slope = (moved.distance - projected.distance) / 1e-6;
            assert!(
                (slope - projected.slope(&along)).abs() < 1e-3,
                "round {round}: {slope}, {projected:?}"
            );
        }
    }
}
