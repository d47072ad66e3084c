//! Tests events, one scenario each: what starts, what stops, when and in which order.

use crate::support::world_stage;

use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::{Point, Space};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, DefaultNarrowPhase};
use impinge::query::{ContactId, Proximity};
use impinge::shape::ShapeHandle;
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_reference::random::Random;
use world_stage::{Stage, add, ball, contacts, cube, half_space, near, step};

use ContactEvent::{Started, Stopped};
use Proximity::{Disjoint, Intersecting, WithinMargin};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

/// Returns the proximity events of the last update, as old and new status.
fn transitions<N: Space<D>, const D: usize>(world: &World<N, D>) -> Vec<(Proximity, Proximity)> {
    world.proximity_events().iter().map(|event| (event.prev_status, event.new_status)).collect()
}

/// Returns the ids of all contacts of a pair.
fn ids<N: Space<D>, const D: usize>(
    world: &World<N, D>,
    handle1: CollisionObjectHandle,
    handle2: CollisionObjectHandle,
) -> Vec<ContactId> {
    let mut manifolds = Vec::new();
    world.contact_pair(handle1, handle2).expect("a pair").contacts(&mut manifolds);
    manifolds.iter().flat_map(|m| m.contacts().iter().map(|contact| contact.id)).collect()
}

fn proximity_goes_through_all_transitions<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.25));
    let (a, b) = (ball(1.0), cube(1.0));
    let first = add(&mut world, 0.0, &a, near(0.25));
    let second = add(&mut world, 8.0, &b, near(0.5));
    let script = [
        (8.0, vec![]),
        (2.875, vec![]),
        (2.75, vec![(Disjoint, WithinMargin)]),
        (2.5, vec![]),
        (2.0, vec![(WithinMargin, Intersecting)]),
        (1.0, vec![]),
        (2.25, vec![(Intersecting, WithinMargin)]),
        (1.5, vec![(WithinMargin, Intersecting)]),
        (100.0, vec![(Intersecting, Disjoint)]),
        (0.0, vec![(Disjoint, Intersecting)]),
        (-2.5, vec![(Intersecting, WithinMargin)]),
        (-3.0, vec![(WithinMargin, Disjoint)]),
    ];
    for (x, expected) in script {
        world.set_position(second, N::on_x(x));
        assert!(step(&mut world).is_empty(), "proximity only");
        assert_eq!(transitions(&world), expected, "at {x}");
        for event in world.proximity_events() {
            assert_eq!((event.collider1, event.collider2), (first, second), "in order");
        }
    }
    assert!(world.contact_pair(first, second).is_none(), "no contacts are asked for");
}

fn contacts_start_with_the_first_point_and_stop_with_the_last<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let (a, b) = (cube(1.0), cube(1.0));
    let first = add(&mut world, 0.0, &a, contacts(0.125));
    let second = add(&mut world, 3.0, &b, contacts(0.25));
    assert_eq!(step(&mut world), [], "apart");
    world.set_position(second, N::on_x(2.375));
    assert_eq!(step(&mut world), [Started(first, second)], "the sum of the predictions counts");
    let deepest = world.contact_manifolds().next().expect("one").2.deepest_contact().copied();
    assert_eq!(deepest.expect("one").contact.depth, N::lit(-0.375), "near, not touching");
    world.set_position(second, N::on_x(1.75));
    assert_eq!(step(&mut world), [], "still in contact");
    let mut corner = [0.0; D];
    corner[1] = 2.375;
    world.set_position(second, N::at(corner));
    assert_eq!(step(&mut world), [], "other points, but never none");
    world.set_position(second, N::on_x(2.5));
    assert_eq!(step(&mut world), [Stopped(first, second)], "too far");
    assert_eq!(step(&mut world), [], "nothing changed");
}

fn one_contact_to_many_is_not_reported<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let (small, floor) = (ball(0.5), half_space(1, 1.0));
    let solid = world.add(N::at([0.0; D]), small, CollisionGroups::new(), contacts(0.0), ());
    let ground = world.add(N::at([0.0; D]), floor, CollisionGroups::new(), contacts(0.0), ());
    assert_eq!(step(&mut world), [Started(solid, ground)], "one point");
    assert_eq!(world.contact_pair(solid, ground).expect("a pair").num_contacts(), 1, "one");
    world.set_shape(solid, cube(0.5));
    assert_eq!(step(&mut world), [], "from one to many");
    let many = world.contact_pair(ground, solid).expect("in either order").num_contacts();
    assert_eq!(many, if D == 2 { 2 } else { 4 }, "a face");
}

fn removal_ends_each_pair_once<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let shape = ball(1.0);
    let first = add(&mut world, 0.0, &shape, contacts(0.0));
    let second = add(&mut world, 1.0, &shape, contacts(0.0));
    let area = add(&mut world, 0.5, &shape, near(0.0));
    let apart = add(&mut world, 1.5, &cube(0.25), contacts(0.0));
    world.set_position(apart, N::on_x(2.5));
    let started = step(&mut world);
    assert_eq!(started, [Started(first, second)], "the far one touches nobody");
    assert_eq!(transitions(&world), [(Disjoint, Intersecting); 2], "both are in the area");

    world.remove(&[second, apart]);
    let third = add(&mut world, 0.25, &shape, contacts(0.0));
    assert_eq!(third.uid(), apart.uid(), "the index is used again");
    assert_ne!(third, apart, "the handle is not");
    assert!(world.collision_object(second).is_none(), "gone at once");
    assert_eq!(world.contact_events(), started, "events are those of the last update");
    let fourth = add(&mut world, 50.0, &shape, contacts(0.0));
    let events = step(&mut world);
    assert_eq!(events, [Stopped(first, second), Started(first, third)], "the removal first");
    assert_eq!(fourth.uid(), second.uid(), "the index is used again");
    assert_eq!(
        transitions(&world),
        [(Intersecting, Disjoint), (Disjoint, Intersecting)],
        "one left, one came"
    );
    let gone = world.proximity_events()[0];
    assert_eq!((gone.collider1, gone.collider2), (second, area), "the old handle");
    assert_eq!(step(&mut world), [], "no more");
    assert!(world.proximity_events().is_empty(), "no more");
}

fn removals_of_both_ends_tell_once<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::ZERO);
    let shape = ball(1.0);
    let handles: Vec<_> =
        (0..4).map(|k| add(&mut world, f64::from(k), &shape, contacts(0.0))).collect();
    assert_eq!(step(&mut world).len(), 5, "neighbours and next but one");
    world.remove(&[handles[2], handles[0], handles[1]]);
    let events = step(&mut world);
    let stopped =
        [(0, 1), (0, 2), (1, 2), (1, 3), (2, 3)].map(|(a, b)| Stopped(handles[a], handles[b]));
    assert_eq!(events, stopped, "each once, in order");
    world.remove(&handles[3..]);
    assert_eq!(step(&mut world), [], "it touched nobody any more");
    assert!(world.is_empty(), "all gone");
}

fn what_never_touched_never_stops<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.5));
    let shape = ball(1.0);
    let first = add(&mut world, 0.0, &shape, contacts(0.0));
    let second = world.add(N::at([1.5; D]), shape, CollisionGroups::new(), contacts(0.0), ());
    assert_eq!(step(&mut world), [], "the boxes meet, the balls do not");
    assert!(world.contact_pair(first, second).is_some(), "the broad phase keeps the pair");
    world.remove(&[first]);
    assert_eq!(step(&mut world), [], "nothing had started");
    let came = add(&mut world, 1.5, &ball(1.0), contacts(0.0));
    world.remove(&[came]);
    assert_eq!(step(&mut world), [], "came and went between two updates");
}

fn changes_in_place_are_followed<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let first = add(&mut world, 0.0, &ball(1.0), contacts(0.0));
    let second = add(&mut world, 1.5, &ball(1.0), contacts(0.0));
    let both = (first, second);
    assert_eq!(step(&mut world), [Started(both.0, both.1)], "start");
    world.set_query_type(second, near(0.25));
    assert_eq!(step(&mut world), [Stopped(both.0, both.1)], "no contacts any more");
    assert_eq!(transitions(&world), [(Disjoint, Intersecting)], "but proximity");
    world.set_shape(first, ball(0.25));
    assert_eq!(step(&mut world), [], "smaller");
    assert_eq!(transitions(&world), [(Intersecting, WithinMargin)], "smaller");
    world.set_query_type(second, contacts(0.25));
    assert_eq!(step(&mut world), [Started(both.0, both.1)], "within the prediction");
    assert_eq!(transitions(&world), [(WithinMargin, Disjoint)], "no proximity any more");
    let mut groups = CollisionGroups::new();
    groups.set_blacklist(&[7]);
    world.set_collision_groups(first, groups);
    assert_eq!(step(&mut world), [Stopped(both.0, both.1)], "not allowed");
    assert!(world.contact_pair(first, second).is_none(), "no pair");
    groups.modify_blacklist(7, false);
    world.set_collision_groups(first, groups);
    world.set_position(first, N::on_x(0.125));
    assert_eq!(step(&mut world), [Started(both.0, both.1)], "allowed again, and moved");
    world.set_shape(first, ball(4.0));
    world.remove(&[second]);
    assert_eq!(step(&mut world), [Stopped(both.0, both.1)], "changed and partner removed");
}

/// Asserts that replacing a solid by one of the same kind changes its contacts, although the narrow
/// phase keeps copies of small solids.
fn another_solid_of_the_same_kind_is_seen<N: Stage<D>, const D: usize>() {
    let kinds: [fn(f64) -> ShapeHandle<N, D>; 2] = [ball, cube];
    for (kind, partner) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        let mut world = World::<N, D>::new(N::lit(0.02));
        let first = add(&mut world, 0.0, &kinds[kind](1.0), contacts(0.0));
        let second = add(&mut world, 2.5, &kinds[partner](1.0), contacts(0.0));
        let both = (first, second);
        assert_eq!(step(&mut world), [], "apart by a half");
        world.set_shape(first, kinds[kind](2.0));
        assert_eq!(step(&mut world), [Started(both.0, both.1)], "deep by a half");
        let deepest = world.contact_views().next().map(|(_, _, view)| view.deepest_contact());
        assert_eq!(deepest.map(|found| found.contact.depth), Some(N::HALF), "{kind} {partner}");
        world.set_shape(first, kinds[kind](1.0));
        assert_eq!(step(&mut world), [Stopped(both.0, both.1)], "as before");
    }
}

fn names_last_as_long_as_contacts<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let floor = half_space(1, 1.0);
    let ground = world.add(N::at([0.0; D]), floor, CollisionGroups::new(), contacts(0.0), ());
    let mut height = [0.0; D];
    height[1] = 0.875;
    let solid = world.add(N::at(height), cube(1.0), CollisionGroups::new(), contacts(0.0), ());
    step(&mut world);
    let before = ids(&world, ground, solid);
    assert_eq!(before.len(), if D == 2 { 2 } else { 4 }, "a face");
    height[0] = 0.25;
    world.set_position(solid, N::at(height));
    step(&mut world);
    assert_eq!(ids(&world, ground, solid), before, "the contacts moved");
    world.set_query_type(solid, contacts(0.5));
    world.set_shape(solid, cube(1.125));
    step(&mut world);
    assert_eq!(ids(&world, ground, solid), before, "the features stayed");
    world.set_position(solid, N::at([100.0; D]));
    assert_eq!(step(&mut world), [Stopped(ground, solid)], "away");
    world.set_position(solid, N::at(height));
    assert_eq!(step(&mut world), [Started(ground, solid)], "and back");
    let after = ids(&world, ground, solid);
    assert!(after.iter().all(|id| !before.contains(id)), "new names");
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::<N, D>::new()));
    assert_eq!(step(&mut world), [], "nothing changed");
    let replaced = ids(&world, ground, solid);
    let old = [before, after].concat();
    assert!(replaced.iter().all(|id| !old.contains(id)), "names are never given twice");
}

fn phases_are_exchanged_without_false_events<N: Stage<D>, const D: usize>() {
    for which in 0..3 {
        let mut world = World::<N, D>::new(N::lit(0.02));
        let shape = ball(1.0);
        let first = add(&mut world, 0.0, &shape, contacts(0.0));
        let second = add(&mut world, 1.5, &shape, contacts(0.0));
        let third = add(&mut world, 3.0, &shape, contacts(0.0));
        let area = add(&mut world, -1.5, &shape, near(0.5));
        assert_eq!(step(&mut world), [Started(first, second), Started(second, third)], "start");
        let replace = |world: &mut World<N, D>| {
            if which != 1 {
                world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::lit(0.5))));
            }
            if which != 0 {
                world.set_narrow_phase(Box::new(DefaultNarrowPhase::<N, D>::new()));
            }
        };
        replace(&mut world);
        let at_origin = world.interferences_with_point(&Point::origin(), &CollisionGroups::new());
        assert_eq!(at_origin.count(), 1, "queries go on");
        assert_eq!(step(&mut world), [], "nothing changed");
        assert!(world.proximity_events().is_empty(), "nothing changed");
        replace(&mut world);
        world.set_position(third, N::on_x(8.0));
        world.set_position(area, N::on_x(-1.0));
        world.remove(&[first]);
        let fourth = add(&mut world, 7.0, &shape, contacts(0.0));
        let events = step(&mut world);
        let expected = [Stopped(first, second), Started(fourth, third), Stopped(second, third)];
        assert_eq!(events, expected, "what changed since, whichever phase is new");
        let expected = [(Intersecting, Disjoint), (Disjoint, WithinMargin)];
        assert_eq!(transitions(&world), expected, "the first left the area, the second is near");
        assert_eq!(step(&mut world), [], "no more");
    }
}

fn half_spaces_overlap_without_points<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let groups = CollisionGroups::new();
    let ground = world.add(N::at([0.0; D]), half_space(1, 1.0), groups, contacts(0.0), ());
    let wall = world.add(N::on_x(-5.0), half_space(0, 1.0), groups, contacts(0.0), ());
    assert_eq!(step(&mut world), [], "they overlap without bound: no contact");
    world.set_query_type(wall, near(0.0));
    step(&mut world);
    assert_eq!(transitions(&world), [(Disjoint, Intersecting)], "but they intersect");
    let mut height = [0.0; D];
    height[1] = -0.5;
    let ceiling = world.add(N::at(height), half_space(1, -1.0), groups, contacts(0.0), ());
    assert_eq!(step(&mut world), [Started(ground, ceiling)], "antiparallel ones do touch");
}

/// The pairs that touch or are near according to the events so far, with which new events must be
/// consistent.
#[derive(Default)]
struct Ledger {
    touching: Vec<(CollisionObjectHandle, CollisionObjectHandle)>,
    near: Vec<((CollisionObjectHandle, CollisionObjectHandle), Proximity)>,
    stopped: usize,
}

impl Ledger {
    fn enter<N: Space<D>, const D: usize>(&mut self, world: &World<N, D>) {
        for event in world.contact_events() {
            let known = self.touching.iter().position(|pair| *pair == event.handles());
            match (event, known) {
                (Started(..), None) => self.touching.push(event.handles()),
                (Stopped(..), Some(place)) => drop(self.touching.swap_remove(place)),
                _ => panic!("{event:?} comes twice"),
            }
            self.stopped += usize::from(known.is_some());
        }
        for event in world.proximity_events() {
            let pair = (event.collider1, event.collider2);
            let known = self.near.iter().position(|(other, _)| *other == pair);
            let before = known.map_or(Disjoint, |place| self.near.swap_remove(place).1);
            assert_eq!(event.prev_status, before, "{event:?}");
            if event.new_status != Disjoint {
                self.near.push((pair, event.new_status));
            }
        }
    }

    fn agrees_with<N: Space<D>, const D: usize>(&mut self, world: &World<N, D>) {
        self.touching.sort_unstable();
        let mut found: Vec<_> =
            world.contact_manifolds().map(|(a, b, _)| (a.handle(), b.handle())).collect();
        found.dedup();
        assert_eq!(self.touching, found, "what touches");
    }
}

/// Clears a world partly and completely, many times. Asserts that each contact that started stops
/// once, also for objects that were removed and whose index was reused between two updates.
fn clearing_and_retaining_end_every_pair_once<N: Stage<D>, const D: usize>() {
    let (mut random, mut world) = (Random::new(3), World::<N, D>::default());
    let (mut ledger, mut handles) = (Ledger::default(), Vec::new());
    for round in 0..120 {
        for _ in 0..6 {
            let query = if random.chance(0.4) { near(0.25) } else { contacts(0.1) };
            let position = N::at(std::array::from_fn(|_| random.grid(2, 4)));
            let shape = if random.chance(0.5) { ball(0.6) } else { cube(0.4) };
            let handle = world.add(position, shape, CollisionGroups::new(), query, ());
            assert!(!handles.contains(&handle), "no handle is given twice");
            handles.push(handle);
        }
        match round % 5 {
            4 => world.clear(),
            1 | 3 => {
                let (before, mut asked) = (world.len(), Vec::new());
                world.retain(|object| {
                    asked.push(object.handle());
                    random.chance(0.5)
                });
                assert!(asked.is_sorted() && asked.len() == before, "each once, in order");
            }
            _ => {}
        }
        if random.chance(0.8) {
            step(&mut world);
            ledger.enter(&world);
            ledger.agrees_with(&world);
        }
    }
    world.clear();
    world.clear();
    assert!(world.is_empty() && !handles.iter().any(|handle| world.contains(*handle)), "empty");
    step(&mut world);
    ledger.enter(&world);
    assert!(ledger.touching.is_empty() && ledger.near.is_empty(), "all has stopped");
    assert!(ledger.stopped > 50, "and there was much: {}", ledger.stopped);
    assert_eq!(step(&mut world), [], "once");
}

in_tests! {
    clearing_and_retaining_end_every_pair_once,
    proximity_goes_through_all_transitions,
    contacts_start_with_the_first_point_and_stop_with_the_last,
    one_contact_to_many_is_not_reported,
    removal_ends_each_pair_once,
    removals_of_both_ends_tell_once,
    what_never_touched_never_stops,
    changes_in_place_are_followed,
    another_solid_of_the_same_kind_is_seen,
    names_last_as_long_as_contacts,
    phases_are_exchanged_without_false_events,
    half_spaces_overlap_without_points,
}
