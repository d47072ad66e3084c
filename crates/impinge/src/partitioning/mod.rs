//! Searches among boxes: a tree over the boxes of a user, and the searches that it and the broad
//! phase share.
//!
//! [`BoxTree`] is for static objects of the user, each with a box: the triangles of a scene, or the
//! rooms of a building. It returns indices; the objects themselves stay with the user. Objects that
//! move on their own belong in a broad phase.
//!
//! The packed tree (`bvh`) has boxes rounded outwards to `f32`, so it proposes every result; each
//! proposal is then tested against the exact box. Boxes that no finite `f32` box encloses are kept
//! in a list beside the tree.

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
