//! Tests input at and beyond the limits: worlds refuse it or handle it, and never panic, hang or
//! become inconsistent.

use crate::support::scene_stage;
use crate::support::world_stage;

use std::hash::Hasher;
use std::panic::{AssertUnwindSafe, catch_unwind};

use impinge::bounding_volume::{Aabb, BoundingSphere};
use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::{Point, Real, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, GeometricQueryType};
use impinge::query::{PointQuery, Proximity, Ray, RayCast};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, Rounded, Segment,
    ShapeHandle, TaperedCapsule, Tetrahedron, Triangle,
};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld};
use scene_stage::{Digest, digest_state};
use world_stage::{Stage, add, ball, contacts, cube, half_space, near, step, vector};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

const BAD: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Returns a digest of what a world reports after an update, of the handles, poses and query limits
/// of its objects, and of a query with the unbounded box.
fn state<N: Stage<D>, const D: usize>(world: &World<N, D>) -> u64 {
    let mut digest = Digest::new();
    digest_state(world, &mut digest);
    for object in world.collision_objects() {
        digest.write_usize(object.handle().uid());
        let pose = N::pose(object.position());
        pose.translation.iter().chain(pose.rotation.iter()).for_each(|x| digest.number(*x));
        digest.number(object.query_type().query_limit());
    }
    let everything = Aabb::unbounded();
    let found = world.interferences_with_aabb(&everything, &CollisionGroups::new());
    found.for_each(|object| digest.write_usize(object.handle().uid()));
    digest.finish()
}

/// Asserts that `call` panics with a message of more than ten bytes.
#[track_caller]
fn panics<R>(call: impl FnOnce() -> R, what: &str) {
    let outcome = catch_unwind(AssertUnwindSafe(|| drop(call())));
    let cause = outcome.expect_err(what);
    let text = cause.downcast_ref::<String>().map_or("", String::as_str);
    assert!(text.len() > 10, "{what}: the message says why: {text:?}");
}

fn bad_shapes_are_refused<N: Stage<D>, const D: usize>() {
    let good = Point::<N, D>::origin();
    for number in BAD.into_iter().chain([-1.0]) {
        let x = N::lit(number);
        assert!(Ball::try_new(x).is_err(), "{number}");
        panics(|| Ball::new(x), "ball");
        for axis in 0..D {
            let mut half = Vector::<N, D>::repeat(N::ONE);
            half[axis] = x;
            assert!(Cuboid::try_new(half).is_err(), "{number}");
            panics(|| Cuboid::new(half), "cuboid");
            assert!(Ellipsoid::try_new(half).is_err(), "{number}");
            panics(|| Ellipsoid::new(half), "ellipsoid");
        }
        assert!(Capsule::<N, D>::try_new(x, N::ONE).is_err(), "{number}");
        assert!(Capsule::<N, D>::try_new(N::ONE, x).is_err(), "{number}");
        assert!(Capsule::try_from_ends(good, good, x).is_err(), "{number}");
        panics(|| Capsule::<N, D>::new(N::ONE, x), "capsule");
        assert!(TaperedCapsule::<N, D>::try_new(x, N::ONE, N::ONE).is_err(), "{number}");
        assert!(TaperedCapsule::<N, D>::try_new(N::ONE, x, N::ONE).is_err(), "{number}");
        assert!(TaperedCapsule::<N, D>::try_new(N::ONE, N::ONE, x).is_err(), "{number}");
        panics(|| TaperedCapsule::<N, D>::new(N::ONE, N::ONE, x), "tapered capsule");
        assert!(Rounded::<N, D>::try_new(Segment::new(good, good), x).is_err(), "{number}");
        panics(|| Rounded::<N, D>::new(Segment::new(good, good), x), "rounded");
        let corner = Point::<N, 3>::new(x, N::ONE, N::ZERO);
        let bad = Tetrahedron::try_new([Point::origin(), Point::origin(), corner, corner]);
        assert!(bad.is_err() || number == -1.0, "{number}");
        assert!(Cylinder::try_new(x, N::ONE).is_err(), "{number}");
        assert!(Cylinder::try_new(N::ONE, x).is_err(), "{number}");
        assert!(Cone::try_new(x, N::ONE).is_err(), "{number}");
        assert!(Cone::try_new(N::ONE, x).is_err(), "{number}");
        assert!(BoundingSphere::try_new(good, x).is_err() || number == f64::INFINITY, "{number}");
    }
    for number in BAD {
        let mut bad = good;
        bad[D - 1] = N::lit(number);
        assert!(Segment::try_new(good, bad).is_err(), "{number}");
        assert!(Segment::try_new(bad, good).is_err(), "{number}");
        assert!(Capsule::try_from_ends(bad, good, N::ONE).is_err(), "{number}");
        assert!(Triangle::try_new(good, bad, good).is_err(), "{number}");
        assert!(BoundingSphere::try_new(bad, N::ONE).is_err(), "{number}");
        panics(|| Triangle::new(good, good, bad), "triangle");
        panics(|| Segment::new(good, bad), "segment");
    }
    let mut nan = good;
    nan[0] = N::lit(f64::NAN);
    assert!(Aabb::try_new(nan, good).is_err() && Aabb::try_new(good, nan).is_err(), "boxes");
    panics(|| DBVTBroadPhase::<N, Aabb<N, D>, ()>::new(N::lit(f64::NAN)), "margin");
}

/// Asserts that hulls of too few points, of coinciding points, of points on a line, and of
/// coordinates that are not finite are refused.
fn bad_hulls_are_refused<N: Real>() {
    let flat = |points: &[[f64; 2]]| {
        let points: Vec<_> = points.iter().map(|p| Point::from(vector::<N, 2>(*p))).collect();
        ConvexPolygon::try_from_points(&points).is_err() && ConvexPolygon::try_new(&points).is_err()
    };
    let solid = |points: &[[f64; 3]]| {
        let points: Vec<_> = points.iter().map(|p| Point::from(vector::<N, 3>(*p))).collect();
        ConvexHull::try_from_points(&points).is_err()
    };
    assert!(flat(&[]) && flat(&[[0.0, 0.0]; 5]), "no points and a point");
    assert!(flat(&[[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]]), "a line");
    assert!(solid(&[]) && solid(&[[1.0; 3]; 9]), "no points and a point");
    assert!(solid(&[[0.0; 3], [1.0; 3], [2.0; 3], [4.0; 3]]), "a line");
    let square = [[0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0], [1.0, 1.0, 1.0]];
    assert!(solid(&square), "flat");
    for number in BAD {
        assert!(flat(&[[0.0, 0.0], [1.0, 0.0], [0.0, number]]), "{number}");
        let mut points = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.1; 3]];
        points[4][1] = number;
        assert!(solid(&points), "{number}");
    }
}

#[test]
fn hulls_of_bad_points() {
    bad_hulls_are_refused::<f32>();
    bad_hulls_are_refused::<f64>();
}

/// Returns a world with three objects in contact, one of them a sensor, and the handles, the last
/// of which is stale.
fn busy<N: Stage<D>, const D: usize>() -> (World<N, D>, [CollisionObjectHandle; 4]) {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let handles = [
        add(&mut world, 0.0, &ball(1.0), contacts(0.0)),
        add(&mut world, 1.5, &cube(1.0), contacts(0.0)),
        add(&mut world, 1.0, &ball(1.0), near(0.5)),
        add(&mut world, 9.0, &ball(1.0), near(0.5)),
    ];
    step(&mut world);
    world.remove(&[handles[3]]);
    step(&mut world);
    (world, handles)
}

/// Asserts that methods that change a world refuse bad numbers and stale handles, and leave the
/// state unchanged.
fn refusals_change_nothing<N: Stage<D>, const D: usize>() {
    let (mut world, [first, second, area, stale]) = busy::<N, D>();
    let before = state(&world);
    let groups = CollisionGroups::new();
    for number in BAD {
        let mut coordinates = [0.5; D];
        coordinates[D - 1] = number;
        let bad = N::at(coordinates);
        panics(|| world.set_position(first, bad), "position");
        panics(|| world.set_positions(&[(first, N::on_x(7.0)), (second, bad)]), "positions");
        panics(|| world.add(bad, ball(1.0), groups, contacts(0.0), ()), "add");
        let query = GeometricQueryType::Contacts(N::lit(number), N::ZERO);
        panics(|| world.set_query_type(first, query), "query");
        panics(|| world.set_query_type(area, GeometricQueryType::Proximity(N::lit(-1.0))), "query");
        panics(|| world.add(N::on_x(0.0), ball(1.0), groups, query, ()), "add");
        assert!(world.try_set_position(second, bad).is_err(), "{number}");
        assert!(world.try_add(bad, cube(1.0), groups, near(0.0), ()).is_err(), "{number}");
        assert!(world.try_set_query_type(area, query).is_err(), "{number}");
        assert_eq!(state(&world), before, "{number}");
    }
    panics(|| world.set_position(stale, N::on_x(0.0)), "stale");
    panics(|| world.set_positions(&[(first, N::on_x(7.0)), (stale, N::on_x(0.0))]), "stale");
    panics(|| world.set_shape(stale, ball(1.0)), "stale");
    panics(|| world.set_collision_groups(stale, groups), "stale");
    panics(|| world.set_query_type(stale, near(0.0)), "stale");
    panics(|| world.remove(&[first, stale]), "stale");
    panics(|| world.remove(&[first, second, first]), "twice");
    let (_, [.., other]) = busy::<N, D>();
    panics(|| world.remove(&[other]), "of another world, and gone there too");
    assert!(world.collision_object(stale).is_none(), "stale");
    assert!(world.collision_object_mut(stale).is_none(), "stale");
    assert!(world.contact_pair(first, stale).is_none(), "stale");
    assert!(world.contact_pair(stale, stale).is_none(), "stale");
    assert!(world.proximity_pair(stale, area).is_none() && !world.contains(stale), "stale");
    assert!(world.contact_pair(first, first).is_none(), "no pair with itself");
    assert_eq!(state(&world), before, "stale handles");
    assert!(step(&mut world).is_empty() && world.proximity_events().is_empty(), "no event");
    // The events of the previous update are gone; everything else is unchanged.
    let calm = state(&world);
    step(&mut world);
    assert_eq!(state(&world), calm, "and after another update");
}

/// Asserts that queries with NaN or infinite coordinates find nothing.
fn questions_that_are_none<N: Stage<D>, const D: usize>() {
    let (world, [first, ..]) = busy::<N, D>();
    let all = CollisionGroups::new();
    for number in BAD {
        let mut bad = Vector::<N, D>::repeat(N::HALF);
        bad[0] = N::lit(number);
        let good = Vector::<N, D>::repeat(N::HALF);
        for ray in [Ray::new(bad.into(), good), Ray::new(good.into(), bad)] {
            assert_eq!(world.interferences_with_ray(&ray, &all).count(), 0, "{number}");
            assert!(world.first_interference_with_ray(&ray, &all).is_none(), "{number}");
        }
        let count = world.interferences_with_point(&bad.into(), &all).count();
        assert_eq!(count, 0, "{number}");
    }
    let still = Ray::new(Point::origin(), Vector::<N, D>::zeros());
    assert!(
        world.interferences_with_ray(&still, &all).any(|(o, _)| o.handle() == first),
        "a point"
    );
    let far = Vector::<N, D>::repeat(N::MAX);
    let ray = Ray::new(Point::from(far), -far);
    let _ = world.interferences_with_ray(&ray, &all).count();
    assert_eq!(world.interferences_with_point(&far.into(), &all).count(), 0, "far away");
    let aabb = Aabb::new(Point::from(-far), Point::from(far));
    assert_eq!(world.interferences_with_aabb(&aabb, &all).count(), 3, "everything");
}

/// Asserts that shapes of size zero, a ball, a cube and a half-space, all at one position, touch
/// each other.
fn sizes_of_zero<N: Stage<D>, const D: usize>() {
    let zero = Point::<N, D>::origin();
    let shapes: Vec<ShapeHandle<N, D>> = vec![
        ball(0.0),
        cube(0.0),
        ShapeHandle::new(Capsule::new(N::ZERO, N::ZERO)),
        ShapeHandle::new(Segment::new(zero, zero)),
        ShapeHandle::new(Triangle::new(zero, zero, zero)),
        half_space(1, 1.0),
        ball(1.0),
        cube(1.0),
    ];
    let mut world = World::<N, D>::new(N::ZERO);
    let handles: Vec<_> =
        shapes.iter().map(|shape| add(&mut world, 0.0, shape, contacts(0.0))).collect();
    let count = handles.len();
    let started = step(&mut world);
    assert_eq!(started.len(), count * (count - 1) / 2, "all touch all");
    for (_, _, manifold) in world.contact_manifolds() {
        for tracked in manifold.contacts() {
            let contact = tracked.contact;
            let normal = contact.normal.norm().as_f64();
            assert!((normal - 1.0).abs() < 1e-5, "{contact:?}");
            assert!(contact.depth.is_finite_number() && contact.depth >= N::ZERO, "{contact:?}");
            assert!(contact.world1.iter().all(|x| x.is_finite_number()), "{contact:?}");
        }
    }
    for (index, shape) in shapes.iter().enumerate() {
        let (projection, _) = shape.project_local_point(&zero);
        assert!(projection.is_inside, "the origin is in the {index}-th");
        let ray = Ray::new(zero, vector([1.0; D]));
        let toi = shape.cast_local_ray(&ray, true).map(|hit| hit.toi);
        assert_eq!(toi, Some(N::ZERO), "and a ray from there hits the {index}-th");
    }
    for (index, &handle) in handles.iter().enumerate() {
        world.set_position(handle, N::on_x(10.0 * f64::from(u32::try_from(index).expect("few"))));
    }
    let stopped = step(&mut world);
    // Only the contacts with the half-space remain, since all shapes still lie on it.
    assert_eq!(stopped.len(), (count - 1) * (count - 2) / 2, "all but those of the half-space");
    assert!(stopped.iter().all(|event| matches!(event, ContactEvent::Stopped(..))), "stopped");
}

/// Asserts that a world stays valid with sizes and positions near the limit of the scalar, whose
/// squares overflow, and that a ray still hits.
fn enormous<N: Stage<D>, const D: usize>() {
    let huge = N::MAX.as_f64() / 4.0;
    let mut world = World::<N, D>::new(N::lit(0.02));
    let places = [0.0, 1.0, huge, -huge, huge.sqrt(), -huge.sqrt() * 4.0];
    for x in places {
        for shape in [ball(1.0), cube(1.0), ball(huge), cube(huge), half_space(0, 1.0)] {
            add(&mut world, x, &shape, contacts(0.0));
            add(&mut world, x, &shape, near(0.0));
        }
    }
    for round in 0..3 {
        world.update();
        world.validate().expect("the parts agree");
        let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
        for (index, handle) in handles.into_iter().enumerate() {
            world.set_position(handle, N::on_x(places[(index + round) % places.len()]));
        }
    }
    let ray = Ray::new(Point::origin(), vector::<N, D>([1.0; D]));
    let hits = world.interferences_with_ray(&ray, &CollisionGroups::new()).count();
    assert!(hits > 0, "the enormous ones");
}

/// Adds many objects with the same centre, half of them sensors. Asserts that every two of them
/// have a contact or a proximity event, and that the removal of all but one ends all contacts and
/// proximities.
fn coincident<N: Stage<D>, const D: usize>(count: usize) {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let shape = ball(0.5);
    let handles: Vec<_> = (0..count)
        .map(|n| {
            let query = if n % 2 == 0 { contacts(0.0) } else { near(0.0) };
            add(&mut world, 3.0, &shape, query)
        })
        .collect();
    world.update();
    let pairs = count * (count - 1) / 2;
    let even = count.div_ceil(2);
    let touching = even * (even - 1) / 2;
    assert_eq!(world.contact_events().len(), touching, "two that ask for contacts");
    assert_eq!(world.proximity_events().len(), pairs - touching, "one that does not");
    for (_, _, manifold) in world.contact_manifolds().take(1000) {
        let contact = manifold.deepest_contact().expect("a contact").contact;
        assert_eq!(contact.depth, N::ONE, "both radii");
        assert!((contact.normal.norm().as_f64() - 1.0).abs() < 1e-6, "some direction");
    }
    world.remove(&handles[1..]);
    world.update();
    assert_eq!(world.contact_events().len(), touching, "all contacts end");
    assert_eq!(world.proximity_events().len(), pairs - touching, "and all proximities");
    let disjoint = world.proximity_events().iter().all(|e| e.new_status == Proximity::Disjoint);
    assert!(disjoint && world.len() == 1, "one is left");
}

#[test]
fn two_thousand_at_one_place() {
    // Two million pairs, each looked up among the partners of an object: too slow for debug builds,
    // which check each lookup by a second one.
    coincident::<f32, 3>(if cfg!(debug_assertions) { 1000 } else { 2000 });
    coincident::<f64, 2>(500);
    coincident::<f32, 2>(500);
    coincident::<f64, 3>(500);
}

in_tests! {
    bad_shapes_are_refused, refusals_change_nothing, questions_that_are_none, sizes_of_zero,
    enormous,
}
