//! 3D, for `avian3d`: type aliases with the dimension, and the shapes that exist in 3D only.

mod backend;
mod plugin;
mod queries;
mod shapes;

pub use plugin::ImpingeColliderPlugin;
pub use queries::{PointHit, ShapeCastConfig, ShapeHit, SpatialQuery};

/// The shape of an entity; see [`crate::Collider`].
pub type Collider = crate::Collider<3>;
/// A resource with the state of pairs that contain a composite; see [`crate::PairContacts`].
pub type PairContacts = crate::PairContacts<3>;
