//! Hashes of the results of queries for each shape and for all pairs of shapes, and of a world with
//! two objects of each shape.

use std::array::from_fn;
use std::fmt::Debug;
use std::hash::Hasher;

use impinge::math::na::{Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion};
use impinge::math::{
    AbstractRotation, Isometry, Isometry2, Isometry3, Point, Real, Space, Unit, Vector,
};
use impinge::narrow_phase::GeometricQueryType;
use impinge::procedural::space as surfaces;
use impinge::query::{
    PointQuery, Ray, RayCast, closest_points, contact, distance, proximity, time_of_impact, witness,
};
use impinge::shape::{
    Ball, Capsule, Compound, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid,
    HeightField, Plane, Polyline, Rounded, Segment, Shape, ShapeHandle, TaperedCapsule, TriMesh,
    Triangle,
};
use impinge::world::{CollisionGroups, CollisionWorld};

use crate::scene_stage::{Digest, digest_state};

/// The positions of shapes. Their rotations are constants too, since the sines of different
/// platforms differ.
const PLACES: [[f64; 3]; 4] = [[0.0; 3], [1.5, 0.25, -0.5], [0.3, -0.2, 0.1], [4.0, 1.0, 2.0]];

/// Returns the hash of the results in 2D.
pub(crate) fn in_plane<N: Real>() -> u64 {
    let turns = [[1.0, 0.0], [0.6, 0.8], [1.0, 0.0], [-0.8, 0.6]];
    let poses = from_fn(|index| {
        let [x, y, _] = PLACES[index].map(N::lit);
        let [cosine, sine] = turns[index].map(N::lit);
        let turn = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation2::new(x, y), turn)
    });
    of_all(&shapes_of_plane(), &poses)
}

/// Returns the hash of the results in 3D.
pub(crate) fn in_space<N: Real>() -> u64 {
    let turns = [[1.0, 0.0, 0.0, 0.0], [0.8, 0.36, 0.48, 0.0], [1.0, 0.0, 0.0, 0.0], [0.5; 4]];
    let poses = from_fn(|index| {
        let [x, y, z] = PLACES[index].map(N::lit);
        let [w, i, j, k] = turns[index].map(N::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation3::new(x, y, z), turn)
    });
    of_all(&shapes_of_space(), &poses)
}

fn of_all<N, R, const D: usize>(shapes: &[ShapeHandle<N, D>], poses: &[Isometry<N, R, D>; 4]) -> u64
where
    R: AbstractRotation<N, D> + Clone,
    N: Space<D, Isometry = Isometry<N, R, D>>,
{
    let mut digest = Digest::new();
    for shape1 in shapes {
        one(&**shape1, &poses[1], &mut digest);
        for shape2 in shapes {
            for pose2 in poses {
                two([&**shape1, &**shape2], [&poses[0], pose2], &mut digest);
            }
        }
    }
    together(shapes, poses, &mut digest);
    digest.finish()
}

/// Adds a result to the digest. Numbers are formatted with as many digits as are needed to
/// distinguish them.
fn note(answer: &impl Debug, digest: &mut Digest) {
    digest.write(format!("{answer:?}").as_bytes());
}

/// Runs the ray casts and point queries of one shape.
fn one<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
    digest: &mut Digest,
) {
    for step in 0..9 {
        let offset = Vector::<N, D>::from_fn(|axis, _| {
            N::lit([0.0, 0.25, -1.5][(step / [1, 3, 2][axis]) % 3])
        });
        let point = Point::from(pose.translation.vector + offset);
        note(&shape.project_point_with_location(pose, &point, true), digest);
        note(&shape.distance_to_point(pose, &point, false), digest);
        let ray = Ray::new(point, Vector::<N, D>::repeat(N::ONE) - offset);
        note(&shape.toi_and_normal_with_ray(pose, &ray, false), digest);
    }
}

/// Runs the queries of a pair of shapes.
fn two<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    [g1, g2]: [&dyn Shape<N, D>; 2],
    [m1, m2]: [&Isometry<N, R, D>; 2],
    digest: &mut Digest,
) {
    let (far, margin) = (N::lit(10.0), N::HALF);
    note(&distance(m1, g1, m2, g2), digest);
    note(&contact(m1, g1, m2, g2, margin), digest);
    note(&closest_points(m1, g1, m2, g2, far), digest);
    note(&proximity(m1, g1, m2, g2, margin), digest);
    note(&witness(m1, g1, m2, g2, far), digest);
    let (rest, velocity) = (Vector::<N, D>::zeros(), m1.translation.vector - m2.translation.vector);
    note(&time_of_impact(m1, &rest, g1, m2, &velocity, g2), digest);
}

/// Runs a world with two objects of each shape, at four positions in turn, for three steps.
fn together<N, R, const D: usize>(
    shapes: &[ShapeHandle<N, D>],
    poses: &[Isometry<N, R, D>; 4],
    digest: &mut Digest,
) where
    R: AbstractRotation<N, D> + Clone,
    N: Space<D, Isometry = Isometry<N, R, D>>,
{
    let mut world = CollisionWorld::<N, D, usize>::new(N::lit(0.02));
    let query = GeometricQueryType::Contacts(N::lit(0.01), N::ZERO);
    let mut handles = Vec::new();
    for (index, shape) in shapes.iter().cycle().take(2 * shapes.len()).enumerate() {
        let pose = poses[index % 4].clone();
        handles.push(world.add(pose, shape.clone(), CollisionGroups::new(), query, index));
    }
    for _ in 0..3 {
        world.update();
        digest_state(&world, digest);
        for (index, handle) in handles.iter().enumerate() {
            let mut pose = poses[index % 4].clone();
            let axis = index % D;
            pose.translation.vector[axis] += N::lit(0.01);
            world.set_position(*handle, pose);
        }
    }
}

/// Returns the shapes that exist in both dimensions.
fn shapes<N: Space<D>, const D: usize>(corners: &[Point<N, D>; 3]) -> Vec<ShapeHandle<N, D>> {
    let [a, b, c] = *corners;
    let half = Vector::<N, D>::from_fn(|axis, _| N::lit([1.0, 0.5, 2.0][axis]));
    let mut up = Vector::<N, D>::zeros();
    up[1] = N::ONE;
    vec![
        ShapeHandle::new(Ball::new(N::ONE)),
        ShapeHandle::new(Segment::new(a, b)),
        ShapeHandle::new(Capsule::<N, D>::new(N::ONE, N::HALF)),
        ShapeHandle::new(Triangle::<N, D>::new(a, b, c)),
        ShapeHandle::new(Cuboid::new(half)),
        ShapeHandle::new(Ellipsoid::new(half)),
        ShapeHandle::new(TaperedCapsule::<N, D>::new(N::ONE, N::HALF, N::ONE)),
        ShapeHandle::new(Rounded::new(Cuboid::new(half), N::HALF)),
        ShapeHandle::new(Plane::<N, D>::new(Unit::new_unchecked(up))),
        ShapeHandle::new(Polyline::open(vec![a, b, c, a + (c - b)])),
        ShapeHandle::new(TriMesh::new(vec![a, b, c, b + (c - a)], vec![[0, 1, 2], [2, 1, 3]])),
    ]
}

fn shapes_of_plane<N: Real>() -> Vec<ShapeHandle<N, 2>> {
    let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x), N::lit(y));
    let mut all = shapes(&[p(-1.0, -0.5), p(1.0, -0.25), p(0.25, 1.0)]);
    let square = [p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)];
    let polygon = ConvexPolygon::from_points(&square);
    let heights = [0.0, 1.0, 0.5, -1.0, 0.0].map(N::lit).to_vec();
    let children = vec![
        (Isometry2::translation(N::ONE, N::ZERO), ShapeHandle::new(Ball::new(N::ONE))),
        (Isometry2::identity(), ShapeHandle::new(Polyline::closed(square.to_vec()))),
    ];
    all.push(ShapeHandle::new(polygon.clone()));
    all.push(ShapeHandle::new(Rounded::new(polygon, N::HALF)));
    let size = Vector::<N, 2>::new(N::lit(4.0), N::ONE);
    all.push(ShapeHandle::new(HeightField::<N, 2>::new(heights, size)));
    all.push(ShapeHandle::new(Compound::new(children)));
    all
}

fn shapes_of_space<N: Real>() -> Vec<ShapeHandle<N, 3>> {
    let p = |x: f64, y: f64, z: f64| Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z));
    let mut all = shapes(&[p(-1.0, -0.5, 0.0), p(1.0, -0.25, 0.5), p(0.25, 1.0, -0.5)]);
    let cube = surfaces::cuboid(&Cuboid::new(Vector::<N, 3>::repeat(N::ONE)));
    // A convex hull with more than eight vertices.
    let stone = [p(1.2, 0.0, 0.1), p(0.0, 1.3, 0.2), p(-0.1, 0.3, -1.4)];
    let hull = ConvexHull::from_points(&[&cube.vertices[..], &stone[..]].concat());
    let heights = [0.0, 1.0, 0.5, -1.0, 0.0, 0.25].map(N::lit).to_vec();
    let size = Vector::<N, 3>::new(N::lit(4.0), N::ONE, N::lit(4.0));
    let closed = ShapeHandle::new(TriMesh::new(cube.vertices, cube.triangles));
    let children = vec![
        (Isometry3::translation(N::ONE, N::ZERO, N::ZERO), ShapeHandle::new(Ball::new(N::ONE))),
        (Isometry3::identity(), closed.clone()),
    ];
    all.push(ShapeHandle::new(hull.clone()));
    all.push(ShapeHandle::new(Rounded::new(hull, N::HALF)));
    all.push(ShapeHandle::new(Cylinder::new(N::ONE, N::HALF)));
    all.push(ShapeHandle::new(Cone::new(N::ONE, N::ONE)));
    all.push(ShapeHandle::new(Rounded::new(Cylinder::new(N::ONE, N::HALF), N::HALF)));
    all.push(ShapeHandle::new(HeightField::<N, 3>::new(2, 3, heights, size)));
    all.push(closed);
    all.push(ShapeHandle::new(Compound::new(children)));
    all
}
