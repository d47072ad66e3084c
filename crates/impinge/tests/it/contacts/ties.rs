//! Tests searches with many ties. Among candidates at equal distance, or hit at the same time, the
//! result is the one with the least index, in whatever order the search visits them.
//!
//! The expected results for boxes and objects come from brute force: the query for a single box or
//! object is called for every candidate. The expected triangle for a vertex is the one with the
//! lowest index that contains the vertex.

use impinge::bounding_volume::{Aabb, Ray};
use impinge::dim3;
use impinge::math::{Point, Real, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::partitioning::BoxTree;
use impinge::query::{ImpactOptions, PointQuery, RayCast, time_of_impact};
use impinge::shape::ShapeHandle;
use impinge::world::{CollisionGroups, QueryFilter};
use impinge_reference::random::Random;

/// Cells along each axis of the grid; few enough that cells hold several objects.
const SIDE: usize = 6;

fn cell<const D: usize>(random: &mut Random) -> [f64; D] {
    core::array::from_fn(|_| f64::from(u32::try_from(random.below(SIDE)).expect("small")))
}

fn vector<N: Real, const D: usize>(v: [f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(v[axis]))
}

/// Returns the first index with the least key, and that key; `None` if there is no key.
fn first<N: Real>(keys: impl Iterator<Item = Option<N>>) -> Option<(usize, N)> {
    let mut best: Option<(usize, N)> = None;
    for (index, key) in keys.enumerate() {
        if let Some(key) = key.filter(|key| best.is_none_or(|(_, least)| *key < least)) {
            best = Some((index, key));
        }
    }
    best
}

/// Returns boxes of half a cell or of size zero, at random cells of size `unit` that start at
/// `offset`.
fn boxes<N: Real, const D: usize>(
    random: &mut Random,
    count: usize,
    (unit, offset): (f64, f64),
) -> Vec<Aabb<N, D>> {
    let one = |_| {
        let low = cell::<D>(random).map(|x| offset + unit * x);
        let size = if random.below(3) == 0 { 0.0 } else { 0.5 * unit };
        let high = low.map(|x| x + size);
        Aabb::new(Point::from(vector::<N, D>(low)), Point::from(vector::<N, D>(high)))
    };
    (0..count).map(one).collect()
}

fn box_trees<N: Space<D>, const D: usize>(unit: f64, offset: f64) {
    let (mut random, mut ties) = (Random::new(41), 0);
    for count in [1, 16, 17, 300, 3000] {
        let boxes = boxes::<N, D>(&mut random, count, (unit, offset));
        let tree = BoxTree::from_boxes(&boxes);
        for _ in 0..60 {
            let half = 0.5 * unit;
            let at = cell::<D>(&mut random).map(|x| offset + unit * x + half);
            let point = Point::from(vector::<N, D>(at));
            let distances: Vec<N> = boxes.iter().map(|own| own.distance_to_point(&point)).collect();
            let expected = first(distances.iter().copied().map(Some));
            assert_eq!(tree.nearest(&point, N::INFINITY), expected, "near {point}");
            let (_, least) = expected.expect("there are boxes");
            ties += distances.iter().filter(|distance| **distance == least).count() - 1;
            assert_eq!(tree.nearest(&point, least), expected, "the limit is included");

            let mut dir = [0.0; D];
            dir[random.below(D)] = if random.below(2) == 0 { -unit } else { unit };
            let from = cell::<D>(&mut random).map(|x| offset + unit * x);
            let ray = Ray::new(Point::from(vector::<N, D>(from)), vector::<N, D>(dir));
            let enter = |own: &Aabb<N, D>| own.ray_interval(&ray).map(|(enter, _)| enter);
            let expected = first(boxes.iter().map(enter));
            assert_eq!(tree.first_hit(&ray, N::INFINITY), expected, "{ray:?}");
        }
    }
    assert!(ties > 500, "{ties} ties");
}

#[test]
fn of_equal_boxes_the_first_by_index_answers() {
    for (unit, offset) in [(1.0, 0.0), (1.0, 1e6), (1e-18, 0.0), (1e15, 0.0)] {
        box_trees::<f32, 2>(unit, offset);
        box_trees::<f32, 3>(unit, offset);
        box_trees::<f64, 2>(unit, offset);
        box_trees::<f64, 3>(unit, offset);
    }
}

type World = dim3::world::CollisionWorld<f32, usize>;

/// Creates a world of balls and cubes of one size at random cells. The collision groups of the
/// objects forbid all pairs.
fn world(random: &mut Random, count: usize) -> World {
    let mut world = World::new(0.02);
    let mut nobody = CollisionGroups::new();
    nobody.set_whitelist(&[]);
    let shapes = [
        ShapeHandle::new(dim3::shape::Ball::new(0.25)),
        ShapeHandle::new(dim3::shape::Cuboid::new(Vector::<f32, 3>::repeat(0.25))),
    ];
    for number in 0..count {
        let shape = shapes[random.below(2)].clone();
        world.add(place(random), shape, nobody, GeometricQueryType::Proximity(0.0), number);
    }
    world
}

fn place(random: &mut Random) -> dim3::math::Isometry<f32> {
    let at = vector::<f32, 3>(cell(random));
    dim3::math::Isometry::translation(at.x, at.y, at.z)
}

/// Compares queries of the world with scans of its objects. Returns the number of ties for the
/// nearest object.
fn ask(world: &World, random: &mut Random) -> usize {
    let (all, reach) = (QueryFilter::new(), 4.0_f32);
    let objects: Vec<_> = world.collision_objects().collect();
    let half = Vector::<f32, 3>::repeat(0.5);
    let point = Point::from(vector::<f32, 3>(cell(random)) + half);
    let distances: Vec<f32> = objects
        .iter()
        .map(|object| object.shape().distance_to_point(object.position(), &point, true))
        .collect();
    let (index, least) = first(distances.iter().copied().map(Some)).expect("there are objects");
    let near = world.nearest_to_point(&point, 3, f32::INFINITY, &all);
    assert_eq!(
        (near[0].object.data(), near[0].distance),
        (objects[index].data(), least),
        "{point}"
    );
    let mut order: Vec<usize> = (0..objects.len()).collect();
    order.sort_by(|&a, &b| distances[a].total_cmp(&distances[b]).then(a.cmp(&b)));
    let three: Vec<_> = order.iter().take(3).map(|&n| objects[n].data()).collect();
    let found: Vec<_> = near.iter().map(|near| near.object.data()).collect();
    assert_eq!(found, three, "the three nearest to {point}");
    let projected = world.project_point(&point, f32::INFINITY, true, &all).map(|it| it.0.data());
    assert_eq!(projected, Some(objects[index].data()), "the projection of {point}");

    let mut dir = Vector::<f32, 3>::zeros();
    dir[random.below(3)] = 1.0;
    let ray = Ray::new(Point::from(vector::<f32, 3>(cell(random)) - dir * 0.5), dir);
    let times = objects.iter().map(|object| {
        object.shape().first_hit_with_ray(object.position(), &ray, reach, true).map(|hit| hit.toi)
    });
    let expected = first(times).map(|(index, time)| (*objects[index].data(), time));
    let hit = world.first_ray_hit(&ray, reach, true, &all);
    assert_eq!(hit.map(|(object, hit)| (*object.data(), hit.toi)), expected, "{ray:?}");

    let ball = dim3::shape::Ball::new(0.125_f32);
    let (start, options) = (ray.origin.coords, ImpactOptions::new().with_max_time(reach));
    let start = dim3::math::Isometry::translation(start.x, start.y, start.z);
    let casts = world.cast_shape_all(&start, &dir, &ball, &options, &all);
    let cast = world.cast_shape(&start, &dir, &ball, &options, &all);
    let of = |(object, impact): &(&dim3::world::CollisionObject<f32, usize>, _)| {
        let impact: &dim3::query::Impact<f32> = impact;
        (*object.data(), impact.toi)
    };
    assert_eq!(cast.as_ref().map(of), casts.first().map(of), "a cast is the first of all");
    let alone = objects.iter().map(|object| {
        let shape = object.shape();
        let still = Vector::<f32, 3>::zeros();
        let time = time_of_impact(&start, &dir, &ball, object.position(), &still, &**shape);
        time.filter(|time| *time <= reach)
    });
    let expected = first(alone).map(|(index, time)| (*objects[index].data(), time));
    assert_eq!(cast.as_ref().map(of), expected, "a cast from {start:?} along {dir}");
    distances.iter().filter(|distance| **distance == least).count() - 1
}

#[test]
fn of_equal_objects_the_first_by_handle_answers() {
    let (mut random, mut ties) = (Random::new(43), 0);
    for count in [20, 700] {
        let mut world = world(&mut random, count);
        // After one update, with some objects at rest, and with all at rest.
        for updates in [1, 40, 100] {
            (0..updates).for_each(|_| world.update());
            world.validate().expect("sound");
            for _ in 0..25 {
                ties += ask(&world, &mut random);
            }
            let handles: Vec<_> =
                world.collision_objects().map(impinge::world::CollisionObject::handle).collect();
            for &handle in handles.iter().step_by(5) {
                let position = place(&mut random);
                world.set_position(handle, position);
            }
            // Queries between a change and the next update.
            ties += ask(&world, &mut random);
        }
    }
    assert!(ties > 500, "{ties} ties");
}

/// Asserts for the triangles of a regular grid, in random order, which triangle is nearest to a
/// point above a vertex: of up to six triangles with that vertex, the one with the least index.
#[test]
fn of_equal_triangles_the_first_by_number_answers() {
    let side = 12_u32;
    let corner = |n: u32| Point::<f32, 3>::new((n % side) as f32, 0.0, (n / side) as f32);
    let vertices: Vec<_> = (0..side * side).map(corner).collect();
    let quads = (0..side - 1).flat_map(|z| (0..side - 1).map(move |x| z * side + x));
    let mut triangles: Vec<[u32; 3]> =
        quads.flat_map(|n| [[n, n + side, n + 1], [n + 1, n + side, n + side + 1]]).collect();
    let mut random = Random::new(47);
    for n in (1..triangles.len()).rev() {
        triangles.swap(n, random.below(n + 1));
    }
    let mesh = dim3::shape::TriMesh::new(vertices.clone(), triangles.clone());
    for (number, vertex) in (0..).zip(&vertices) {
        let above = vertex + Vector::<f32, 3>::new(0.0, 2.0, 0.0);
        let (found, location) = mesh.project_local_point_with_location(&above, true);
        let lowest = triangles.iter().position(|corners| corners.contains(&number));
        assert_eq!(found.point, *vertex, "below {above}");
        assert_eq!(Some(location.part as usize), lowest, "the first of those at {vertex}");
    }
}
