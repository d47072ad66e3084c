//! The world: objects, and the pairs, contacts and events among them as of the last update.
//!
//! The world connects the broad phase and the narrow phase. It has one record for each object:
//! pose, shape, groups and query type as the user last set them (`bodies`), and the user's data.
//! The broad phase has a copy of the boxes, and the narrow phase of the poses, shapes and query
//! types, as of the last update:
//!
//! ```text
//! CollisionWorld
//!   objects ── slots[index] -> records[slot.record]  { body: WorldBody, data: T }
//!      │          changes: dirty objects, until update()
//!      ├── boxes ───────────> broad_phase    (as of the last update)
//!      └── poses, shapes ───> ObjectTable ─> narrow_phase   (rows of objects with pairs only)
//!   queries read the objects and the tree of dirty boxes, so each change has an effect at once
//! ```

mod bodies;
mod changes;
mod clear;
mod collision_world;
mod debug;
mod deform;
mod diagnostics;
mod dirty;
pub(crate) mod entries;
mod error;
mod filter;
mod fork;
mod group_masks;
mod groups;
mod motion;
mod narrow_phase;
mod object;
mod object_pairs;
mod objects;
mod pairs;
mod queries;
mod removed;
#[cfg(feature = "serde")]
mod saved;
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
#[cfg(feature = "serde")]
pub use saved::{Registry, RestoreError, SaveError, SavedWorld};
