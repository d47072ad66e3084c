//! One object that is told, at each update, who touches whom, where, and since when.
//!
//! The world is a thin shell around the two phases. What a step reads of the objects lies apart from
//! the users' data (`bodies`: as the user left them; the table of the narrow phase: as of the last
//! update); the users' records are read only by filters and by those who ask.

mod bodies;
mod collision_world;
mod deform;
mod error;
mod filter;
mod groups;
mod narrow_phase;
mod object;
mod objects;
mod pairs;
mod queries;
mod step;
mod validate;

pub(crate) use bodies::{Bodies, WorldBroadPhase};
pub use collision_world::CollisionWorld;
pub use error::WorldError;
pub use filter::BroadPhasePairFilter;
pub use groups::{CollisionGroups, GroupError};
pub use narrow_phase::{ContactManifolds, ContactPairs, ContactViews, NarrowPhase, ProximityPairs};
pub use object::CollisionObject;
pub use objects::CollisionObjects;
pub use queries::{Neighbor, QueryFilter};
