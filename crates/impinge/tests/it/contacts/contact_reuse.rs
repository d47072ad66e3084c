//! Compares a world that reuses the contacts of pairs that hardly move with a world that computes
//! all contacts anew.

use crate::support::samples::samples;
use crate::support::scene_stage;

use std::collections::BTreeMap;

use impinge::math::na::{Translation3, UnitQuaternion};
use impinge::math::{Isometry3, Point, Real, Vector};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactEvent, DefaultNarrowPhase, GeometricQueryType,
};
use impinge::shape::{
    Ball, Capsule, Compound, ConvexHull, Cuboid, Cylinder, HeightField, Plane, ShapeHandle, TriMesh,
};
use impinge::world::{CollisionGroups, CollisionWorld};
use impinge_scenes::{Scene, SceneQuery, mixed_shapes, pile};
use scene_stage::{Digest, Play, Player, assert_views_agree, digest_state};

/// Sum of the linear predictions of two objects of size 1.
const PREDICTION: f64 = 0.02;
/// Movement of a pair, as a length, up to which its contacts are reused.
const TOLERANCE: f64 = 0.002;

/// Returns the scene with a hundredth of its speeds, so that the fastest objects need ten to a
/// hundred steps to move by [`TOLERANCE`]. All objects get contact queries with half of
/// [`PREDICTION`].
fn slow<const D: usize>(mut scene: Scene<D>) -> Scene<D> {
    for object in &mut scene.objects {
        object.query = SceneQuery::Contacts { linear: PREDICTION / 2.0, angular: 0.0 };
        object.motion.place.iter_mut().for_each(|wave| wave.speed *= 0.01);
        object.motion.tangent.speed *= 0.01;
    }
    scene
}

fn reusing<N: Play<D>, const D: usize>(scene: Scene<D>, tolerance: f64) -> Player<N, D> {
    let mut player = Player::new(scene, 1.0);
    let narrow_phase = DefaultNarrowPhase::<N, D>::new().reusing(N::lit(tolerance));
    player.world.set_narrow_phase(Box::new(narrow_phase));
    player
}

/// Returns the greatest depth of each pair with contacts.
fn depths<N: Play<D>, const D: usize>(player: &Player<N, D>) -> BTreeMap<(usize, usize), f64> {
    let mut depths = BTreeMap::new();
    for (object1, object2, manifold) in player.world.contact_manifolds() {
        let deepest = manifold.deepest_contact().expect("a manifold has contacts").contact;
        let along = (deepest.world2 - deepest.world1).dot(&deepest.normal).as_f64();
        let depth = deepest.depth.as_f64();
        assert!((along + depth).abs() < 1e-4, "points {along} apart at a depth of {depth}");
        let pair = (*object1.data(), *object2.data());
        let least = depths.entry(pair).or_insert(depth);
        *least = depth.max(*least);
    }
    depths
}

/// Runs a scene in a world that computes all contacts anew and in a world that reuses them. Asserts
/// that depths agree up to the tolerance. Returns the number of depths that differ, which proves
/// that contacts were reused, and the number of all compared depths.
fn compare<N: Play<D>, const D: usize>(scene: &Scene<D>, steps: u32) -> (usize, usize) {
    let mut exact = Player::<N, D>::new(scene.clone(), 1.0);
    let mut kept = reusing::<N, D>(scene.clone(), TOLERANCE);
    let (mut differing, mut all) = (0, 0);
    let room = 2.0 * TOLERANCE + 1e-4;
    for _ in 0..steps {
        exact.step();
        kept.step();
        kept.world.validate().expect("sound");
        assert_views_agree(&kept.world);
        let (expected, found) = (depths(&exact), depths(&kept));
        for (pair, depth) in &expected {
            let Some(other) = found.get(pair) else {
                let is_far = -depth >= PREDICTION - room;
                assert!(is_far, "{}: {pair:?} is missed at a depth of {depth}", scene.name);
                continue;
            };
            let off = (other - depth).abs();
            assert!(off <= room, "{}: {pair:?} is {depth} deep, not {other}", scene.name);
            differing += usize::from(other.to_bits() != depth.to_bits());
            all += 1;
        }
        let more = found.iter().filter(|(pair, _)| !expected.contains_key(pair));
        for (pair, depth) in more {
            assert!(-depth >= PREDICTION - room, "{}: {pair:?}, {depth} deep", scene.name);
        }
    }
    (differing, all)
}

fn assert_kept<N: Play<D>, const D: usize>(scene: &Scene<D>) {
    let (differing, all) = compare::<N, D>(scene, 8);
    assert!(all > 8 * scene.objects.len(), "{}: {all} contacts are too few to tell", scene.name);
    assert!(differing * 2 > all, "{}: only {differing} of {all} were kept", scene.name);
}

#[test]
fn depths_are_within_twice_the_tolerance() {
    assert_kept::<f32, 3>(&slow(pile(samples(20).min(120))));
    assert_kept::<f64, 3>(&slow(pile(samples(10).min(60))));
    assert_kept::<f32, 2>(&slow(pile(samples(30).min(200))));
    assert_kept::<f64, 2>(&slow(pile(samples(30).min(200))));
    // Among these kinds, pairs of balls, segments and capsules are always computed anew.
    let count = samples(200).min(400);
    for (differing, all) in [
        compare::<f32, 3>(&slow(mixed_shapes(count)), 10),
        compare::<f64, 3>(&slow(mixed_shapes(count)), 10),
        compare::<f32, 2>(&slow(mixed_shapes(count)), 10),
    ] {
        assert!(differing * 3 > all && 2 * all > count, "only {differing} of {all} were kept");
    }
}

#[test]
fn fast_objects_are_computed_anew() {
    let mut scene = pile::<3>(60);
    scene.objects.iter_mut().for_each(|object| {
        object.query = SceneQuery::Contacts { linear: PREDICTION / 2.0, angular: 0.0 };
    });
    let mut exact = Player::<f32, 3>::new(scene.clone(), 1.0);
    let mut kept = reusing::<f32, 3>(scene, 0.0005);
    for _ in 0..10 {
        exact.step();
        kept.step();
        assert_eq!(depths(&exact), depths(&kept), "every box moves by more than the tolerance");
    }
}

#[test]
fn no_tolerance_is_no_difference() {
    for scene in [slow(pile::<3>(80)), slow(mixed_shapes::<3>(200))] {
        let mut exact = Player::<f32, 3>::new(scene.clone(), 1.0);
        exact.world.set_narrow_phase(Box::new(DefaultNarrowPhase::<f32, 3>::new()));
        let mut kept = reusing::<f32, 3>(scene, 0.0);
        for _ in 0..6 {
            let digests = [&mut exact, &mut kept].map(|player| {
                player.step();
                let mut digest = Digest::new();
                digest_state(&player.world, &mut digest);
                std::hash::Hasher::finish(&digest)
            });
            assert_eq!(digests[0], digests[1], "the same in every bit");
        }
    }
}

type World<N> = CollisionWorld<N, 3, ()>;

fn v<N: Real>(x: f64, y: f64, z: f64) -> Vector<N, 3> {
    Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn at<N: Real>(place: [f64; 3], turn: f64) -> Isometry3<N> {
    let place = Translation3::from(v(place[0], place[1], place[2]));
    Isometry3::from_parts(place, UnitQuaternion::from_scaled_axis(v(0.0, turn, 0.0)))
}

/// A world that reuses contacts, with an object on a floor.
struct Stage<N: Real> {
    world: World<N>,
    ground: CollisionObjectHandle,
    object: CollisionObjectHandle,
}

impl<N: Real> Stage<N> {
    fn new(ground: ShapeHandle<N, 3>, place: [f64; 3], object: ShapeHandle<N, 3>) -> Self {
        Self::within(TOLERANCE, ground, place, object)
    }

    fn within(
        tolerance: f64,
        ground: ShapeHandle<N, 3>,
        place: [f64; 3],
        object: ShapeHandle<N, 3>,
    ) -> Self {
        let mut world = World::<N>::new(N::lit(0.05));
        let narrow_phase = DefaultNarrowPhase::<N, 3>::new().reusing(N::lit(tolerance));
        world.set_narrow_phase(Box::new(narrow_phase));
        let query = GeometricQueryType::Contacts(N::lit(PREDICTION / 2.0), N::ZERO);
        let groups = CollisionGroups::new();
        let ground = world.add(at([place[0], 0.0, place[2]], 0.0), ground, groups, query, ());
        let object = world.add(at(place, 0.0), object, groups, query, ());
        world.update();
        Self { world, ground, object }
    }

    fn moved(&mut self, place: [f64; 3], turn: f64) -> Vec<f64> {
        self.world.set_position(self.object, at(place, turn));
        self.world.update();
        self.world.validate().expect("sound");
        self.depths()
    }

    fn depths(&self) -> Vec<f64> {
        let views = self.world.contact_views();
        views.flat_map(|(_, _, view)| view.contacts()).map(|p| p.contact.depth.as_f64()).collect()
    }
}

/// Returns a square of 4 by 4 at y = 0, made of two triangles.
fn floor<N: Real>() -> ShapeHandle<N, 3> {
    let corners = [(-2.0, -2.0), (2.0, -2.0), (2.0, 2.0), (-2.0, 2.0)];
    let corners = corners.map(|(x, z)| Point::from(v::<N>(x, 0.0, z))).to_vec();
    ShapeHandle::new(TriMesh::new(corners, vec![[0, 2, 1], [0, 3, 2]]))
}

fn solids<N: Real>() -> Vec<ShapeHandle<N, 3>> {
    let corners = [[-0.5, 0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, -0.5]];
    let corners: Vec<_> = corners
        .iter()
        .flat_map(|&[x, z]| [Point::from(v::<N>(x, -0.5, z)), Point::from(v(0.8 * x, 0.5, z))])
        .collect();
    vec![
        ShapeHandle::new(Cuboid::new(v(0.5, 0.5, 0.5))),
        ShapeHandle::new(ConvexHull::from_points(&corners)),
        ShapeHandle::new(Cylinder::new(N::HALF, N::lit(0.4))),
    ]
}

/// Lowers and slightly rotates solids on a floor, near the origin or far from it. Asserts that all
/// contacts remain and that reused depths are exact up to `noise`: they are measured along the old
/// normal, which stays the same. Larger motions must compute the contacts anew.
fn sinks<N: Real>(ground: &ShapeHandle<N, 3>, height: f64, far: f64, noise: f64) {
    for solid in solids::<N>() {
        let place = |depth: f64| [far, height + 0.5 - depth, -far];
        let mut stage = Stage::new(ground.clone(), place(0.001), solid.clone());
        let before = stage.depths().len();
        assert!(before >= 3, "it stands on its face: {before} contacts");
        for step in 0..8 {
            let depth = 0.001 + 0.000_1 * f64::from(step);
            let found = stage.moved(place(depth), 0.000_1 * f64::from(step));
            assert_eq!(found.len(), before, "none came or went");
            let off = found.iter().map(|x| (x - depth).abs()).fold(0.0, f64::max);
            assert!(off <= noise, "{off} off a depth of {depth}, {far} away");
        }
        // A motion beyond the tolerance, such as lifting the solid off, computes all contacts anew.
        assert!(stage.moved(place(-0.5), 0.0).is_empty(), "nothing is kept of what is gone");
        assert_eq!(stage.moved(place(0.001), 0.7).len(), before, "turned");
    }
}

#[test]
fn solids_sink_into_the_ground_by_as_much_as_they_are_lowered() {
    let slab = ShapeHandle::new(Cuboid::new(v::<f64>(2.0, 0.5, 2.0)));
    let (box32, mesh32, mesh64) =
        (ShapeHandle::new(Cuboid::new(v(2.0, 0.5, 2.0))), floor(), floor());
    sinks::<f64>(&slab, 0.5, 0.0, 1e-9);
    sinks::<f64>(&mesh64, 0.0, 1e6, 1e-8);
    sinks::<f32>(&box32, 0.5, 0.0, 1e-6);
    sinks::<f32>(&mesh32, 0.0, 1000.0, 1e-6);
}

#[test]
fn another_shape_or_question_is_answered_anew() {
    let mut stage = Stage::<f64>::new(floor(), [0.0, 0.501, 0.0], solids()[0].clone());
    assert_eq!(stage.depths().len(), 4, "a box stands on the floor");
    let small = ShapeHandle::new(Cuboid::new(v(0.4, 0.4, 0.4)));
    stage.world.set_shape(stage.object, small);
    assert!(stage.moved([0.0, 0.501, 0.0], 0.0).is_empty(), "a smaller one does not reach it");
    let events = stage.world.contact_events();
    assert!(matches!(events, [ContactEvent::Stopped(..)]), "and that is told: {events:?}");
    let wide = GeometricQueryType::Contacts(0.2, 0.0);
    stage.world.set_query_type(stage.object, wide);
    assert_eq!(stage.moved([0.0, 0.501, 0.0], 0.0).len(), 4, "but it is near enough now");
    stage.world.remove(&[stage.ground]);
    stage.world.update();
    assert!(stage.depths().is_empty(), "without a floor there is nothing to stand on");
}

/// Returns the x coordinate of the deepest contact of a capsule on a floor for each step, while the
/// tilt of the capsule increases.
fn leaning(tolerance: f64, ground: &ShapeHandle<f64, 3>) -> Vec<f64> {
    let capsule = ShapeHandle::new(Capsule::<f64, 3>::new(0.5, 0.3));
    let lean =
        |step: u32| UnitQuaternion::from_scaled_axis(v(0.0, 0.0, 0.3 + 0.000_05 * f64::from(step)));
    let place = |step: u32| {
        let height = 0.299 + 0.5 * (0.3 + 0.000_05 * f64::from(step)).cos();
        Isometry3::from_parts(Translation3::new(0.2, height, 0.1), lean(step))
    };
    let mut stage = Stage::within(tolerance, ground.clone(), [0.2, 0.9, 0.1], capsule);
    let mut found = Vec::new();
    for step in 0..16 {
        stage.world.set_position(stage.object, place(step));
        stage.world.set_position(stage.ground, Isometry3::identity());
        stage.world.update();
        let contacts = stage.world.contact_views().flat_map(|(_, _, view)| view.contacts());
        let deepest =
            contacts.map(|point| point.contact).max_by(|a, b| a.depth.total_cmp(&b.depth));
        found.push(deepest.expect("it touches").world2.x);
    }
    found
}

#[test]
fn contacts_are_kept_on_every_ground() {
    let slab = ShapeHandle::new(Cuboid::new(v::<f64>(2.0, 0.5, 2.0)));
    let slab = Compound::new(vec![(Isometry3::translation(0.0, -0.5, 0.0), slab)]);
    let heights = HeightField::<f64, 3>::new(2, 2, vec![0.0; 4], v(4.0, 1.0, 4.0));
    let half_space = Plane::<f64, 3>::new(Vector::<f64, 3>::y_axis());
    let grounds = [
        ("half-space", ShapeHandle::new(half_space)),
        ("mesh", floor()),
        ("field", ShapeHandle::new(heights)),
        ("compound", ShapeHandle::new(slab)),
    ];
    for (name, ground) in grounds {
        let (exact, kept) = (leaning(0.0, &ground), leaning(TOLERANCE, &ground));
        let offs: Vec<f64> = exact.iter().zip(&kept).map(|(a, b)| (a - b).abs()).collect();
        assert!(offs.iter().all(|off| *off < TOLERANCE), "{name}: {offs:?}");
        let count = offs.iter().filter(|off| **off > 1e-6).count();
        assert!(count >= 8, "{name}: kept {count} times, {offs:?}");
    }
}

#[test]
fn what_was_fast_and_slows_down_is_kept_again() {
    // A box moves over the edge of a floor: computed contacts stay at the edge, reused contacts
    // move with the box.
    let mut stage = Stage::<f64>::new(floor(), [0.0, 0.499, 0.0], solids()[0].clone());
    let edge = |stage: &Stage<f64>| {
        let contacts = stage.world.contact_views().flat_map(|(_, _, view)| view.contacts());
        contacts.map(|point| point.contact.world1.x.max(point.contact.world2.x)).fold(0.0, f64::max)
    };
    for step in 0..10 {
        stage.moved([1.7 + 0.02 * f64::from(step), 0.499, 0.0], 0.0);
        let at = edge(&stage);
        assert!((at - 2.0).abs() < 1e-9, "fast, the edge is at {at}");
    }
    let mut kept = 0;
    for step in 0..20 {
        stage.moved([1.88 + 0.000_05 * f64::from(step), 0.499, 0.0], 0.0);
        let off = (edge(&stage) - 2.0).abs();
        assert!(off < TOLERANCE, "{off} is more than it moved");
        kept += usize::from(off > 1e-6);
    }
    assert!(kept >= 10, "kept {kept} times");
}

/// Returns, for each step, the contact depths of pairs of capsules that lie on each other. The tilt
/// of the upper capsules decreases until both of their ends are within the prediction. Every third
/// step moves all upper capsules, the other steps only one.
fn capsules(narrow_phase: DefaultNarrowPhase<f64, 3>) -> Vec<Vec<f64>> {
    let capsule = ShapeHandle::<f64, 3>::new(Capsule::new(0.5, 0.3));
    let (mut world, groups) = (World::<f64>::new(0.05), CollisionGroups::new());
    world.set_narrow_phase(Box::new(narrow_phase));
    let query = GeometricQueryType::Contacts(PREDICTION / 2.0, 0.0);
    let place = |n: u32, height: f64, lean: f64| {
        let turn =
            UnitQuaternion::from_scaled_axis(v(0.0, 0.0, std::f64::consts::FRAC_PI_2 + lean));
        Isometry3::from_parts(Translation3::new(3.0 * f64::from(n), height, 0.0), turn)
    };
    let over = |n: u32, lean: f64| place(n, 0.602 + 0.5 * lean.sin(), lean);
    let mut pair = |n: u32| {
        world.add(place(n, 0.0, 0.0), capsule.clone(), groups, query, ());
        (n, world.add(over(n, 0.0205), capsule.clone(), groups, query, ()))
    };
    let upper: Vec<_> = (0..40).map(&mut pair).collect();
    let mut depths = Vec::new();
    for step in 0..30 {
        let moved = if step % 3 == 0 { &upper[..] } else { &upper[7..8] };
        for &(n, handle) in moved {
            world.set_position(handle, over(n, 0.0205 - 0.000_2 * f64::from(step)));
        }
        world.update();
        let contacts = world.contact_views().flat_map(|(_, _, view)| view.contacts());
        depths.push(contacts.map(|point| point.contact.depth).collect());
    }
    depths
}

#[test]
fn it_is_of_no_account_whether_few_or_all_are_updated() {
    let expected = capsules(DefaultNarrowPhase::new());
    let found = capsules(DefaultNarrowPhase::new().reusing(TOLERANCE));
    assert_eq!([expected[0].len(), expected[29].len()], [40, 80], "on one end, then on two");
    for (expected, found) in expected.iter().zip(&found) {
        let deepest = |depths: &[f64]| depths.iter().copied().fold(f64::MIN, f64::max);
        let off = (deepest(expected) - deepest(found)).abs();
        assert!(off <= 2.0 * TOLERANCE, "{off} off");
    }
    assert_eq!([found[0].len(), found[29].len()], [40, 80], "late, but on two ends");
}

#[test]
fn an_overlap_is_never_missed() {
    // The prediction is zero, less than the tolerance for movement.
    let ball = || ShapeHandle::new(Cylinder::new(0.5_f64, 0.5));
    let mut world = World::<f64>::new(0.05);
    let narrow_phase = DefaultNarrowPhase::<f64, 3>::new().reusing(0.01);
    world.set_narrow_phase(Box::new(narrow_phase));
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    let groups = CollisionGroups::new();
    world.add(at([0.0; 3], 0.0), ball(), groups, query, ());
    let other = world.add(at([0.0, 1.001, 0.0], 0.0), ball(), groups, query, ());
    for height in [1.0005, 1.0001, 0.9999, 1.0001, 0.9999] {
        world.set_position(other, at([0.0, height, 0.0], 0.0));
        world.update();
        let touching = world.contact_views().count() > 0;
        assert_eq!(touching, height < 1.0, "at a height of {height}");
    }
}

#[test]
fn a_tolerance_is_a_length() {
    for tolerance in [-1.0, f64::NAN, f64::INFINITY] {
        let refused = DefaultNarrowPhase::<f64, 3>::new().try_reusing(tolerance);
        let error = refused.expect_err("no length");
        assert_eq!(error.value.to_bits(), tolerance.to_bits(), "it is named");
    }
    let ball = ShapeHandle::<f64, 3>::new(Ball::new(0.5));
    let mut stage = Stage::new(floor(), [0.0, 0.4, 0.0], ball);
    assert_eq!(stage.moved([0.0, 0.4, 0.0], 0.0).len(), 1, "and balls are as ever");
}
