//! 3D, for `avian3d`: every name with its dimension filled in, and the shapes that 3D alone has.

mod backend;
mod plugin;
mod queries;
mod shapes;

pub use plugin::ImpingeColliderPlugin;
pub use queries::{PointHit, ShapeCastConfig, ShapeHit, SpatialQuery};

/// The shape of an entity; see [`crate::Collider`].
pub type Collider = crate::Collider<3>;
/// The state of pairs with a composite, a resource; see [`crate::PairContacts`].
pub type PairContacts = crate::PairContacts<3>;
