//! The broad phase: pairs of objects whose bounding volumes overlap, kept up to date as they move.
//!
//! [`BroadPhase`] is the interface; [`DBVTBroadPhase`] implements it with a packed tree over
//! loosened boxes. A broad phase may report pairs that do not touch, but it never misses a pair
//! that does.
//!
//! ```text
//! DBVTBroadPhase   handles, users' data          by index of the handle
//!   PairFinder     exact boxes, loosened boxes   by the same index
//!                  moving: Tree   still: Tree    each object in one of both trees, or in
//!                  unbounded: Vec                the list of unbounded objects
//!                  pairs: PairTable
//! ```
//!
//! `deferred_*` calls collect changes, which take effect at the next update: many moves cost one
//! update. Events come in canonical order. They are equal on every run, on every machine and for
//! any number of threads.

mod dbvt;
mod error;
mod events;
mod exact_boxes;
mod finder;
mod handle;
mod interface;
mod proposal;
mod rest;
mod rewind;
#[cfg(feature = "serde")]
pub(crate) mod saved;
mod search;

#[cfg(test)]
mod tests;

pub use crate::bvh::{Bounds, Lanes};
pub use dbvt::{DBVTBroadPhase, TreeVolume};
pub use error::BroadPhaseError;
pub use finder::PairFinder;
pub use handle::ProxyHandle;
pub use interface::{BroadPhase, VisitProposals};
pub use proposal::Proposal;
