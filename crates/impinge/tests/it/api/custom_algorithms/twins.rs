//! Runs a scene in two worlds: one with the default parts, and one whose phases and algorithms are
//! exchanged during the run. Both must report the same contacts, proximities and events at every
//! step, even at a step with an exchange.

use std::collections::BTreeMap;

use impinge_scenes::{
    Scene, SceneQuery, SceneShape, mixed_shapes, sparse_drift, spawn_and_despawn,
};

use super::brute_force::BruteForce;
use super::dim::broad_phase::DBVTBroadPhase;
use super::dim::events::{ContactEvent, Proximity};
use super::dim::math::{DIM, Real};
use super::dim::narrow_phase::DefaultNarrowPhase;
use super::dim::query::ContactId;
use super::generators::Policy;
use super::plain_narrow_phase::PlainNarrowPhase;
use crate::support::samples::{samples, stride};
use crate::support::scene_stage::{Play, Player, World, assert_views_agree};

/// The uids of two handles. An object has the same uid in both worlds.
type Key = (usize, usize);

/// The part that is exchanged before the update of a step.
#[derive(Clone, Copy, Debug)]
enum Exchange {
    Algorithms(Policy),
    Narrow,
    Broad,
    Both,
    Back,
}

impl Exchange {
    fn apply<N: Play<DIM>>(self, world: &mut World<N, DIM>) {
        if let Self::Algorithms(policy) = self {
            let narrow = DefaultNarrowPhase::with_dispatchers(Box::new(policy), Box::new(policy));
            return world.set_narrow_phase(Box::new(narrow));
        }
        match self {
            Self::Narrow | Self::Both => {
                world.set_narrow_phase(Box::new(PlainNarrowPhase::<N>::default()));
            }
            Self::Back => world.set_narrow_phase(Box::new(DefaultNarrowPhase::new())),
            Self::Broad | Self::Algorithms(_) => {}
        }
        match self {
            Self::Broad | Self::Both => world.set_broad_phase(Box::new(BruteForce::new())),
            Self::Back => world.set_broad_phase(Box::new(DBVTBroadPhase::new(N::lit(0.25)))),
            Self::Narrow | Self::Algorithms(_) => {}
        }
    }
}

/// Returns the pairs that have contacts, each with its largest depth.
fn touching<N: Real>(world: &World<N, DIM>) -> BTreeMap<Key, f64> {
    assert_views_agree(world);
    let pairs = world.contact_manifolds().map(|(a, b, manifold)| {
        let deepest = manifold.deepest_contact().expect("not empty");
        ((a.handle().uid(), b.handle().uid()), deepest.contact.depth.as_f64())
    });
    pairs.collect()
}

/// Returns the pairs of the contact events, with `true` for started and `false` for stopped.
fn told<N: Real>(world: &World<N, DIM>) -> Vec<(Key, bool)> {
    let key = |event: &ContactEvent| {
        let (a, b) = event.handles();
        ((a.uid(), b.uid()), matches!(event, ContactEvent::Started(..)))
    };
    world.contact_events().iter().map(key).collect()
}

fn nearness<N: Real>(world: &World<N, DIM>) -> BTreeMap<Key, Proximity> {
    let pairs = world
        .proximity_pairs()
        .map(|(a, b, pair)| ((a.handle().uid(), b.handle().uid()), pair.proximity()));
    pairs.filter(|(_, proximity)| *proximity != Proximity::Disjoint).collect()
}

struct Twins<N: Play<DIM>> {
    usual: Player<N, DIM>,
    other: Player<N, DIM>,
    /// The pair of each contact id so far: an id must never belong to a second pair.
    names: BTreeMap<ContactId, Key>,
    events: usize,
}

impl<N: Play<DIM>> Twins<N> {
    fn new(scene: &Scene<DIM>) -> Self {
        let player = || Player::new(scene.clone(), 1.0);
        Self { usual: player(), other: player(), names: BTreeMap::new(), events: 0 }
    }

    fn step(&mut self, exchange: Option<Exchange>) {
        self.usual.step();
        self.other.apply();
        exchange.into_iter().for_each(|exchange| exchange.apply(&mut self.other.world));
        self.other.update();
        let names = self.other.world.contact_manifolds().flat_map(|(a, b, manifold)| {
            let key = (a.handle().uid(), b.handle().uid());
            manifold.contacts().iter().map(move |tracked| (tracked.id, key))
        });
        for (name, key) in names {
            assert_eq!(*self.names.entry(name).or_insert(key), key, "{name:?} is given twice");
        }
    }

    /// Asserts that both worlds report the same events and proximities, and that the same pairs
    /// touch, with depths that are equal up to rounding.
    fn compare(&mut self, place: &str) {
        let (usual, other) = (&self.usual.world, &self.other.world);
        other.validate().expect("the parts agree");
        assert_eq!(told(usual), told(other), "{place}");
        // Compared as text: handles of two worlds differ, but their text is the same.
        let near = [usual, other].map(|world| format!("{:?}", world.proximity_events()));
        assert_eq!(near[0], near[1], "{place}");
        assert_eq!(nearness(usual), nearness(other), "{place}");
        let (depths, others) = (touching(usual), touching(other));
        assert!(depths.keys().eq(others.keys()), "{place}: the same pairs touch");
        for ((key, a), b) in depths.iter().zip(others.values()) {
            assert!((a - b).abs() <= 64.0 * N::EPSILON.as_f64() * 20.0, "{place}: {key:?} {a} {b}");
        }
        self.events += usual.contact_events().len() + usual.proximity_events().len();
    }
}

/// Runs the scene in both worlds, with an exchange of a phase or of algorithms in one of them every
/// two steps, or every five with more samples. Asserts that both report the same events,
/// proximities and depths after each step.
fn exchanges<N: Play<DIM>>(scene: &Scene<DIM>) {
    let plan = [
        Exchange::Algorithms(Policy::Balls),
        Exchange::Broad,
        Exchange::Narrow,
        Exchange::Back,
        Exchange::Both,
        Exchange::Algorithms(Policy::Balls),
        Exchange::Back,
        Exchange::Back,
    ];
    let (mut twins, steps) = (Twins::<N>::new(scene), samples(2).min(5));
    for (round, exchange) in plan.into_iter().enumerate() {
        for step in 0..steps {
            twins.step((step == steps / 2).then_some(exchange));
            twins.compare(&format!("{}, round {round} {exchange:?}, step {step}", scene.name));
        }
    }
    assert!(twins.events > 12 * steps, "{} events", twins.events);
}

/// Returns the scene `sparse_drift` with a ball for each object; every fifth object is a sensor.
fn balls() -> Scene<DIM> {
    let mut scene = sparse_drift::<DIM>(150);
    for (index, object) in scene.objects.iter_mut().enumerate() {
        object.shape = SceneShape::Ball { radius: 0.7 };
        if index.is_multiple_of(5) {
            object.query = SceneQuery::Proximity { margin: 0.0625 };
        }
    }
    scene
}

#[test]
fn phases_are_exchanged_without_false_or_lost_events() {
    let scenes = [balls(), mixed_shapes(100), spawn_and_despawn(200)];
    // By default each scene has one scalar: every second scene `f64`, the others `f32`.
    let has_both = stride(2) == 1;
    for (number, scene) in scenes.iter().enumerate() {
        let is_odd = number % 2 == 1;
        if has_both || !is_odd {
            exchanges::<f32>(scene);
        }
        if has_both || is_odd {
            exchanges::<f64>(scene);
        }
    }
}

/// Asserts that each touching pair stops with one event when all pairs lose their algorithm, and
/// starts with one event when they get one again.
fn pairs_without_algorithm<N: Play<DIM>>() {
    let mut twins = Twins::<N>::new(&balls());
    for step in 0..12 {
        let exchange = match step {
            4 => Some(Exchange::Algorithms(Policy::Nothing)),
            8 => Some(Exchange::Algorithms(Policy::Balls)),
            _ => None,
        };
        let before = touching(&twins.usual.world);
        let near_before = nearness(&twins.usual.world);
        twins.step(exchange);
        let (usual, other) = (&twins.usual.world, &twins.other.world);
        let expected: Vec<(Key, bool)> = match step {
            4 => before.keys().map(|&key| (key, false)).collect(),
            8 => touching(usual).keys().map(|&key| (key, true)).collect(),
            5..8 => Vec::new(),
            _ => told(usual),
        };
        assert_eq!(told(other), expected, "step {step}");
        let changes = match step {
            4 => near_before.len(),
            8 => nearness(usual).len(),
            5..8 => 0,
            _ => usual.proximity_events().len(),
        };
        assert_eq!(other.proximity_events().len(), changes, "step {step}");
        if (4..8).contains(&step) {
            assert!(expected.len() > 5 || step > 4, "some ended");
            assert_eq!((touching(other).len(), nearness(other).len()), (0, 0), "nothing is known");
            assert_eq!(other.contact_pairs().count(), 0, "no algorithm, no pair to look at");
        }
    }
}

/// Asserts that pairs for which the algorithm's `update` returns `false` have no contacts and no
/// events. Every third object is not a ball, so that such pairs occur.
fn pairs_that_are_refused<N: Play<DIM>>() {
    let mut scene = balls();
    for (object, other) in scene.objects.iter_mut().zip(sparse_drift::<DIM>(150).objects).step_by(3)
    {
        object.shape = other.shape;
    }
    let is_ball = |index: usize| matches!(scene.objects[index].shape, SceneShape::Ball { .. });
    let mut twins = Twins::<N>::new(&scene);
    let mut balls = 0;
    for step in 0..10 {
        let only = Exchange::Algorithms(Policy::OnlyBalls);
        twins.step((step == 0).then_some(only));
        let expected: Vec<_> = twins
            .usual
            .world
            .contact_manifolds()
            .filter(|(a, b, _)| is_ball(*a.data()) && is_ball(*b.data()))
            .map(|(a, b, _)| (a.handle().uid(), b.handle().uid()))
            .collect();
        assert!(touching(&twins.other.world).keys().eq(&expected), "balls only, step {step}");
        let near = nearness(&twins.other.world);
        let known = nearness(&twins.usual.world);
        assert!(near.iter().all(|(key, near)| known.get(key) == Some(near)), "balls only");
        assert!(near.len() < known.len(), "others are not near: their detectors refuse");
        balls += expected.len();
    }
    assert!(balls > 5, "{balls} pairs of balls");
}

#[test]
fn pairs_need_an_algorithm() {
    pairs_without_algorithm::<f32>();
    pairs_without_algorithm::<f64>();
    pairs_that_are_refused::<f32>();
    pairs_that_are_refused::<f64>();
}
