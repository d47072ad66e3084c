//! The broad phase: pairs of objects whose bounding volumes overlap, kept up to date as they move.
//!
//! [`BroadPhase`] is the interface; [`DBVTBroadPhase`] implements it with two packed trees over
//! loosened boxes. A broad phase may report pairs that do not touch, but it reports every pair that
//! touches and that the filter allows.
//!
//! ```text
//! DBVTBroadPhase   handles, users' data          by handle index
//!   PairFinder     exact boxes, loosened boxes   by the same index
//!                  moving: Tree   still: Tree    each bounded object in one of these trees,
//!                  unbounded: Vec                each unbounded object in this list
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
