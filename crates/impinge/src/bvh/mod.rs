//! A packed tree of boxes for objects that move: no pointers, sixteen boxes per block.
//!
//! What lies where in memory:
//! * layer 0 is an array of [`Block`]s of object boxes; block `i` of layer `k` holds the bounds of
//!   blocks `16i … 16i + 15` of layer `k - 1`, up to a layer of one block. Child and parent are
//!   arithmetic, so nothing is fixed up when objects change places;
//! * beside each layer stand the bounds of its blocks one by one (the query side of a test of one
//!   box against a block) and a mask of the lanes that changed since the last [`Tree::settle`];
//! * beside layer 0 stand the boxes *before* the changes, again in blocks (not in a tree of objects that
//!   stay, as long as they do), and the maps between slots (positions) and ids (the caller's numbers).
//!
//! Slots are in a balanced k-d order, so that a block holds neighbours; which lane an object has
//! is nobody's business but the tree's. The owner of the tree calls, in each step: [`Tree::set_later`],
//! [`Tree::insert`], [`Tree::remove`], then [`Tree::refit`], then the [`Joiner`] for the pairs that
//! began and ended, then [`Tree::settle`] and [`Tree::maintain`].
//!
//! **No set of pairs is kept.** A pair began exactly if the boxes overlap and those of before did
//! not, and ended if it is the other way round; so the join compares the two and reports what
//! differs.
//!
//! The tree knows no shapes and no user data. Its boxes are always `f32`; [`Bounds::enclosing`]
//! rounds outwards. Every result is a function of the calls made: it does not depend on the
//! instruction set nor on the number of threads.

#![cfg_attr(
    not(any(
        all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"),
        all(target_arch = "aarch64", target_feature = "neon"),
        all(target_arch = "wasm32", target_feature = "simd128")
    )),
    allow(dead_code, reason = "without vectors the scalar kernels are all that there is")
)]

mod block;
mod block_slabs;
mod bounds;
mod farthest;
mod gaps;
mod join;
mod kernel;
mod near_first;
mod order;
mod ordered;
mod place;
mod query;
mod ranked;
mod refit;
mod renewal;
mod schedule;
mod slabs;
mod still;
mod stream;
mod tree;
mod triangles;
mod two;
mod validate;
mod visit;

#[cfg(test)]
pub(crate) mod tests;

pub(crate) use block::{Block, LANES};
pub use bounds::Bounds;
pub(crate) use gaps::Gaps;
pub(crate) use join::{Changes, Joiner};
pub use kernel::Lanes;
pub(crate) use near_first::{GROUP, RayProbe};
pub(crate) use ordered::{Frontier, Keys};
pub(crate) use ranked::{BoxRanking, visit_ranked};
pub(crate) use slabs::Slabs;
pub(crate) use stream::{RAYS, RayVisitor, Walk};
pub(crate) use tree::{NONE, Tree};
pub(crate) use triangles::{ShearedLine, TriangleAt, Triangles};
pub(crate) use two::{Toward, TreeMeeting, TreePair, visit_meetings, visit_pairs};

/// Below this many objects nothing runs in parallel: waking a thread costs more than it saves.
pub(crate) const PARALLEL_FROM: usize = 2000;
