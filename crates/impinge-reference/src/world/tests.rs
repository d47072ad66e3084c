//! Compares the naive world with event logs computed by hand.

use super::*;
use crate::random::Random;

const TOUCH: QueryType = QueryType::Contacts(0.0);

fn ball_at(world: &mut NaiveWorld<2>, x: f64, query_type: QueryType) -> Handle {
    world.add(Pose::at([x, 0.0]), Solid::ball(0.5), Groups::new(), query_type)
}

fn move_to(world: &mut NaiveWorld<2>, handle: Handle, x: f64) {
    world.set_position(handle, Pose::at([x, 0.0])).expect("alive");
}

fn transition(pair: (Handle, Handle), previous: Proximity, new: Proximity) -> ProximityEvent {
    ProximityEvent { collider1: pair.0, collider2: pair.1, previous, new }
}

#[test]
fn touching_starts_and_leaving_stops() {
    let mut world = NaiveWorld::new();
    let a = ball_at(&mut world, 0.0, TOUCH);
    let b = ball_at(&mut world, 1.0, QueryType::Contacts(0.25));
    assert_eq!(world.update().contacts, [ContactEvent::Started(a, b)]);
    assert_eq!(world.update(), Events::default());
    move_to(&mut world, b, 1.25);
    assert_eq!(world.update(), Events::default(), "just within the prediction");
    move_to(&mut world, b, 1.5);
    assert_eq!(world.touching_pairs(), [(a, b)], "nothing happens before the update");
    assert_eq!(world.update().contacts, [ContactEvent::Stopped(a, b)]);
    assert_eq!(world.touching_pairs(), []);
}

#[test]
fn proximity_passes_all_statuses() {
    use Proximity::{Disjoint, Intersecting, WithinMargin};
    let mut world = NaiveWorld::new();
    let a = ball_at(&mut world, 0.0, QueryType::Proximity(0.25));
    let b = ball_at(&mut world, 2.0, QueryType::Contacts(9.0));
    assert_eq!(world.update(), Events::default(), "predictions are not margins");
    for (x, previous, new) in [
        (1.25, Disjoint, WithinMargin),
        (1.0, WithinMargin, Intersecting),
        (4.0, Intersecting, Disjoint),
    ] {
        move_to(&mut world, b, x);
        assert_eq!(world.update().proximities, [transition((a, b), previous, new)]);
    }
    world.set_query_type(b, QueryType::Proximity(2.75)).expect("alive");
    assert_eq!(world.update().proximities, [transition((a, b), Disjoint, WithinMargin)]);
    assert_eq!(world.close_pairs(), [(a, b, WithinMargin)]);
}

#[test]
fn removal_comes_first_and_handles_are_not_reused() {
    let mut world = NaiveWorld::new();
    let a = ball_at(&mut world, 0.0, TOUCH);
    let b = ball_at(&mut world, 0.5, TOUCH);
    let c = ball_at(&mut world, 0.75, QueryType::Proximity(0.0));
    world.update();
    world.remove(&[a]).expect("alive");
    let d = ball_at(&mut world, 0.5, TOUCH);
    assert_eq!((d.index, d.generation), (a.index, 1));
    assert!(world.object(a).is_none() && world.object(d).is_some(), "a is stale");
    assert_eq!(world.remove(&[b, a]), Err(StaleHandle(a)));
    assert_eq!(world.remove(&[b, b]), Err(StaleHandle(b)));
    let events = world.update();
    assert_eq!(events.contacts, [ContactEvent::Stopped(a, b), ContactEvent::Started(d, b)]);
    let gone = transition((a, c), Proximity::Intersecting, Proximity::Disjoint);
    let came = transition((d, c), Proximity::Disjoint, Proximity::Intersecting);
    assert_eq!(events.proximities, [gone, came]);
    assert_eq!((events.removed_contacts, events.removed_proximities), (1, 1));
    assert_eq!(world.objects().map(|object| object.order).collect::<Vec<_>>(), [3, 1, 2]);
}

#[test]
fn a_short_life_leaves_no_trace() {
    let mut world = NaiveWorld::new();
    ball_at(&mut world, 0.0, TOUCH);
    world.update();
    let b = ball_at(&mut world, 0.5, TOUCH);
    world.remove(&[b]).expect("alive");
    assert_eq!(world.update(), Events::default());
}

#[test]
fn change_of_query_type_stops_the_contact_and_starts_from_disjoint() {
    let mut world = NaiveWorld::new();
    let a = ball_at(&mut world, 0.0, TOUCH);
    let b = ball_at(&mut world, 0.5, TOUCH);
    world.update();
    world.set_query_type(a, QueryType::Proximity(0.0)).expect("alive");
    let events = world.update();
    assert_eq!(events.contacts, [ContactEvent::Stopped(a, b)]);
    let came = transition((a, b), Proximity::Disjoint, Proximity::Intersecting);
    assert_eq!(events.proximities, [came]);
}

#[test]
fn groups_shapes_and_filters_change_the_facts() {
    let mut world = NaiveWorld::new();
    let a = ball_at(&mut world, 0.0, TOUCH);
    let b = ball_at(&mut world, 0.5, TOUCH);
    let (started, stopped) = (ContactEvent::Started(a, b), ContactEvent::Stopped(a, b));
    assert_eq!(world.update().contacts, [started]);
    world.set_groups(a, Groups::of(&[1], &[1], &[2])).expect("alive");
    assert_eq!(world.update().contacts, [stopped]);
    world.set_groups(a, Groups::new()).expect("alive");
    assert_eq!(world.update().contacts, [started]);
    world.set_shape(b, Solid::half_space([-1.0, 0.0])).expect("alive");
    assert_eq!(world.update().contacts, []);
    world.set_shape(b, Solid::cuboid([0.0, 1.0])).expect("alive");
    world.register_filter("same parity", |uid1, uid2| uid1 % 2 == uid2 % 2);
    assert_eq!(world.update().contacts, [stopped]);
    assert!(world.unregister_filter("same parity"), "it was there");
    assert_eq!(world.update().contacts, [started]);
}

#[test]
fn planes_that_overlap_without_bound_intersect_without_contact() {
    let mut world = NaiveWorld::<2>::new();
    let mut plane = |normal, query_type| {
        world.add(Pose::identity(), Solid::half_space(normal), Groups::new(), query_type)
    };
    let a = plane([1.0, 0.0], TOUCH);
    plane([0.0, 1.0], TOUCH);
    let c = plane([-1.0, 0.0], TOUCH);
    let d = plane([0.6, 0.8], QueryType::Proximity(0.0));
    let events = world.update();
    assert_eq!(events.contacts, [ContactEvent::Started(a, c)]);
    assert_eq!(events.proximities.len(), 3);
    assert!(events.proximities.iter().all(|event| event.collider2 == d), "{events:?}");
}

#[test]
fn queries_see_changes_at_once() {
    let mut world = NaiveWorld::new();
    let a = ball_at(&mut world, 0.0, TOUCH);
    let b = ball_at(&mut world, 5.0, TOUCH);
    let all = Groups::new();
    let hits = world.interferences_with_ray(&[-2.5, 0.0], &[2.0, 0.0], all);
    assert_eq!(hits.iter().map(|hit| hit.0).collect::<Vec<_>>(), [a, b]);
    assert!((hits[0].1 - 1.0).abs() < 1e-12 && (hits[1].1 - 3.5).abs() < 1e-12, "{hits:?}");
    move_to(&mut world, a, 5.5);
    assert_eq!(world.interferences_with_point(&[5.25, 0.0], all), [a, b]);
    assert_eq!(world.interferences_with_point(&[5.25, 0.45], all), []);
    assert_eq!(world.interferences_with_aabb(&[5.5, 0.5], &[9.0, 9.0], all), [a, b]);
    assert_eq!(world.interferences_with_aabb(&[5.75, 0.5], &[9.0, 9.0], all), [a]);
    let nobody = Groups { membership: 0, ..all };
    assert_eq!(world.interferences_with_point(&[5.25, 0.0], nobody), []);
    world.remove(&[a]).expect("alive");
    assert_eq!(world.interferences_with_point(&[5.25, 0.0], all), [b]);
}

/// Asserts that in random histories `Started` and `Stopped` alternate for each pair, and that each
/// proximity event begins with the status at which the pair's previous one ended.
#[test]
fn events_of_random_histories_are_coherent() {
    let mut random = Random::new(5);
    let mut world = NaiveWorld::<2>::new();
    let mut touching = BTreeSet::new();
    let mut statuses: BTreeMap<(Handle, Handle), Proximity> = BTreeMap::new();
    let mut count = 0;
    for _ in 0..300 {
        random_change(&mut world, &mut random);
        let events = world.update();
        for event in &events.contacts {
            let changed = match event {
                ContactEvent::Started(a, b) => touching.insert((*a, *b)),
                ContactEvent::Stopped(a, b) => touching.remove(&(*a, *b)),
            };
            assert!(changed, "{event:?} twice");
        }
        for event in &events.proximities {
            let before = statuses.insert((event.collider1, event.collider2), event.new);
            assert_eq!(before.unwrap_or_default(), event.previous);
        }
        assert_eq!(touching.iter().copied().collect::<Vec<_>>(), world.touching_pairs());
        count += events.contacts.len() + events.proximities.len();
    }
    assert!(count > 300, "only {count} events");
}

fn random_change(world: &mut NaiveWorld<2>, random: &mut Random) {
    let handles: Vec<Handle> = world.objects().map(|object| object.handle).collect();
    let query_type = if random.chance(0.5) { TOUCH } else { QueryType::Proximity(0.2) };
    let pose = random.pose(2.0);
    if handles.len() < 8 {
        world.add(pose, Solid::cuboid([0.7, 0.3]), Groups::new(), query_type);
        return;
    }
    let handle = *random.pick(&handles);
    match random.below(4) {
        0 => world.remove(&[handle]),
        1 => world.set_query_type(handle, query_type),
        2 => world.set_shape(handle, Solid::ball(random.range(0.1, 1.0))),
        _ => world.set_position(handle, pose),
    }
    .expect("alive");
}
