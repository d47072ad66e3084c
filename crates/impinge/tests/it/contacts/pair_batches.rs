//! Compares pairs that begin and end in batches with a world that handles them one by one.

use crate::support::samples::samples;
use crate::support::scene_stage;

use impinge::math::Space;
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactPair, DefaultNarrowPhase, Events, IdAllocator, ProximityPair,
};
use impinge::world::{CollisionObjects, ContactPairs, NarrowPhase, ProximityPairs};
use impinge_scenes::{Scene, SceneQuery, mixed_shapes, sparse_drift, spawn_and_despawn};
use scene_stage::{Digest, Play, Player, digest_state};
use std::hash::Hasher;

/// Wraps the default narrow phase but keeps the provided `handle_interactions` of the trait, which
/// handles the pairs one by one.
#[derive(Clone)]
struct OneByOne<N: Space<D>, const D: usize>(DefaultNarrowPhase<N, D>);

impl<N: Space<D>, const D: usize, T> NarrowPhase<N, D, T> for OneByOne<N, D> {
    fn update(&mut self, objects: &CollisionObjects<N, D, T>, events: &mut Events) {
        NarrowPhase::update(&mut self.0, objects, events);
    }

    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        started: bool,
    ) {
        self.0.handle_interaction(events, objects, handle1, handle2, started);
    }

    fn handle_removal(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) {
        self.0.handle_removal(events, objects, handle1, handle2);
    }

    fn handle_change(
        &mut self,
        events: &mut Events,
        objects: &CollisionObjects<N, D, T>,
        handle: CollisionObjectHandle,
    ) {
        self.0.handle_change(events, objects, handle);
    }

    fn has_pairs_of(&self, handle: CollisionObjectHandle) -> bool {
        NarrowPhase::<N, D, T>::has_pairs_of(&self.0, handle)
    }

    fn ids(&mut self) -> Option<&mut IdAllocator> {
        NarrowPhase::<N, D, T>::ids(&mut self.0)
    }

    fn contact_pair<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'a, N, D>> {
        NarrowPhase::contact_pair(&self.0, objects, handle1, handle2)
    }

    fn proximity_pair(
        &self,
        objects: &CollisionObjects<N, D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair> {
        NarrowPhase::proximity_pair(&self.0, objects, handle1, handle2)
    }

    fn contact_pairs<'a>(
        &'a self,
        objects: &'a CollisionObjects<N, D, T>,
    ) -> ContactPairs<'a, N, D> {
        NarrowPhase::contact_pairs(&self.0, objects)
    }

    fn proximity_pairs<'a>(&'a self, objects: &'a CollisionObjects<N, D, T>) -> ProximityPairs<'a> {
        NarrowPhase::proximity_pairs(&self.0, objects)
    }
}

/// Makes every third object of a scene a sensor.
fn asking_for_both<const D: usize>(mut scene: Scene<D>) -> Scene<D> {
    for object in scene.objects.iter_mut().step_by(3) {
        object.query = SceneQuery::Proximity { margin: 0.02 };
    }
    scene
}

/// Runs a scene with pairs handled in batches and one by one, and asserts equal digests, and that
/// there are some contact and proximity events for each step.
fn compare<N: Play<D>, const D: usize>(scene: &Scene<D>, steps: usize) {
    let mut together = Player::<N, D>::new(scene.clone(), 1.0);
    let mut one_by_one = Player::<N, D>::new(scene.clone(), 1.0);
    // Both worlds replace their narrow phase, after which proxies have new indices.
    together.world.set_narrow_phase(Box::new(DefaultNarrowPhase::new()));
    one_by_one.world.set_narrow_phase(Box::new(OneByOne(DefaultNarrowPhase::new())));
    let mut events = 0;
    for step in 0..steps {
        let digests = [&mut together, &mut one_by_one].map(|player| {
            player.step();
            player.world.validate().expect("sound");
            let mut digest = Digest::new();
            digest_state(&player.world, &mut digest);
            digest.finish()
        });
        assert_eq!(digests[0], digests[1], "{}, step {step}", scene.name);
        events += together.world.contact_events().len() + together.world.proximity_events().len();
    }
    let few = 5 * steps / 2;
    assert!(events > few, "{}: hardly anything happens: {events} in {steps} steps", scene.name);
}

#[test]
fn together_or_one_by_one_is_the_same() {
    // A hundred boxes are enough to fill batches of eight. Shapes of eight kinds are not.
    let (boxes, steps) = (samples(100).min(300), samples(3).min(12));
    compare::<f32, 3>(&sparse_drift(boxes), steps);
    compare::<f64, 2>(&asking_for_both(sparse_drift(boxes)), steps);
    compare::<f32, 3>(&asking_for_both(mixed_shapes(150)), steps);
    compare::<f64, 3>(&spawn_and_despawn(samples(100).min(120)), samples(5).min(20));
    compare::<f32, 2>(&asking_for_both(spawn_and_despawn(boxes)), samples(5).min(30));
    compare::<f32, 2>(&mixed_shapes(150), steps);
}
