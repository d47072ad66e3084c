//! A narrow phase that measures the time of its updates.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use impinge::math::Space;
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactPair, DefaultNarrowPhase, Events, IdAllocator, Interaction,
    ProximityPair,
};
use impinge::world::{
    CollisionObjects, ContactManifolds, ContactPairs, ContactViews, NarrowPhase, ProximityPairs,
};

use crate::measure::timed;

/// The default narrow phase, with a clock for its last update.
#[derive(Clone)]
pub struct Clocked<const D: usize>
where
    f32: Space<D>,
{
    inner: DefaultNarrowPhase<f32, D>,
    time: Clock,
}

/// A shared cell with the time of the last update of a narrow phase, in nanoseconds.
#[derive(Clone, Debug, Default)]
pub struct Clock(Arc<AtomicU64>);

impl Clock {
    /// Returns the time of the last update, in nanoseconds.
    pub fn read(&self) -> f64 {
        f64::from_bits(self.0.load(Ordering::Relaxed))
    }
}

impl<const D: usize> Clocked<D>
where
    f32: Space<D>,
{
    pub fn new(inner: DefaultNarrowPhase<f32, D>, time: Clock) -> Self {
        Self { inner, time }
    }
}

/// The objects of a world in `f32`. The implementation below measures `update`; its other methods
/// only call those of `inner`.
type Objects<const D: usize, T> = CollisionObjects<f32, D, T>;

impl<const D: usize, T> NarrowPhase<f32, D, T> for Clocked<D>
where
    f32: Space<D>,
{
    fn update(&mut self, objects: &Objects<D, T>, events: &mut Events) {
        let (time, ()) = timed(|| self.inner.update(objects, events));
        self.time.0.store(time.to_bits(), Ordering::Relaxed);
    }

    fn handle_interaction(
        &mut self,
        events: &mut Events,
        objects: &Objects<D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        started: bool,
    ) {
        self.inner.handle_interaction(events, objects, handle1, handle2, started);
    }

    fn handle_interactions(
        &mut self,
        events: &mut Events,
        objects: &Objects<D, T>,
        interactions: &[Interaction],
    ) {
        self.inner.handle_interactions(events, objects, interactions);
    }

    fn handle_removal(
        &mut self,
        events: &mut Events,
        objects: &Objects<D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) {
        self.inner.handle_removal(events, objects, handle1, handle2);
    }

    fn handle_change(
        &mut self,
        events: &mut Events,
        objects: &Objects<D, T>,
        handle: CollisionObjectHandle,
    ) {
        self.inner.handle_change(events, objects, handle);
    }

    fn has_pairs_of(&self, handle: CollisionObjectHandle) -> bool {
        NarrowPhase::<f32, D, T>::has_pairs_of(&self.inner, handle)
    }

    fn ids(&mut self) -> Option<&mut IdAllocator> {
        NarrowPhase::<f32, D, T>::ids(&mut self.inner)
    }

    fn contact_pair<'a>(
        &'a self,
        objects: &'a Objects<D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ContactPair<'a, f32, D>> {
        NarrowPhase::contact_pair(&self.inner, objects, handle1, handle2)
    }

    fn proximity_pair(
        &self,
        objects: &Objects<D, T>,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
    ) -> Option<ProximityPair> {
        NarrowPhase::proximity_pair(&self.inner, objects, handle1, handle2)
    }

    fn contact_pairs<'a>(&'a self, objects: &'a Objects<D, T>) -> ContactPairs<'a, f32, D> {
        NarrowPhase::contact_pairs(&self.inner, objects)
    }

    fn contact_manifolds<'a>(&'a self, objects: &'a Objects<D, T>) -> ContactManifolds<'a, f32, D> {
        NarrowPhase::contact_manifolds(&self.inner, objects)
    }

    fn contact_views<'a>(&'a self, objects: &'a Objects<D, T>) -> ContactViews<'a, f32, D> {
        NarrowPhase::contact_views(&self.inner, objects)
    }

    fn proximity_pairs<'a>(&'a self, objects: &'a Objects<D, T>) -> ProximityPairs<'a> {
        NarrowPhase::proximity_pairs(&self.inner, objects)
    }
}
