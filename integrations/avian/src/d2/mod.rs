//! 2D, for `avian2d`: type aliases with the dimension, and the shapes that exist in 2D only.

mod backend;
mod plugin;
mod queries;
mod shapes;

pub use plugin::ImpingeColliderPlugin;
pub use queries::{PointHit, ShapeCastConfig, ShapeHit, SpatialQuery};

/// The shape of an entity; see [`crate::Collider`].
pub type Collider = crate::Collider<2>;
/// A resource with the state of pairs that contain a composite; see [`crate::PairContacts`].
pub type PairContacts = crate::PairContacts<2>;
