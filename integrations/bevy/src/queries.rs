//! Queries about all entities of a world: rays, points, shapes at rest and in motion.

use core::fmt;

use bevy_ecs::prelude::Entity;
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::{ClosestPoints, Impact, ImpactOptions, RayIntersection};
use impinge::shape::ShapeHandle;
use impinge::world::{NearObject, QueryFilter};

use crate::collider::point;
use crate::collisions::Object;
use crate::glam::{Glam, Pose, Vec_};
use crate::{Collider, CollisionLayers, Collisions, WorldKey};

/// The entities that a query considers: all, unless some are excluded.
///
/// ```
/// use bevy_ecs::prelude::*;
/// use bevy_impinge::{CollisionLayers, SpatialFilter};
///
/// let is_enemy = |entity: Entity| entity != Entity::PLACEHOLDER;
/// let walls = CollisionLayers::new(CollisionLayers::ALL, 1 << 3);
/// let filter = SpatialFilter::new().layers(walls).without_sensors().predicate(&is_enemy);
/// # let _ = filter;
/// ```
#[derive(Clone, Default)]
pub struct SpatialFilter<'a> {
    layers: Option<CollisionLayers>,
    excluded: Vec<Entity>,
    skips_sensors: bool,
    predicate: Option<&'a dyn Fn(Entity) -> bool>,
}

impl<'a> SpatialFilter<'a> {
    /// Creates a filter that considers all entities.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Considers only entities that may interact with a collider with these `layers`.
    #[must_use]
    pub fn layers(self, layers: CollisionLayers) -> Self {
        Self { layers: Some(layers), ..self }
    }

    /// Excludes an entity, for instance the one that runs the query. Earlier exclusions remain.
    #[must_use]
    pub fn exclude(mut self, entity: Entity) -> Self {
        self.excluded.push(entity);
        self
    }

    /// Excludes sensors.
    #[must_use]
    pub fn without_sensors(self) -> Self {
        Self { skips_sensors: true, ..self }
    }

    /// Considers only entities that satisfy `predicate`, which replaces an earlier predicate.
    #[must_use]
    pub fn predicate(self, predicate: &'a dyn Fn(Entity) -> bool) -> Self {
        Self { predicate: Some(predicate), ..self }
    }

    fn accepts<const D: usize>(&self, object: &Object<D>) -> bool
    where
        f32: Glam<D>,
    {
        let is_sensor = || matches!(object.query_type(), GeometricQueryType::Proximity(_));
        if self.excluded.contains(object.data()) || (self.skips_sensors && is_sensor()) {
            return false;
        }
        self.predicate.is_none_or(|predicate| predicate(*object.data()))
    }

    /// Runs a query with the equivalent filter of the library.
    pub(crate) fn ask<const D: usize, A>(
        &self,
        question: impl FnOnce(&QueryFilter<'_, f32, D, Entity>) -> A,
    ) -> A
    where
        f32: Glam<D>,
    {
        let predicate = |object: &Object<D>| self.accepts(object);
        let mut filter = QueryFilter::new().predicate(&predicate);
        if let Some(layers) = self.layers {
            filter = filter.groups(layers.groups());
        }
        question(&filter)
    }
}

impl fmt::Debug for SpatialFilter<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SpatialFilter")
            .field("layers", &self.layers)
            .field("excluded", &self.excluded)
            .field("skips_sensors", &self.skips_sensors)
            .finish_non_exhaustive()
    }
}

/// The hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit<const D: usize>
where
    f32: Glam<D>,
{
    /// The entity.
    pub entity: Entity,
    /// The distance from the origin of the ray; zero if the ray starts inside the collider.
    pub distance: f32,
    /// The point that was hit.
    pub point: Vec_<D>,
    /// The outward unit normal of the collider; zero if the ray starts inside it.
    pub normal: Vec_<D>,
}

/// The hit of a moving shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit<const D: usize>
where
    f32: Glam<D>,
{
    /// The entity.
    pub entity: Entity,
    /// The fraction of the motion that is possible, from 0 to 1.
    pub fraction: f32,
    /// The point on the surface of the entity.
    pub point: Vec_<D>,
    /// The unit vector from the entity to the moving shape.
    pub normal: Vec_<D>,
}

/// The nearest point of an entity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointHit<const D: usize>
where
    f32: Glam<D>,
{
    /// The entity.
    pub entity: Entity,
    /// The point of the entity that is nearest to the query point.
    pub point: Vec_<D>,
    /// The distance between the query point and `point`; zero if the query point is inside.
    pub distance: f32,
    /// `true` if the query point lies in the collider or on its surface.
    pub is_inside: bool,
}

/// An entity near a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestEntity<const D: usize>
where
    f32: Glam<D>,
{
    /// The entity.
    pub entity: Entity,
    /// The distance between the entity and the shape; zero if they touch or overlap.
    pub distance: f32,
    /// The closest points, first on the query shape, then on the entity; `None` if the entity and
    /// the shape overlap.
    pub points: Option<[Vec_<D>; 2]>,
}

/// Queries about all entities. A shape with an error, and a pose or point that is not finite, have no hits.
impl<const D: usize, W: WorldKey> Collisions<D, W>
where
    f32: Glam<D>,
{
    /// Returns the first hit of a ray within `max_distance`; among hits at the same distance, the
    /// hit of the entity that was added first. Colliders are solid: a ray that starts inside a
    /// collider hits it at distance 0. Costs a search of a tree.
    #[must_use]
    pub fn cast_ray(
        &self,
        ray: <f32 as Glam<D>>::Ray,
        max_distance: f32,
        filter: &SpatialFilter<'_>,
    ) -> Option<RayHit<D>> {
        let ray = f32::ray(&ray);
        let (object, hit) =
            filter.ask(|filter| self.world.first_ray_hit(&ray, max_distance, true, filter))?;
        Some(ray_hit(*object.data(), &ray, &hit))
    }

    /// Returns all hits of a ray, nearest first, each entity once.
    #[must_use]
    pub fn cast_ray_all(
        &self,
        ray: <f32 as Glam<D>>::Ray,
        max_distance: f32,
        filter: &SpatialFilter<'_>,
    ) -> Vec<RayHit<D>> {
        let ray = f32::ray(&ray);
        let hits = filter.ask(|filter| self.world.ray_hits(&ray, max_distance, true, filter));
        hits.into_iter().map(|(object, hit)| ray_hit(*object.data(), &ray, &hit)).collect()
    }

    /// Returns the first hit of a shape that moves straight by `motion` without rotating. A contact
    /// at the start counts only if the motion leads deeper into the entity.
    #[must_use]
    pub fn cast_shape<V: WorldKey>(
        &self,
        shape: &Collider<D, V>,
        pose: impl Into<Pose<D>>,
        motion: Vec_<D>,
        filter: &SpatialFilter<'_>,
    ) -> Option<ShapeHit<D>> {
        self.cast_with_skin(shape.shape().ok()?, &pose.into(), motion, 0.0, filter)
    }

    /// Casts like [`Self::cast_shape`], but counts a distance of `skin` as touching.
    pub(crate) fn cast_with_skin(
        &self,
        shape: &ShapeHandle<f32, D>,
        pose: &Pose<D>,
        motion: Vec_<D>,
        skin: f32,
        filter: &SpatialFilter<'_>,
    ) -> Option<ShapeHit<D>> {
        let options = ImpactOptions::new().with_max_time(1.0).with_target_distance(skin);
        let (position, motion) = (f32::isometry_of(pose), f32::vector(motion));
        let (object, impact) = filter
            .ask(|filter| self.world.cast_shape(&position, &motion, &**shape, &options, filter))?;
        Some(shape_hit(*object.data(), &impact))
    }

    /// Returns all hits of a shape along its path, nearest first, each entity once. A hit does not
    /// stop the shape.
    #[must_use]
    pub fn cast_shape_all<V: WorldKey>(
        &self,
        shape: &Collider<D, V>,
        pose: impl Into<Pose<D>>,
        motion: Vec_<D>,
        filter: &SpatialFilter<'_>,
    ) -> Vec<ShapeHit<D>> {
        let Ok(shape) = shape.shape() else { return Vec::new() };
        let options = ImpactOptions::new().with_max_time(1.0);
        let (position, motion) = (f32::isometry_of(&pose.into()), f32::vector(motion));
        let hits = filter.ask(|filter| {
            self.world.cast_shape_all(&position, &motion, &**shape, &options, filter)
        });
        hits.into_iter().map(|(object, impact)| shape_hit(*object.data(), &impact)).collect()
    }

    /// Returns the entities that contain a point, surface included.
    #[must_use]
    pub fn entities_at(&self, at: Vec_<D>, filter: &SpatialFilter<'_>) -> Vec<Entity> {
        filter.ask(|filter| {
            let objects = self.world.objects_containing(&point::<D>(at), filter);
            objects.map(|object| *object.data()).collect()
        })
    }

    /// Returns the entities that touch or overlap a shape.
    #[must_use]
    pub fn overlapping<V: WorldKey>(
        &self,
        shape: &Collider<D, V>,
        pose: impl Into<Pose<D>>,
        filter: &SpatialFilter<'_>,
    ) -> Vec<Entity> {
        let Ok(shape) = shape.shape() else { return Vec::new() };
        let position = f32::isometry_of(&pose.into());
        filter.ask(|filter| {
            let objects = self.world.objects_overlapping(&position, &**shape, filter);
            objects.map(|object| *object.data()).collect()
        })
    }

    /// Whether any entity touches or overlaps a shape. The search ends at the first such entity.
    #[must_use]
    pub fn overlaps_any<V: WorldKey>(
        &self,
        shape: &Collider<D, V>,
        pose: impl Into<Pose<D>>,
        filter: &SpatialFilter<'_>,
    ) -> bool {
        let Ok(shape) = shape.shape() else { return false };
        let position = f32::isometry_of(&pose.into());
        filter.ask(|filter| self.world.overlaps_any(&position, &**shape, filter))
    }

    /// Returns the nearest point of any entity within `max_distance`. A point in a collider is its own nearest point.
    #[must_use]
    pub fn nearest_point(
        &self,
        to: Vec_<D>,
        max_distance: f32,
        filter: &SpatialFilter<'_>,
    ) -> Option<PointHit<D>> {
        let to = point::<D>(to);
        let (object, found) =
            filter.ask(|filter| self.world.project_point(&to, max_distance, true, filter))?;
        let distance = if found.is_inside { 0.0 } else { (found.point - to).norm() };
        Some(PointHit {
            entity: *object.data(),
            point: f32::vec(&found.point.coords),
            distance,
            is_inside: found.is_inside,
        })
    }

    /// Returns the `count` entities nearest to a shape within `max_distance`, nearest first.
    #[must_use]
    pub fn nearest_entities<V: WorldKey>(
        &self,
        shape: &Collider<D, V>,
        pose: impl Into<Pose<D>>,
        (count, max_distance): (usize, f32),
        filter: &SpatialFilter<'_>,
    ) -> Vec<NearestEntity<D>> {
        let Ok(shape) = shape.shape() else { return Vec::new() };
        let position = f32::isometry_of(&pose.into());
        let found = filter.ask(|filter| {
            self.world.nearest_objects(&position, &**shape, count, max_distance, filter)
        });
        found.iter().map(nearest_entity).collect()
    }
}

fn ray_hit<const D: usize>(
    entity: Entity,
    ray: &impinge::query::Ray<f32, D>,
    hit: &RayIntersection<f32, D>,
) -> RayHit<D>
where
    f32: Glam<D>,
{
    let (point, normal) = (f32::vec(&ray.point_at(hit.toi).coords), f32::vec(&hit.normal));
    RayHit { entity, distance: hit.toi, point, normal }
}

fn shape_hit<const D: usize>(entity: Entity, impact: &Impact<f32, D>) -> ShapeHit<D>
where
    f32: Glam<D>,
{
    ShapeHit {
        entity,
        fraction: impact.toi,
        point: f32::vec(&impact.world2.coords),
        normal: f32::vec(&-impact.normal.into_inner()),
    }
}

fn nearest_entity<const D: usize>(near: &NearObject<'_, f32, D, Entity>) -> NearestEntity<D>
where
    f32: Glam<D>,
{
    let points = match near.points {
        ClosestPoints::WithinMargin(one, other) => {
            Some([f32::vec(&one.coords), f32::vec(&other.coords)])
        }
        _ => None,
    };
    NearestEntity { entity: *near.object.data(), distance: near.distance, points }
}
