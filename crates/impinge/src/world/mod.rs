//! The world: who touches whom, where, and since when, brought up to date by each update.
//!
//! The world is a thin shell around the two phases. Each object is one record: what the user said, as
//! they left it (`bodies`), and the user's data. The phases have what they need as of the last update: the
//! broad phase the boxes, the table of the narrow phase the poses and shapes of objects that have pairs.

mod bodies;
mod changes;
mod collision_world;
mod debug;
mod deform;
mod dirty;
mod emptying;
pub(crate) mod entries;
mod error;
mod filter;
mod fork;
mod group_masks;
mod groups;
mod motion;
mod narrow_phase;
mod object;
mod objects;
mod of_object;
mod pairs;
mod queries;
mod reasons;
mod removed;
mod skin;
mod step;
mod substep;

pub(crate) use bodies::{WorldBody, WorldBroadPhase};
pub use collision_world::CollisionWorld;
pub(crate) use dirty::{DirtyTree, DirtyVisitor};
pub(crate) use entries::{SmallWorldEntries, WorldEntries};
pub use error::WorldError;
pub use filter::BroadPhasePairFilter;
pub use fork::{WorldMark, WorldsBroadPhase, WorldsNarrowPhase};
pub use groups::{CollisionGroups, GroupError};
pub use narrow_phase::{
    ContactManifolds, ContactPairs, ContactViewPiece, ContactViews, NarrowPhase, ProximityPairs,
};
pub use object::CollisionObject;
pub use objects::CollisionObjects;
pub use queries::{NearObject, QueryFilter};
