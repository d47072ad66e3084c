//! Tests that batches of rays, which cull triangles early, give the same bits as single calls and
//! as a scan of all parts.

use crate::support::query_support;

use impinge::math::na::{UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Unit, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::{Ray, RayBatch, RayCast, RayIntersection};
use impinge::shape::{Ball, CompositeShape, Part, Plane, Polyline, Shape, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld, QueryFilter};
use query_support::random::Random;

/// Sizes of the triangle soups, and their offsets from the origin.
const PLACES: [(f64, f64); 6] =
    [(1.0, 0.0), (1.0, 1e6), (1e-3, 40.0), (1e6, 0.0), (1e-18, 0.0), (1e25, -3e25)];

/// Returns triangles of very different sizes in random order, a tenth of them without area.
fn soup<N: Real>(random: &mut Random, (size, offset): (f64, f64), count: u32) -> TriMesh<N, 3> {
    let by = Vector::<N, 3>::repeat(N::lit(offset));
    let mut vertices = Vec::new();
    for index in 0..count {
        let own = N::lit(size * 10.0_f64.powf(random.within(-3.0, 0.3)));
        let middle = random.vector::<N, 3>() * N::lit(size);
        let corners = [(); 3].map(|()| Point::from(middle + random.vector::<N, 3>() * own + by));
        let [a, b, c] = corners;
        vertices.extend(if index % 10 == 0 { [a, b, a + (b - a) * N::HALF] } else { [a, b, c] });
    }
    TriMesh::new(vertices, (0..count).map(|index| [0, 1, 2].map(|k| 3 * index + k)).collect())
}

/// Returns a ray at a corner, at a point of a side, into a triangle, along a side, from a point of
/// a side, or an arbitrary ray.
fn aimed<N: Real>(random: &mut Random, mesh: &TriMesh<N, 3>, size: f64) -> Ray<N, 3> {
    let any = |random: &mut Random| {
        let part = u32::try_from(random.bits() % u64::from(mesh.num_parts())).expect("few");
        *mesh.triangle(part).corners()
    };
    let [a, b, c] = any(random);
    let far = a + random.vector::<N, 3>() * N::lit(3.0 * size);
    let share = N::lit(random.within(0.0, 1.0));
    let start = any(random)[0];
    match random.bits() % 7 {
        0 => Ray::new(far, a - far),
        1 => Ray::new(far, a + (b - a) * share - far),
        2 => Ray::new(far, Point::from((a.coords + b.coords + c.coords) / N::lit(3.0)) - far),
        3 => Ray::new(a - (b - a), b - a),
        4 => Ray::new(start, b - start),
        5 => Ray::new(a + (b - a) * share, random.vector::<N, 3>() * N::lit(size)),
        _ => Ray::new(far, random.vector::<N, 3>() * N::lit(size)),
    }
}

/// Returns the earliest hit, from a separate cast at each part. At equal times the part with the
/// lowest index wins.
fn slow<N: Space<D>, const D: usize>(
    shape: &impl CompositeShape<N, D>,
    batch: &RayBatch<'_, N, D>,
    ray: &Ray<N, D>,
) -> Option<RayIntersection<N, D>> {
    let of_part = |part: u32| {
        let Part { pose, solid } = shape.part(part);
        let local = ray.inverse_transformed_by(&pose);
        let hit = solid.as_shape().cast_local_ray_until(&local, batch.max_time, batch.solid)?;
        Some(RayIntersection { part, normal: pose.vector(&hit.normal), ..hit })
    };
    let hits = (0..shape.num_parts()).filter_map(of_part);
    hits.reduce(|first, hit| if hit.toi < first.toi { hit } else { first })
}

fn check<N: Space<D>, const D: usize>(
    shape: &(impl CompositeShape<N, D> + Shape<N, D>),
    rays: &[Ray<N, D>],
    max_time: N,
) -> usize {
    let mut found = 0;
    for batch in [RayBatch::new(rays), RayBatch::new(rays).until(max_time).hollow()] {
        let mut hits = vec![None; rays.len()];
        shape.cast_local_rays(&batch, &mut hits);
        for (ray, hit) in rays.iter().zip(&hits) {
            let single = shape.cast_local_ray_until(ray, batch.max_time, batch.solid);
            assert_eq!(*hit, single, "one by one: {ray:?}");
            assert_eq!(*hit, slow(shape, &batch, ray), "of all parts: {ray:?}");
        }
        found += hits.iter().flatten().count();
    }
    found
}

fn soups<N: Real>() {
    for place in PLACES {
        let random = &mut Random(17, false);
        for count in [1, 15, 40, 700] {
            let mesh = soup::<N>(random, place, count);
            let rays: Vec<_> = (0..300).map(|_| aimed(random, &mesh, place.0)).collect();
            let found = check(&mesh, &rays, N::lit(1.5));
            assert!(found > 150, "{found} hits at {place:?}");
        }
    }
}

#[test]
fn triangles_are_sorted_out_by_what_decides() {
    soups::<f32>();
    soups::<f64>();
}

#[test]
fn rays_that_pass_where_squares_underflow() {
    let at = |x: f32, y: f32, z: f32| Point::<f32, 3>::new(x * 1e-21, y * 1e-21, z * 1e-21);
    let corners = vec![at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.2), at(0.0, 1.0, 0.1)];
    let mesh = TriMesh::new(corners, vec![[0, 1, 2]]);
    for (x, y) in [(5.0, 5.0), (-3.0, 0.5), (0.5, 1.5), (1.25, 0.0)] {
        let ray = Ray::new(at(x, y, 4.0), Vector::<f32, 3>::new(0.0, 0.0, -1e-21));
        assert_eq!(mesh.cast_local_ray(&ray, true), None, "it passes at {x}, {y}");
    }
    let through = Ray::new(at(0.25, 0.25, 4.0), Vector::<f32, 3>::new(0.0, 0.0, -1e-21));
    assert!(mesh.intersects_local_ray(&through, 8.0), "it does not pass");
}

#[test]
fn moved_vertices_are_seen_by_rays() {
    let random = &mut Random(5, false);
    let mut mesh = soup::<f32>(random, (1.0, 0.0), 300);
    for step in 0..40 {
        let moved: Vec<_> =
            mesh.vertices().iter().map(|v| v + random.vector::<f32, 3>() * 0.2).collect();
        mesh.set_vertices(&moved);
        let rays: Vec<_> = (0..20).map(|_| aimed(random, &mesh, 1.0)).collect();
        check(&mesh, &rays, 2.0);
        assert_eq!(mesh.tree().validate(), Ok(()), "step {step}");
    }
}

#[test]
fn lines_and_filled_meshes_of_the_plane() {
    let random = &mut Random(9, false);
    let points: Vec<_> = (0..400).map(|_| Point::from(random.vector::<f64, 2>() * 5.0)).collect();
    let triangles = (0..133).map(|index| [0, 1, 2].map(|k| 3 * index + k)).collect();
    let rays: Vec<_> = (0..200)
        .map(|_| Ray::new(Point::from(random.vector::<f64, 2>() * 8.0), random.vector()))
        .collect();
    assert!(check(&Polyline::<f64, 2>::open(points.clone()), &rays, 3.0) > 100, "lines");
    assert!(check(&TriMesh::<f64, 2>::new(points, triangles), &rays, 3.0) > 100, "triangles");
}

#[test]
fn placed_shapes_and_rays_that_are_none() {
    let random = &mut Random(2, false);
    let (m3, ball) =
        (Isometry3::new([1.0, 2.0, 3.0].into(), [0.3, 0.2, 0.1].into()), Ball::new(2.0));
    let mut rays: Vec<Ray<f64, 3>> =
        (0..200).map(|_| Ray::new(Point::from(random.vector() * 5.0), random.vector())).collect();
    rays[7].dir.x = f64::NAN;
    rays[8].origin.y = f64::INFINITY;
    rays[9].dir = Vector::<f64, 3>::zeros();
    let mut hits = vec![None; rays.len()];
    RayCast::<f64, 3>::cast_rays(&ball, &m3, &RayBatch::new(&rays), &mut hits);
    for (ray, hit) in rays.iter().zip(&hits) {
        assert_eq!(*hit, ball.first_hit_with_ray(&m3, ray, f64::INFINITY, true), "{ray:?}");
    }
    assert!(hits[7].is_none() && hits[8].is_none(), "no rays");
    assert!(hits.iter().flatten().count() > 20, "some hit");
    let m2 = Isometry2::<f32>::identity();
    RayCast::<f32, 2>::cast_rays(&Ball::new(1.0_f32), &m2, &RayBatch::new(&[]), &mut []);
}

#[test]
#[should_panic(expected = "a place for each answer")]
fn answers_need_places() {
    let rays = [Ray::new(Point::<f32, 2>::origin(), Vector::<f32, 2>::x())];
    RayCast::<f32, 2>::cast_local_rays(&Ball::new(1.0_f32), &RayBatch::new(&rays), &mut []);
}

/// Returns a world of 5000 balls and half-spaces, whose objects do not interact. Every ninth moves
/// in each step and once after the last update; a hundred are removed.
fn world<N: Space<D>, const D: usize>(
    random: &mut Random,
    place: impl Fn(Vector<N, D>) -> N::Isometry,
) -> CollisionWorld<N, D, ()> {
    let mut world = CollisionWorld::new(N::lit(0.02));
    let mut up = Vector::<N, D>::zeros();
    up[0] = N::ONE;
    let shapes: [ShapeHandle<N, D>; 2] = [
        ShapeHandle::new(Ball::new(N::ONE)),
        ShapeHandle::new(Plane::new(Unit::new_normalize(up))),
    ];
    let mut handles = Vec::new();
    for index in 0..5000 {
        let shape = &shapes[usize::from(index % 2000 == 0)];
        let position = place(random.vector::<N, D>() * N::lit(60.0));
        let proximity = GeometricQueryType::Proximity(N::ZERO);
        let mut alone = CollisionGroups::new();
        alone.set_whitelist(&[]);
        handles.push(world.add(position, shape.clone(), alone, proximity, ()));
    }
    for _ in 0..30 {
        world.update();
        for &handle in handles.iter().step_by(9) {
            world.set_position(handle, place(random.vector::<N, D>() * N::lit(60.0)));
        }
    }
    world.remove(&handles[100..200]);
    world
}

fn worlds<N: Space<D>, const D: usize>(place: impl Fn(Vector<N, D>) -> N::Isometry) {
    let random = &mut Random(4, false);
    let world = world(random, place);
    let start = |random: &mut Random| Point::from(random.vector::<N, D>() * N::lit(70.0));
    let mut rays: Vec<_> = (0..600).map(|_| Ray::new(start(random), random.vector())).collect();
    rays[3].dir[0] = N::lit(f64::NAN);
    rays[50].origin[1] = N::INFINITY;
    rays[51].dir = Vector::<N, D>::zeros();
    let mut found = 0;
    for count in [0, 1, 7, 8, 9, 20, rays.len()] {
        for (longest, solid) in [(30.0, true), (f64::INFINITY, false), (0.0, true), (-1.0, true)] {
            let (longest, filter) = (N::lit(longest), QueryFilter::new());
            let batch = RayBatch { rays: &rays[..count], max_time: longest, solid };
            let mut hits = vec![None; count];
            world.cast_rays(&batch, &filter, &mut hits);
            for (ray, hit) in rays.iter().zip(&hits) {
                let single = world.first_ray_hit(ray, longest, solid, &filter);
                assert_eq!(*hit, single.map(|(object, hit)| (object.handle(), hit)), "{ray:?}");
            }
            found += hits.iter().flatten().count();
        }
    }
    assert!(found > 1000, "{found} hits");
}

#[test]
fn worlds_answer_many_rays_as_one_by_one() {
    worlds::<f32, 2>(|v| Isometry2::from_parts(v.into(), UnitComplex::identity()));
    worlds::<f64, 3>(|v| Isometry3::from_parts(v.into(), UnitQuaternion::identity()));
}
