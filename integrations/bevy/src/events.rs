//! What is told about pairs: messages, events for observers, and what an entity touches.

use core::marker::PhantomData;
use core::ops::Deref;

use bevy_ecs::prelude::{Component, Entity, EntityEvent, Message};

use crate::{DefaultWorld, WorldKey};

/// Two entities began to touch: their distance became zero.
///
/// As a message it comes once per pair. As an event it is triggered twice, each time with the other entity as
/// target, so that an observer of either entity sees its own side. In a step all that ended comes before what began;
/// of each part contacts come before sensors, both in the order in which the colliders were added.
#[derive(Message, EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct CollisionStarted<const D: usize, W: WorldKey = DefaultWorld> {
    /// The entity; of a message the one whose collider was added first.
    #[event_target]
    pub entity: Entity,
    /// The entity that it touches.
    pub other: Entity,
    /// One of the two is a sensor.
    pub is_sensor: bool,
    pub(crate) world: PhantomData<W>,
}

/// Two entities ceased to touch: they parted, or one of them was removed, disabled, or is no longer allowed to meet the
/// other. Each [`CollisionStarted`] has one. An entity of it may be gone.
///
/// Messages and events come as those of [`CollisionStarted`] do.
#[derive(Message, EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct CollisionEnded<const D: usize, W: WorldKey = DefaultWorld> {
    /// The entity; of a message the one whose collider was added first.
    #[event_target]
    pub entity: Entity,
    /// The entity that it touched.
    pub other: Entity,
    /// One of the two was a sensor.
    pub is_sensor: bool,
    pub(crate) world: PhantomData<W>,
}

/// The entities that this one touches, as of the last step, in ascending order of their indices. Insert it where you want to read it:
/// entities without it cost nothing.
#[derive(Component, Clone, Debug, PartialEq)]
pub struct CollidingEntities<const D: usize, W: WorldKey = DefaultWorld> {
    pub(crate) entities: Vec<Entity>,
    pub(crate) world: PhantomData<W>,
}

/// An empty list, which the next step fills.
impl<const D: usize> Default for CollidingEntities<D> {
    fn default() -> Self {
        Self { entities: Vec::new(), world: PhantomData }
    }
}

/// The order of lists of entities: by index, then by generation. That of [`Entity`] itself is another, which Bevy
/// chose for speed.
pub(crate) fn rank(entity: &Entity) -> (u32, u32) {
    (entity.index_u32(), entity.generation().to_bits())
}

impl<const D: usize, W: WorldKey> CollidingEntities<D, W> {
    /// The list for the world of another key, empty.
    #[must_use]
    pub fn in_world<V: WorldKey>(self) -> CollidingEntities<D, V> {
        CollidingEntities { entities: Vec::new(), world: PhantomData }
    }

    /// Whether an entity is touched. Costs O(log n).
    #[must_use]
    pub fn contains(&self, entity: Entity) -> bool {
        self.position(entity).is_ok()
    }

    fn position(&self, entity: Entity) -> Result<usize, usize> {
        self.entities.binary_search_by_key(&rank(&entity), rank)
    }

    pub(crate) fn insert(&mut self, entity: Entity) {
        if let Err(index) = self.position(entity) {
            self.entities.insert(index, entity);
        }
    }

    pub(crate) fn remove(&mut self, entity: Entity) {
        if let Ok(index) = self.position(entity) {
            self.entities.remove(index);
        }
    }
}

impl<const D: usize, W: WorldKey> Deref for CollidingEntities<D, W> {
    type Target = [Entity];

    fn deref(&self) -> &[Entity] {
        &self.entities
    }
}
