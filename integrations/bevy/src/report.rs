//! Updates the world and reports its changes to entities.

use core::marker::PhantomData;

use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::event::Event;
use bevy_ecs::prelude::{Entity, MessageWriter, Query, Res, ResMut, World};
use bevy_ecs::query::Allow;
use bevy_ecs::system::StaticSystemParam;
use impinge::narrow_phase::{CollisionObjectHandle, ContactEvent};
use impinge::query::Proximity;

use crate::events::rank;
use crate::glam::Glam;
use crate::{
    CollidingEntities, CollisionEnded, CollisionStarted, Collisions, PairFilter, WorldKey,
};

/// The start or end of a pair in the last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PairEvent {
    is_start: bool,
    entity: Entity,
    other: Entity,
    is_sensor: bool,
}

/// Updates the world.
pub(crate) fn step<const D: usize, W: WorldKey, F: PairFilter + 'static>(
    mut collisions: ResMut<'_, Collisions<D, W>>,
    filter: StaticSystemParam<'_, '_, F>,
) where
    f32: Glam<D>,
{
    let mut filter = filter.into_inner();
    let collisions = &mut *collisions;
    collisions
        .world
        .update_with(&mut |one, other| F::allows(&mut filter, *one.data(), *other.data()));
    collisions.read_events();
}

impl<const D: usize, W: WorldKey> Collisions<D, W>
where
    f32: Glam<D>,
{
    /// Lists the pairs that ended, then the pairs that started. A pair that changes between contact
    /// and proximity is in both lists.
    fn read_events(&mut self) {
        let mut events = core::mem::take(&mut self.events);
        events.clear();
        for is_start in [false, true] {
            let contacts = self.world.contact_events().iter();
            events.extend(contacts.filter_map(|event| self.contact_event(event, is_start)));
            for event in self.world.proximity_events() {
                let was = event.prev_status == Proximity::Intersecting;
                let is = event.new_status == Proximity::Intersecting;
                if was != is && is == is_start {
                    events.extend(self.pair(event.collider1, event.collider2, is_start, true));
                }
            }
        }
        self.events = events;
    }

    fn contact_event(&self, event: &ContactEvent, is_start: bool) -> Option<PairEvent> {
        let (one, other) = event.handles();
        let is_wanted = matches!(event, ContactEvent::Started(..)) == is_start;
        is_wanted.then(|| self.pair(one, other, is_start, false))?
    }

    fn pair(
        &self,
        one: CollisionObjectHandle,
        other: CollisionObjectHandle,
        is_start: bool,
        is_sensor: bool,
    ) -> Option<PairEvent> {
        let (entity, other) = (self.entity_of(one)?, self.entity_of(other)?);
        Some(PairEvent { is_start, entity, other, is_sensor })
    }

    /// Returns the entity of an object. The object may be removed already if an event of the last
    /// step names it.
    fn entity_of(&self, handle: CollisionObjectHandle) -> Option<Entity> {
        let object = self.world.collision_object(handle);
        object.or_else(|| self.world.removed_object(handle)).map(|object| *object.data())
    }
}

/// Writes the messages and updates [`CollidingEntities`].
pub(crate) fn report<const D: usize, W: WorldKey>(
    collisions: Res<'_, Collisions<D, W>>,
    mut started: MessageWriter<'_, CollisionStarted<D, W>>,
    mut ended: MessageWriter<'_, CollisionEnded<D, W>>,
    mut touched: Query<'_, '_, &mut CollidingEntities<D, W>, Allow<Disabled>>,
) where
    f32: Glam<D>,
{
    let has_touched = !touched.is_empty();
    for &PairEvent { is_start, entity, other, is_sensor } in &collisions.events {
        let world = PhantomData;
        if is_start {
            started.write(CollisionStarted { entity, other, is_sensor, world });
        } else {
            ended.write(CollisionEnded { entity, other, is_sensor, world });
        }
        if !has_touched {
            continue;
        }
        for (entity, other) in [(entity, other), (other, entity)] {
            if let Ok(mut list) = touched.get_mut(entity) {
                if is_start { list.insert(other) } else { list.remove(other) }
            }
        }
    }
}

/// Fills [`CollidingEntities`] that were inserted or replaced since the last step.
pub(crate) fn fill_colliding<const D: usize, W: WorldKey>(
    collisions: Res<'_, Collisions<D, W>>,
    mut touched: Query<'_, '_, (Entity, &mut CollidingEntities<D, W>)>,
) where
    f32: Glam<D>,
{
    for (entity, mut list) in &mut touched {
        if !list.is_filled {
            list.is_filled = true;
            list.entities = collisions.touching(entity);
            list.entities.sort_unstable_by_key(rank);
        }
    }
}

/// Triggers the events of the last step for observers, each pair for both of its entities.
pub(crate) fn trigger<const D: usize, W: WorldKey>(world: &mut World)
where
    f32: Glam<D>,
{
    let (for_ended, for_started) = (
        has_observers::<CollisionEnded<D, W>>(world),
        has_observers::<CollisionStarted<D, W>>(world),
    );
    if !for_ended && !for_started {
        return;
    }
    let events = world.resource::<Collisions<D, W>>().events.clone();
    for PairEvent { is_start, entity, other, is_sensor } in events {
        for (entity, other) in [(entity, other), (other, entity)] {
            let key = PhantomData;
            if is_start && for_started {
                world.trigger(CollisionStarted::<D, W> { entity, other, is_sensor, world: key });
            } else if !is_start && for_ended {
                world.trigger(CollisionEnded::<D, W> { entity, other, is_sensor, world: key });
            }
        }
    }
}

/// Whether there are observers of an event.
fn has_observers<E: Event>(world: &World) -> bool {
    let key = world.event_key::<E>();
    key.and_then(|key| world.observers().try_get_observers(key)).is_some_and(|observers| {
        !observers.global_observers().is_empty() || !observers.entity_observers().is_empty()
    })
}
