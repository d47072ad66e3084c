//! Tests laws of composites that need no expected results: a solid and its surface agree, common
//! motion changes nothing, nesting changes nothing, and a search visits few parts.

use crate::support::composite_support;
use crate::support::query_support;

use std::sync::atomic::{AtomicUsize, Ordering};

use composite_support::{Piece, Pieces};
use impinge::bounding_volume::Aabb;
use impinge::math::{Isometry3, Point, Pose, Real, Unit, Vector};
use impinge::procedural::space as surfaces;
use impinge::query::{
    ImpactOptions, Moving, PointQuery, Ray, RayCast, distance, impact, proximity, witness,
};
use impinge::shape::{
    Ball, CompositeShape, Compound, Cuboid, Geometry, Part, PartSearch, Shape, ShapeHandle, TriMesh,
};
use query_support::random::Random;
use query_support::samples::{SPACE, sample3};

/// Returns a ball of radius 1 as a closed mesh, and the greatest distance between the sphere and
/// the plane of a triangle.
fn ball_mesh<N: Real>(subdivisions: u32) -> (TriMesh<N, 3>, N) {
    let surface = surfaces::ball(&Ball::new(N::ONE), subdivisions);
    let inside = |corners: [Point<N, 3>; 3]| {
        let middle = corners.iter().fold(Vector::<N, 3>::zeros(), |sum, p| sum + p.coords);
        let normal = (corners[1] - corners[0]).cross(&(corners[2] - corners[0]));
        N::ONE - (normal.dot(&middle) / N::lit(3.0) / normal.norm()).abs()
    };
    let error = surface.corners().map(inside).fold(N::ZERO, |a, b| if a > b { a } else { b });
    (TriMesh::new(surface.vertices, surface.triangles), error)
}

fn as_its_surface<N: Real>() {
    let (mesh, error) = ball_mesh::<N>(24);
    assert!(error < N::lit(0.02), "{error:?}");
    let (ball, noise) = (Ball::new(N::ONE), N::EPSILON * N::lit(1024.0));
    let random = &mut Random(1, false);
    let mut apart = 0;
    for seed in 0..200 {
        let kind = SPACE[seed % SPACE.len()];
        let solid = sample3::<N>(kind, random, N::HALF);
        let turn = random.turn3::<N>();
        let m1 = Isometry3::from_parts((random.vector::<N, 3>() * N::TWO).into(), turn);
        let m2 = Isometry3::from_parts(
            (random.vector::<N, 3>() * N::lit(6.0)).into(),
            random.turn3::<N>(),
        );
        let of_ball = distance(&m1, &ball, &m2, &*solid);
        if of_ball > N::ZERO {
            let of_mesh = distance(&m1, &mesh, &m2, &*solid);
            let right = of_mesh >= of_ball - noise && of_mesh <= of_ball + error + noise;
            assert!(right, "{kind:?} {of_ball:?} {of_mesh:?}");
            apart += 1;
        }
        let ray = Ray::new(
            Point::from(m2.translation.vector),
            m1.translation.vector - m2.translation.vector,
        );
        let at = |shape: &dyn Shape<N, 3>| shape.toi_with_ray(&m1, &ray, true);
        if let (Some(on_ball), Some(on_mesh)) = (at(&ball), at(&mesh)) {
            let way = (on_mesh - on_ball) * ray.dir.norm();
            let starts_inside = on_ball == N::ZERO;
            assert!(starts_inside || (way >= -noise && way <= error * N::TWO + noise), "{way:?}");
        }
        let of_point = mesh.distance_to_point(&m1, &ray.origin, true);
        let expected = (ray.dir.norm() - N::ONE).abs();
        assert!((of_point - expected).abs() <= error + noise, "{of_point:?} {expected:?}");
    }
    assert!(apart > 80, "{apart}");
}

#[test]
fn a_ball_is_as_its_surface() {
    as_its_surface::<f32>();
    as_its_surface::<f64>();
}

#[test]
fn common_motion_changes_nothing() {
    let (mesh, _) = ball_mesh::<f64>(8);
    let random = &mut Random(2, false);
    let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.25, 0.5, 1.0));
    for _ in 0..50 {
        let m1 = Isometry3::from_parts(random.vector::<f64, 3>().into(), random.turn3());
        let m2 = Isometry3::from_parts((random.vector::<f64, 3>() * 4.0).into(), random.turn3());
        let by = Isometry3::from_parts((random.vector::<f64, 3>() * 8.0).into(), random.turn3());
        let still = witness(&m1, &mesh, &m2, &cuboid, f64::INFINITY).expect("a witness");
        let moved = witness(&(by * m1), &mesh, &(by * m2), &cuboid, f64::INFINITY);
        let moved = moved.expect("a witness");
        assert!((still.distance - moved.distance).abs() < 1e-13, "{still:?} {moved:?}");
        if still.distance > 1e-3 {
            assert!((by * still.point1 - moved.point1).norm() < 1e-12, "{still:?} {moved:?}");
        }
    }
}

/// Asserts that a nested compound of meshes and solids has the results of a flat list of its parts,
/// and reports the path to each part.
#[test]
fn nested_is_as_flat() {
    let (mesh, _) = ball_mesh::<f64>(4);
    let mesh = ShapeHandle::new(mesh);
    let random = &mut Random(3, false);
    let mut place =
        || Isometry3::from_parts((random.vector::<f64, 3>() * 3.0).into(), random.turn3());
    let places = [0; 4].map(|_| place());
    let inner = Compound::new(vec![
        (places[0], ShapeHandle::new(Ball::new(0.5))),
        (places[1], mesh.clone()),
    ]);
    let inner = ShapeHandle::new(inner);
    let outer = Compound::new(vec![(places[2], mesh), (places[3], inner)]);
    let pose = |m: &Isometry3<f64>| Pose::from_isometry(m);
    let mut flat = Vec::new();
    for part in 0..outer.num_parts() {
        let Part { pose, solid } = outer.part(part);
        let piece = match solid {
            impinge::shape::PartSolid::Triangle(triangle) => Piece::Triangle(triangle),
            impinge::shape::PartSolid::Shape(_) => Piece::of(Ball::new(0.5)),
            impinge::shape::PartSolid::Segment(_) => panic!("no segments"),
        };
        flat.push((pose, piece));
    }
    let flat = Pieces::new(flat);
    assert_eq!(pose(&places[2]), outer.part(0).pose, "the first triangle is where its mesh is");
    let here = Isometry3::identity();
    for _ in 0..60 {
        let m = place();
        let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.25, 0.5, 1.0));
        let found = witness(&here, &outer, &m, &cuboid, f64::INFINITY);
        assert_eq!(found, witness(&here, &flat, &m, &cuboid, f64::INFINITY), "nested and flat");
        let part = found.expect("a witness").part1;
        let path = (&outer as &dyn Shape<f64, 3>).path_to_part(part);
        let in_first = path.first() == Some(&0);
        assert_eq!(
            path.len(),
            if in_first { 2 } else { 3 - usize::from(path[1] == 0) },
            "{path:?}"
        );
        let point = Point::from(m.translation.vector);
        let locate =
            |shape: &dyn Shape<f64, 3>| shape.project_local_point_with_location(&point, true);
        assert_eq!(locate(&outer), locate(&flat), "points");
        let ray = Ray::new(point, -point.coords);
        let hits = |shape: &dyn Shape<f64, 3>| shape.local_ray_hits(&ray, f64::INFINITY, true);
        assert_eq!(hits(&outer), hits(&flat), "rays");
        let velocity = -m.translation.vector;
        let moving = Moving::new(&m, &velocity, &cuboid);
        let options = ImpactOptions::new();
        let hit =
            |shape: &dyn Shape<f64, 3>| impact(&Moving::still(&here, shape), &moving, &options);
        let hits = [hit(&outer), hit(&flat)];
        // The contacts of a mesh at the start are filtered at its internal edges. `flat` is a plain
        // list of parts that knows no internal edges, so an impact at time zero may differ.
        if !hits.iter().flatten().any(|hit| hit.status.is_at_start()) {
            assert_eq!(hits[0], hits[1], "impacts");
        }
    }
}

/// A mesh that counts visits of parts.
#[derive(Debug)]
struct Counted {
    mesh: TriMesh<f64, 3>,
    looked: AtomicUsize,
}

impl Counted {
    fn new(mesh: TriMesh<f64, 3>) -> Self {
        Self { mesh, looked: AtomicUsize::new(0) }
    }

    fn take(&self) -> usize {
        self.looked.swap(0, Ordering::Relaxed)
    }
}

impl CompositeShape<f64, 3> for Counted {
    fn num_parts(&self) -> u32 {
        self.mesh.num_parts()
    }

    fn part(&self, part: u32) -> Part<'_, f64, 3> {
        self.looked.fetch_add(1, Ordering::Relaxed);
        self.mesh.part(part)
    }

    fn search(&self) -> &dyn PartSearch<f64, 3> {
        self.mesh.search()
    }
}

impl Shape<f64, 3> for Counted {
    fn geometry(&self) -> Geometry<'_, f64, 3> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<f64, 3> {
        self.mesh.local_aabb()
    }
}

#[test]
fn few_parts_are_looked_at() {
    let (mesh, _) = ball_mesh::<f64>(48);
    let parts = mesh.num_parts() as usize;
    assert!(parts > 2000, "{parts}");
    let (one, two) = (Counted::new(mesh.clone()), Counted::new(mesh));
    let count = |what: &str, most: usize, run: &dyn Fn()| {
        run();
        let looked = one.take() + two.take();
        assert!(looked <= most, "{what} looks at {looked} of {parts} parts");
    };
    let here = Isometry3::identity();
    let turn = Unit::new_normalize(Vector::<f64, 3>::new(1.0, 2.0, 3.0));
    let turn = impinge::math::na::UnitQuaternion::from_axis_angle(&turn, 0.7);
    for x in [3.0, 2.05, 1.9] {
        let there = Isometry3::from_parts(Vector::<f64, 3>::new(x, 0.5, 0.0).into(), turn);
        let ball = Ball::new(1.0);
        count("a ball", 300, &|| assert!(distance(&here, &one, &there, &ball) < 3.0));
        count("two meshes", 12 * parts, &|| assert!(distance(&here, &one, &there, &two) < 3.0));
        count("their proximity", 4 * parts, &|| {
            proximity(&here, &one, &there, &two, 0.0);
        });
        count("a point", 60, &|| {
            one.project_point(&here, &Point::<f64, 3>::new(x, 0.5, 0.25), true);
        });
        count("a ray", 20, &|| {
            let ray = Ray::new(Point::<f64, 3>::new(x, 0.5, 0.0), -Vector::<f64, 3>::x());
            assert!(one.intersects_ray(&here, &ray));
        });
        let options = ImpactOptions::new();
        let velocity = -Vector::<f64, 3>::x();
        count("a moving mesh", 12 * parts, &|| {
            let moving = Moving::new(&there, &velocity, &two);
            assert!(impact(&Moving::still(&here, &one), &moving, &options).is_some());
        });
    }
}
