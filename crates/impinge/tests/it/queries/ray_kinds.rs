//! Tests that every kind of shape is hit from above at its top, in both dimensions and with both
//! scalars, and that hulls agree with cuboids.

use crate::support::solids;

use impinge::math::{Point, Real, Space, Unit, Vector};
use impinge::query::{PointQuery, Ray, RayCast};
use impinge::shape::{
    self, Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, FeatureId, Plane,
    Rounded, Segment, ShapeHandle, ShapeKind, TaperedCapsule, Triangle,
};
use solids::{Ellipsoid, Rng, narrow};

fn point<N: Real, const D: usize>(coordinates: [f64; D]) -> Point<N, D> {
    Point::from(Vector::<f64, D>::from(coordinates).map(N::lit))
}

/// Returns one shape of each kind that exists in both dimensions. Above the origin, all have their
/// top at y = 1, except for the half-space, which has it at y = 0.
fn common<N: Real, const D: usize>(
    left: Point<N, D>,
    right: Point<N, D>,
) -> Vec<ShapeHandle<N, D>> {
    let mut up = Vector::<N, D>::zeros();
    up[1] = N::ONE;
    let ones = Vector::<N, D>::repeat(N::ONE);
    vec![
        ShapeHandle::new(Ball::new(N::ONE)),
        ShapeHandle::new(Segment::new(left, right)),
        ShapeHandle::new(Capsule::<N, D>::new(N::HALF, N::HALF)),
        ShapeHandle::new(Cuboid::new(ones)),
        ShapeHandle::new(Ellipsoid(ones)),
        ShapeHandle::new(shape::Ellipsoid::new(ones)),
        ShapeHandle::new(TaperedCapsule::<N, D>::new(N::HALF, N::ONE, N::HALF)),
        ShapeHandle::new(Rounded::<N, D>::new(Cuboid::new(ones * N::HALF), N::HALF)),
        ShapeHandle::new(Plane::new(Unit::new_unchecked(up))),
    ]
}

fn plane_kinds<N: Real>() -> Vec<ShapeHandle<N, 2>> {
    let mut shapes = common::<N, 2>(point([-1.0, 1.0]), point([1.0, 1.0]));
    let [a, b, c] = [point([-1.0, 0.0]), point([1.0, 0.0]), point([0.0, 1.0])];
    shapes.push(ShapeHandle::new(Triangle::new(a, b, c)));
    shapes.push(ShapeHandle::new(ConvexPolygon::from_points(&[a, b, c])));
    shapes
}

fn space_kinds<N: Real>() -> Vec<ShapeHandle<N, 3>> {
    let mut shapes = common::<N, 3>(point([-1.0, 1.0, 0.0]), point([1.0, 1.0, 0.0]));
    let [a, b, c] = [[-1.0, 1.0, -1.0], [1.0, 1.0, -1.0], [0.0, 1.0, 2.0]].map(point);
    shapes.push(ShapeHandle::new(Triangle::new(a, b, c)));
    shapes.push(ShapeHandle::new(ConvexHull::from_points(&cube_corners())));
    shapes.push(ShapeHandle::new(Cylinder::new(N::ONE, N::ONE)));
    shapes.push(ShapeHandle::new(Cone::new(N::ONE, N::ONE)));
    shapes
}

fn cube_corners<N: Real>() -> Vec<Point<N, 3>> {
    let sign = |bits: u32, bit: u32| if bits >> bit & 1 == 1 { 1.0 } else { -1.0 };
    (0..8).map(|bits| point([sign(bits, 0), sign(bits, 1), sign(bits, 2)])).collect()
}

/// Returns a ray downwards along y from `height`, with a direction of length `length`.
fn falling<N: Real, const D: usize>(height: f64, length: f64) -> Ray<N, D> {
    let (mut origin, mut dir) = (Vector::<f64, D>::zeros(), Vector::<f64, D>::zeros());
    (origin[1], dir[1]) = (height, -length);
    Ray::new(Point::from(narrow(&origin)), narrow(&dir))
}

fn check_kind<N: Space<D>, const D: usize>(shape: &ShapeHandle<N, D>) {
    let top = if shape.geometry().kind() == ShapeKind::Plane { 0.0 } else { 1.0 };
    let close = 1e3 * N::EPSILON.as_f64().max(1e-15);
    for (height, length) in [(3.0, 1.0), (3.0, 1000.0), (1025.0, 1.0 / 1024.0), (1.5, 0.25)] {
        let ray = falling::<N, D>(height, length);
        let hit = shape.cast_local_ray(&ray, true);
        let what = format!("{shape:?} from {height}: {hit:?}");
        let hit = hit.expect(&what);
        let travelled = hit.toi.as_f64() * length;
        assert!((travelled - (height - top)).abs() <= close * height, "{what}");
        let distance = shape.distance_to_point(&no_pose::<N, D>(), &ray.origin, true).as_f64();
        assert!((distance - travelled).abs() <= close * height, "{distance}: {what}");
        let back = Ray::new(ray.origin, -ray.dir);
        assert_eq!(shape.cast_local_ray(&back, true), None, "it is behind: {what}");
    }
}

/// Returns the identity. Its rotation is a matrix, a type that exists in every dimension.
fn no_pose<N: Real, const D: usize>()
-> impinge::math::Isometry<N, impinge::math::na::Rotation<N, D>, D>
where
    impinge::math::na::Rotation<N, D>: impinge::math::AbstractRotation<N, D>,
{
    impinge::math::Isometry::identity()
}

fn kinds<N: Space<D>, const D: usize>(shapes: &[ShapeHandle<N, D>], expected: &[ShapeKind]) {
    let mut seen: Vec<_> = shapes.iter().map(|shape| shape.geometry().kind()).collect();
    seen.sort();
    assert_eq!(seen, expected, "one of each");
    shapes.iter().for_each(check_kind);
}

#[test]
fn every_kind_is_hit_from_above() {
    use ShapeKind as K;
    let plane = [
        K::Ball,
        K::Segment,
        K::Capsule,
        K::Triangle,
        K::Cuboid,
        K::Polytope,
        K::Ellipsoid,
        K::TaperedCapsule,
        K::Rounded,
        K::SupportMap,
        K::Plane,
    ];
    let space = [
        K::Ball,
        K::Segment,
        K::Capsule,
        K::Triangle,
        K::Cuboid,
        K::Polytope,
        K::Cylinder,
        K::Cone,
        K::Ellipsoid,
        K::TaperedCapsule,
        K::Rounded,
        K::SupportMap,
        K::Plane,
    ];
    kinds(&plane_kinds::<f32>(), &plane);
    kinds(&plane_kinds::<f64>(), &plane);
    kinds(&space_kinds::<f32>(), &space);
    kinds(&space_kinds::<f64>(), &space);
}

/// Asserts that a cube as a hull gives the results of a cuboid, even at corners and edges and along
/// faces.
fn cube<N: Real>() {
    let hull = ConvexHull::<N>::from_points(&cube_corners());
    let cuboid = Cuboid::<N, 3>::new(Vector::<N, 3>::repeat(N::ONE));
    let mut rng = Rng::new(21);
    let mut hits = 0;
    for _ in 0..2000 {
        // Multiples of 0.5, so that many lines run through corners and edges or in faces.
        let mut quarters = || rng.vector::<3>(3.0).map(|x| (x * 2.0).round() / 2.0);
        let (origin, dir) = (quarters(), quarters());
        let ray = Ray::new(Point::from(narrow(&origin)), narrow(&dir));
        for solid in [true, false] {
            let found = hull.cast_local_ray(&ray, solid).map(|hit| hit.toi);
            let expected = cuboid.cast_local_ray(&ray, solid).map(|hit| hit.toi);
            let same = match (found, expected) {
                (Some(found), Some(expected)) => (found - expected).abs() <= N::EPSILON * N::TWO,
                (found, expected) => found == expected,
            };
            assert!(same, "{ray:?} solid {solid}: {found:?}, {expected:?}");
            hits += u32::from(found.is_some());
        }
        let (near, _) = hull.project_local_point(&ray.origin);
        let (expected, _) = cuboid.project_local_point(&ray.origin);
        assert_eq!(near.is_inside, expected.is_inside, "{origin}");
        let depth = |point: &Point<N, 3>| (point - ray.origin).norm();
        assert_eq!(depth(&near.point), depth(&expected.point), "{origin}");
    }
    assert!((400..3000).contains(&hits), "{hits} of 4000");
}

#[test]
fn a_hull_of_eight_corners_is_a_cuboid() {
    cube::<f32>();
    cube::<f64>();
}

#[test]
fn hulls_name_their_features() {
    let hull = ConvexHull::<f64>::from_points(&cube_corners());
    let beyond = |x: f64, y: f64, z: f64| hull.project_local_point(&point([x, y, z])).1;
    assert!(matches!(beyond(0.0, 3.0, 0.5), FeatureId::Face(_)), "over a face");
    assert!(matches!(beyond(2.0, 3.0, 0.5), FeatureId::Edge(_)), "over an edge");
    let FeatureId::Vertex(index) = beyond(2.0, -3.0, 2.0) else { panic!("over a vertex") };
    assert_eq!(hull.vertices()[index as usize], point([1.0, -1.0, 1.0]), "the nearest one");
}
