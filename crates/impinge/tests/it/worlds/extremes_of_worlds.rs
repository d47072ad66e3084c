//! Tests worlds far from the origin, crowded, emptied, and refilled within one step.

use crate::support::scene_stage;
use crate::support::world_stage;

use std::collections::BTreeSet;

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Vector};
use impinge::narrow_phase::ContactEvent::{Started, Stopped};
use impinge::query::Ray;
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_scenes::{Scene, Wave, mixed_shapes};
use scene_stage::{Play, Player};
use world_stage::{Stage, add, ball, contacts, cube, near, step};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

/// Returns the scene with all positions on a grid that `f32` resolves a million units away (1/8),
/// moved by a shift on that grid: all differences of positions keep their bits.
fn shifted<const D: usize>(mut scene: Scene<D>, shift: f64) -> Scene<D> {
    let on_grid = |x: f64| (x * 8.0).round() / 8.0;
    for wave in scene.objects.iter_mut().flat_map(|object| &mut object.motion.place) {
        let at = |x: f64| on_grid(x) + shift;
        let speed = if wave.speed == 0.0 { 0.0 } else { wave.speed.signum() / 8.0 };
        *wave = Wave { low: at(wave.low), high: at(wave.high), start: at(wave.start), speed };
    }
    scene
}

/// A manifold of a step: the objects, the number of points, and the depth and the normal of the
/// deepest point.
type Seen<N, const D: usize> = ((usize, usize), usize, N, Vector<N, D>);

fn contacts_seen<N: Play<D>, const D: usize>(player: &Player<N, D>) -> Vec<Seen<N, D>> {
    let pairs = player.world.contact_manifolds().map(|(a, b, manifold)| {
        let deepest = manifold.deepest_contact().expect("not empty").contact;
        let normal = deepest.normal.into_inner();
        ((*a.data(), *b.data()), manifold.len(), deepest.depth, normal)
    });
    pairs.collect()
}

/// Asserts that a scene around the origin and the scene moved by 2^20 have contacts that are equal
/// to the bit, except for the rounding of world points.
fn far_from_the_origin<N: Play<D>, const D: usize>() {
    let shift = f64::from(1_u32 << 20);
    let mut here = Player::<N, D>::new(shifted(mixed_shapes(120), 0.0), 1.0);
    let mut there = Player::<N, D>::new(shifted(mixed_shapes(120), shift), 1.0);
    let mut all = 0;
    for step in 0..20 {
        here.step();
        there.step();
        let (near, far) = (contacts_seen(&here), contacts_seen(&there));
        assert_eq!(near, far, "step {step}");
        // Compared as text: handles of two worlds are never equal, but handles with the same index
        // have the same text.
        let events = [&here.world, &there.world]
            .map(|world| format!("{:?} {:?}", world.contact_events(), world.proximity_events()));
        assert_eq!(events[0], events[1], "step {step}");
        let both = here.world.contact_manifolds().zip(there.world.contact_manifolds());
        for ((.., a), (.., b)) in both {
            for (a, b) in a.contacts().iter().zip(b.contacts()) {
                let off = b.contact.world1 - a.contact.world1 - Vector::repeat(N::lit(shift));
                let off = off.norm().as_f64();
                assert!(off <= 4.0 * N::EPSILON.as_f64() * shift, "step {step}: {off}");
            }
        }
        all += near.len();
    }
    assert!(all > 400, "{all} contacts");
}

#[test]
fn a_million_units_away() {
    far_from_the_origin::<f32, 2>();
    far_from_the_origin::<f64, 2>();
    far_from_the_origin::<f32, 3>();
    far_from_the_origin::<f64, 3>();
}

/// Asserts that an object far away changes no event and no bit of a manifold of the other objects.
fn one_far_object<N: Stage<D>, const D: usize>() {
    let fill = |world: &mut World<N, D>| {
        for n in 0..60 {
            let shape = if n % 2 == 0 { ball(0.75) } else { cube(0.625) };
            add(world, f64::from(n), &shape, if n % 5 == 0 { near(0.1) } else { contacts(0.1) });
        }
    };
    let (mut alone, mut with) = (World::new(N::lit(0.1)), World::new(N::lit(0.1)));
    fill(&mut alone);
    fill(&mut with);
    let far = add(&mut with, 1e6, &ball(1.0), contacts(0.1));
    for round in 0..4 {
        // Compared as text: handles of two worlds are never equal, but handles with the same index
        // have the same text.
        let [alone_events, with_events] =
            [&mut alone, &mut with].map(|world| format!("{:?}", step(world)));
        assert_eq!(alone_events, with_events, "round {round}");
        let manifolds = |world: &World<N, D>| {
            let all = world.contact_manifolds();
            all.map(|(_, _, manifold)| manifold.clone()).collect::<Vec<_>>()
        };
        let (a, b) = (manifolds(&alone), manifolds(&with));
        assert!(a.len() > 20 && a == b, "to the bit");
        with.set_position(far, N::on_x([1e6, -1e9, 1e12, -1e15][round]));
    }
}

/// Adds `count` objects and removes all but three, in the first round with an update between and in
/// the second within one step. Nothing may be left of the removed objects.
fn mass_arrival<N: Stage<D>, const D: usize>(count: u32) {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let shape = ball(0.25);
    let place = |n: u32| {
        let mut at = [0.0; D];
        (at[0], at[1]) = (f64::from(n % 317), f64::from(n / 317));
        N::at(at)
    };
    let groups = CollisionGroups::new();
    for round in 0..2 {
        let handles: Vec<_> = (0..count)
            .map(|n| world.add(place(n), shape.clone(), groups, contacts(0.0), ()))
            .collect();
        assert_eq!(world.len(), handles.len(), "all are there");
        if round == 0 {
            world.update();
            assert!(world.contact_events().is_empty(), "none touches another");
        }
        let (kept, gone) = handles.split_at(3);
        world.remove(gone);
        world.update();
        assert!(world.contact_events().is_empty() && world.len() == 3, "three are left");
        world.remove(kept);
        world.update();
        assert!(world.is_empty() && world.contact_pairs().next().is_none(), "none is left");
        let everything = Aabb::unbounded();
        assert_eq!(world.interferences_with_aabb(&everything, &groups).count(), 0, "none is found");
    }
}

#[test]
fn a_hundred_thousand_come_and_go() {
    mass_arrival::<f32, 2>(100_000);
    mass_arrival::<f64, 3>(100_000);
}

/// Asserts that an object added and removed between two updates causes no events.
fn between_two_updates<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let shape = ball(1.0);
    let rest = add(&mut world, 0.0, &shape, contacts(0.0));
    let brief = add(&mut world, 0.5, &shape, contacts(0.0));
    world.set_position(brief, N::on_x(0.25));
    world.set_shape(brief, cube(2.0));
    world.set_query_type(brief, near(0.5));
    world.remove(&[brief]);
    assert_eq!(step(&mut world), [], "nothing happened");
    assert!(world.proximity_events().is_empty(), "nothing happened");
    // The index is reused several times within one step.
    let mut last = add(&mut world, 0.5, &shape, contacts(0.0));
    for _ in 0..5 {
        world.remove(&[last]);
        last = add(&mut world, 0.5, &shape, contacts(0.0));
        assert_eq!(last.uid(), brief.uid(), "used again");
    }
    assert_eq!(step(&mut world), [Started(rest, last)], "the last one only");
    world.remove(&[last, rest]);
    assert_eq!(step(&mut world), [Stopped(rest, last)], "gone");
    assert!(world.is_empty(), "empty");
}

/// Removes an object in contact and adds an object that takes its index in the same step. Asserts
/// that the old pair stops first and that the new pair then starts with new contact ids.
fn removal_and_reuse_at_once<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let floor = add(&mut world, 0.0, &cube(1.0), contacts(0.0));
    let area = add(&mut world, 1.0, &cube(1.0), near(0.0));
    let mut current = add(&mut world, 1.5, &cube(1.0), contacts(0.0));
    step(&mut world);
    let mut names = BTreeSet::new();
    for round in 0..30 {
        for (_, _, manifold) in world.contact_manifolds() {
            for tracked in manifold.contacts() {
                assert!(names.insert(tracked.id), "{:?} is given twice", tracked.id);
            }
        }
        world.remove(&[current]);
        let old = current;
        let shape = if round % 2 == 0 { ball(1.0) } else { cube(1.0) };
        current = add(&mut world, 1.5, &shape, contacts(0.0));
        assert_eq!(current.uid(), old.uid(), "the same index");
        assert!(world.contact_pair(floor, current).is_none(), "no contacts before the update");
        let events = step(&mut world);
        assert_eq!(events, [Stopped(floor, old), Started(floor, current)], "round {round}");
        assert_eq!(world.proximity_events().len(), 2, "out and in, round {round}");
        let others = world.proximity_events().iter().map(|event| event.collider2);
        assert_eq!(others.collect::<Vec<_>>(), [old, current], "of the old and the new one");
    }
    assert!(names.len() >= 30, "{}", names.len());
    assert!(world.contains(area), "still there");
}

/// Asserts that queries and updates of a world without objects find and report nothing, before its
/// first object and after the removal of all objects.
fn empty_worlds<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::ZERO);
    for round in 0..3 {
        let all = CollisionGroups::new();
        let origin = Point::<N, D>::origin();
        let ray = Ray::new(origin, Vector::<N, D>::repeat(N::ONE));
        assert_eq!(world.interferences_with_ray(&ray, &all).count(), 0, "round {round}");
        assert!(world.first_interference_with_ray(&ray, &all).is_none(), "round {round}");
        assert_eq!(world.interferences_with_point(&origin, &all).count(), 0, "round {round}");
        let tiny = Aabb::new(origin, origin);
        assert_eq!(world.interferences_with_aabb(&tiny, &all).count(), 0, "round {round}");
        world.remove(&[]);
        world.set_positions(&[]);
        step(&mut world);
        assert_eq!(world.contact_manifolds().count(), 0, "round {round}");
        let handles: Vec<_> =
            (0..200).map(|_| add(&mut world, 0.0, &ball(1.0), near(0.0))).collect();
        if round == 1 {
            step(&mut world);
        }
        world.remove(&handles);
        world.update();
    }
    assert!(world.proximity_events().is_empty(), "all is over");
}

in_tests! {
    one_far_object, between_two_updates, removal_and_reuse_at_once, empty_worlds,
}
