//! Which objects may touch: pairs whose bounding volumes overlap, kept up to date as they move.
//!
//! [`BroadPhase`] is the interface; [`DBVTBroadPhase`] implements it with a packed tree over
//! loosened boxes. A broad phase may report pairs that do not touch; it never misses one that does.
//!
//! Who owns what:
//! * [`DBVTBroadPhase`] owns the user's data and the handles, by index of the handle;
//! * [`PairFinder`] owns everything else, by the same index: exact boxes and loosened boxes in
//!   arrays of their own, two trees (objects that move and objects that have long stood still), the
//!   list of unbounded objects, and the table of pairs. It knows no user data.
//!
//! Changes are collected by the `deferred_*` calls and take effect at the next update: many moves
//! cost one update. Events come in canonical order, the same on every run, machine and number of
//! threads.

mod dbvt;
mod error;
mod events;
mod finder;
mod handle;
mod interface;
mod proposal;
mod rest;
mod rewind;
mod search;
mod sieve;

#[cfg(test)]
mod tests;

pub use crate::bvh::{Bounds, Lanes};
pub use dbvt::{DBVTBroadPhase, TreeVolume};
pub use error::BroadPhaseError;
pub use finder::PairFinder;
pub use handle::ProxyHandle;
pub use interface::{BroadPhase, VisitProposals};
pub use proposal::Proposal;
