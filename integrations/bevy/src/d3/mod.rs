//! 3D: every name with its dimension filled in, and the shapes that exist in 3D only.

mod math;
mod shapes;

pub use crate::{
    ColliderError, CollisionLayers, DefaultWorld, FixedCollider, ImpingeSystems, PairFilter,
    Sensor, SlideSettings, SpatialFilter, WorldKey,
};

/// The shape of an entity; see [`crate::Collider`].
pub type Collider<W = DefaultWorld> = crate::Collider<3, W>;
/// The world of collisions, a resource; see [`crate::Collisions`].
pub type Collisions<W = DefaultWorld> = crate::Collisions<3, W>;
/// The plugin; see [`crate::ImpingePlugin`].
pub type ImpingePlugin<W = DefaultWorld, F = ()> = crate::ImpingePlugin<3, W, F>;
/// Two entities started touching; see [`crate::CollisionStarted`].
pub type CollisionStarted<W = DefaultWorld> = crate::CollisionStarted<3, W>;
/// Two entities stopped touching; see [`crate::CollisionEnded`].
pub type CollisionEnded<W = DefaultWorld> = crate::CollisionEnded<3, W>;
/// The entities that an entity touches; see [`crate::CollidingEntities`].
pub type CollidingEntities<W = DefaultWorld> = crate::CollidingEntities<3, W>;
/// The reason why a collider is not in the world or is outdated; see [`crate::ColliderProblem`].
pub type ColliderProblem<W = DefaultWorld> = crate::ColliderProblem<3, W>;
/// A collider is not in the world or is outdated; see [`crate::ColliderFailed`].
pub type ColliderFailed<W = DefaultWorld> = crate::ColliderFailed<3, W>;
/// Two entities in contact; see [`crate::ContactPair`].
pub type ContactPair = crate::ContactPair<3>;
/// A point of contact; see [`crate::ContactPoint`].
pub type ContactPoint = crate::ContactPoint<3>;
/// The hit of a ray; see [`crate::RayHit`].
pub type RayHit = crate::RayHit<3>;
/// The hit of a moving shape; see [`crate::ShapeHit`].
pub type ShapeHit = crate::ShapeHit<3>;
/// The nearest point of an entity; see [`crate::PointHit`].
pub type PointHit = crate::PointHit<3>;
/// A near entity; see [`crate::NearestEntity`].
pub type NearestEntity = crate::NearestEntity<3>;
/// The result of a character motion; see [`crate::Slide`].
pub type Slide = crate::Slide<3>;
/// Drawing with gizmos, a plugin; see [`crate::DebugGizmosPlugin`].
#[cfg(feature = "gizmos")]
pub type DebugGizmosPlugin<W = DefaultWorld> = crate::DebugGizmosPlugin<3, W>;
/// The drawing options, a resource; see [`crate::DebugGizmos`].
#[cfg(feature = "gizmos")]
pub type DebugGizmos<W = DefaultWorld> = crate::DebugGizmos<3, W>;

/// The names of common programs in 3D.
pub mod prelude {
    pub use super::{
        Collider, ColliderFailed, ColliderProblem, CollidingEntities, CollisionEnded,
        CollisionLayers, CollisionStarted, Collisions, FixedCollider, ImpingePlugin,
        ImpingeSystems, PairFilter, Sensor, SlideSettings, SpatialFilter,
    };
}
