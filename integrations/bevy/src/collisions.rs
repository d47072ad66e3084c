//! The world of collisions as a resource.

use core::fmt;
use core::marker::PhantomData;

use bevy_ecs::entity::EntityHashMap;
use bevy_ecs::prelude::{Entity, Resource};
use impinge::world::{CollisionObject, CollisionWorld};

use crate::body::Body;
use crate::glam::{Glam, Pose};
use crate::report::PairEvent;
use crate::{ColliderError, DefaultWorld, WorldKey};

/// The entities with colliders, and their contacts as of the last step: a resource that the plugin inserts.
///
/// Systems take `Res<Collisions>` for queries: rays, shapes, points, contacts, [`Self::move_and_slide`]. Poses are
/// those of the last [`ImpingeSystems::Follow`](crate::ImpingeSystems::Follow); pairs and contacts those of the last
/// [`ImpingeSystems::Step`](crate::ImpingeSystems::Step). An entity that was removed since is not found. The order of
/// results depends on the order of insertion alone.
///
/// ```
/// use bevy_app::prelude::*;
/// use bevy_ecs::prelude::*;
/// use bevy_impinge::d2::prelude::*;
/// use bevy_math::{Dir2, Ray2d, Vec2};
/// use bevy_transform::prelude::*;
///
/// let mut app = App::new();
/// app.add_plugins(ImpingePlugin::default().in_schedule(Update));
/// let wall = app.world_mut().spawn((Collider::rectangle(1.0, 4.0), Transform::from_xyz(5.0, 0.0, 0.0))).id();
/// app.update();
/// let collisions = app.world().resource::<Collisions>();
/// let hit = collisions.cast_ray(Ray2d::new(Vec2::ZERO, Dir2::X), 10.0, &SpatialFilter::new());
/// let hit = hit.expect("the wall is in the way");
/// assert_eq!((hit.entity, hit.distance, hit.normal), (wall, 4.5, Vec2::NEG_X));
/// ```
#[derive(Resource)]
pub struct Collisions<const D: usize, W: WorldKey = DefaultWorld>
where
    f32: Glam<D>,
{
    pub(crate) world: CollisionWorld<f32, D, Entity>,
    /// For each entity its object. Used for look-ups, never iterated.
    pub(crate) bodies: EntityHashMap<Body<D>>,
    /// For each entity with a [`ColliderProblem`](crate::ColliderProblem) its error. Used for
    /// look-ups, never iterated.
    pub(crate) problems: EntityHashMap<ColliderError>,
    /// Entities to read again although none of their components has changed.
    pub(crate) dirty: Vec<Entity>,
    /// The pairs that ended in the last step, then those that started.
    pub(crate) events: Vec<PairEvent>,
    /// The prediction of each collider; contacts of a pair exist up to twice this distance.
    pub(crate) prediction: f32,
    key: PhantomData<W>,
}

/// An object of the library's world, whose data is its entity.
pub(crate) type Object<const D: usize> = CollisionObject<f32, D, Entity>;

impl<const D: usize, W: WorldKey> Collisions<D, W>
where
    f32: Glam<D>,
{
    pub(crate) fn new(world: CollisionWorld<f32, D, Entity>, prediction: f32) -> Self {
        Self {
            world,
            bodies: EntityHashMap::default(),
            problems: EntityHashMap::default(),
            dirty: Vec::new(),
            events: Vec::new(),
            prediction,
            key: PhantomData,
        }
    }

    /// The library's world, for queries without a method here; the data of its objects are their entities.
    #[must_use]
    pub const fn world(&self) -> &CollisionWorld<f32, D, Entity> {
        &self.world
    }

    /// The number of entities in the world.
    #[must_use]
    pub fn len(&self) -> usize {
        self.world.len()
    }

    /// Whether there is no entity in the world.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.world.is_empty()
    }

    /// Whether an entity is in the world. An entity is added by the first step after the insertion
    /// of its collider, and is not in the world while it is disabled.
    #[must_use]
    pub fn contains(&self, entity: Entity) -> bool {
        self.bodies.contains_key(&entity)
    }

    /// Returns the pose of an entity in the world; `None` if it is not in the world.
    #[must_use]
    pub fn pose(&self, entity: Entity) -> Option<Pose<D>> {
        self.object(entity).map(|object| f32::pose_of(object.position()))
    }

    /// Makes the next step call the [`PairFilter`](crate::PairFilter) again for the pairs of an entity. Otherwise a
    /// filter is called once, when the boxes of two colliders begin to overlap. Does nothing if the entity is not in
    /// the world.
    pub fn refilter(&mut self, entity: Entity) {
        if let Some(body) = self.bodies.get(&entity) {
            self.world.refilter_pairs_of(body.handle);
        }
    }

    /// Makes the next step call the [`PairFilter`](crate::PairFilter) again for all pairs.
    pub fn refilter_all(&mut self) {
        self.world.refilter_pairs();
    }

    pub(crate) fn object(&self, entity: Entity) -> Option<&Object<D>> {
        self.world.collision_object(self.bodies.get(&entity)?.handle)
    }

    /// Removes an entity from the world; its pairs end at the next step. Returns `true` if it had a problem.
    pub(crate) fn forget(&mut self, entity: Entity) -> bool {
        if let Some(body) = self.bodies.remove(&entity) {
            self.world.remove(&[body.handle]);
        }
        self.problems.remove(&entity).is_some()
    }
}

impl<const D: usize, W: WorldKey> fmt::Debug for Collisions<D, W>
where
    f32: Glam<D>,
{
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Collisions").field("key", &self.key).field("world", &self.world).finish()
    }
}
