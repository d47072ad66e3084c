//! Corners on a half-space in one pass against the general builder.

use super::super::{build3, level_corners};
use super::scene::{Random, Scene, describe, request};
use crate::math::{Point, Pose, Real, Space, Unit, Vector, max};
use crate::query::separation::separation_in_space;
use crate::query::{Pair, RawManifold, RawPoint};
use crate::shape::{
    Capsule, ConvexHull, Cuboid, Kind, Plane, Rounded, Segment, Shape, SupportMap, Triangle,
};

fn solid<N: Real>(kind: usize, scale: f64, random: &mut Random) -> Box<dyn Shape<N, 3>> {
    let point =
        |random: &mut Random| Point::from(random.vector::<f64, 3>(1.0).map(|x| N::lit(x * scale)));
    let length = |random: &mut Random| N::lit(random.between(0.2, 1.0) * scale);
    let half = |random: &mut Random| Vector::<N, 3>::from_fn(|_, _| length(random));
    match kind {
        0 => Box::new(Cuboid::new(half(random))),
        1 => Box::new(Rounded::new(Cuboid::new(half(random)), length(random) * N::HALF)),
        2 | 3 => {
            let count = [12, 40][kind - 2];
            let points: Vec<_> = (0..count).map(|_| point(random)).collect();
            Box::new(ConvexHull::from_points(&points))
        }
        4 => Box::new(Triangle::new(point(random), point(random), point(random))),
        5 => Box::new(Segment::new(point(random), point(random))),
        6 => Box::new(Capsule::<N, 3>::new(length(random), length(random))),
        7 => {
            let mut half = half(random);
            half[1] = N::ZERO;
            Box::new(Cuboid::new(half))
        }
        8 => Box::new(Capsule::<N, 3>::new(N::ZERO, length(random))),
        _ => {
            let (a, b) = (point(random), point(random));
            Box::new(Triangle::new(a, b, a))
        }
    }
}

/// A direction: any, along an axis, or nearly so.
fn direction<N: Real>(round: usize, random: &mut Random) -> Vector<N, 3> {
    let any = random.vector::<N, 3>(1.0).normalize();
    let mut axis = Vector::<N, 3>::zeros();
    axis[round % 3] = if round.is_multiple_of(2) { N::ONE } else { -N::ONE };
    let off = [N::ONE, N::ZERO, N::lit(1e-3), N::lit(0.2)][round % 4];
    if round.is_multiple_of(4) { any } else { (axis + any * off).normalize() }
}

/// The same points but for rounding.
fn are_alike<N: Real>(found: &[RawPoint<N, 3>], other: &[RawPoint<N, 3>], room: N) -> bool {
    found.len() == other.len()
        && found.iter().zip(other).all(|(a, b)| {
            let names = [a.feature1, a.feature2] == [b.feature1, b.feature2] && a.id == b.id;
            let off = max((a.point1 - b.point1).norm(), (a.distance - b.distance).abs());
            names && off <= room
        })
}

/// Holds the two ways against each other over some steps; answers how often the quick one answered, and how
/// many points it had.
fn compare<N: Scene<3> + Space<3>>(seed: u64, scale: f64) -> (usize, usize) {
    let (random, mut answered, mut points) = (&mut Random(seed), 0, 0);
    for round in 0..1200_usize {
        let solid = solid::<N>(round % 10, scale, random);
        let up = Unit::new_normalize(random.vector::<N, 3>(1.0));
        let plane = Plane::new(up);
        let pose = <N as Scene<3>>::pose(Vector::<N, 3>::zeros(), random.turn());
        // The frame is such that the plane's normal is a direction of the solid.
        let wanted = direction::<N>(round / 10, random);
        let turn = crate::math::na::Rotation3::rotation_between(&pose.vector(&up), &-wanted);
        let turn = turn.unwrap_or_else(crate::math::na::Rotation3::identity);
        let rotation = turn.matrix() * pose.rotation;
        let mut pair = Pair {
            first: solid.geometry().0,
            second: Kind::Plane(&plane),
            pose12: Pose { rotation, translation: Vector::<N, 3>::zeros() },
        };
        let normal = -pair.pose12.vector(&up);
        let asked = request::<N>(0.05 * scale, [0.0, 0.0, 0.1][round / 10 % 3]);
        let deep = N::lit(random.between(-[0.1, 1.5][round / 40 % 2], 0.06) * scale);
        let found = separation_in_space(&pair, N::INFINITY).expect("near enough");
        pair.pose12.translation = normal * (deep - found.distance);
        let (mut quick, mut general) = (RawManifold::default(), RawManifold::default());
        for _ in 0..3 {
            match separation_in_space(&pair, asked.prediction) {
                Some(found) => build3(&pair, &found, &asked, &mut general),
                None => general.points.clear(),
            }
            if !level_corners::build(&pair, &asked, &mut quick) {
                quick = general.clone();
                continue;
            }
            let room = N::lit(64.0 * scale) * N::EPSILON;
            let what = describe(&pair);
            assert!(
                are_alike(&quick.points, &general.points, room),
                "round {round}, {what}:\n{quick:?}\n{general:?}"
            );
            if let Some(found) = separation_in_space(&pair, asked.prediction) {
                let deepest = quick.points[quick.deepest()].distance;
                assert_eq!((quick.normal, deepest), (found.normal, found.distance), "{what}");
            }
            (answered, points) = (answered + 1, points + quick.points.len());
            pair.pose12.translation += random.vector::<N, 3>(0.02).map(|x| x * N::lit(scale));
        }
    }
    (answered, points)
}

#[test]
fn corners_are_those_of_the_general_builder() {
    for (seed, scale) in [(1, 1.0), (2, 2.0_f64.powi(20)), (3, 2.0_f64.powi(-30))] {
        let counts = [compare::<f32>(seed, scale), compare::<f64>(seed + 10, scale)];
        for (answered, points) in counts {
            assert!(answered > 3000 && points > 4000, "{answered} manifolds, {points} points");
        }
    }
}

#[test]
fn numbers_that_are_none_give_no_points() {
    let cuboid = Cuboid::new(Vector::<f32, 3>::repeat(1.0));
    let plane = Plane::new(Unit::new_unchecked(Vector::<f32, 3>::y()));
    for bad in [f32::NAN, f32::INFINITY, -f32::INFINITY] {
        let pose12 = Pose::from_translation(Vector::<f32, 3>::new(0.0, bad, 0.0));
        let pair = Pair { first: Kind::Cuboid(&cuboid), second: Kind::Plane(&plane), pose12 };
        let mut out = RawManifold::default();
        assert!(level_corners::build(&pair, &request(0.1, 0.0), &mut out), "answered");
        assert!(out.points.is_empty(), "{bad}: {out:?}");
    }
    assert!(cuboid.reach() > 1.0, "a solid");
}
