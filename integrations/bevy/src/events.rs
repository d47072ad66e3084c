//! Reports about pairs: messages, events for observers, and the list of entities that an entity touches.

use core::marker::PhantomData;
use core::ops::Deref;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::{Component, Entity, EntityEvent, Message};
use bevy_ecs::world::DeferredWorld;

use crate::{DefaultWorld, WorldKey};

/// Two entities started touching: their distance became zero, or with a
/// [prediction](crate::ImpingePlugin::with_prediction) at most twice the prediction.
///
/// As a message it is written once per pair. As an event it is triggered twice, each time with one
/// of the two entities as target, so observers of both get it. In a step, ended pairs come before
/// started ones. Within each of the two lists contacts come before sensors, both in the order in
/// which the colliders were added.
#[derive(Message, EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct CollisionStarted<const D: usize, W: WorldKey = DefaultWorld> {
    /// The entity; in a message the one whose collider was added first.
    #[event_target]
    pub entity: Entity,
    /// The entity that it touches.
    pub other: Entity,
    /// Whether one of the two is a sensor.
    pub is_sensor: bool,
    pub(crate) world: PhantomData<W>,
}

/// Two entities stopped touching: they separated, or one of them was removed, disabled, or is no
/// longer allowed to collide with the other. Each [`CollisionStarted`] is followed by exactly one
/// [`CollisionEnded`]. The entities may be despawned already.
///
/// Messages and events have the same order as those of [`CollisionStarted`].
#[derive(Message, EntityEvent, Clone, Copy, Debug, PartialEq)]
pub struct CollisionEnded<const D: usize, W: WorldKey = DefaultWorld> {
    /// The entity; in a message the one whose collider was added first.
    #[event_target]
    pub entity: Entity,
    /// The entity that it touched.
    pub other: Entity,
    /// Whether one of the two was a sensor.
    pub is_sensor: bool,
    pub(crate) world: PhantomData<W>,
}

/// The entities that this one touches, as of the last step, sorted by index. Insert it where you want to read it:
/// entities without it cost nothing.
#[derive(Component, Clone, Debug)]
#[component(on_insert = refill::<D, W>)]
pub struct CollidingEntities<const D: usize, W: WorldKey = DefaultWorld> {
    pub(crate) entities: Vec<Entity>,
    /// Whether a step has filled the list since it was inserted. Change detection does not tell: a
    /// list that replaces another one is changed, but not added.
    pub(crate) is_filled: bool,
    pub(crate) world: PhantomData<W>,
}

/// When the component is inserted, makes the next step fill it, whatever list is inserted.
fn refill<const D: usize, W: WorldKey>(mut world: DeferredWorld<'_>, context: HookContext) {
    if let Some(mut list) = world.get_mut::<CollidingEntities<D, W>>(context.entity) {
        list.is_filled = false;
    }
}

/// An empty list, which the next step fills.
impl<const D: usize> Default for CollidingEntities<D> {
    fn default() -> Self {
        Self { entities: Vec::new(), is_filled: false, world: PhantomData }
    }
}

/// Lists with equal entities are equal, whether or not a step has filled them.
impl<const D: usize, W: WorldKey> PartialEq for CollidingEntities<D, W> {
    fn eq(&self, other: &Self) -> bool {
        self.entities == other.entities
    }
}

/// The order of lists of entities: by index, then by generation. The order of [`Entity`] itself differs, since Bevy
/// chose it for speed.
pub(crate) fn rank(entity: &Entity) -> (u32, u32) {
    (entity.index_u32(), entity.generation().to_bits())
}

impl<const D: usize, W: WorldKey> CollidingEntities<D, W> {
    /// Returns an empty list for the world of another key.
    #[must_use]
    pub fn in_world<V: WorldKey>(self) -> CollidingEntities<D, V> {
        CollidingEntities { entities: Vec::new(), is_filled: false, world: PhantomData }
    }

    /// Whether an entity is in the list. Costs O(log n).
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
