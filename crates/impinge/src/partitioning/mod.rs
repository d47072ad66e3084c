//! Searches among boxes: a tree over a user's boxes, and the searches that it shares with the broad
//! phase.
//!
//! [`BoxTree`] is for static objects of the user's own, each with a box: the triangles of a scene,
//! the rooms of a building. It returns indices; the objects themselves stay with the user. Objects
//! that move belong in a broad phase.
//!
//! The packed tree (`bvh`) contains boxes rounded outwards to `f32`, so it misses none; every
//! proposal is tested against the exact box. Boxes that no `f32` box encloses are kept in a list
//! beside the tree.

mod box_tree;
mod boxes;
pub(crate) mod entries;
mod error;
mod search;

pub use box_tree::BoxTree;
pub(crate) use box_tree::Question;
pub(crate) use boxes::packed;
pub(crate) use entries::SearchEntries;
pub use error::BoxTreeError;
use search::Best;
pub(crate) use search::{Search, Sweep};
