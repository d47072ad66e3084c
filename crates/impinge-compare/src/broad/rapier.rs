//! The broad phase of rapier, used as in its `CollisionPipeline`: colliders without bodies are
//! moved, the broad phase gets the list of moved colliders, and returns events.
//!
//! Only a pipeline can clear the change flags of a collider, and running one would cost rapier
//! time. Therefore all colliders are copies of a template whose flags a pipeline has cleared. Later
//! steps change only their translations.

use super::rapier::prelude::*;

use super::{D, parry};
use crate::broad::contender::{Contender, Event, Held, MARGIN};
use crate::broad::swarm::{Cell, Change};

/// A broad phase of rapier.
pub struct Rapier {
    phase: BroadPhaseBvh,
    params: IntegrationParameters,
    bodies: RigidBodySet,
    colliders: ColliderSet,
    template: Collider,
    handles: Vec<ColliderHandle>,
    modified: Vec<ColliderHandle>,
    events: Vec<BroadPhasePairEvent>,
    /// The index of the box of each collider, by the first part of the collider's handle.
    numbers: Vec<u32>,
    held: Held,
    /// Whether boxes are passed to the broad phase directly, without a look-up of colliders.
    is_direct: bool,
}

impl Rapier {
    /// Creates a broad phase that contains the boxes.
    pub fn new(cells: &[Cell<D>], is_direct: bool) -> Self {
        // The margin of rapier is 0.04 times `length_unit`.
        let params = IntegrationParameters {
            length_unit: MARGIN / 0.04,
            normalized_prediction_distance: 0.0,
            dt: 0.0,
            ..IntegrationParameters::default()
        };
        let mut rapier = Self {
            phase: BroadPhaseBvh::new(),
            params,
            bodies: RigidBodySet::new(),
            colliders: ColliderSet::new(),
            template: template(),
            handles: Vec::new(),
            modified: Vec::new(),
            events: Vec::new(),
            numbers: Vec::new(),
            held: Held::default(),
            is_direct,
        };
        for (n, cell) in (0..).zip(cells) {
            let handle = rapier.insert(n, cell);
            rapier.handles.push(handle);
        }
        rapier
    }

    fn insert(&mut self, n: u32, cell: &Cell<D>) -> ColliderHandle {
        let mut collider = self.template.clone();
        collider.set_shape(SharedShape::new(Cuboid::new(Vector::from(cell.half))));
        collider.set_translation(Vector::from(cell.center));
        let handle = self.colliders.insert(collider.clone());
        let index = handle.into_raw_parts().0 as usize;
        if self.numbers.len() <= index {
            self.numbers.resize(index + 1, u32::MAX);
        }
        self.numbers[index] = n;
        // Insertion sets all change flags; the copy that replaces the collider has none.
        self.colliders[handle] = collider;
        self.colliders.take_modified();
        // A new collider is always reported as modified. If its box were passed directly, the
        // update would attribute the box to the removed collider whose index is reused, and remove
        // the box.
        self.modified.push(handle);
        handle
    }

    fn tell(&mut self, handle: ColliderHandle, cell: &Cell<D>) {
        if self.is_direct {
            let aabb = parry::bounding_volume::Aabb::new(
                Vector::from(cell.mins()),
                Vector::from(cell.maxs()),
            );
            self.phase.set_aabb(&self.params, handle, aabb);
        } else {
            self.modified.push(handle);
        }
    }

    fn remove(&mut self, n: u32) -> ColliderHandle {
        let handle = self.handles[n as usize];
        self.colliders.remove(
            handle,
            &mut IslandManager::new(),
            &mut self.bodies,
            &mut SoftBodySet::new(),
            false,
        );
        handle
    }
}

/// Returns a collider whose change flags a pipeline has cleared. It collides with fixed colliders
/// too: by default two fixed colliders ignore each other.
fn template() -> Collider {
    let mut colliders = ColliderSet::new();
    let ball = ColliderBuilder::ball(1.0).active_collision_types(ActiveCollisionTypes::all());
    let handle = colliders.insert(ball);
    CollisionPipeline::new().step(
        0.0,
        &mut IslandManager::new(),
        &mut BroadPhaseBvh::new(),
        &mut NarrowPhase::new(),
        &mut RigidBodySet::new(),
        &mut colliders,
        &(),
        &(),
    );
    colliders[handle].clone()
}

impl Contender<D> for Rapier {
    fn name(&self) -> &'static str {
        if self.is_direct { "rapier set_aabb" } else { "rapier" }
    }

    fn step(&mut self, change: &Change<D>) {
        self.events.clear();
        let removed: Vec<_> = change.replaced.iter().map(|(n, _)| self.remove(*n)).collect();
        for (n, cell) in &change.replaced {
            self.handles[*n as usize] = self.insert(*n, cell);
        }
        for (n, cell) in &change.moved {
            let handle = self.handles[*n as usize];
            if !self.is_direct {
                self.colliders[handle].set_translation(Vector::from(cell.center));
            }
            self.tell(handle, cell);
        }
        let Self { phase, params, bodies, colliders, modified, events, .. } = self;
        phase.update(params, colliders, bodies, modified, &removed, events);
        modified.clear();
    }

    fn settle(&mut self, change: &Change<D>) {
        self.colliders.take_removed();
        self.held.forget(change);
        let number = |handle: ColliderHandle| {
            let n = self.numbers[handle.into_raw_parts().0 as usize];
            (self.handles[n as usize] == handle).then_some(n)
        };
        let events = self.events.iter().filter_map(|event| -> Option<Event> {
            let (pair, started) = match event {
                BroadPhasePairEvent::AddPair(pair) => (pair, true),
                BroadPhasePairEvent::DeletePair(pair) => (pair, false),
            };
            Some((number(pair.collider1)?, number(pair.collider2)?, started))
        });
        self.held.apply(events);
    }

    fn pairs(&mut self) -> Vec<u64> {
        self.held.pairs()
    }
}
