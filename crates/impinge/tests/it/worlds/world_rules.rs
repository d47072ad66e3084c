//! Tests groups, filters and margins: which pairs exist, and which settings must not affect
//! results.

use crate::support::world_stage;

use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use impinge::dim2;
use impinge::dim3;
use impinge::math::{Real, Space};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, ProximityEvent};
use impinge::query::{ManifoldView, Proximity};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld};
use impinge_reference::random::Random;
use world_stage::{Stage, ball, contacts, cube, near, step};

use ContactEvent::{Started, Stopped};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

fn groups(membership: &[usize], whitelist: &[usize], blacklist: &[usize]) -> CollisionGroups {
    let mut groups = CollisionGroups::new();
    groups.set_membership(membership);
    groups.set_whitelist(whitelist);
    groups.set_blacklist(blacklist);
    groups
}

/// Adds a ball of radius 1 at the origin with the given groups.
fn add<N: Stage<D>, const D: usize>(
    world: &mut World<N, D>,
    groups: CollisionGroups,
) -> CollisionObjectHandle {
    world.add(N::at([0.0; D]), ball(1.0), groups, contacts(0.0), ())
}

fn groups_decide_who_meets<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let a = add(&mut world, groups(&[1, 3, 6], &[6, 7], &[1]));
    let b = add(&mut world, groups(&[1, 3, 7], &[3, 7], &[]));
    let c = add(&mut world, groups(&[6, 9], &[3, 7], &[]));
    assert_eq!(step(&mut world), [Started(a, c)], "A and C alone");
    let mut self_colliding = groups(&[1, 3, 7], &[3, 7], &[]);
    self_colliding.enable_self_collision();
    world.set_collision_groups(b, self_colliding);
    assert_eq!(step(&mut world), [], "a convex solid has nothing to say about itself");
    for _ in 0..100 {
        world.add(N::at([0.0; D]), ball(1.0), groups(&[], &[], &[]), contacts(0.0), ());
    }
    assert_eq!(step(&mut world), [], "members of nothing meet nobody");
    assert_eq!(world.contact_pairs().count(), 1, "not even in the broad phase");
}

/// A filter that accepts pairs whose indices have equal parity.
struct Parity;

impl<N: Real, T> dim2::world::BroadPhasePairFilter<N, T> for Parity {
    fn is_pair_valid(
        &self,
        a: &dim2::world::CollisionObject<N, T>,
        b: &dim2::world::CollisionObject<N, T>,
    ) -> bool {
        a.handle().uid() % 2 == b.handle().uid() % 2
    }
}

impl<N: Real, T> dim3::world::BroadPhasePairFilter<N, T> for Parity {
    fn is_pair_valid(
        &self,
        a: &dim3::world::CollisionObject<N, T>,
        b: &dim3::world::CollisionObject<N, T>,
    ) -> bool {
        a.handle().uid() % 2 == b.handle().uid() % 2
    }
}

#[test]
fn filters_decide_who_meets() {
    let mut world = World::<f32, 2>::new(0.02);
    world.register_broad_phase_pair_filter("parity", Parity);
    let handles: Vec<_> = (0..4).map(|_| add(&mut world, CollisionGroups::new())).collect();
    let pair = |a: usize, b: usize| (handles[a], handles[b]);
    let started = |pairs: &[(CollisionObjectHandle, CollisionObjectHandle)]| {
        pairs.iter().map(|&(a, b)| Started(a, b)).collect::<Vec<_>>()
    };
    assert_eq!(step(&mut world), started(&[pair(0, 2), pair(1, 3)]), "the same parity");
    world.unregister_broad_phase_pair_filter("parity");
    world.unregister_broad_phase_pair_filter("no such filter");
    let others = [pair(0, 1), pair(0, 3), pair(1, 2), pair(2, 3)];
    assert_eq!(step(&mut world), started(&others), "all others");
    world.register_broad_phase_pair_filter("parity", Parity);
    let stopped: Vec<_> = others.iter().map(|&(a, b)| Stopped(a, b)).collect();
    assert_eq!(step(&mut world), stopped, "and back");
    type Object = dim2::world::CollisionObject<f32, ()>;
    world.register_broad_phase_pair_filter("never", |_: &Object, _: &Object| false);
    assert_eq!(step(&mut world).len(), 2, "all filters must agree");
    assert_eq!(world.contact_pairs().count(), 0, "nobody");
}

#[test]
fn filters_hear_of_new_pairs_that_the_groups_allow() {
    type Object = dim3::world::CollisionObject<f64, ()>;
    let calls = Arc::new(AtomicUsize::new(0));
    let counter = Arc::clone(&calls);
    let mut world = World::<f64, 3>::new(0.02);
    world.register_broad_phase_pair_filter("count", move |a: &Object, b: &Object| {
        assert!(
            a.collision_groups().can_interact_with_groups(b.collision_groups()),
            "groups first"
        );
        counter.fetch_add(1, Ordering::Relaxed);
        true
    });
    let first = add(&mut world, CollisionGroups::new());
    add(&mut world, groups(&[1], &[1], &[]));
    add(&mut world, groups(&[2], &[2], &[]));
    step(&mut world);
    // `step` calls the filters once more to validate the world.
    calls.store(0, Ordering::Relaxed);
    world.update();
    world.set_position(first, <f64 as Stage<3>>::on_x(0.001));
    world.update();
    assert_eq!(calls.load(Ordering::Relaxed), 0, "nothing new");
    add(&mut world, groups(&[2], &[2], &[]));
    world.update();
    assert_eq!(calls.load(Ordering::Relaxed), 2, "with the first and the third");
}

type Log = Vec<(Vec<ContactEvent>, Vec<ProximityEvent>, usize)>;

/// Simulates a swarm on random walks. Returns the events and the number of contact points of each
/// update.
fn swarm<N: Stage<D>, const D: usize>(margin: f64) -> Log {
    let mut random = Random::new(11);
    let mut world = World::<N, D>::new(N::lit(margin));
    let mut places: Vec<[f64; D]> = Vec::new();
    let mut handles = Vec::new();
    for number in 0..40 {
        places.push(std::array::from_fn(|_| random.grid(4, 6)));
        let shape = if number % 2 == 0 { ball(0.75) } else { cube(0.5) };
        let query = if number % 3 == 0 { near(0.25) } else { contacts(0.125) };
        let position = N::at(places[number]);
        handles.push(world.add(position, shape, CollisionGroups::new(), query, ()));
    }
    let mut log = Log::new();
    for _ in 0..60 {
        for (place, handle) in places.iter_mut().zip(&handles) {
            place.iter_mut().for_each(|x| *x += random.grid(1, 6) * 0.25);
            world.set_position(*handle, N::at(*place));
        }
        world.update();
        let manifolds = world.contact_manifolds().map(|(_, _, manifold)| manifold.len());
        let points = manifolds.sum();
        log.push((world.contact_events().to_vec(), world.proximity_events().to_vec(), points));
    }
    log
}

fn margins_never_change_an_answer<N: Stage<D>, const D: usize>() {
    let log = swarm::<N, D>(0.0);
    let events: usize = log.iter().map(|(contacts, near, _)| contacts.len() + near.len()).sum();
    assert!(events > 200, "much happens: {events}");
    for margin in [0.02, 0.5, 8.0] {
        // Compared as text: handles of two worlds differ, but their text is the same.
        let other = swarm::<N, D>(margin);
        assert_eq!(format!("{other:?}"), format!("{log:?}"), "margin {margin}");
    }
}

fn order_is_canonical<N: Stage<D>, const D: usize>() {
    for (contacts, proximities, _) in swarm::<N, D>(0.02) {
        assert!(contacts.iter().map(ContactEvent::handles).is_sorted(), "contact events");
        let pairs = proximities.iter().map(|event| (event.collider1, event.collider2));
        assert!(pairs.is_sorted(), "proximity events");
        assert!(contacts.iter().all(|event| event.handles().0 < event.handles().1), "in a pair");
    }
    let mut world = World::<N, D>::new(N::ONE);
    for _ in 0..20 {
        add(&mut world, CollisionGroups::new());
    }
    let gone: Vec<_> = world.collision_objects().map(CollisionObject::handle).step_by(3).collect();
    world.update();
    world.remove(&gone);
    for _ in 0..5 {
        add(&mut world, CollisionGroups::new());
    }
    world.update();
    let pairs: Vec<_> = world.contact_pairs().map(|(a, b, _)| (a.handle(), b.handle())).collect();
    assert!(pairs.is_sorted() && pairs.len() == 18 * 17 / 2, "all pairs, in order");
    assert_eq!(world.contact_manifolds().count(), pairs.len(), "each with a contact");
}

/// Asserts that `contacts_with` returns the contacts of all pairs that contain the object, with the
/// object as the first solid. Stale handles, and objects that no update has seen, have none.
fn an_object_sees_its_pairs_from_its_side<N: Stage<D>, const D: usize>() {
    let (mut random, mut world) = (Random::new(5), World::<N, D>::new(N::lit(0.02)));
    for number in 0..60 {
        let shape = if number % 2 == 0 { ball(0.75) } else { cube(0.5) };
        let query = if number % 4 == 0 { near(0.25) } else { contacts(0.125) };
        let position = N::at(std::array::from_fn(|_| random.grid(2, 6)));
        world.add(position, shape, CollisionGroups::new(), query, ());
    }
    world.update();
    let mut seen = [0; 2];
    for object in world.collision_objects() {
        let handle = object.handle();
        let own: Vec<_> = world.contacts_with(handle).map(|(o, p)| (o.handle(), p)).collect();
        let mut expected = Vec::new();
        for (first, second, view) in world.contact_manifolds().filter_map(|(first, second, m)| {
            Some((first.handle(), second.handle(), ManifoldView::of_manifold(m)?))
        }) {
            if first == handle {
                expected.extend(view.contacts().map(|point| (second, point)));
            } else if second == handle {
                expected.extend(view.contacts().map(|point| (first, point.flipped())));
            }
        }
        expected.sort_by_key(|(other, _)| *other);
        assert_eq!(own, expected, "{handle:?}");
        for (_, point) in &own {
            let outwards = point.contact.normal.dot(&(point.contact.world1 - point.contact.world2));
            let depth = point.contact.depth;
            assert!(outwards * depth >= N::ZERO, "away from {handle:?}: {point:?}");
        }
        let near: Vec<_> = world.proximities_with(handle).map(|(o, p)| (o.handle(), p)).collect();
        assert!(near.is_sorted_by_key(|(other, _)| *other), "in order");
        for other in world.collision_objects().map(CollisionObject::handle) {
            let known = world.proximity_pair(other, handle).map(|pair| pair.proximity());
            let known = known.filter(|proximity| *proximity != Proximity::Disjoint);
            let told = near.iter().find(|(found, _)| *found == other).map(|(_, p)| *p);
            assert_eq!(told, known, "{handle:?} and {other:?}");
        }
        seen[0] += own.len();
        seen[1] += near.len();
    }
    assert!(seen[0] > 100 && seen[1] > 50, "there is much to see: {seen:?}");
    let (gone, new) = (world.collision_objects().next().expect("many").handle(), ball(1.0));
    world.remove(&[gone]);
    let new = world.add(N::at([0.0; D]), new, CollisionGroups::new(), contacts(0.0), ());
    for handle in [gone, new] {
        assert_eq!(world.contacts_with(handle).count(), 0, "{handle:?}");
        assert_eq!(world.proximities_with(handle).count(), 0, "{handle:?}");
    }
    let others = world.collision_objects().flat_map(|object| world.contacts_with(object.handle()));
    assert!(others.map(|(other, _)| other.handle()).all(|other| other != gone), "it is gone");
}

in_tests! {
    groups_decide_who_meets,
    margins_never_change_an_answer,
    order_is_canonical,
    an_object_sees_its_pairs_from_its_side,
}

/// Asserts that a world is `Send` and `Sync` if its data are.
#[test]
fn worlds_are_sent_and_shared_with_their_data() {
    fn is_send_and_sync<S: Send + Sync>(_: &S) {}
    fn all<N: Space<D>, const D: usize>() {
        is_send_and_sync(&CollisionWorld::<N, D, u8>::new(N::ZERO));
    }
    all::<f32, 2>();
    all::<f64, 2>();
    all::<f32, 3>();
    all::<f64, 3>();
    let counter = Rc::new(Cell::new(0));
    let mut world = CollisionWorld::<f32, 2, Rc<Cell<u8>>>::new(0.02);
    for _ in 0..2 {
        let position = <f32 as Stage<2>>::on_x(0.0);
        world.add(position, ball(1.0), CollisionGroups::new(), contacts(0.0), Rc::clone(&counter));
    }
    world.update();
    for event in world.contact_events() {
        let object = world.collision_object(event.handles().0).expect("alive");
        object.data().set(object.data().get() + 1);
    }
    assert_eq!(counter.get(), 1, "one event; the data are the user's own");
    let handle = world.collision_objects().next().expect("two").handle();
    *world.collision_object_mut(handle).expect("alive").data_mut() = Rc::new(Cell::new(7));
    assert_eq!(Rc::strong_count(&counter), 2, "one object has other data");
}
