//! Queries about all objects of a world, compared with a loop over the objects.

use std::cmp::Ordering;
use std::fmt::Debug;

use impinge::math::{Isometry, Point, Pose, Space};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge::query::{self, ImpactOptions, Moving, PointQuery, Ray, RayCast};
use impinge::shape::{Shape, ShapeHandle};
use impinge::world::{CollisionObject, CollisionWorld, QueryFilter};

use crate::Bytes;
use crate::construct::any_box;
use crate::pair::same;
use crate::place::Dimension;
use crate::shapes::shape;

type World<N, const D: usize> = CollisionWorld<N, D, u8>;
type Object<N, const D: usize> = CollisionObject<N, D, u8>;

/// Runs the kind of query that the next byte selects, and checks the result.
pub(crate) fn ask<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    world: &World<N, D>,
    bytes: &mut Bytes<'_>,
) {
    match bytes.choice(5) {
        0 => rays(world, bytes),
        1 => points(world, bytes),
        2 => boxes(world, bytes),
        3 => near::<N, M, D>(world, bytes),
        _ => casts::<N, M, D>(world, bytes),
    }
}

type Keyed<N, A> = (N, CollisionObjectHandle, A);

/// Returns the result of each object that has one, sorted by key and handle.
fn ranked<N: Space<D>, A, const D: usize>(
    world: &World<N, D>,
    ask: impl Fn(&Object<N, D>) -> Option<(N, A)>,
) -> Vec<Keyed<N, A>> {
    let one =
        |object: &Object<N, D>| ask(object).map(|(key, answer)| (key, object.handle(), answer));
    let mut all: Vec<_> = world.collision_objects().filter_map(one).collect();
    all.sort_by(|a, b| a.0.partial_cmp(&b.0).unwrap_or(Ordering::Equal).then(a.1.cmp(&b.1)));
    all
}

/// Checks that the results are equal to the expected results, if all numbers are moderate.
fn check<A: Debug + PartialEq, N: Space<D>, const D: usize>(
    world: &World<N, D>,
    found: &A,
    expected: &A,
    (is_moderate, question): (bool, &dyn Debug),
) {
    if is_moderate && !same(found, expected) {
        let objects: Vec<_> = world.collision_objects().collect();
        panic!("\n{found:?}\nis not\n{expected:?}\n{question:?}\n{objects:?}");
    }
}

fn rays<N: Space<D>, const D: usize>(world: &World<N, D>, bytes: &mut Bytes<'_>) {
    let ray = Ray::new(Point::from(bytes.vector::<N, D>()), bytes.vector());
    let max_time = if bytes.coin() { N::INFINITY } else { bytes.number() };
    let (solid, filter) = (bytes.coin(), QueryFilter::new());
    let expected = ranked(world, |object| {
        let pose = N::pose(object.position());
        let local = ray.inverse_transformed_by(&pose);
        let hit = object.shape().cast_local_ray_until(&local, max_time, solid)?;
        Some((hit.toi, query::RayIntersection { normal: pose.vector(&hit.normal), ..hit }))
    });
    let found = world.ray_hits(&ray, max_time, solid, &filter);
    let found: Vec<_> =
        found.iter().map(|(object, hit)| (hit.toi, object.handle(), *hit)).collect();
    let question = (&ray, max_time, solid);
    check(world, &found, &expected, (bytes.is_moderate(), &question));
    let first = world.first_ray_hit(&ray, max_time, solid, &filter);
    let first = first.map(|(object, hit)| (hit.toi, object.handle(), hit));
    check(world, &first, &expected.first().copied(), (bytes.is_moderate(), &question));
}

fn points<N: Space<D>, const D: usize>(world: &World<N, D>, bytes: &mut Bytes<'_>) {
    let point = Point::from(bytes.vector::<N, D>());
    let (filter, solid, limit) = (QueryFilter::new(), bytes.coin(), bytes.number::<N>());
    let inside = |object: &&Object<N, D>| {
        let local = N::pose(object.position()).inverse_point(&point);
        object.shape().contains_local_point(&local)
    };
    let expected: Vec<_> = world.collision_objects().filter(inside).map(Object::handle).collect();
    let found: Vec<_> = world.objects_containing(&point, &filter).map(Object::handle).collect();
    check(world, &found, &expected, (bytes.is_moderate(), &point));
    let _ = world.project_point(&point, limit, solid, &filter);
    let count = bytes.choice(4);
    let neighbors = world.nearest_to_point(&point, count, limit, &filter);
    assert!(neighbors.len() <= count && neighbors.is_sorted_by_key(|found| found.distance));
}

fn boxes<N: Space<D>, const D: usize>(world: &World<N, D>, bytes: &mut Bytes<'_>) {
    let Some(aabb) = any_box(bytes) else { return };
    let found: Vec<_> =
        world.objects_in_aabb(&aabb, &QueryFilter::new()).map(Object::handle).collect();
    assert!(found.is_sorted(), "{found:?}");
}

/// Returns the shape of an object of the world, or another shape, and a position.
fn probe<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    world: &World<N, D>,
    bytes: &mut Bytes<'_>,
) -> (ShapeHandle<N, D>, Isometry<N, M::Turn, D>) {
    let count = world.len();
    let own = bytes.choice(count + 2);
    let object = world.collision_objects().nth(own).map(|object| object.shape().clone());
    (object.unwrap_or_else(|| shape::<N, M, D>(bytes)), M::position(bytes))
}

fn near<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    world: &World<N, D>,
    bytes: &mut Bytes<'_>,
) {
    let (shape, m) = probe::<N, M, D>(world, bytes);
    let (limit, filter) = (bytes.number::<N>(), QueryFilter::new());
    let question = (&shape, Pose::from_isometry(&m), limit);
    let distance = |object: &Object<N, D>| {
        query::distance(&m, &*shape, &M::loose(*object.position()), &**object.shape())
    };
    let touching = |object: &&Object<N, D>| distance(object) == N::ZERO;
    let expected: Vec<_> = world.collision_objects().filter(touching).map(Object::handle).collect();
    let place = M::stored(m);
    let found: Vec<_> =
        world.objects_overlapping(&place, &*shape, &filter).map(Object::handle).collect();
    check(world, &found, &expected, (bytes.is_moderate(), &question));
    let any = world.overlaps_any(&place, &*shape, &filter);
    assert_eq!(any, !found.is_empty(), "one of them");
    let expected = ranked(world, |object| Some((distance(object), ())));
    let expected: Vec<_> = expected
        .into_iter()
        .filter(|(distance, ..)| *distance <= limit && *distance < N::INFINITY)
        .collect();
    let found = world.objects_within(&place, &*shape, limit, &filter);
    let found: Vec<_> =
        found.iter().map(|found| (found.distance, found.object.handle(), ())).collect();
    check(world, &found, &expected, (bytes.is_moderate(), &question));
    let closest = world.closest_object(&place, &*shape, limit, &filter);
    let closest = closest.map(|found| (found.distance, found.object.handle(), ()));
    check(world, &closest, &expected.first().copied(), (bytes.is_moderate(), &question));
}

fn casts<N: Space<D>, M: Dimension<N, D>, const D: usize>(
    world: &World<N, D>,
    bytes: &mut Bytes<'_>,
) {
    let (shape, m) = probe::<N, M, D>(world, bytes);
    let (velocity, filter) = (bytes.vector(), QueryFilter::new());
    let max_time = if bytes.coin() { N::INFINITY } else { bytes.number() };
    let options = ImpactOptions::new().with_max_time(max_time);
    let moving = Moving::new(&m, &velocity, &*shape as &dyn Shape<N, D>);
    let expected = ranked(world, |object| {
        let place = M::loose(*object.position());
        let found = query::impact(&moving, &Moving::still(&place, &**object.shape()), &options)?;
        Some((found.toi, found))
    });
    let place = M::stored(m);
    let found = world.cast_shape_all(&place, &velocity, &*shape, &options, &filter);
    let found: Vec<_> =
        found.iter().map(|(object, hit)| (hit.toi, object.handle(), *hit)).collect();
    let question = (&shape, Pose::from_isometry(&m), velocity, options);
    check(world, &found, &expected, (bytes.is_moderate(), &question));
    let first = world.cast_shape(&place, &velocity, &*shape, &options, &filter);
    let first = first.map(|(object, hit)| (hit.toi, object.handle(), hit));
    check(world, &first, &expected.first().copied(), (bytes.is_moderate(), &question));
}
