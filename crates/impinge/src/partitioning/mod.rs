//! Searches among boxes: a tree over a user's own, and what the broad phase shares with it.
//!
//! [`BoxTree`] is for those who have things of their own, each with a box, that do not move: the
//! triangles of a scene, the rooms of a building. It answers with indices, and what lies in the boxes is
//! the user's business. Things that move belong into a broad phase.
//!
//! The packed tree (`bvh`) holds boxes rounded outwards to `f32`, so it proposes and never
//! misses; every answer is checked against the box as it was given. Boxes that no `f32` box encloses
//! stand in a list beside the tree.

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
