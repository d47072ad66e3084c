//! Asserts that searches return the pair of parts that a brute-force test of all pairs finds, and
//! that lower bounds do not exceed computed distances.

use super::nearest::nearest_between;
use super::solid_bounds::SolidBounds;
use super::{Between, PartSeparation, Wanted};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::Pair;
use crate::collide::separation::hulls::tests::Random;
use crate::collide::separation::separation;
use crate::math::{Matrix, Point, Pose, Real, Space, Vector, unit};
use crate::procedural::space::ellipsoid;
use crate::samples::samples;
use crate::shape::{
    Ball, Capsule, CompositeShape, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid,
    Rounded, Segment, Shape, TriMesh, Triangle,
};

type Solids<N, const D: usize> = Vec<Box<dyn Shape<N, D>>>;

/// Returns a mesh of 40 triangles of four sizes, some of them thin or perpendicular to a coordinate
/// axis (in 2D, without area), and a copy of one triangle.
fn soup<N: Space<D>, const D: usize>(
    random: &mut Random,
    vector: fn(&mut Random) -> Vector<N, D>,
) -> TriMesh<N, D> {
    let mut corners = Vec::new();
    for number in 0..40 {
        let size = N::lit([0.05, 0.2, 0.6, 1.5][number % 4]);
        let (position, mut arms) = (vector(random), [(); 2].map(|()| vector(random) * size));
        match number % 7 {
            3 => arms[1] = arms[0] * N::HALF + arms[1] * N::lit(1e-3),
            5 => arms.iter_mut().for_each(|arm| arm[number % D] = N::ZERO),
            _ => (),
        }
        corners.extend([position, position + arms[0], position + arms[1]].map(Point::from));
    }
    let triangle = |first: u32| [3 * first, 3 * first + 1, 3 * first + 2];
    let triangles: Vec<_> = (0..40).chain([7]).map(triangle).collect();
    TriMesh::new(corners, triangles)
}

/// Returns the nearest pair, or the deepest if parts overlap, by a test of all pairs of parts.
fn of_all<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    counts: [u32; 2],
) -> PartSeparation<N, D> {
    let all = (0..counts[0]).flat_map(|part1| (0..counts[1]).map(move |part2| [part1, part2]));
    let found = all.map(|parts| {
        let placed = between.parts(parts);
        let local = separation(&placed.pair(), N::INFINITY).expect("no limit");
        PartSeparation { separation: placed.in_first(&local), local, parts }
    });
    found.reduce(|best, next| if next.is_before(&best) { next } else { best }).expect("some parts")
}

/// Asserts that the search for [`Wanted::Deepest`] returns the best pair, and the search for
/// [`Wanted::Touching`] a pair with the best distance or, if that is an overlap, any touching pair.
/// Asserts that there is no result for a limit slightly below the best distance. Returns the best
/// distance.
fn check<N: Space<D>, const D: usize>(pair: &Pair<'_, N, D>, counts: [u32; 2]) -> N {
    let between = Between::of_pair(pair);
    let best = of_all(&between, counts);
    let distance = best.separation.distance;
    for limit in [N::INFINITY, distance] {
        let found = nearest_between(&between, limit, Wanted::Deepest, None).expect("within it");
        assert_eq!(
            (found.parts, found.separation.distance),
            (best.parts, distance),
            "at {:?}",
            pair.pose12
        );
        let found = nearest_between(&between, limit, Wanted::Touching, None).expect("within it");
        let known = found.separation.distance;
        assert!(
            known == distance || (known <= N::ZERO && distance <= N::ZERO),
            "at {:?}",
            pair.pose12
        );
    }
    let less = distance - distance.abs() * N::lit(1e-3) - N::lit(1e-6);
    assert!(
        nearest_between(&between, less, Wanted::Deepest, None).is_none(),
        "at {:?}",
        pair.pose12
    );
    distance
}

fn searches<N: Space<D>, const D: usize>(
    solids: &Solids<N, D>,
    vector: fn(&mut Random) -> Vector<N, D>,
    turn: fn(&mut Random) -> Pose<N, D>,
) {
    let random = &mut Random(3);
    let (mesh, other) = (soup(random, vector), soup(random, vector));
    let (first, parts) = (mesh.geometry().0, mesh.num_parts());
    let mut overlaps = [0; 2];
    for round in 0..samples(8) {
        let distance = N::lit([0.3, 1.0, 2.0, 8.0][round % 4]);
        let pose12 = Pose { translation: vector(random) * distance, ..turn(random) };
        let second = other.geometry().0;
        let distance = check(&Pair { first, second, pose12 }, [parts, other.num_parts()]);
        overlaps[usize::from(distance > N::ZERO)] += 1;
        for solid in solids {
            let pair = Pair { first, second: solid.geometry().0, pose12 };
            let distance = check(&pair, [parts, 1]);
            overlaps[usize::from(distance > N::ZERO)] += 1;
            bounds(&pair, &mesh, random, vector);
        }
    }
    assert!(overlaps.iter().all(|count| count * 6 > overlaps[0] + overlaps[1]), "{overlaps:?}");
}

/// Asserts that searches of a finely tessellated ellipsoid find the nearest part. The mesh has over
/// 1000 triangles, so the tree has several levels. The other solid lies inside, crosses the
/// surface, or lies near or far outside; its axes are parallel to the axes of the ellipsoid or
/// rotated.
fn searches_of_surface<N: Space<3>>() {
    let half = Vector::<N, 3>::new(N::ONE, N::lit(0.75), N::HALF);
    let surface = ellipsoid(&Ellipsoid::new(half), 40);
    let mesh = TriMesh::new(surface.vertices, surface.triangles);
    let (first, parts, random) = (mesh.geometry().0, mesh.num_parts(), &mut Random(5));
    let mut overlaps = [0; 2];
    for distance in [0.0, 0.5, 0.75, 1.0, 1.25, 1.5, 4.0, 1e4] {
        let along = Vector::<N, 3>::new(N::lit(distance), N::ZERO, N::ZERO);
        let aside = random.vector::<N>() * N::lit(distance);
        for pose12 in [
            Pose::from_translation(along),
            Pose { translation: along, ..random.turn() },
            Pose { translation: aside, ..random.turn() },
        ] {
            for solid in solids_3d() {
                let pair = Pair { first, second: solid.geometry().0, pose12 };
                overlaps[usize::from(check(&pair, [parts, 1]) > N::ZERO)] += 1;
            }
        }
    }
    assert!(parts > 1000 && overlaps.iter().all(|&count| count > 40), "{parts} {overlaps:?}");
}

/// Asserts that lower bounds do not exceed the distances of the parts, and that
/// [`SolidBounds::of_part`] is below the distance by less than 2.5 times half the diagonal of the
/// part's box, plus 1e-4.
fn bounds<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    mesh: &TriMesh<N, D>,
    random: &mut Random,
    vector: fn(&mut Random) -> Vector<N, D>,
) {
    let between = Between::of_pair(pair);
    let solid = SolidBounds::of(&between, 1).expect("a convex solid");
    for number in 0..mesh.num_parts() {
        let placed = between.parts([number, 0]);
        let found = separation(&placed.pair(), N::INFINITY).expect("no limit").distance;
        let part = mesh.part(number);
        let aabb = part.solid.as_shape().aabb(&part.pose);
        let (of_part, of_box) = (solid.of_part(&part, &aabb), solid.of_box(&aabb));
        assert!(
            of_part <= found && of_box <= found,
            "{of_part} {of_box} {found} at {:?}",
            pair.pose12
        );
        let size = aabb.half_extents().norm() * N::lit(2.5) + N::lit(1e-4);
        assert!(of_part > found - size, "{of_part} is far from {found} at {:?}", pair.pose12);
        let position = Point::from(vector(random));
        let around = Aabb::new(position, position).merged(&aabb);
        assert!(solid.of_box(&around) <= found, "a larger box at {:?}", pair.pose12);
    }
}

fn solids_3d<N: Space<3>>() -> Solids<N, 3> {
    let half = Vector::<N, 3>::new(N::lit(0.5), N::lit(0.3), N::lit(0.2));
    let random = &mut Random(8);
    let points: Vec<_> =
        (0..20).map(|_| Point::from(random.vector::<N>().component_mul(&half))).collect();
    vec![
        Box::new(Ball::new(N::lit(0.4))),
        Box::new(Segment::new(points[0], points[1])),
        Box::new(Capsule::new(N::lit(0.4), N::lit(0.1))),
        Box::new(Triangle::new(points[0], points[1], points[2])),
        Box::new(Cuboid::new(half)),
        Box::new(ConvexHull::from_points(&points)),
        Box::new(Cylinder::new(N::lit(0.4), N::lit(0.2))),
        Box::new(Cone::new(N::lit(0.4), N::lit(0.2))),
        Box::new(Ellipsoid::new(half)),
        Box::new(Rounded::new(Cuboid::new(half), N::lit(0.1))),
    ]
}

fn solids_2d<N: Space<2>>() -> Solids<N, 2> {
    let half = Vector::<N, 2>::new(N::lit(0.5), N::lit(0.2));
    let random = &mut Random(8);
    let points: Vec<_> =
        (0..9).map(|_| Point::from(random.vector::<N>().xy().component_mul(&half))).collect();
    vec![
        Box::new(Ball::new(N::lit(0.4))),
        Box::new(Segment::new(points[0], points[1])),
        Box::new(Triangle::new(points[0], points[1], points[2])),
        Box::new(Cuboid::new(half)),
        Box::new(ConvexPolygon::from_points(&points)),
        Box::new(Ellipsoid::new(half)),
        Box::new(Rounded::new(Cuboid::new(half), N::lit(0.1))),
    ]
}

fn random_rotation<N: Real>(random: &mut Random) -> Pose<N, 2> {
    let direction =
        unit(&random.vector::<N>().xy()).map_or_else(Vector::<N, 2>::x, |(direction, _)| direction);
    let mut pose = Pose::<N, 2>::identity();
    pose.rotation = Matrix::<N, 2>::new(direction.x, -direction.y, direction.y, direction.x);
    pose
}

#[test]
fn no_part_is_nearer_than_the_one_that_is_found() {
    searches::<f32, 3>(&solids_3d(), Random::vector, Random::turn);
    searches::<f32, 2>(&solids_2d(), |random| random.vector().xy(), random_rotation);
    searches_of_surface::<f32>();
}

#[test]
fn no_part_is_nearer_in_double_precision() {
    searches::<f64, 3>(&solids_3d(), Random::vector, Random::turn);
    searches::<f64, 2>(&solids_2d(), |random| random.vector().xy(), random_rotation);
    searches_of_surface::<f64>();
}
