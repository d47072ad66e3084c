//! Compares the distances with values computed by hand, with the `f64` reference, and with each
//! other.

use super::{Pose, Precise, Quad, Solid, separation_along, signed_distance};
use crate::geometry;
use crate::geometry::vector as plain;
use crate::random::Random;

fn apart(solid1: &Solid<3>, solid2: &Solid<3>, offset: [f64; 3]) -> Precise<3> {
    let still = |at| Pose::from_quaternion(at, [0.0, 0.0, 0.0, 1.0]);
    signed_distance(solid1, &still([0.0; 3]), solid2, &still(offset))
}

fn is<const D: usize>(found: &Precise<D>, expected: Quad) {
    let error = (found.distance - expected).abs().to_f64();
    assert!(error < 1e-28, "{found:?} is off by {error}");
    assert!(found.is_settled(1e-20), "{found:?}");
}

fn ratio(above: f64, below: f64) -> Quad {
    Quad::new(above) / Quad::new(below)
}

fn root(x: f64) -> Quad {
    Quad::new(x).sqrt()
}

#[test]
fn roots_to_thirty_digits() {
    let (ball, cuboid) = (Solid::ball(0.25), Solid::round_cuboid([1.0; 3], 0.0));
    is(&apart(&ball, &cuboid, [2.0, 3.0, 4.0]), root(14.0) - Quad::new(0.25));
    is(&apart(&cuboid, &cuboid, [3.0, 3.0, 3.0]), root(3.0));
    is(&apart(&cuboid, &cuboid, [1.5, 0.0, 0.0]), Quad::new(-0.5));
    // The lateral surface of this cone has the normal (4, 3) / 5.
    let beside_cone = root(8.0) * ratio(4.0, 5.0) - ratio(17.0, 20.0);
    is(&apart(&Solid::cone(2.0, 3.0), &ball, [2.0, 1.0, 2.0]), beside_cone);
    let cylinder = Solid::cylinder(2.0, 1.0);
    is(&apart(&cylinder, &cylinder, [3.0, 0.0, 2.0]), root(13.0) - Quad::new(2.0));
    is(&apart(&cylinder, &cylinder, [1.0, 0.0, 1.0]), root(2.0) - Quad::new(2.0));
    is(&apart(&cylinder, &ball, [0.5, 3.0, 0.0]), Quad::new(0.75));
}

#[test]
fn half_space_below_and_mantle_beside_a_tapered_capsule() {
    let ground = Solid::half_space([0.0, 3.0, 4.0]);
    let tapered = Solid::tapered_capsule([0.0, -1.0, 0.0], 1.0, [0.0, 1.0, 0.0], 0.5);
    is(&apart(&ground, &tapered, [0.0, 5.0, 0.0]), ratio(7.0, 5.0));
    // The radius grows by half a unit over a length of two: the sine of the slope is a quarter.
    let found = apart(&tapered, &Solid::ball(0.0), [3.0, 0.0, 0.0]);
    is(&found, ratio(15.0, 16.0).sqrt() * Quad::new(3.0) - Quad::new(0.75));
    assert!((found.normal[1] - Quad::new(0.25)).abs().to_f64() < 1e-28, "{found:?}");
}

/// A quaternion far from unit length gives the rotation of the normalized quaternion.
#[test]
fn rotations_are_brought_to_length_one() {
    let rod = Solid::capsule([0.0; 3], [0.0, 5.0, 0.0], 0.0);
    let turned = Pose::from_quaternion([0.0; 3], [3.0, 0.0, 0.0, 1.0]);
    // A rotation about x by twice the angle whose tangent is 3 maps y to (0, −4, 3) / 5.
    let ceiling = Pose::from_quaternion([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
    let found = signed_distance(&Solid::half_space([0.0, 1.0, 0.0]), &ceiling, &rod, &turned);
    is(&found, Quad::new(-4.0));
    let turned = Pose::from_complex([0.0; 2], [3.0, 4.0]);
    let still = Pose::from_complex([0.0; 2], [1.0, 0.0]);
    let rod = Solid::capsule([0.0; 2], [-5.0, 0.0], 0.0);
    is(&signed_distance(&Solid::half_space([0.0, 2.0]), &still, &rod, &turned), Quad::new(-4.0));
}

/// One solid in the types of this reference and of the `f64` reference.
struct Twin(Solid<3>, geometry::Solid<3>);

fn random_twin(random: &mut Random) -> Twin {
    let mut size = || random.range(0.1, 1.5);
    let (x, y, z) = (size(), size(), size());
    match random.below(6) {
        0 => Twin(Solid::ball(x), geometry::Solid::ball(x)),
        1 => {
            Twin(Solid::round_cuboid([x, y, z], 0.1), geometry::Solid::round_cuboid([x, y, z], 0.1))
        }
        2 => {
            let (a, b) = ([x, y, z], [-z, x, 0.0]);
            Twin(Solid::capsule(a, b, y), geometry::Solid::capsule(a, b, y))
        }
        3 => {
            let points: Vec<[f64; 3]> = (0..8).map(|_| random.vector(1.0)).collect();
            Twin(Solid::polytope(points.clone()), geometry::Solid::polytope(points))
        }
        4 => Twin(Solid::cylinder(x, y), geometry::Solid::Cylinder { half_height: x, radius: y }),
        _ => Twin(Solid::cone(x, y), geometry::Solid::Cone { half_height: x, radius: y }),
    }
}

#[test]
fn agrees_with_the_reference_in_f64_and_with_itself_swapped() {
    let mut random = Random::new(5);
    let (mut hits, mut settled) = (0, 0);
    for _ in 0..300 {
        let (one, two) = (random_twin(&mut random), random_twin(&mut random));
        let (q1, q2) = (random.quaternion(), random.quaternion());
        let (at1, at2) = (random.vector::<3>(0.5), random.vector::<3>(2.0));
        let (pose1, pose2) = (Pose::from_quaternion(at1, q1), Pose::from_quaternion(at2, q2));
        let found = signed_distance(&one.0, &pose1, &two.0, &pose2);
        let poses =
            (geometry::Pose::from_quaternion(at1, q1), geometry::Pose::from_quaternion(at2, q2));
        let rough = geometry::signed_distance(&one.1, &poses.0, &two.1, &poses.1);
        let distance = found.distance.to_f64();
        assert!(rough.error_of(distance) < 1e-14 * found.size, "{found:?} {rough:?}");
        let swapped = signed_distance(&two.0, &pose2, &one.0, &pose1);
        if found.is_settled(1e-20) && swapped.is_settled(1e-20) {
            let difference = (swapped.distance - found.distance).abs().to_f64();
            assert!(difference < 1e-20 * found.size, "{found:?} {swapped:?}");
            settled += 1;
        }
        let normal = super::vector::rounded(&found.normal);
        let along = separation_along(&one.0, &pose1, &two.0, &pose2, &normal);
        let loss = (found.distance - along.expect("no half-spaces")).to_f64();
        assert!((-1e-25..1e-13).contains(&loss), "{found:?} loses {loss}");
        hits += u32::from(distance < 0.0);
    }
    assert!((60..240).contains(&hits), "hits {hits}");
    assert!(settled > 290, "settled {settled}");
}

/// Places random ellipsoids at a known distance: if two support points differ by a multiple of
/// their common normal, they are the closest points. Asserts that the distance is found and proven.
fn ellipsoids_across<const D: usize>(
    random: &mut Random,
    pose: impl Fn(&mut Random, [f64; D]) -> Pose<D>,
) {
    for _ in 0..50 {
        let axes = |random: &mut Random| std::array::from_fn(|_| random.range(0.1, 2.0));
        let (one, two) = (Solid::ellipsoid(axes(random)), Solid::ellipsoid(axes(random)));
        let (pose1, mut pose2) = (pose(random, [0.0; D]), pose(random, [0.0; D]));
        let normal: [f64; D] = random.unit_vector();
        let gap = random.magnitude(1e-6, 22);
        let support = |solid: &Solid<D>, pose: &Pose<D>, direction: &[f64; D]| {
            let parts = super::solid::placed(solid, pose, &[0.0; D]);
            super::solid::support64(&parts, direction)
        };
        let from = support(&two, &pose2, &plain::negate(&normal));
        let target = plain::add(&support(&one, &pose1, &normal), &plain::scale(&normal, gap));
        pose2.translation = plain::sub(&target, &from);
        let found = signed_distance(&one, &pose1, &two, &pose2);
        assert!((found.distance.to_f64() - gap).abs() < 1e-14, "{found:?}, not {gap}");
        assert!(found.gap < 1e-20, "{found:?}");
    }
}

#[test]
fn ellipsoids_apart_are_proven() {
    let mut random = Random::new(6);
    ellipsoids_across::<3>(&mut random, |random, at| {
        Pose::from_quaternion(at, random.quaternion())
    });
    ellipsoids_across::<2>(&mut random, |random, at| Pose::from_complex(at, random.unit_vector()));
}

/// Asserts that a ball has the same distance from a box if it is a point with a radius and if it is
/// an ellipsoid, which use different code.
#[test]
fn two_ways_to_say_ball() {
    let mut random = Random::new(7);
    for _ in 0..50 {
        let r = random.range(0.1, 1.0);
        let half_extents = random.vector::<3>(1.0).map(f64::abs);
        let cuboid = Solid::round_cuboid(half_extents, 0.0);
        let pose = Pose::from_quaternion(random.vector(1.0), random.quaternion());
        let still = Pose::from_quaternion([0.0; 3], [0.0, 0.0, 0.0, 1.0]);
        let one = signed_distance(&Solid::ball(r), &still, &cuboid, &pose);
        let two = signed_distance(&Solid::ellipsoid([r; 3]), &still, &cuboid, &pose);
        assert!((one.distance - two.distance).abs().to_f64() < 1e-25, "{one:?} {two:?}");
    }
}
