//! Tests that bad input is refused with an error that reports it and leaves the world unchanged,
//! and that lookups of removed objects return `None`.

use crate::support::world_stage;

use impinge::bounding_volume::Aabb;
use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::Point;
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::query::Ray;
use impinge::shape::Ball;
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld, QueryFilter, WorldError};
use world_stage::{Stage, add, ball, contacts, cube, half_space, near, step, vector};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

/// Returns a world of two balls in contact, with their handles and a stale handle.
fn pair<N: Stage<D>, const D: usize>() -> (World<N, D>, [CollisionObjectHandle; 3]) {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let shape = ball(1.0);
    let first = add(&mut world, 0.0, &shape, contacts(0.0));
    let stale = add(&mut world, 0.5, &shape, contacts(0.0));
    let second = add(&mut world, 1.5, &shape, contacts(0.0));
    world.remove(&[stale]);
    step(&mut world);
    (world, [first, second, stale])
}

/// Asserts that nothing has changed since [`pair`].
fn check_unchanged<N: Stage<D>, const D: usize>(
    world: &mut World<N, D>,
    [first, second, stale]: [CollisionObjectHandle; 3],
) {
    assert_eq!(world.len(), 2, "two objects");
    assert_eq!(world.collision_object(second).expect("alive").position(), &N::on_x(1.5), "there");
    assert_eq!(step(world), [], "no event");
    assert_eq!(world.contact_pairs().count(), 1, "one pair");
    assert!(world.contact_pair(first, second).is_some(), "still");
    assert!(world.contact_pair(first, stale).is_none(), "stale");
    assert!(world.proximity_pair(stale, first).is_none(), "stale");
    let next = add(world, 90.0, &ball(1.0), contacts(0.0));
    assert_eq!(next.uid(), stale.uid(), "the free index is still free");
}

/// Asserts that every method refuses the handle as stale.
fn check_unknown<N: Stage<D>, const D: usize>(
    world: &mut World<N, D>,
    first: CollisionObjectHandle,
    unknown: CollisionObjectHandle,
) {
    let refused = Err(WorldError::StaleHandle(unknown));
    assert_eq!(world.try_set_position(unknown, N::on_x(0.0)), refused, "move");
    let moves = [(first, N::on_x(9.0)), (unknown, N::on_x(9.0))];
    assert_eq!(world.try_set_positions(&moves), refused, "move many");
    assert_eq!(world.try_remove(&[first, unknown]), refused, "remove");
    assert_eq!(world.try_set_shape(unknown, cube(1.0)), refused, "shape");
    assert_eq!(world.try_set_collision_groups(unknown, CollisionGroups::new()), refused, "groups");
    assert_eq!(world.try_set_query_type(unknown, near(1.0)), refused, "query type");
    let deformed = world.try_deform(unknown, |_: &mut Ball<N>| ());
    assert_eq!(deformed, refused, "deform");
    assert!(!world.contains(unknown), "unknown");
    assert!(world.collision_object(unknown).is_none(), "look up");
    assert!(world.collision_object_mut(unknown).is_none(), "look up, to change");
    assert!(world.contact_pair(first, unknown).is_none(), "contacts");
    assert!(world.proximity_pair(unknown, first).is_none(), "proximity");
    let everything = Ray::new(Point::from(vector([-9.0; D])), vector([1.0; D]));
    let hits = |filter: &QueryFilter<'_, N, D, ()>| {
        world.ray_hits(&everything, N::INFINITY, true, filter).len()
    };
    let all = hits(&QueryFilter::new());
    assert_eq!(hits(&QueryFilter::new().exclude(unknown)), all, "it excludes nothing");
}

fn stale_handles_are_refused<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = pair::<N, D>();
    let [first, _, stale] = handles;
    check_unknown(&mut world, first, stale);
    let twice = Err(WorldError::RepeatedHandle(first));
    assert_eq!(world.try_remove(&[first, first]), twice, "twice at once");
    check_unchanged(&mut world, handles);
}

/// Asserts that each of four worlds with equal contents, as on a server and its clients, refuses
/// the handles of the others.
fn handles_of_other_worlds_are_refused<N: Stage<D>, const D: usize>() {
    let mut worlds: Vec<_> = (0..4).map(|_| pair::<N, D>()).collect();
    for round in 0..2 {
        for (own, other) in (0..4).flat_map(|own| (0..4).map(move |other| (own, other))) {
            let ([first, second, _], foreign) = (worlds[own].1, worlds[other].1);
            let world = &mut worlds[own].0;
            if own != other {
                for handle in foreign {
                    check_unknown(world, first, handle);
                }
                assert!(first != foreign[0], "no handle has two worlds");
                assert_eq!(format!("{first:?}"), format!("{:?}", foreign[0]), "the same message");
            }
            let expected = [Some(first), Some(second), None];
            assert_eq!(foreign.map(|handle| world.counterpart(handle)), expected, "by number");
            world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::ONE)));
        }
        for (world, handles) in &mut worlds {
            assert_eq!(step(world), [], "no event in round {round}");
            if round == 1 {
                check_unchanged(world, *handles);
            }
        }
    }
}

fn bad_numbers_are_refused<N: Stage<D>, const D: usize>() {
    let (mut world, handles) = pair::<N, D>();
    let [first, ..] = handles;
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut coordinates = [0.0; D];
        coordinates[D - 1] = bad;
        let position = N::at(coordinates);
        let moved = world.try_set_position(first, position).expect_err("not finite");
        assert!(moved.to_string().contains(&bad.to_string()), "the value: {moved}");
        assert!(moved.to_string().contains(&format!("{first:?}")), "the handle: {moved}");
        let groups = CollisionGroups::new();
        let added = world.try_add(position, ball(1.0), groups, contacts(0.0), ());
        assert!(matches!(added, Err(WorldError::Position { handle: None, .. })), "{added:?}");
        let many = world.try_set_positions(&[(first, N::on_x(50.0)), (first, position)]);
        assert!(matches!(many, Err(WorldError::Position { .. })), "all or nothing");
    }
    for bad in [f64::NAN, f64::INFINITY, -0.125] {
        let value = N::lit(bad);
        for query in [
            GeometricQueryType::Contacts(value, N::ZERO),
            GeometricQueryType::Contacts(N::ZERO, value),
            GeometricQueryType::Proximity(value),
        ] {
            let changed = world.try_set_query_type(first, query).expect_err("unusable");
            assert!(changed.to_string().contains(&bad.to_string()), "the value: {changed}");
            let added = world.try_add(N::on_x(0.0), ball(1.0), CollisionGroups::new(), query, ());
            assert!(matches!(added, Err(WorldError::QueryType { .. })), "{added:?}");
        }
        let made = World::<N, D>::try_new(value).map(|_| ());
        assert!(matches!(made, Err(WorldError::Margin { .. })), "{made:?}");
    }
    check_unchanged(&mut world, handles);
}

fn uids_are_dense_and_in_order<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::ZERO);
    let shape = ball(0.5);
    let handles: Vec<_> = (0..40).map(|_| add(&mut world, 0.0, &shape, near(0.0))).collect();
    let uids: Vec<usize> = handles.iter().map(CollisionObjectHandle::uid).collect();
    assert_eq!(uids, (0..40).collect::<Vec<_>>(), "dense, in order of creation");
    world.remove(&[handles[7], handles[3]]);
    let again = [add(&mut world, 0.0, &shape, near(0.0)), add(&mut world, 0.0, &shape, near(0.0))];
    assert_eq!(again.map(|handle| handle.uid()), [3, 7], "the last freed one first");
    let seen: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
    assert!(seen.is_sorted() && seen.len() == 40, "iteration is in order");
}

fn empty_worlds_answer<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let mut nobody = CollisionGroups::new();
    nobody.set_whitelist(&[]);
    for round in 0..4 {
        if round == 1 {
            add(&mut world, 0.0, &ball(1.0), contacts(0.0));
        }
        if round == 2 {
            step(&mut world);
        }
        if round == 3 {
            world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::ONE)));
        }
        let origin = Point::<N, D>::origin();
        let ray = Ray::new(origin, vector([1.0; D]));
        assert_eq!(world.interferences_with_ray(&ray, &nobody).count(), 0, "nothing");
        assert_eq!(world.interferences_with_point(&origin, &nobody).count(), 0, "nothing");
        let everything = Aabb::unbounded();
        assert_eq!(world.interferences_with_aabb(&everything, &nobody).count(), 0, "nothing");
        assert!(world.first_interference_with_ray(&ray, &nobody).is_none(), "nothing");
        let all = CollisionGroups::new();
        let count = usize::from(round > 0);
        assert_eq!(world.interferences_with_aabb(&everything, &all).count(), count, "the ball");
        let bad = Ray::new(origin, vector([f64::NAN; D]));
        assert_eq!(world.interferences_with_ray(&bad, &all).count(), 0, "not a ray");
        assert!(world.first_interference_with_ray(&bad, &all).is_none(), "not a ray");
    }
}

fn queries_are_right_at_once<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(4.0));
    let all = CollisionGroups::new();
    let from = Ray::new(
        vector::<N, D>([0.0; D]).into(),
        vector(std::array::from_fn(|i| if i == 0 { 2.0 } else { 0.0 })),
    );
    let hits = |world: &World<N, D>| {
        let hits = world.interferences_with_ray(&from, &all);
        let hits: Vec<_> = hits.map(|(object, hit)| (object.handle(), hit.toi)).collect();
        let first = world.first_interference_with_ray(&from, &all);
        let first = first.map(|(object, hit)| (object.handle(), hit.toi));
        let nearest = hits.iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a });
        assert_eq!(first, nearest, "the nearest of all");
        hits
    };
    let first = add(&mut world, 5.0, &ball(1.0), contacts(0.5));
    assert_eq!(hits(&world), [(first, N::TWO)], "just added");
    world.update();
    assert_eq!(hits(&world), [(first, N::TWO)], "after an update");
    world.set_position(first, N::on_x(9.0));
    assert_eq!(hits(&world), [(first, N::lit(4.0))], "just moved");
    let second = add(&mut world, 5.0, &cube(2.0), near(0.0));
    assert_eq!(hits(&world), [(first, N::lit(4.0)), (second, N::lit(1.5))], "in order of handles");
    world.update();
    world.set_shape(second, ball(0.5));
    assert_eq!(hits(&world)[1], (second, N::lit(2.25)), "another shape");
    let mut alone = CollisionGroups::new();
    alone.set_blacklist(&[0]);
    world.set_collision_groups(first, alone);
    assert_eq!(hits(&world), [(second, N::lit(2.25))], "other groups");
    world.remove(&[second]);
    assert_eq!(hits(&world), [], "just removed");
    world.set_collision_groups(first, all);
    let third = add(&mut world, 5.0, &ball(1.0), near(0.0));
    assert_eq!(third.uid(), second.uid(), "the index is used again");
    world.set_position(third, N::on_x(-5.0));
    assert_eq!(hits(&world), [(first, N::lit(4.0))], "behind");
    world.update();
    assert_eq!(hits(&world), [(first, N::lit(4.0))], "behind");
}

fn boxes_are_exact<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(4.0));
    let handle = add(&mut world, 0.0, &ball(1.0), contacts(2.0));
    let ground =
        world.add(N::at([-5.0; D]), half_space(1, 1.0), CollisionGroups::new(), near(1.0), ());
    for _ in 0..2 {
        let count = |low: f64, high: f64| {
            let aabb = Aabb::new(vector::<N, D>([low; D]).into(), vector::<N, D>([high; D]).into());
            let found = world.interferences_with_aabb(&aabb, &CollisionGroups::new());
            found.map(CollisionObject::handle).collect::<Vec<_>>()
        };
        assert_eq!(count(1.0, 2.0), [handle], "the box touches, though the ball does not");
        assert_eq!(count(1.0625, 2.0), [], "neither margin nor prediction counts");
        assert_eq!(count(-6.0, -5.0), [ground], "touching the ground");
        assert_eq!(count(-5.0, -1.0), [handle, ground], "both");
        assert_eq!(count(-4.9375, -2.0), [], "between them");
        world.update();
    }
}

in_tests! {
    stale_handles_are_refused, handles_of_other_worlds_are_refused, bad_numbers_are_refused, uids_are_dense_and_in_order,
    empty_worlds_answer, queries_are_right_at_once, boxes_are_exact,
}

#[test]
#[should_panic(expected = "CollisionObjectHandle { index: 1, generation: 0 } is stale")]
fn panics_name_the_handle() {
    let (mut world, [_, _, stale]) = pair::<f32, 2>();
    world.set_position(stale, <f32 as Stage<2>>::on_x(0.0));
}

#[test]
#[should_panic(expected = "is to be removed twice")]
fn removing_twice_panics() {
    let (mut world, [first, ..]) = pair::<f64, 3>();
    world.remove(&[first, first]);
}

#[test]
#[should_panic(expected = "the margin is -1")]
fn negative_margins_panic() {
    let _ = World::<f64, 3>::new(-1.0);
}
