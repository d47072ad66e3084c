//! Tests queries with results computed by hand, and edge cases: ties, limits, empty worlds, NaN,
//! half-spaces, objects far away.

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Space, Vector};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::{ClosestPoints, ImpactOptions, Ray};
use impinge::shape::{Ball, Cuboid, ShapeHandle};
use impinge::world::CollisionGroups;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};

use super::stage::{Filter, Object, Stage, World, add, contacts, ground, on_x, point, vector};

fn ball<N: Space<D>, const D: usize>(radius: f64) -> ShapeHandle<N, D> {
    ShapeHandle::new(Ball::new(N::lit(radius)))
}

/// Returns a world of balls of radius 1 on the first axis, and their handles.
fn row<N: Stage<D>, const D: usize>(places: &[f64]) -> (World<N, D>, Vec<CollisionObjectHandle>) {
    let mut world = World::new(N::lit(0.1));
    let handles = places.iter().map(|&x| add(&mut world, on_x(x), &ball(1.0))).collect();
    (world, handles)
}

fn handles_of<'a, N: Space<D>, const D: usize>(
    found: impl IntoIterator<Item = &'a Object<N, D>>,
) -> Vec<CollisionObjectHandle> {
    found.into_iter().map(Object::handle).collect()
}

fn along_x<N: Space<D>, const D: usize>() -> Ray<N, D> {
    Ray::new(Point::origin(), vector(on_x(2.0)))
}

fn rays_in_order<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = row::<N, D>(&[9.0, 5.0, 5.0, 0.0, -5.0]);
    let (ray, all) = (along_x(), Filter::new());
    for _ in 0..2 {
        let hits = world.ray_hits(&ray, N::INFINITY, true, &all);
        let times: Vec<_> = hits.iter().map(|(_, hit)| hit.toi.as_f64()).collect();
        assert_eq!(times, [0.0, 2.0, 2.0, 4.0], "the last one is behind");
        let order = [handles[3], handles[1], handles[2], handles[0]];
        assert_eq!(handles_of(hits.into_iter().map(|(object, _)| object)), order, "ties by handle");
        let hollow = world.ray_hits(&ray, N::TWO, false, &all);
        let times: Vec<_> = hollow.iter().map(|(_, hit)| hit.toi.as_f64()).collect();
        assert_eq!(times, [0.5, 2.0, 2.0], "out of the one it starts in; the limit counts");
        let others = Filter::new().exclude(handles[3]).exclude(handles[1]);
        let (first, hit) = world.first_ray_hit(&ray, N::TWO, true, &others).expect("one is left");
        assert_eq!((first.handle(), hit.normal), (handles[2], -vector(on_x(1.0))), "its twin");
        assert!(world.first_ray_hit(&ray, N::ONE, true, &others).is_none(), "later than that");
        world.update();
    }
}

fn neighbors_in_order<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = row::<N, D>(&[9.0, 5.0, -5.0, 0.5]);
    let (here, own, all) = (N::pose_at([0.0; D], 0.0), ball::<N, D>(0.5), Filter::new());
    for _ in 0..2 {
        let found = world.nearest_objects(&here, &*own, 3, N::INFINITY, &all);
        let distances: Vec<_> = found.iter().map(|near| near.distance.as_f64()).collect();
        assert_eq!(distances, [0.0, 3.5, 3.5], "of radius 1 and a half");
        let order = [handles[3], handles[1], handles[2]];
        assert_eq!(handles_of(found.iter().map(|near| near.object)), order, "ties by handle");
        assert_eq!(found[0].points, ClosestPoints::Intersecting, "it overlaps");
        let (on_own, on_other) = (point(on_x(-0.5)), point(on_x(-4.0)));
        assert_eq!(found[2].points, ClosestPoints::WithinMargin(on_own, on_other), "to the left");
        let within = world.objects_within(&here, &*own, N::lit(3.5), &all);
        assert_eq!(within.len(), 3, "the limit counts");
        let overlapping = world.objects_overlapping(&here, &*own, &all);
        assert_eq!(handles_of(overlapping), [handles[3]], "the one");
        assert!(world.overlaps_any(&here, &*own, &all), "the same");
        let others = Filter::new().exclude(handles[3]);
        assert!(!world.overlaps_any(&here, &*own, &others), "there is no other");
        let at = point(on_x(3.0));
        let found = world.nearest_to_point(&at, 2, N::INFINITY, &all);
        let distances: Vec<_> = found.iter().map(|near| near.distance.as_f64()).collect();
        assert_eq!(distances, [1.0, 1.5], "of a point");
        let (object, nearest) = world.project_point(&at, N::ONE, true, &all).expect("one away");
        assert_eq!((object.handle(), nearest.point), (handles[1], point(on_x(4.0))), "the nearest");
        assert!(world.project_point(&at, N::HALF, true, &all).is_none(), "nothing that near");
        let inside = point(on_x(0.75));
        let (_, hollow) = world.project_point(&inside, N::ONE, false, &all).expect("inside");
        assert_eq!((hollow.is_inside, hollow.point), (true, point(on_x(1.5))), "the boundary");
        world.update();
    }
}

fn casts_in_order<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = row::<N, D>(&[9.0, 5.0, 5.0, -5.0]);
    let (here, own, all) = (N::pose_at([0.0; D], 0.0), ball::<N, D>(1.0), Filter::new());
    let (velocity, options) = (vector(on_x(2.0)), ImpactOptions::new());
    for _ in 0..2 {
        let found = world.cast_shape_all(&here, &velocity, &*own, &options, &all);
        let times: Vec<_> = found.iter().map(|(_, impact)| impact.toi.as_f64()).collect();
        assert_eq!(times, [1.5, 1.5, 3.5], "gaps of 3 and 7 at speed 2");
        let (impact, object) = (found[0].1, found[0].0);
        assert_eq!((object.handle(), impact.world1), (handles[1], point(on_x(4.0))), "where it is");
        let early = options.with_target_distance(N::ONE).with_max_time(N::ONE);
        let (_, impact) =
            world.cast_shape(&here, &velocity, &*own, &early, &all).expect("a unit before");
        assert_eq!(impact.toi, N::ONE, "the limit counts");
        let still = Vector::<N, D>::zeros();
        assert!(world.cast_shape(&here, &still, &*own, &options, &all).is_none(), "at rest");
        world.update();
    }
}

/// Asserts that queries respect changes since the last update: they find objects at the present
/// positions, with the present shapes, and no removed objects.
fn changes_are_seen_at_once<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = row::<N, D>(&[4.0, 8.0, 12.0]);
    world.update();
    world.set_position(handles[0], N::pose_at(on_x(20.0), 0.0));
    world.remove(&[handles[1]]);
    let (ray, all) = (along_x(), Filter::new());
    let first = |world: &World<N, D>| {
        let hit = world.first_ray_hit(&ray, N::INFINITY, true, &all);
        hit.map(|(object, hit)| (object.handle(), hit.toi.as_f64()))
    };
    assert_eq!(first(&world), Some((handles[2], 5.5)), "one moved, one went");
    let new = add(&mut world, on_x(6.0), &ball(0.5));
    assert_eq!(first(&world), Some((new, 2.75)), "one came");
    world.set_shape(handles[2], ball(10.0));
    assert_eq!(first(&world), Some((handles[2], 1.0)), "one grew");
    let mut nobody = CollisionGroups::new();
    nobody.set_membership(&[]);
    world.set_collision_groups(handles[2], nobody);
    let hit = world.first_ray_hit(&ray, N::INFINITY, true, &CollisionGroups::new().into());
    assert_eq!(hit.map(|(object, _)| object.handle()), Some(new), "groups too");
    assert_eq!(first(&world), Some((handles[2], 1.0)), "but only if they are asked");
    let here = N::pose_at(on_x(20.0), 0.0);
    let found = world.closest_object(&here, &Ball::new(N::ONE), N::ZERO, &all);
    assert_eq!(found.map(|near| near.object.handle()), Some(handles[0]), "where it went");
}

/// Asserts the results if the first queries after a change come from many threads at once, some of
/// which wait for each other.
fn many_threads_ask_after_a_change<N: Stage<D>, const D: usize>()
where
    N::Isometry: Sync,
{
    let places: Vec<f64> = (0..5000).map(|x| 3.0 * f64::from(x)).collect();
    let (mut world, handles) = row::<N, D>(&places);
    world.update();
    for (&handle, x) in handles.iter().zip(&places) {
        world.set_position(handle, N::pose_at(on_x(x + 1.0), 0.0));
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(4).build().expect("four threads");
    let (world, ray) = (&world, |x: f64| Ray::new(point(on_x(x)), vector(on_x(1.0))));
    let found: Vec<_> = pool.install(|| {
        let asked = places.par_iter().map(|&x| {
            let hit = world.first_ray_hit(&ray(x + 2.5), N::ONE, true, &Filter::new());
            hit.map(|(object, hit)| (object.handle(), hit.toi))
        });
        asked.collect()
    });
    let expected = handles.iter().skip(1).map(|&handle| Some((handle, N::HALF)));
    assert!(found.iter().copied().eq(expected.chain([None])), "each meets the next one");
}

/// Tests that queries find half-spaces like all other objects, although their boxes are unbounded
/// on one side or on all sides.
fn planes<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.1));
    let level = add(&mut world, [0.0; D], &ground());
    let position = N::pose_at([-8.0; D], 0.5);
    let tilted = world.add(position, ground(), CollisionGroups::new(), contacts(), 1);
    let up = |y: f64| core::array::from_fn(|axis| if axis + 1 == D { y } else { 0.0 });
    let all = Filter::new();
    for _ in 0..2 {
        let (here, own) = (N::pose_at(up(3.0), 0.0), ball::<N, D>(1.0));
        let found = world.nearest_objects(&here, &*own, 9, N::INFINITY, &all);
        assert_eq!(found.len(), 2, "both");
        assert_eq!((found[0].object.handle(), found[0].distance), (level, N::TWO), "the level one");
        let below = world.objects_containing(&point(up(-100.0)), &all);
        assert_eq!(handles_of(below), [level, tilted], "deep below both");
        let fall = vector(up(-2.0));
        let options = ImpactOptions::new();
        let (object, impact) =
            world.cast_shape(&here, &fall, &*own, &options, &all).expect("it falls");
        assert_eq!((object.handle(), impact.toi), (level, N::ONE), "on the level one");
        let sky = Ray::new(point(up(3.0)), vector(up(1.0)));
        assert!(world.first_ray_hit(&sky, N::INFINITY, true, &all).is_none(), "nothing above");
        // The solid of the query may be unbounded too.
        let half = ground::<N, D>();
        let found = world.objects_overlapping(&here, &*half, &all);
        assert_eq!(handles_of(found), [level, tilted], "a half-space overlaps half-spaces");
        world.update();
    }
}

/// Tests that solids of size zero are found like all others.
fn zero_sizes<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::ZERO);
    let dot = ball::<N, D>(0.0);
    let first = add(&mut world, on_x(2.0), &dot);
    let flat = ShapeHandle::new(Cuboid::new(Vector::<N, D>::zeros()));
    let second = add(&mut world, on_x(2.0), &flat);
    let (here, all, options) = (N::pose_at([0.0; D], 0.0), Filter::new(), ImpactOptions::new());
    for _ in 0..2 {
        let hits = world.ray_hits(&along_x(), N::ONE, true, &all);
        assert_eq!(handles_of(hits.into_iter().map(|(object, _)| object)), [first, second], "ray");
        let found = world.nearest_objects(&here, &*dot, 5, N::TWO, &all);
        assert_eq!(handles_of(found.iter().map(|near| near.object)), [first, second], "distance");
        let found = world.objects_containing(&point(on_x(2.0)), &all);
        assert_eq!(handles_of(found), [first, second], "the same place");
        let found = world.cast_shape_all(&here, &vector(on_x(1.0)), &*dot, &options, &all);
        assert_eq!(found.len(), 2, "dot on dot");
        assert_eq!(found[0].1.toi, N::TWO, "at speed 1");
        world.update();
    }
}

fn nothing_to_find<N: Stage<D>, const D: usize>() {
    let (here, own) = (N::pose_at([0.0; D], 0.0), ball::<N, D>(1.0));
    let (all, options, v) = (Filter::new(), ImpactOptions::new(), vector(on_x(1.0)));
    let empty = World::<N, D>::new(N::ZERO);
    assert!(empty.ray_hits(&along_x(), N::INFINITY, true, &all).is_empty(), "no object");
    assert!(empty.closest_object(&here, &*own, N::INFINITY, &all).is_none(), "no object");
    assert!(empty.cast_shape(&here, &v, &*own, &options, &all).is_none(), "no object");
    assert_eq!(empty.objects_containing(&Point::origin(), &all).count(), 0, "no object");
    assert_eq!(empty.objects_overlapping(&here, &*own, &all).count(), 0, "no object");
    assert!(!empty.overlaps_any(&here, &*own, &all), "no object");
    assert_eq!(empty.objects_in_aabb(&Aabb::unbounded(), &all).count(), 0, "no object");

    let (mut world, _) = row::<N, D>(&[0.0, 1.0]);
    for _ in 0..2 {
        assert!(world.nearest_objects(&here, &*own, 0, N::INFINITY, &all).is_empty(), "none asked");
        assert!(world.nearest_to_point(&Point::origin(), 0, N::ONE, &all).is_empty(), "none asked");
        for limit in [-N::ONE, N::lit(f64::NAN)] {
            assert!(world.ray_hits(&along_x(), limit, true, &all).is_empty(), "until {limit}");
            assert!(world.objects_within(&here, &*own, limit, &all).is_empty(), "up to {limit}");
            assert!(world.project_point(&Point::origin(), limit, true, &all).is_none(), "{limit}");
            let options = options.with_max_time(limit);
            assert!(world.cast_shape(&here, &v, &*own, &options, &all).is_none(), "{limit}");
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            not_finite(&world, bad);
        }
        world.update();
    }
}

fn not_finite<N: Stage<D>, const D: usize>(world: &World<N, D>, bad: f64) {
    let (own, all, options) = (ball::<N, D>(1.0), Filter::new(), ImpactOptions::new());
    let (p, here) = (point::<N, D>(on_x(bad)), N::pose_at([0.0; D], 0.0));
    for ray in
        [Ray::new(p, p.coords), Ray::new(Point::origin(), p.coords), Ray::new(p, vector([1.0; D]))]
    {
        assert!(world.ray_hits(&ray, N::INFINITY, true, &all).is_empty(), "{ray:?}");
    }
    assert!(world.nearest_to_point(&p, 9, N::INFINITY, &all).is_empty(), "{p}");
    assert!(world.project_point(&p, N::INFINITY, false, &all).is_none(), "{p}");
    assert_eq!(world.objects_containing(&p, &all).count(), 0, "{p}");
    let nowhere = N::pose_at(on_x(bad), 0.0);
    assert!(world.objects_within(&nowhere, &*own, N::INFINITY, &all).is_empty(), "{bad}");
    assert_eq!(world.objects_overlapping(&nowhere, &*own, &all).count(), 0, "{bad}");
    assert!(!world.overlaps_any(&nowhere, &*own, &all), "{bad}");
    let v = vector(on_x(1.0));
    assert!(world.cast_shape(&nowhere, &v, &*own, &options, &all).is_none(), "from {bad}");
    assert!(world.cast_shape(&here, &p.coords, &*own, &options, &all).is_none(), "at {bad}");
}

/// Tests that results are exact a million units away, at positions that the scalar represents
/// exactly.
fn far_away<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = row::<N, D>(&[1e6, 1e6 + 8.0, 1e6 + 16.0]);
    let (here, own) = (N::pose_at(on_x(1e6 + 4.0), 0.0), ball::<N, D>(1.0));
    let (all, options) = (Filter::new(), ImpactOptions::new());
    for _ in 0..2 {
        let found = world.nearest_objects(&here, &*own, 2, N::TWO, &all);
        assert_eq!(handles_of(found.iter().map(|near| near.object)), handles[..2], "both sides");
        assert_eq!(found[1].distance, N::TWO, "a gap of two");
        let ray = Ray::new(point(on_x(1e6 + 4.0)), vector(on_x(1.0)));
        let (object, hit) = world.first_ray_hit(&ray, N::lit(3.0), true, &all).expect("three away");
        assert_eq!((object.handle(), hit.toi), (handles[1], N::lit(3.0)), "exactly");
        let found = world.cast_shape(&here, &vector(on_x(-1.0)), &*own, &options, &all);
        let (object, impact) = found.expect("to the left");
        assert_eq!((object.handle(), impact.toi), (handles[0], N::TWO), "exactly");
        world.update();
    }
}

/// Tests that objects are found in order of their distances even if the squares of these overflow
/// or underflow.
fn huge_and_tiny<N: Stage<D>, const D: usize>() {
    let [large, small] = [N::MAX, N::MIN_POSITIVE].map(|limit| limit.as_f64().powf(0.75));
    for unit in [large, small, 1.0] {
        let mut world = World::<N, D>::new(N::ZERO);
        let dot = ball::<N, D>(0.0);
        let handles = [4.0, 2.0, -3.0].map(|x| add(&mut world, [x * unit; D], &dot));
        let here = N::pose_at([0.0; D], 0.0);
        let edge = N::distance((&here, &*dot), (&N::pose_at([-3.0 * unit; D], 0.0), &*dot));
        for _ in 0..2 {
            let found = world.objects_within(&here, &*dot, edge, &Filter::new());
            let order = [handles[1], handles[2]];
            assert_eq!(handles_of(found.iter().map(|near| near.object)), order, "unit {unit}");
            assert_eq!(found[1].distance, edge, "unit {unit}");
            let point = world.nearest_to_point(&Point::origin(), 1, N::INFINITY, &Filter::new());
            assert_eq!(point[0].object.handle(), handles[1], "unit {unit}");
            world.update();
        }
    }
}

in_tests!(
    huge_and_tiny,
    rays_in_order,
    neighbors_in_order,
    casts_in_order,
    changes_are_seen_at_once,
    many_threads_ask_after_a_change,
    planes,
    zero_sizes,
    nothing_to_find,
    far_away,
);
