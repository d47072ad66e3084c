//! The state of an entity: its object, and the components that were last read.

use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::hierarchy::ChildOf;
use bevy_ecs::prelude::{Entity, Has, Ref};
use bevy_ecs::query::QueryData;
use bevy_transform::components::{GlobalTransform, Transform};
use impinge::math::Vector;
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactQuery, GeometricQueryType, ProximityQuery,
};
use impinge::shape::ShapeHandle;

use crate::glam::{Glam, Isometry, Placement, kept_scale};
use crate::{
    Collider, ColliderError, CollisionLayers, Collisions, FixedCollider, Sensor, WorldKey,
};

/// The object of an entity, with the pose and scale that were last set.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Body<const D: usize>
where
    f32: Glam<D>,
{
    pub(crate) handle: CollisionObjectHandle,
    isometry: Isometry<D>,
    scale: Vector<f32, D>,
}

/// The transform of an entity.
#[derive(QueryData)]
pub(crate) struct Whereabouts {
    transform: &'static Transform,
    global: &'static GlobalTransform,
    has_parent: Has<ChildOf>,
}

impl WhereaboutsItem<'_, '_> {
    /// Returns the pose and scale. For an entity without a parent they are exact copies, otherwise
    /// they have rounding errors.
    #[inline]
    fn placement<const D: usize>(&self) -> Result<Placement<D>, ColliderError>
    where
        f32: Glam<D>,
    {
        if self.has_parent {
            f32::place_child(self.global)
        } else {
            f32::place_root(self.transform)
        }
    }
}

/// The components of an entity that the plugin reads.
#[derive(QueryData)]
pub(crate) struct Everything<const D: usize, W: WorldKey>
where
    f32: Glam<D>,
{
    entity: Entity,
    collider: Ref<'static, Collider<D, W>>,
    whereabouts: Whereabouts,
    layers: Option<&'static CollisionLayers>,
    is_sensor: Has<Sensor>,
    is_fixed: Has<FixedCollider>,
}

impl<const D: usize, W: WorldKey> Collisions<D, W>
where
    f32: Glam<D>,
{
    /// Moves the object of an entity of which only the transform has changed. Returns `false` if a
    /// complete refresh is needed: the entity is new, has another scale, or had or has a problem.
    #[inline]
    pub(crate) fn try_move(&mut self, entity: Entity, at: &WhereaboutsItem<'_, '_>) -> bool {
        let Some(body) = self.bodies.get_mut(&entity) else { return false };
        let Ok(placement) = at.placement::<D>() else { return false };
        if kept_scale(body.scale, placement.scale) != body.scale
            || (!self.problems.is_empty() && self.problems.contains_key(&entity))
        {
            return false;
        }
        if placement.isometry == body.isometry {
            return true;
        }
        let is_moved = self.world.try_set_position(body.handle, placement.isometry).is_ok();
        if is_moved {
            body.isometry = placement.isometry;
        }
        is_moved
    }

    /// Updates the object from all components of an entity. On an error the object is unchanged, or
    /// there is still no object.
    pub(crate) fn refresh(
        &mut self,
        entity: &EverythingItem<'_, '_, D, W>,
    ) -> Result<(), ColliderError> {
        let placement = entity.whereabouts.placement::<D>()?;
        match self.bodies.get(&entity.entity).copied() {
            Some(body) => self.change(entity, body, &placement),
            None => self.add(entity, &placement),
        }
    }

    fn add(
        &mut self,
        entity: &EverythingItem<'_, '_, D, W>,
        placement: &Placement<D>,
    ) -> Result<(), ColliderError> {
        let shape = entity.collider.scaled(&placement.scale)?;
        let groups = entity.layers.copied().unwrap_or_default().groups();
        let query = self.query_type(entity.is_sensor);
        let handle = self.world.try_add(placement.isometry, shape, groups, query, entity.entity)?;
        if entity.is_fixed {
            self.world.set_fixed(handle, true);
        }
        let Placement { isometry, scale } = *placement;
        self.bodies.insert(entity.entity, Body { handle, isometry, scale });
        Ok(())
    }

    fn change(
        &mut self,
        entity: &EverythingItem<'_, '_, D, W>,
        body: Body<D>,
        placement: &Placement<D>,
    ) -> Result<(), ColliderError> {
        let scale = kept_scale(body.scale, placement.scale);
        let is_other = scale != body.scale
            || entity.collider.is_changed()
            || self.problems.contains_key(&entity.entity);
        let shape = is_other.then(|| entity.collider.scaled(&scale)).transpose()?;
        self.world.try_set_position(body.handle, placement.isometry)?;
        self.set_properties(entity, body.handle, shape);
        let body = Body { isometry: placement.isometry, scale, ..body };
        self.bodies.insert(entity.entity, body);
        Ok(())
    }

    /// Sets the properties of an object that differ. Setting equal properties would filter and
    /// recompute its pairs again.
    fn set_properties(
        &mut self,
        entity: &EverythingItem<'_, '_, D, W>,
        handle: CollisionObjectHandle,
        shape: Option<ShapeHandle<f32, D>>,
    ) {
        if let Some(shape) = shape {
            self.world.set_shape(handle, shape);
        }
        let groups = entity.layers.copied().unwrap_or_default().groups();
        let query = self.query_type(entity.is_sensor);
        let Some(object) = self.world.collision_object(handle) else { return };
        let (has_groups, has_query) =
            (*object.collision_groups() == groups, object.query_type() == query);
        if !has_groups {
            self.world.set_collision_groups(handle, groups);
        }
        if !has_query {
            self.world.set_query_type(handle, query);
        }
        self.world.set_fixed(handle, entity.is_fixed);
    }

    fn query_type(&self, is_sensor: bool) -> GeometricQueryType<f32> {
        if is_sensor {
            ProximityQuery::default().into()
        } else {
            ContactQuery::new(self.prediction).into()
        }
    }
}
