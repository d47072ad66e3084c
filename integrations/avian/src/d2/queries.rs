//! Spatial queries over Avian's trees of colliders.

use avian2d::collider_tree::{ColliderTree, ColliderTrees, ProxyId};
use avian2d::prelude::{Position, RayHitData, Rotation, SpatialQueryFilter};
use bevy_ecs::prelude::*;
use bevy_ecs::system::SystemParam;
use bevy_impinge::Glam;
use bevy_math::{Dir2, Ray2d, Vec2};
use impinge::dim2::math::Isometry;
use impinge::dim2::query::{ImpactOptions, Moving, Proximity, impact, proximity};

use super::Collider;
use super::backend::isometry;

/// Rays, shape casts, overlaps and nearest points: Avian's `SpatialQuery` for these colliders. The
/// methods have the names and arguments of Avian's type, which works for Avian's own colliders
/// only.
///
/// Results are those of the last step, in which Avian updates its trees.
#[derive(SystemParam)]
#[expect(missing_debug_implementations, reason = "Avian's trees have none")]
pub struct SpatialQuery<'w, 's> {
    colliders: Query<'w, 's, (&'static Position, &'static Rotation, &'static Collider)>,
    trees: Res<'w, ColliderTrees>,
}

/// Options of a shape cast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeCastConfig {
    /// The maximum distance of the motion; `f32::MAX` by default.
    pub max_distance: f32,
    /// The distance at which the shapes count as touching; zero by default.
    pub target_distance: f32,
    /// If `true`, a collider that the shape overlaps at the start is hit only if the motion leads
    /// deeper into it. If `false`, the default, it is hit at distance 0.
    pub ignore_origin_penetration: bool,
}

impl Default for ShapeCastConfig {
    fn default() -> Self {
        Self { max_distance: f32::MAX, target_distance: 0.0, ignore_origin_penetration: false }
    }
}

/// The first hit of a shape cast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// The collider that was hit.
    pub entity: Entity,
    /// The distance that the shape moves until the hit.
    pub distance: f32,
    /// The hit point on the collider, in the global frame.
    pub point1: Vec2,
    /// The hit point on the cast shape, in the global frame.
    pub point2: Vec2,
    /// The outward unit normal of the hit collider.
    pub normal1: Vec2,
    /// The outward unit normal of the cast shape: `-normal1`.
    pub normal2: Vec2,
}

/// The nearest point of a collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointHit {
    /// The collider.
    pub entity: Entity,
    /// The nearest point of the collider, in the global frame.
    pub point: Vec2,
    /// `true` if the query point is inside the collider.
    pub is_inside: bool,
}

impl SpatialQuery<'_, '_> {
    /// Returns the first hit of a ray within `max_distance`. If `solid` is `true`, a ray that
    /// starts inside a collider hits it at distance 0; otherwise the ray hits the surface where it
    /// leaves the collider.
    #[must_use]
    pub fn cast_ray(
        &self,
        origin: Vec2,
        direction: Dir2,
        max_distance: f32,
        solid: bool,
        filter: &SpatialQueryFilter,
    ) -> Option<RayHitData> {
        self.cast_ray_predicate(origin, direction, max_distance, solid, filter, &|_| true)
    }

    /// Returns the first hit of a ray within `max_distance` on a collider that the predicate
    /// accepts.
    #[must_use]
    pub fn cast_ray_predicate(
        &self,
        origin: Vec2,
        direction: Dir2,
        max_distance: f32,
        solid: bool,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Option<RayHitData> {
        let (mut nearest, mut best) = (None, max_distance);
        for tree in self.trees.iter_trees() {
            tree.ray_traverse_closest(Ray2d::new(origin, direction), best, |proxy| {
                let met = self.placed(tree, proxy, filter).filter(|met| predicate(met.entity));
                let hit = met.and_then(|met| met.ray_hit([origin, *direction], best, solid));
                let Some(hit) = hit else { return f32::MAX };
                if nearest.is_none() || hit.distance < best {
                    (nearest, best) = (Some(hit), hit.distance);
                }
                hit.distance
            });
        }
        nearest
    }

    /// Returns the hits of a ray within `max_distance`, one for each collider, nearest first; at
    /// most `max_hits`.
    #[must_use]
    pub fn ray_hits(
        &self,
        origin: Vec2,
        direction: Dir2,
        max_distance: f32,
        max_hits: u32,
        solid: bool,
        filter: &SpatialQueryFilter,
    ) -> Vec<RayHitData> {
        let mut hits = Vec::new();
        for tree in self.trees.iter_trees() {
            tree.ray_traverse_all(Ray2d::new(origin, direction), max_distance, |proxy| {
                let met = self.placed(tree, proxy, filter);
                let ray = [origin, *direction];
                hits.extend(met.and_then(|met| met.ray_hit(ray, max_distance, solid)));
                true
            });
        }
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance).then(a.entity.cmp(&b.entity)));
        hits.truncate(max_hits as usize);
        hits
    }

    /// Returns the first hit of a moving shape; `None` if nothing is hit or the shape has an error.
    #[must_use]
    pub fn cast_shape(
        &self,
        shape: &Collider,
        origin: Vec2,
        shape_rotation: f32,
        direction: Dir2,
        config: &ShapeCastConfig,
        filter: &SpatialQueryFilter,
    ) -> Option<ShapeHit> {
        let solid = shape.shape_scaled().ok()?;
        let pose = isometry(origin, shape_rotation.into());
        let moving = Moving::new(&pose, &f32::vector(*direction), &**solid);
        let options = ImpactOptions::new()
            .with_target_distance(config.target_distance)
            .with_contact_at_start(!config.ignore_origin_penetration);
        let (mut nearest, mut best) = (None, config.max_distance);
        for tree in self.trees.iter_trees() {
            let aabb = shape.aabb(origin, shape_rotation).into();
            let target = config.target_distance;
            tree.sweep_traverse_closest(aabb, direction, best, target, |proxy| {
                let met = self.placed(tree, proxy, filter);
                let hit = met.and_then(|met| met.shape_hit(&moving, &options.with_max_time(best)));
                let Some(hit) = hit else { return f32::MAX };
                if nearest.is_none() || hit.distance < best {
                    (nearest, best) = (Some(hit), hit.distance);
                }
                hit.distance
            });
        }
        nearest
    }

    /// Returns the nearest point of all colliders that the filter accepts; `None` if there is no
    /// such collider. If `solid` is `true`, a point inside a collider is its own nearest point;
    /// otherwise the nearest point lies on the surface.
    #[must_use]
    pub fn project_point(
        &self,
        point: Vec2,
        solid: bool,
        filter: &SpatialQueryFilter,
    ) -> Option<PointHit> {
        let (mut nearest, mut best) = (None, f32::INFINITY);
        for tree in self.trees.iter_trees() {
            tree.squared_distance_traverse_closest(point, best, |proxy| {
                let met = self.placed(tree, proxy, filter);
                let Some(hit) = met.and_then(|met| met.nearest(point, solid)) else {
                    return f32::INFINITY;
                };
                let distance = hit.point.distance_squared(point);
                if distance < best {
                    (nearest, best) = (Some(hit), distance);
                }
                distance
            });
        }
        nearest
    }

    /// Returns the colliders that contain a point, sorted by entity.
    #[must_use]
    pub fn point_intersections(&self, point: Vec2, filter: &SpatialQueryFilter) -> Vec<Entity> {
        let mut found = Vec::new();
        for tree in self.trees.iter_trees() {
            tree.point_traverse(point, |proxy| {
                let met = self.placed(tree, proxy, filter);
                let met = met.filter(|met| met.collider.holds(&met.pose(), point));
                found.extend(met.map(|met| met.entity));
                true
            });
        }
        found.sort();
        found
    }

    /// Returns the colliders that touch or overlap a shape, sorted by entity.
    #[must_use]
    pub fn shape_intersections(
        &self,
        shape: &Collider,
        shape_position: Vec2,
        shape_rotation: f32,
        filter: &SpatialQueryFilter,
    ) -> Vec<Entity> {
        let (mut found, pose) = (Vec::new(), isometry(shape_position, shape_rotation.into()));
        for tree in self.trees.iter_trees() {
            tree.aabb_traverse(shape.aabb(shape_position, shape_rotation).into(), |proxy| {
                let met = self.placed(tree, proxy, filter);
                found.extend(met.filter(|met| met.overlaps(shape, &pose)).map(|met| met.entity));
                true
            });
        }
        found.sort();
        found
    }

    /// Returns the collider of a leaf of a tree; `None` if the filter rejects it, or if the entity
    /// no longer has a collider.
    fn placed(
        &self,
        tree: &ColliderTree,
        proxy: ProxyId,
        filter: &SpatialQueryFilter,
    ) -> Option<Met<'_>> {
        let proxy = tree.get_proxy(proxy)?;
        let entity = proxy.collider;
        if !filter.test(entity, proxy.layers) {
            return None;
        }
        let (position, rotation, collider) = self.colliders.get(entity).ok()?;
        Some(Met { entity, position: position.0, rotation: *rotation, collider })
    }
}

/// A collider that a query tests, with its pose.
struct Met<'a> {
    entity: Entity,
    position: Vec2,
    rotation: Rotation,
    collider: &'a Collider,
}

impl Met<'_> {
    fn pose(&self) -> Isometry<f32> {
        isometry(self.position, self.rotation)
    }

    fn ray_hit(&self, ray: [Vec2; 2], max_distance: f32, solid: bool) -> Option<RayHitData> {
        let (distance, normal) = self.collider.ray_hit(&self.pose(), ray, max_distance, solid)?;
        Some(RayHitData { entity: self.entity, distance, normal })
    }

    fn shape_hit(
        &self,
        moving: &Moving<'_, f32>,
        options: &ImpactOptions<f32>,
    ) -> Option<ShapeHit> {
        let still = Moving::still(&self.pose(), &**self.collider.shape_scaled().ok()?);
        let hit = impact(&still, moving, options)?;
        let normal = f32::vec(&hit.normal);
        Some(ShapeHit {
            entity: self.entity,
            distance: hit.toi,
            point1: f32::vec(&hit.world1.coords),
            point2: f32::vec(&hit.world2.coords),
            normal1: normal,
            normal2: -normal,
        })
    }

    fn nearest(&self, point: Vec2, solid: bool) -> Option<PointHit> {
        let (point, is_inside) = self.collider.nearest(&self.pose(), point, solid)?;
        Some(PointHit { entity: self.entity, point, is_inside })
    }

    fn overlaps(&self, shape: &Collider, pose: &Isometry<f32>) -> bool {
        let [Ok(own), Ok(shape)] = [self.collider, shape].map(Collider::shape_scaled) else {
            return false;
        };
        proximity(&self.pose(), &**own, pose, &**shape, 0.0) == Proximity::Intersecting
    }
}
