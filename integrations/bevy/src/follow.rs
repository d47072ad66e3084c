//! Updates the world from entities that were inserted, changed, moved or disabled.

use core::marker::PhantomData;
use core::mem::{discriminant, take};

use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::lifecycle::{Add, Remove};
use bevy_ecs::prelude::{
    Changed, Commands, Component, Entity, MessageWriter, On, Or, Query, ResMut, With,
};
use bevy_transform::components::{GlobalTransform, Transform};

use crate::body::{Everything, Whereabouts};
use crate::events::rank;
use crate::glam::Glam;
use crate::{
    Collider, ColliderError, ColliderFailed, ColliderProblem, CollisionLayers, Collisions,
    FixedCollider, Sensor, WorldKey,
};

type IsChanged<const D: usize, W> = Or<(
    Changed<Collider<D, W>>,
    Changed<CollisionLayers>,
    Changed<Sensor>,
    Changed<FixedCollider>,
)>;
type IsMoved = Or<(Changed<Transform>, Changed<GlobalTransform>, Changed<ChildOf>)>;

/// Updates the objects of the world from their entities: first those that only moved, then all others in ascending
/// order of their indices. So the order of objects does not depend on archetypes.
pub(crate) fn follow<const D: usize, W: WorldKey>(
    mut collisions: ResMut<'_, Collisions<D, W>>,
    moved: Query<'_, '_, (Entity, Whereabouts), (With<Collider<D, W>>, IsMoved)>,
    changed: Query<'_, '_, Entity, (With<Collider<D, W>>, IsChanged<D, W>)>,
    entities: Query<'_, '_, Everything<D, W>>,
    mut failures: Failures<'_, '_, D, W>,
) where
    f32: Glam<D>,
{
    let collisions = &mut *collisions;
    let mut dirty = take(&mut collisions.dirty);
    for (entity, whereabouts) in &moved {
        if !collisions.try_move(entity, &whereabouts) {
            dirty.push(entity);
        }
    }
    dirty.extend(&changed);
    dirty.sort_unstable_by_key(rank);
    dirty.dedup();
    for entity in dirty.drain(..) {
        // An entity that is despawned or disabled is no longer in the world.
        if let Ok(item) = entities.get(entity) {
            let result = collisions.refresh(&item);
            failures.note(collisions, entity, result);
        }
    }
    collisions.dirty = dirty;
}

/// The outputs for problems.
#[derive(bevy_ecs::system::SystemParam)]
pub(crate) struct Failures<'w, 's, const D: usize, W: WorldKey> {
    commands: Commands<'w, 's>,
    messages: MessageWriter<'w, ColliderFailed<D, W>>,
}

impl<const D: usize, W: WorldKey> Failures<'_, '_, D, W>
where
    f32: Glam<D>,
{
    /// Reports a problem that begins, ends, or changes to another kind of error.
    fn note(
        &mut self,
        collisions: &mut Collisions<D, W>,
        entity: Entity,
        result: Result<(), ColliderError>,
    ) {
        let Err(error) = result else {
            if !collisions.problems.is_empty() && collisions.problems.remove(&entity).is_some() {
                self.commands.entity(entity).try_remove::<ColliderProblem<D, W>>();
            }
            return;
        };
        let old = collisions.problems.insert(entity, error);
        if old.is_some_and(|old| discriminant(&old) == discriminant(&error)) {
            return;
        }
        log::error!("the collider of {entity} is not followed: {error}");
        let world = PhantomData;
        self.commands.entity(entity).try_insert(ColliderProblem::<D, W> { error, world });
        self.messages.write(ColliderFailed { entity, error, world });
    }
}

/// Removes the object of a disabled entity from the world, and its problem from the entity.
pub(crate) fn forget_disabled<const D: usize, W: WorldKey>(
    disabled: On<'_, '_, Add, Disabled>,
    collisions: Option<ResMut<'_, Collisions<D, W>>>,
    mut commands: Commands<'_, '_>,
) where
    f32: Glam<D>,
{
    if collisions.is_some_and(|mut all| all.forget(disabled.entity)) {
        commands.entity(disabled.entity).try_remove::<ColliderProblem<D, W>>();
    }
}

/// Marks an entity that loses a component as dirty. Change detection does not detect a removal, and
/// messages of removal are dropped if frames are more frequent than steps.
pub(crate) fn notice_removal<C: Component, const D: usize, W: WorldKey>(
    removed: On<'_, '_, Remove, C>,
    collisions: Option<ResMut<'_, Collisions<D, W>>>,
) where
    f32: Glam<D>,
{
    if let Some(mut collisions) = collisions {
        collisions.dirty.push(removed.entity);
    }
}

/// Marks an entity that lost its parent as dirty: its pose is then that of its own transform,
/// whether or not its global transform was recomputed.
pub(crate) fn notice_orphan<const D: usize, W: WorldKey>(
    removed: On<'_, '_, Remove, ChildOf>,
    collisions: Option<ResMut<'_, Collisions<D, W>>>,
) where
    f32: Glam<D>,
{
    if let Some(mut collisions) = collisions
        && collisions.contains(removed.entity)
    {
        collisions.dirty.push(removed.entity);
    }
}
