//! Contacts of entities.

use bevy_ecs::prelude::Entity;
use impinge::narrow_phase::{CollisionObjectHandle, ContactPair as PairOfObjects};
use impinge::query::{ManifoldView, Proximity};

use crate::collisions::Object;
use crate::glam::{Glam, Vec_};
use crate::{Collisions, WorldKey};

/// A point of contact, in the global frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint<const D: usize>
where
    f32: Glam<D>,
{
    /// The point on the surface of the entity.
    pub point: Vec_<D>,
    /// The point on the surface of the other entity.
    pub other_point: Vec_<D>,
    /// The penetration depth: zero if the entities touch, minus the distance if they are apart,
    /// which happens only with a prediction.
    pub depth: f32,
}

/// Two entities in contact along one normal. A pair with a composite shape, such as a mesh, may
/// have several such pairs, one for each normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair<const D: usize>
where
    f32: Glam<D>,
{
    /// The entity.
    pub entity: Entity,
    /// The entity that it touches.
    pub other: Entity,
    /// The unit vector from the entity to the other.
    pub normal: Vec_<D>,
    /// The points of contact: at least one, at most two in 2D and four in 3D.
    pub points: Vec<ContactPoint<D>>,
}

impl<const D: usize> ContactPair<D>
where
    f32: Glam<D>,
{
    fn new(entities: [Entity; 2], view: ManifoldView<'_, f32, D>) -> Self {
        let [entity, other] = entities;
        let normal = f32::vec(&view.normal());
        let points = view.contacts().map(|point| ContactPoint {
            point: f32::vec(&point.contact.world1.coords),
            other_point: f32::vec(&point.contact.world2.coords),
            depth: point.contact.depth,
        });
        Self { entity, other, normal, points: points.collect() }
    }

    fn flipped(self) -> Self {
        let flip = |point: ContactPoint<D>| ContactPoint {
            point: point.other_point,
            other_point: point.point,
            ..point
        };
        Self {
            entity: self.other,
            other: self.entity,
            normal: f32::vec(&-f32::vector(self.normal)),
            points: self.points.into_iter().map(flip).collect(),
        }
    }

    /// The depth of the deepest point.
    #[must_use]
    pub fn depth(&self) -> f32 {
        self.points.iter().fold(f32::NEG_INFINITY, |deepest, point| deepest.max(point.depth))
    }
}

/// Pairs, as of the last step.
impl<const D: usize, W: WorldKey> Collisions<D, W>
where
    f32: Glam<D>,
{
    /// Returns all contacts, in the order in which the colliders were added; sensors have none. `entity` of a pair is
    /// the one that was added first.
    pub fn contact_pairs(&self) -> impl Iterator<Item = ContactPair<D>> {
        let views = self.world.contact_views();
        views.map(|(one, other, view)| ContactPair::new([*one.data(), *other.data()], view))
    }

    /// Returns the contacts of an entity, with normals that point away from it; none if it is not in the world.
    pub fn contacts_with(&self, entity: Entity) -> impl Iterator<Item = ContactPair<D>> {
        let handle = self.bodies.get(&entity).map(|body| body.handle);
        handle.into_iter().flat_map(move |handle| {
            let others = self.world.pairs_with(handle);
            others.flat_map(move |other| self.contacts_between((entity, handle), other))
        })
    }

    /// Returns the contacts of an entity with an object, with normals that point away from the entity.
    fn contacts_between(
        &self,
        (entity, handle): (Entity, CollisionObjectHandle),
        other: &Object<D>,
    ) -> impl Iterator<Item = ContactPair<D>> {
        let views = self.world.contact_pair(handle, other.handle()).map(PairOfObjects::views);
        let (other, is_second) = (*other.data(), other.handle() < handle);
        views.into_iter().flatten().map(move |view| match is_second {
            false => ContactPair::new([entity, other], view),
            true => ContactPair::new([other, entity], view).flipped(),
        })
    }

    /// Returns the entities that an entity touches, including sensors, as
    /// [`CollidingEntities`](crate::CollidingEntities) has them. Empty if it is not in the world.
    #[must_use]
    pub fn touching(&self, entity: Entity) -> Vec<Entity> {
        let Some(body) = self.bodies.get(&entity) else { return Vec::new() };
        let pairs = self.world.pairs_with(body.handle).map(|other| *other.data());
        pairs.filter(|&other| self.are_touching(entity, other)).collect()
    }

    /// Whether two entities touch; if one is a sensor, whether they overlap or touch.
    #[must_use]
    pub fn are_touching(&self, one: Entity, other: Entity) -> bool {
        let (Some(one), Some(other)) = (self.bodies.get(&one), self.bodies.get(&other)) else {
            return false;
        };
        let (one, other) = (one.handle, other.handle);
        let contacts = self.world.contact_pair(one, other);
        let proximity = self.world.proximity_pair(one, other);
        contacts.is_some_and(|pair| pair.views().next().is_some())
            || proximity.is_some_and(|pair| pair.proximity() == Proximity::Intersecting)
    }
}
