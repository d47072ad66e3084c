//! Tests the methods for authors of engines, one scenario each.

use crate::support::world_stage;

use std::rc::Rc;

use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::Space;
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, DefaultNarrowPhase};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld, QueryFilter, WorldError};
use world_stage::{Stage, add, ball, contacts, cube, half_space, near, step};

use ContactEvent::{Started, Stopped};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

/// Returns the objects that have a pair with the object `handle`.
fn partners<N: Space<D>, const D: usize>(
    world: &World<N, D>,
    handle: CollisionObjectHandle,
) -> Vec<CollisionObjectHandle> {
    world.pairs_with(handle).map(CollisionObject::handle).collect()
}

fn fixed_objects_have_no_pairs_among_each_other<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.125));
    let [floor, wall] = [half_space(0, -1.0), cube(1.0)];
    let walls = [0.0, 1.5].map(|x| add(&mut world, x, &wall, contacts(0.0)));
    let area = add(&mut world, 0.5, &wall, near(0.0));
    let floor = add(&mut world, 1.0, &floor, contacts(0.0));
    for handle in [walls[0], walls[1], area, floor] {
        world.set_fixed(handle, true);
    }
    assert_eq!(step(&mut world), [], "all are fixed");
    assert!(world.proximity_events().is_empty(), "areas, too");
    assert_eq!(world.contact_pairs().count() + world.proximity_pairs().count(), 0, "no pair");

    let moving = add(&mut world, 0.75, &ball(0.5), contacts(0.0));
    let expected = [Started(walls[0], moving), Started(walls[1], moving), Started(floor, moving)];
    assert_eq!(step(&mut world), expected, "what moves meets what is fixed");
    assert_eq!(partners(&world, moving), [walls[0], walls[1], area, floor], "all of them");

    world.set_fixed(walls[0], false);
    assert_eq!(partners(&world, walls[0]), [moving], "not before the update");
    assert!(!world.collision_object(walls[0]).expect("alive").is_fixed(), "told at once");
    let expected = [Started(walls[0], walls[1]), Started(walls[0], floor)];
    assert_eq!(step(&mut world), expected, "it moves, the others do not");
    assert_eq!(world.proximity_events().len(), 1, "it is in the area");

    world.set_fixed(moving, true);
    world.set_fixed(walls[1], true);
    let expected = [Stopped(walls[1], moving), Stopped(floor, moving)];
    assert_eq!(step(&mut world), expected, "the pair with the one that moves stays");
    world.set_position(walls[1], N::on_x(1.25));
    assert_eq!(step(&mut world), [], "what is fixed may be placed elsewhere");
    assert_eq!(partners(&world, walls[1]), [walls[0]], "and still meets nobody new");
    let pairs = world.contact_pairs().count() + world.proximity_pairs().count();
    assert_eq!(pairs, 4, "walls[0] with all");
}

fn queries_and_phases_do_not_mind_fixed_objects<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.125));
    let fixed = [0.0, 0.5].map(|x| add(&mut world, x, &ball(1.0), contacts(0.0)));
    fixed.iter().for_each(|&handle| world.set_fixed(handle, true));
    let found = |world: &World<N, D>| {
        let shape = ball::<N, D>(0.25);
        let filter = QueryFilter::new();
        world.objects_overlapping(&N::on_x(0.25), shape.as_ref(), &filter).count()
    };
    assert_eq!(found(&world), 2, "before an update");
    assert_eq!(step(&mut world), [], "fixed");
    assert_eq!(found(&world), 2, "after it");
    world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::ONE)));
    assert_eq!(step(&mut world), [], "a new broad phase");
    world.set_narrow_phase(Box::new(DefaultNarrowPhase::<N, D>::new()));
    assert_eq!(step(&mut world), [], "a new narrow phase");
    // A new object that reuses the index of a fixed object is not fixed.
    world.remove(&[fixed[1]]);
    let other = add(&mut world, 0.5, &ball(1.0), contacts(0.0));
    assert_eq!(other.uid(), fixed[1].uid(), "the index is used again");
    assert_eq!(step(&mut world), [Started(fixed[0], other)], "a new object is not fixed");
    assert_eq!(
        world.try_set_fixed(fixed[1], true),
        Err(WorldError::StaleHandle(fixed[1])),
        "stale"
    );
    assert!(format!("{:?}", world.collision_object(fixed[0])).contains("is_fixed: true"), "shown");
}

fn an_object_is_in_its_pairs_whether_they_touch_or_not<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.25));
    let first = add(&mut world, 0.0, &ball(1.0), contacts(0.0));
    let touching = add(&mut world, 1.5, &ball(1.0), contacts(0.0));
    let area = add(&mut world, -2.25, &ball(1.0), near(0.0));
    let far = add(&mut world, 9.0, &ball(1.0), contacts(0.0));
    assert_eq!(partners(&world, first), [], "before the first update");
    step(&mut world);
    assert_eq!(partners(&world, first), [touching, area], "in order, with the area that is near");
    assert_eq!(partners(&world, touching), [first], "seen from the other side");
    assert_eq!(partners(&world, far), [], "alone");
    world.remove(&[touching]);
    assert_eq!(partners(&world, first), [area], "what is removed is gone at once");
    assert_eq!(partners(&world, touching), [], "a stale handle");

    let mut groups = CollisionGroups::new();
    groups.enable_self_collision();
    world.set_collision_groups(first, groups);
    step(&mut world);
    assert_eq!(partners(&world, first), [area], "a convex solid is not tested against itself");
}

fn a_prediction_pairs_what_may_meet_on_the_way<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let bullets = [-8.0, 8.0].map(|x| add(&mut world, x, &ball(0.125), contacts(0.0)));
    let [left, right] = bullets;
    let away = cube::<N, D>(0.5);
    let other = world.add(N::at([3.0; D]), away, CollisionGroups::new(), contacts(0.0), ());
    step(&mut world);
    assert_eq!(world.contact_pairs().count(), 0, "far from each other");
    for (bullet, x) in [(left, -8.0), (right, 8.0)] {
        world.set_position_with_prediction(bullet, N::on_x(x), N::on_x(-x));
    }
    assert_eq!(partners(&world, left), [], "not before the update");
    assert_eq!(step(&mut world), [], "no contact");
    assert_eq!(partners(&world, left), [right], "what is not on the way has no pair");

    // Queries find an object at its position, and ignore its predicted position.
    let shape = ball::<N, D>(1.0);
    let filter = QueryFilter::new();
    let hit = |world: &World<N, D>, x| {
        world.objects_overlapping(&N::on_x(x), shape.as_ref(), &filter).count()
    };
    assert_eq!([hit(&world, 0.0), hit(&world, -8.0)], [0, 1], "where it is");
    let found = world.nearest_objects(&N::on_x(-4.0), shape.as_ref(), 1, N::lit(9.0), &filter);
    assert_eq!((found[0].object.handle(), found[0].distance), (left, N::lit(2.875)), "from there");

    step(&mut world);
    world.set_query_type(left, contacts(0.25));
    step(&mut world);
    world.set_shape(left, ball(0.25));
    step(&mut world);
    world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::ZERO)));
    step(&mut world);
    assert_eq!(partners(&world, left), [right], "whatever else changes, the prediction holds");
    assert_eq!(world.predicted_position(left), Some(&N::on_x(8.0)), "as it was given");

    // Both move out of their predicted boxes, which shrink at the update.
    for (bullet, x) in [(left, -9.0), (right, 9.0)] {
        world.set_position(bullet, N::on_x(x));
        assert_eq!(world.predicted_position(bullet), None, "the prediction is over");
    }
    assert_eq!(partners(&world, left), [right], "not before the update");
    step(&mut world);
    assert_eq!(partners(&world, left), [], "no pair without it");

    world.set_position_with_prediction(left, N::on_x(9.0), N::on_x(10.0));
    assert_eq!(step(&mut world), [Started(left, right)], "contacts are those of the position");
    world.remove(&[left]);
    let next = add(&mut world, -8.0, &ball(0.125), contacts(0.0));
    assert_eq!(next.uid(), left.uid(), "the index is used again");
    step(&mut world);
    assert_eq!(partners(&world, next), [], "without the prediction");
    assert_eq!(
        (world.predicted_position(next), world.predicted_position(left)),
        (None, None),
        "none"
    );
    assert_eq!(partners(&world, other), [], "nobody came near");
}

fn bad_predictions_are_refused<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let [one, gone] = [0.0, 1.0].map(|x| add(&mut world, x, &ball(1.0), contacts(0.0)));
    world.remove(&[gone]);
    for wrong in [f64::NAN, f64::INFINITY] {
        let wrong = N::on_x(wrong);
        for (position, predicted) in [(wrong, N::on_x(1.0)), (N::on_x(1.0), wrong)] {
            let refused = world.try_set_position_with_prediction(one, position, predicted);
            let names =
                |error| matches!(error, WorldError::Position { handle, .. } if handle == Some(one));
            assert!(refused.is_err_and(names), "not finite");
            assert_eq!(world.predicted_position(one), None, "unchanged");
        }
    }
    assert_eq!(world.collision_object(one).expect("alive").position(), &N::on_x(0.0), "unchanged");
    let stale = Err(WorldError::StaleHandle(gone));
    let at = N::on_x(0.0);
    assert_eq!(world.try_set_position_with_prediction(gone, at, at), stale, "stale");
}

fn a_lent_filter_decides_with_what_it_borrows<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let [a, b, c] = [0.0, 0.5, 1.0].map(|x| add(&mut world, x, &ball(1.0), contacts(0.0)));
    let mut asked = Vec::new();
    world.update_with(&mut |one, two| {
        asked.push((one.handle(), two.handle()));
        two.handle() != c
    });
    assert_eq!(asked, [(a, b), (a, c), (b, c)], "each pair once, in order");
    assert_eq!(world.contact_events(), [Started(a, b)], "the others were refused");

    asked.clear();
    world.set_position(c, N::on_x(0.75));
    world.update_with(&mut |one, two| {
        asked.push((one.handle(), two.handle()));
        true
    });
    assert_eq!(asked, [], "neither pairs that stand nor refused ones are asked about again");
    world.update();
    assert_eq!(world.contact_pairs().count(), 1, "nor by an update without it");

    world.refilter_pairs_of(c);
    world.update_with(&mut |one, two| {
        asked.push((one.handle(), two.handle()));
        one.handle() != a
    });
    assert_eq!(asked, [(a, c), (b, c)], "the pairs of one object");
    assert_eq!(world.contact_events(), [Started(b, c)], "one of them");
    world.refilter_pairs();
    world.update_with(&mut |one, _| one.handle() == a);
    assert_eq!(world.contact_events(), [Started(a, c), Stopped(b, c)], "all pairs anew");

    // Groups and fixed marks are tested before the filter, and pairs of removed objects are not
    // filtered.
    asked.clear();
    world.set_fixed(a, true);
    world.set_fixed(b, true);
    world.set_collision_groups(c, CollisionGroups::empty());
    world.update_with(&mut |one, two| {
        asked.push((one.handle(), two.handle()));
        true
    });
    assert_eq!(asked, [], "none is left to be asked about");
    assert_eq!(world.contact_events(), [Stopped(a, b), Stopped(a, c)], "all are forbidden");
    world.remove(&[c]);
    assert_eq!(world.try_refilter_pairs_of(c), Err(WorldError::StaleHandle(c)), "stale");
}

#[test]
fn a_lent_filter_that_panics_is_asked_again() {
    let mut world = World::<f32, 2>::new(0.02);
    let [a, b] = [0.0, 0.5].map(|x| add(&mut world, x, &ball(1.0), contacts(0.0)));
    update_that_panics(&mut world);
    assert_eq!(step(&mut world), [Started(a, b)], "as if nothing had been asked");
}

/// Updates with a filter that panics at its first call.
fn update_that_panics<N: Stage<D>, const D: usize>(world: &mut World<N, D>) {
    let update = || world.update_with(&mut |_, _| panic!("of the user's own"));
    let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(update));
    assert!(outcome.is_err(), "the panic goes through");
}

fn a_panic_of_a_filter_loses_nothing<N: Stage<D>, const D: usize>() {
    for (new_broad, new_narrow) in [(false, false), (true, false), (false, true), (true, true)] {
        let mut world = World::<N, D>::new(N::lit(0.02));
        let add = |world: &mut _, x| add(world, x, &ball(1.0), contacts(0.0));
        let [a, b, c, d, e] = [0.0, 1.5, 10.0, 20.0, 20.5].map(|x| add(&mut world, x));
        assert_eq!(step(&mut world), [Started(a, b), Started(d, e)], "two pairs of five objects");
        let ids = |world: &World<N, D>| -> Vec<_> {
            world.contact_manifolds().map(|(_, _, manifold)| manifold.contacts()[0].id).collect()
        };
        let before = ids(&world);
        world.remove(&[e]);
        world.set_position(c, N::on_x(-1.5));
        if new_broad {
            world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::lit(0.02))));
        }
        if new_narrow {
            world.set_narrow_phase(Box::new(DefaultNarrowPhase::new()));
        }
        update_that_panics(&mut world);
        let stopped = world.contact_events().to_vec();
        let started = step(&mut world);
        if new_narrow {
            assert_eq!(
                stopped,
                [Stopped(d, e), Stopped(a, b)],
                "the new phase begins without pairs"
            );
            assert_eq!(started, [Started(a, b), Started(a, c)], "filtered again");
        } else {
            assert_eq!(stopped, [Stopped(d, e)], "the event of the removal");
            assert_eq!(started, [Started(a, c)], "filtered again");
            assert_eq!(ids(&world)[0], before[0], "the pair stayed, with its contact");
        }
        world.validate().expect("a world as any other");
        // The end of a pair needs no filter; two that meet do.
        world.set_position(b, N::on_x(20.5));
        update_that_panics(&mut world);
        assert_eq!(world.contact_events(), [Stopped(a, b)], "parted");
        assert_eq!(step(&mut world), [Started(b, d)], "met");
    }
}

fn events_of_two_updates_are_kept_in_their_order<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let [a, b, c] = [0.0, 1.5, 3.0].map(|x| add(&mut world, x, &ball(1.0), contacts(0.0)));
    let area = add(&mut world, 20.0, &ball(1.0), near(0.0));
    let first = step(&mut world);
    assert_eq!(first, [Started(a, b), Started(b, c)], "a chain");
    world.set_position(a, N::on_x(20.0));
    world.remove(&[c]);
    world.keep_events();
    assert_eq!(world.contact_events(), first, "nothing happens at once");
    world.update();
    let second = world.contact_events().to_vec();
    let expected = [Started(a, b), Started(b, c), Stopped(b, c), Stopped(a, b)];
    assert_eq!(second, expected, "two batches, the removal first in its own");
    world.set_position(a, N::on_x(0.0));
    world.keep_events();
    world.keep_events();
    world.update();
    assert_eq!(world.contact_events().len(), 5, "a third one");
    assert_eq!(world.contact_events()[4], Started(a, b), "at the end");
    assert_eq!(world.proximity_events().len(), 2, "into the area and out of it");
    assert!(world.proximity_events().iter().all(|event| event.collider2 == area), "in order");
    assert_eq!(step(&mut world), [], "that was for one update");
    assert!(world.proximity_events().is_empty(), "of all events");
}

/// A world whose data are counted references, so that a test can see when the world drops them.
type Counted<N, const D: usize> = CollisionWorld<N, D, Rc<u8>>;

fn removed_objects_stay_beside_their_events<N: Stage<D>, const D: usize>() {
    let mut world = Counted::<N, D>::new(N::lit(0.02));
    let counter = Rc::new(7);
    let add = |world: &mut Counted<N, D>, x| {
        let (shape, groups) = (ball(1.0), CollisionGroups::new());
        world.add(N::on_x(x), shape, groups, contacts(0.0), Rc::clone(&counter))
    };
    let [a, b, c, far] = [0.0, 1.5, 3.0, 50.0].map(|x| add(&mut world, x));
    world.update();
    world.remove(&[b, far]);
    let kept = |world: &Counted<N, D>, handle| world.removed_object(handle).is_some();
    assert!(kept(&world, b) && !kept(&world, far), "events name b alone");
    assert_eq!(Rc::strong_count(&counter), 4, "far was dropped at once");
    world.remove(&[c]);
    assert!(kept(&world, c), "the removal of b has queued an event that names c");

    world.update();
    assert_eq!(world.contact_events(), [Stopped(a, b), Stopped(b, c)], "the events");
    let object = world.removed_object(b).expect("beside them");
    assert_eq!(
        (object.handle(), object.position(), **object.data()),
        (b, &N::on_x(1.5), 7),
        "as it was"
    );
    assert!(world.collision_object(b).is_none() && !world.contains(b), "but not in the world");
    assert!(!kept(&world, a), "a is there");
    assert_eq!(world.take_removed(c).as_deref(), Some(&7), "taken");
    assert_eq!(world.take_removed(c), None, "once");
    world.keep_events();
    world.update();
    assert!(kept(&world, b), "its events were kept");
    world.update();
    assert!(!kept(&world, b), "no event names it any more");
    assert_eq!(Rc::strong_count(&counter), 2, "and its data are gone");

    // An object is removed while the events of the last update are read, some of which refer to it.
    world.set_position(a, N::on_x(9.0));
    let d = add(&mut world, 9.0);
    world.update();
    world.set_position(d, N::on_x(0.0));
    world.update();
    let handles = (a.min(d), a.max(d));
    assert_eq!(world.contact_events(), [Stopped(handles.0, handles.1)], "they parted");
    world.remove(&[d]);
    assert!(kept(&world, d), "the last event names it");
    let e = add(&mut world, 9.0);
    assert_eq!(e.uid(), d.uid(), "the index is used again");
    assert!(kept(&world, d) && !kept(&world, e), "the handle is not");
    world.remove(&[e]);
    assert!(!kept(&world, e), "no update has seen it");
    world.update();
    assert!(!kept(&world, d), "forgotten with the event");
    world.clear();
    drop(world);
    assert_eq!(Rc::strong_count(&counter), 1, "all is gone with the world");
}

in_tests! {
    fixed_objects_have_no_pairs_among_each_other,
    queries_and_phases_do_not_mind_fixed_objects,
    an_object_is_in_its_pairs_whether_they_touch_or_not,
    a_prediction_pairs_what_may_meet_on_the_way,
    bad_predictions_are_refused,
    a_lent_filter_decides_with_what_it_borrows,
    a_panic_of_a_filter_loses_nothing,
    events_of_two_updates_are_kept_in_their_order,
    removed_objects_stay_beside_their_events,
}
