//! Tests that the separation algorithms for a segment or capsule and a flat-faced or rounded solid,
//! a cylinder or a cone give the same results as the general algorithm, up to a tolerance.

use super::scene::{Random, Scene, describe};
use crate::collide::Pair;
use crate::collide::separation::separation_3d;
use crate::convex::{self, Separation};
use crate::math::{Point, Pose, Real, Space, Vector, max};
use crate::shape::{
    Capsule, Cone, ConvexHull, Cuboid, Cylinder, Geometry, Kind, Rounded, Segment, Shape, Triangle,
};

type Solid<N> = Box<dyn Shape<N, 3>>;

fn segment<N: Real>(kind: usize, scale: f64, random: &mut Random) -> Solid<N> {
    let point =
        |random: &mut Random| Point::from(random.vector::<f64, 3>(1.0).map(|x| N::lit(x * scale)));
    let length = |random: &mut Random| N::lit(random.between(0.1, 1.0) * scale);
    match kind {
        0 => Box::new(Segment::new(point(random), point(random))),
        1 => Box::new(Capsule::<N, 3>::new(length(random), length(random) * N::HALF)),
        // As long as the largest solids below, so that it can cross their edges and corners.
        2 => Box::new(Capsule::<N, 3>::new(N::lit(scale), N::lit(scale * 0.25))),
        _ => Box::new(Capsule::<N, 3>::new(N::ZERO, length(random))),
    }
}

fn solid<N: Real>(kind: usize, scale: f64, random: &mut Random) -> Solid<N> {
    let length = |random: &mut Random| N::lit(random.between(0.2, 1.0) * scale);
    let half = |random: &mut Random| Vector::<N, 3>::from_fn(|_, _| length(random));
    let point =
        |random: &mut Random| Point::from(random.vector::<f64, 3>(1.0).map(|x| N::lit(x * scale)));
    match kind {
        0 => Box::new(Cuboid::new(half(random))),
        1 => Box::new(Rounded::new(Cuboid::new(half(random)), length(random) * N::HALF)),
        2 => {
            let points: Vec<_> = (0..12).map(|_| point(random)).collect();
            Box::new(ConvexHull::from_points(&points))
        }
        3 => Box::new(Triangle::new(point(random), point(random), point(random))),
        4 => {
            let mut half = half(random);
            half[1] = N::ZERO;
            Box::new(Cuboid::new(half))
        }
        5 => Box::new(Cylinder::new(length(random), length(random))),
        6 => Box::new(Cone::new(length(random), length(random))),
        _ => Box::new(Cuboid::new(Vector::<N, 3>::repeat(N::lit(0.5 * scale)))),
    }
}

fn is_round<N: Real>(pair: &Pair<'_, N, 3>) -> bool {
    matches!(pair.second, Kind::Cylinder(..) | Kind::Cone(..))
}

/// Returns the tolerance of distances: 256 epsilons of `scale`, but for cylinders and cones at
/// least 8e-12 of it, because the general algorithm is accurate to 2⁻⁴⁰ of the size for curved
/// solids.
fn tolerance<N: Real>(pair: &Pair<'_, N, 3>, scale: f64) -> N {
    let least = if is_round(pair) { N::lit(8.0e-12) } else { N::ZERO };
    max(N::lit(256.0) * N::EPSILON, least) * N::lit(scale)
}

/// Returns a rotation vector: arbitrary, zero, nearly zero, or about the y axis.
fn turn(round: usize, random: &mut Random) -> [f64; 3] {
    let any = random.turn();
    match round % 5 {
        0 | 1 => any,
        2 => [0.0; 3],
        3 => any.map(|x| x * 1e-4),
        _ => [0.0, any[1], 0.0],
    }
}

/// Returns the separation by the general algorithm, the reference of the tests.
fn truth<N: Scene<3>>(pair: &Pair<'_, N, 3>) -> Separation<N, 3> {
    let [first, second] =
        [pair.first, pair.second].map(|kind| Geometry(kind).as_support_map().expect("a solid"));
    convex::separation(first, second, &pair.pose12, N::INFINITY).expect("no limit")
}

/// Visits 2400 random pairs. Two in three are moved along the normal, to a distance between -0.2
/// and 0.1 of `scale`; the others have random translations of up to `scale`.
fn visit<N: Scene<3>>(
    (seed, scale): (u64, f64),
    mut each: impl FnMut(&mut Pair<'_, N, 3>, usize, &mut Random),
) {
    let random = &mut Random(seed);
    for round in 0..2400_usize {
        let one = segment::<N>(round % 4, scale, random);
        let other = solid::<N>(round / 4 % 8, scale, random);
        let turn = turn(round / 24, random);
        let direction = random.vector::<N, 3>(scale);
        let mut pair = Pair {
            first: one.geometry().0,
            second: other.geometry().0,
            pose12: <N as Scene<3>>::pose(direction, turn),
        };
        if !round.is_multiple_of(3) {
            let found = truth(&pair);
            let target = N::lit(random.between(-0.2, 0.1) * scale);
            pair.pose12.translation += found.normal * (target - found.distance);
        }
        each(&mut pair, round, random);
    }
}

/// Asserts that the distances of both algorithms agree, that the normal is a unit vector, and that
/// the points lie at the distance from each other along the normal. Asserts that a limit slightly
/// above the distance does not change it, and that a limit slightly below it gives `None`.
fn separations<N: Scene<3> + Space<3>>(seed: u64, scale: f64) {
    visit::<N>((seed, scale), |pair, round, _| {
        let tolerance = tolerance(pair, scale);
        let truth = truth(pair);
        let found = separation_3d(pair, N::INFINITY).expect("no limit");
        let what = describe(pair);
        let off = (found.distance - truth.distance).abs();
        assert!(off <= tolerance, "round {round}: {found:?}\n{truth:?}\n{what}");
        let across = found.point2 - found.point1 - found.normal * found.distance;
        assert!(across.norm() <= tolerance, "round {round}: {found:?} {what}");
        assert!((found.normal.norm() - N::ONE).abs() < N::lit(64.0) * N::EPSILON, "{found:?}");
        let limited = separation_3d(pair, truth.distance + tolerance);
        assert_eq!(limited.map(|limited| limited.distance), Some(found.distance), "{what}");
        assert!(separation_3d(pair, truth.distance - tolerance).is_none(), "{what}");
    });
}

#[test]
fn separations_are_those_of_the_general_algorithm() {
    for (seed, scale) in [(1, 1.0), (2, 2.0_f64.powi(20)), (3, 2.0_f64.powi(-30))] {
        separations::<f32>(seed, scale);
        separations::<f64>(seed + 10, scale);
    }
}

#[test]
fn numbers_that_are_none_are_no_contacts() {
    let capsule = Capsule::<f32, 3>::new(1.0, 0.5);
    let cuboid = Cuboid::new(Vector::<f32, 3>::repeat(1.0));
    for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
        let pose12 = Pose::from_translation(Vector::<f32, 3>::new(0.0, bad, 0.0));
        let pair = Pair { first: capsule.geometry().0, second: cuboid.geometry().0, pose12 };
        assert_eq!(separation_3d(&pair, 1.0), None, "{bad}");
    }
}
