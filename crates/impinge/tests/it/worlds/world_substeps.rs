//! Tests that a pair computed between updates has the result of an update, and that contacts with
//! skins equal those of shapes rounded by the same radii.

use crate::support::world_stage;

use std::fmt::Debug;

use impinge::math::na::{Isometry, Rotation, Translation};
use impinge::math::{Real, Space};
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent, DefaultNarrowPhase};
use impinge::query::{ContactPoint, ManifoldView, Proximity, TrackedContact};
use impinge::shape::{Capsule, Compound, Rounded, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld, WorldError};
use impinge_reference::random::Random;
use world_stage::{Stage, add, ball, contacts, cube, half_space, near, step};

use ContactEvent::{Started, Stopped};

type World<N, const D: usize> = CollisionWorld<N, D, ()>;

/// Returns a compound of two cubes of half width 1, with a gap of 1 between them.
fn table<N: Stage<D>, const D: usize>() -> ShapeHandle<N, D> {
    let legs = [-1.5, 1.5].map(|x| (N::on_x(x), cube(1.0)));
    ShapeHandle::new(Compound::new(legs.to_vec()))
}

fn capsule<N: Real, const D: usize>() -> ShapeHandle<N, D> {
    ShapeHandle::new(Capsule::<N, D>::new(N::ONE, N::HALF))
}

/// Returns a ball, a box, a capsule and a compound.
fn shapes<N: Stage<D>, const D: usize>() -> [ShapeHandle<N, D>; 4] {
    [ball(1.0), cube(1.0), capsule(), table()]
}

/// Returns the pose at height `y`, moved sideways by `x`.
fn above<N: Stage<D>, const D: usize>(x: f64, y: f64) -> N::Isometry {
    let mut coordinates = [0.0; D];
    (coordinates[0], coordinates[1]) = (x, y);
    N::at(coordinates)
}

/// Returns all contact points of a pair.
fn points<N: Space<D>, const D: usize>(
    world: &World<N, D>,
    one: CollisionObjectHandle,
    two: CollisionObjectHandle,
) -> Vec<ContactPoint<N, D>> {
    let pair = world.contact_pair(one, two).expect("a pair");
    pair.views().flat_map(ManifoldView::contacts).collect()
}

/// Asserts that every way of reading a pair gives the points of its views.
fn check_readers<N: Space<D>, const D: usize>(
    world: &World<N, D>,
    one: CollisionObjectHandle,
    two: CollisionObjectHandle,
) {
    let all = points(world, one, two);
    let is_pair = |a: CollisionObjectHandle, b| (a, b) == (one.min(two), one.max(two));
    let in_views = world.contact_views().filter(|(a, b, _)| is_pair(a.handle(), b.handle()));
    let read: Vec<_> = in_views.flat_map(|(_, _, view)| view.contacts()).collect();
    assert_eq!(read, all, "views of all pairs");
    let pieces = world.contact_view_pieces(3).into_iter().flatten();
    let in_pieces = pieces.filter(|(a, b, _)| is_pair(a.handle(), b.handle()));
    let read: Vec<_> = in_pieces.flat_map(|(_, _, view)| view.contacts()).collect();
    assert_eq!(read, all, "pieces of views");
    let made = world.contact_manifolds().filter(|(a, b, _)| is_pair(a.handle(), b.handle()));
    let made: Vec<_> = made.flat_map(|(_, _, manifold)| manifold.contacts()).collect();
    let of_views: Vec<_> = world.contact_pair(one, two).expect("a pair").views().collect();
    let tracked: Vec<TrackedContact<N, D>> = of_views
        .iter()
        .flat_map(|view| (0..view.len()).map(|index| view.tracked_contact(index)))
        .collect();
    assert_eq!(made, tracked.iter().collect::<Vec<_>>(), "manifolds");
    for (point, tracked) in all.iter().zip(&tracked) {
        assert_eq!((point.contact, point.id), (tracked.contact, tracked.id), "the same contact");
    }
    let seen: Vec<_> =
        world.contacts_with(two).filter(|(other, _)| other.handle() == one).collect();
    let seen = seen.into_iter().map(|(_, point)| if two < one { point } else { point.flipped() });
    assert_eq!(seen.collect::<Vec<_>>(), all, "seen from the second");
}

/// Asserts that a pair computed between updates has the contacts that an update would give it, and
/// that the contacts of other pairs are unchanged.
fn a_pair_is_computed_as_an_update_would<N: Stage<D>, const D: usize>() {
    for reuses in [false, true] {
        for (index, shape) in shapes::<N, D>().into_iter().enumerate() {
            check_substep(&shape, reuses, &(index, reuses));
        }
    }
}

fn check_substep<N: Stage<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    reuses: bool,
    name: &impl Debug,
) {
    let mut worlds = [0, 1].map(|_| World::<N, D>::new(N::lit(0.125)));
    let [substeps, updates] = &mut worlds;
    let fill = |world: &mut World<N, D>| {
        if reuses {
            let narrow_phase = DefaultNarrowPhase::<N, D>::new().reusing(N::lit(0.001));
            world.set_narrow_phase(Box::new(narrow_phase));
        }
        let [floor, wall] = [table(), cube(1.0)];
        let floor = add(world, 0.0, &floor, contacts(0.125));
        let wall = add(world, 3.5, &wall, contacts(0.125));
        let moving = world.add(above::<N, D>(1.5, 1.75), shape.clone(), all(), contacts(0.125), ());
        step(world);
        [floor, wall, moving]
    };
    let [floor, wall, moving] = fill(substeps);
    let twins = fill(updates);
    let ids = |points: &[ContactPoint<N, D>]| points.iter().map(|p| p.id).collect::<Vec<_>>();
    let geometry = |points: &[ContactPoint<N, D>]| {
        points.iter().map(|p| (p.contact, p.feature1, p.feature2, p.part2)).collect::<Vec<_>>()
    };
    let before = points(substeps, floor, moving);
    assert!(!before.is_empty(), "{name:?} stands on the floor");
    let others = points(substeps, wall, moving);
    for (x, y) in [(1.5, 1.8125), (1.375, 1.75), (1.25, 1.8125)] {
        substeps.set_position(moving, above::<N, D>(x, y));
        assert_eq!(points(substeps, floor, moving), before, "{name:?}: not by itself");
        break_off(substeps, moving, [floor, wall], (x, y));
        updates.set_position(twins[2], above::<N, D>(x, y));
        step(updates);
        let (now, expected) =
            (points(substeps, floor, moving), points(updates, twins[0], twins[2]));
        assert_eq!(geometry(&now), geometry(&expected), "{name:?} at {x} {y}");
        assert_eq!(points(substeps, wall, moving), others, "{name:?}: other pairs stay");
        check_readers(substeps, floor, moving);
        check_readers(substeps, wall, moving);
        assert!(ids(&now).iter().all(|id| ids(&before).contains(id)) || D == 3, "{name:?}: ids");
        substeps.set_position(moving, above::<N, D>(1.5, 1.75));
        assert!(substeps.update_pair(floor, moving), "kept");
        assert_eq!(geometry(&points(substeps, floor, moving)), geometry(&before), "{name:?}: back");
        updates.set_position(twins[2], above::<N, D>(1.5, 1.75));
        step(updates);
    }
    step(substeps);
    check_readers(substeps, floor, moving);
    assert_eq!(substeps.contact_events(), [], "{name:?}: it touched all along");
}

/// Computes the pair of `moving` and the first of two objects twice, with the handles in both
/// orders. Asserts that the second call changes no contact.
fn break_off<N: Stage<D>, const D: usize>(
    world: &mut World<N, D>,
    moving: CollisionObjectHandle,
    [floor, _]: [CollisionObjectHandle; 2],
    (x, y): (f64, f64),
) {
    assert!(world.update_pair(moving, floor), "kept");
    let once = points(world, floor, moving);
    assert!(world.update_pair(floor, moving), "whichever is named first");
    assert_eq!(points(world, floor, moving), once, "nothing moved since, at {x} {y}");
}

fn all() -> CollisionGroups {
    CollisionGroups::new()
}

fn transitions_in_substeps_are_told_once<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let post = add(&mut world, 0.0, &ball(1.0), contacts(0.0));
    let area = add(&mut world, 0.0, &cube(1.0), near(0.0));
    let fast = add(&mut world, -8.0, &ball(1.0), contacts(0.0));
    world.set_position_with_prediction(fast, N::on_x(-8.0), N::on_x(8.0));
    assert_eq!(step(&mut world), [], "apart");
    let go = |world: &mut World<N, D>, x| {
        world.set_position(fast, N::on_x(x));
        assert!(world.update_pair(fast, post) && world.update_pair(area, fast), "kept");
        assert_eq!(world.contact_events(), [], "events are those of the last update");
        let touches = world.contact_pair(fast, post).expect("a pair").num_contacts() > 0;
        (touches, world.proximity_pair(fast, area).expect("a pair").proximity())
    };
    assert_eq!(go(&mut world, -1.5), (true, Proximity::Intersecting), "it hits");
    assert_eq!(go(&mut world, -4.0), (false, Proximity::Disjoint), "it bounces");
    assert_eq!(go(&mut world, 1.0), (true, Proximity::Intersecting), "and hits again");
    let told = [Started(post, fast), Stopped(post, fast), Started(post, fast)];
    assert_eq!(step(&mut world), told, "in the order in which it happened");
    assert_eq!(world.proximity_events().len(), 3, "of the area, too");
    assert_eq!(step(&mut world), [], "once");

    // A removal ends the pair that a substep began; a pair that a substep ended does not end again.
    world.set_position(fast, N::on_x(2.5));
    assert!(world.update_pair(post, fast), "kept");
    world.set_position(fast, N::on_x(1.0));
    assert!(world.update_pair(post, fast), "kept");
    world.remove(&[fast]);
    let told = [Stopped(post, fast), Started(post, fast), Stopped(post, fast)];
    world.update();
    assert_eq!(world.contact_events(), told, "all of it");
    assert!(world.removed_object(fast).is_some(), "the events name it");
}

fn pairs_that_are_not_kept_are_left_alone<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let [a, b, far] = [0.0, 1.5, 50.0].map(|x| add(&mut world, x, &ball(1.0), contacts(0.0)));
    assert!(!world.update_pair(a, b), "before the first update");
    step(&mut world);
    assert!(!world.update_pair(a, far) && !world.update_pair(a, a), "no pair");
    world.set_position(far, N::on_x(0.5));
    assert!(!world.update_pair(a, far), "the broad phase has not been asked");
    let new = add(&mut world, 0.0, &ball(1.0), contacts(0.0));
    assert!(!world.update_pair(new, a), "no update has seen it");
    world.remove(&[b]);
    for (one, two) in [(a, b), (b, a), (b, b)] {
        assert_eq!(world.try_update_pair(one, two), Err(WorldError::StaleHandle(b)), "stale");
    }
    let told = [Stopped(a, b), Started(a, far), Started(a, new), Started(far, new)];
    assert_eq!(step(&mut world), told, "as without");
}

fn an_object_with_itself_is_a_pair<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let children = [0.0, 1.5].map(|x| (N::on_x(x), ball(1.0)));
    let knot = ShapeHandle::new(Compound::new(children.to_vec()));
    let mut groups = CollisionGroups::new();
    groups.enable_self_collision();
    let knot = world.add(N::on_x(0.0), knot, groups, contacts(0.0), ());
    assert_eq!(step(&mut world), [Started(knot, knot)], "its parts overlap");
    let before = points(&world, knot, knot);
    world.set_position(knot, N::on_x(4.0));
    assert!(world.update_pair(knot, knot), "kept");
    let after = points(&world, knot, knot);
    assert_eq!(after[0].contact.world1[0], before[0].contact.world1[0] + N::lit(4.0), "moved");
    assert_eq!(after[0].id, before[0].id, "the same contact");
    assert_eq!(step(&mut world), [], "it touched all along");
    assert_eq!(points(&world, knot, knot), after, "as the update has it");
}

/// Returns a world of two shapes, the first at the origin and the second at a pose, and their
/// handles.
fn two<N: Stage<D>, const D: usize>(
    shapes: [&ShapeHandle<N, D>; 2],
    at: N::Isometry,
    query: [f64; 2],
) -> (World<N, D>, [CollisionObjectHandle; 2]) {
    let mut world = World::<N, D>::new(N::lit(0.125));
    let one = world.add(N::on_x(0.0), shapes[0].clone(), all(), contacts(query[0]), ());
    let other = world.add(at, shapes[1].clone(), all(), contacts(query[1]), ());
    (world, [one, other])
}

/// Asserts that the deepest contact of shapes with skins equals, up to rounding, the deepest
/// contact of shapes rounded by the same radii.
fn skins_round_shapes<N: Stage<D>, const D: usize>() {
    let (skins, slack) = ([0.25, 0.125], N::lit(64.0) * N::EPSILON);
    let rounded = |shape: &ShapeHandle<N, D>, radius: f64| -> ShapeHandle<N, D> {
        let rounded = Rounded::try_from_handle(shape.clone(), N::lit(radius));
        ShapeHandle::new(rounded.expect("it is bounded and convex"))
    };
    let solids: [ShapeHandle<N, D>; 3] = [ball(1.0), cube(1.0), capsule()];
    let (mut touching, mut all_pairs) = (0, 0);
    for (x, y) in [(0.0, 2.0), (0.5, 2.25), (0.25, 2.375), (0.25, 2.5), (0.5, 3.0), (1.5, 2.125)] {
        for [first, second] in solids.iter().flat_map(|a| solids.iter().map(move |b| [a, b])) {
            let (mut world, [one, other]) = two([first, second], above::<N, D>(x, y), [0.0; 2]);
            world.set_skin(one, N::lit(skins[0]));
            world.set_skin(other, N::lit(skins[1]));
            step(&mut world);
            check_readers_of_pair(&world, one, other);
            let grown = [rounded(first, skins[0]), rounded(second, skins[1])];
            let (mut expected, names) = two([&grown[0], &grown[1]], above::<N, D>(x, y), [0.0; 2]);
            step(&mut expected);
            let found = deepest(&world, one, other);
            let wanted = deepest(&expected, names[0], names[1]);
            all_pairs += 1;
            assert_eq!(found.is_some(), wanted.is_some(), "{first:?} {second:?} {x} {y}");
            let (Some(found), Some(wanted)) = (found, wanted) else { continue };
            touching += 1;
            let contact = (found.contact, wanted.contact);
            assert!((contact.0.depth - contact.1.depth).abs() <= slack, "{contact:?}");
            assert!((*contact.0.normal - *contact.1.normal).norm() <= slack, "{contact:?}");
            let apart = contact.0.world2 - (contact.0.world1 - *contact.0.normal * contact.0.depth);
            assert!(apart.norm() <= slack, "the points are a depth apart: {contact:?}");
        }
    }
    assert!((all_pairs / 4..all_pairs).contains(&touching), "{touching} of {all_pairs} touch");
}

/// Returns the deepest contact of a pair; `None` if there is no pair or it has no contact.
fn deepest<N: Space<D>, const D: usize>(
    world: &World<N, D>,
    one: CollisionObjectHandle,
    other: CollisionObjectHandle,
) -> Option<ContactPoint<N, D>> {
    let views = world.contact_pair(one, other)?.views();
    let points = views.map(|view| view.deepest_contact());
    points.reduce(|best, next| if next.contact.depth > best.contact.depth { next } else { best })
}

/// Calls [`check_readers`] if there is a pair, and asserts that the kinematics of each contact give
/// that contact again at the poses of the update, up to rounding.
fn check_readers_of_pair<N: Space<D>, const D: usize>(
    world: &World<N, D>,
    one: CollisionObjectHandle,
    other: CollisionObjectHandle,
) {
    if world.contact_pair(one, other).is_none() {
        return;
    }
    check_readers(world, one, other);
    let poses = [one.min(other), one.max(other)].map(|handle| {
        let pose = N::pose(world.collision_object(handle).expect("alive").position());
        let rotation = Rotation::<N, D>::from_matrix_unchecked(pose.rotation);
        Isometry::from_parts(Translation::from(pose.translation), rotation)
    });
    for view in world.contact_pair(one, other).expect("a pair").views() {
        for (index, point) in view.contacts().enumerate() {
            let moved = view.kinematic(index).contact(&poses[0], &poses[1]);
            let slack = N::lit(64.0) * N::EPSILON;
            assert!((moved.depth - point.contact.depth).abs() <= slack, "{moved:?} {point:?}");
            assert!((moved.world1 - point.contact.world1).norm() <= slack, "{moved:?} {point:?}");
        }
    }
}

fn skins_grow_parts_of_composites<N: Stage<D>, const D: usize>() {
    for (order, y) in [(false, 2.25), (true, 2.25), (false, 2.0), (true, 1.75)] {
        let mut world = World::<N, D>::new(N::lit(0.02));
        let (floor, solid) = (table(), cube(0.5));
        let mut place = |is_floor: bool| {
            let (shape, at) = if is_floor { (&floor, 0.0) } else { (&solid, y) };
            let at = above::<N, D>(if is_floor { 0.0 } else { 1.5 }, at);
            world.add(at, shape.clone(), all(), contacts(0.0), ())
        };
        let [one, two] = [place(order), place(!order)];
        let (floor, solid) = if order { (one, two) } else { (two, one) };
        world.set_skin(floor, N::lit(0.5));
        world.set_skin(solid, N::lit(0.25));
        assert_eq!(step(&mut world), [Started(one, two)], "{y}: skins touch");
        check_readers_of_pair(&world, one, two);
        for (_, point) in world.contacts_with(floor) {
            let contact = point.contact;
            assert_eq!(contact.depth, N::lit(2.25 - y), "half a cube, a cube, and both skins");
            assert_eq!(
                (contact.world1[1], contact.world2[1]),
                (N::lit(1.5), N::lit(y - 0.75)),
                "on both"
            );
            assert_eq!((contact.normal[1], point.part1), (N::ONE, 1), "up, from the second part");
        }
        assert_eq!(world.contacts_with(floor).count(), 1 << (D - 1), "the lower face");
        // The skins apply between updates too.
        world.set_position(solid, above::<N, D>(1.5, 1.875));
        assert!(world.update_pair(one, two), "kept");
        check_readers_of_pair(&world, one, two);
        let depths = world.contacts_with(floor).map(|(_, point)| point.contact.depth);
        assert!(depths.into_iter().all(|depth| depth == N::lit(0.375)), "with the skins");
    }
}

fn skins_change_in_place<N: Stage<D>, const D: usize>() {
    let mut world = World::<N, D>::new(N::lit(0.02));
    let floor = add(&mut world, 0.0, &half_space(0, 1.0), contacts(0.0));
    let cube = add(&mut world, 1.25, &cube(1.0), contacts(0.0));
    let area = add(&mut world, 2.375, &ball(0.0), near(0.0));
    assert_eq!(step(&mut world), [], "a quarter above the floor");
    world.set_skin(cube, N::lit(0.25));
    assert_eq!(
        world.contact_pairs().map(|(_, _, pair)| pair.num_contacts()).sum::<usize>(),
        0,
        "none"
    );
    assert_eq!(step(&mut world), [Started(floor, cube)], "the skin touches the floor");
    assert!(world.proximity_events().is_empty(), "an area does not see the skin");
    let before = points(&world, floor, cube);
    assert!(before.iter().all(|point| point.contact.depth == N::ZERO), "touching: {before:?}");
    world.set_skin(floor, N::lit(0.125));
    assert_eq!(step(&mut world), [], "deeper");
    let after = points(&world, floor, cube);
    assert!(after.iter().all(|point| point.contact.depth == N::lit(0.125)), "{after:?}");
    let ids = |points: &[ContactPoint<N, D>]| points.iter().map(|p| p.id).collect::<Vec<_>>();
    assert_eq!(ids(&after), ids(&before), "the same contacts");
    world.set_skin(cube, N::ZERO);
    assert_eq!(step(&mut world), [Stopped(floor, cube)], "an eighth is missing");
    assert_eq!(world.skin(floor), Some(N::lit(0.125)), "kept");

    // Queries and boxes use the shape without its skin.
    let object = world.collision_object(floor).expect("alive");
    assert!(object.shape().aabb(&N::pose(object.position())).maxs()[0] <= N::lit(0.01), "its own");
    world.remove(&[cube]);
    world.set_skin(floor, N::ZERO);
    let next = add(&mut world, 1.125, &ball(1.0), contacts(0.0));
    assert_eq!((next.uid(), world.skin(next)), (cube.uid(), Some(N::ZERO)), "not inherited");
    assert_eq!(step(&mut world), [], "apart");
    assert_eq!(world.skin(cube), None, "stale");
    assert_eq!(world.try_set_skin(cube, N::ONE), Err(WorldError::StaleHandle(cube)), "stale");
    for wrong in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = world.try_set_skin(next, N::lit(wrong));
        assert!(matches!(refused, Err(WorldError::Skin { handle, .. }) if handle == next), "named");
    }
    assert!(world.contains(area), "it was there all along");
}

/// Asserts that the skin of a distant object changes no bit of the pairs of other objects.
fn worlds_without_skins_are_as_before<N: Stage<D>, const D: usize>() {
    let mut worlds = [0, 1].map(|_| World::<N, D>::new(N::lit(0.125)));
    for world in &mut worlds {
        let mut random = Random::new(5);
        for shape in shapes::<N, D>().iter().cycle().take(24) {
            let at = std::array::from_fn(|_| random.single(-2.0, 2.0));
            world.add(N::at(at), shape.clone(), all(), contacts(0.125), ());
        }
    }
    let [plain, skinned] = &mut worlds;
    let alone = skinned.add(N::on_x(90.0), ball(1.0), all(), contacts(0.0), ());
    skinned.set_skin(alone, N::ONE);
    step(plain);
    step(skinned);
    let read = |world: &World<N, D>| -> Vec<_> {
        let views = world.contact_views().flat_map(|(_, _, view)| view.contacts());
        let points: Vec<_> = views.map(|point| format!("{:?}", point.contact)).collect();
        let manifolds = world.contact_manifolds();
        let made = manifolds.flat_map(|(_, _, manifold)| manifold.contacts().to_vec());
        points.into_iter().chain(made.map(|tracked| format!("{:?}", tracked.contact))).collect()
    };
    assert!(read(plain).len() > 100, "many contacts");
    assert_eq!(read(plain), read(skinned), "the same bits");
}

in_tests! {
    a_pair_is_computed_as_an_update_would,
    transitions_in_substeps_are_told_once,
    pairs_that_are_not_kept_are_left_alone,
    an_object_with_itself_is_a_pair,
    skins_round_shapes,
    skins_grow_parts_of_composites,
    skins_change_in_place,
    worlds_without_skins_are_as_before,
}
