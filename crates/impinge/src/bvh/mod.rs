//! A packed tree of boxes for objects that move: no pointers, sixteen boxes in a block.
//!
//! ```text
//! layer 2   [ block 0                                  ]     bounds of layer-1 blocks 0..16
//! layer 1   [ block 0      ][ block 1      ] ...             bounds of layer-0 blocks 16i..16i + 16
//! layer 0   [ block 0 | block 1 | ... ]                      boxes of objects, one for each lane
//! slot      0 ... 15   16 ... 31                             lane = slot % 16, block = slot / 16
//! ids       slot -> id (the caller's number)                 slots   id -> slot
//! ```
//!
//! Memory layout:
//! * block `i` of layer `k` has the bounds of blocks `16i … 16i + 15` of layer `k - 1`, up to a
//!   layer of one block. Child and parent are computed from the index, so no links change when
//!   objects move between slots;
//! * each layer also has the bounds of its blocks as an array (the query side of a test of one box
//!   against a block), and a mask of the lanes that changed since the last [`Tree::commit_boxes`];
//! * layer 0 also has the boxes *before* the changes, again in blocks. A sparing tree, whose
//!   objects seldom change, has these only while something has changed.
//!
//! Slots are in a balanced k-d order, so that a block holds neighbours. In each step the owner of
//! the tree calls [`Tree::set_later`], [`Tree::insert`], [`Tree::remove`], then [`Tree::refit`],
//! then the [`Joiner`] for the pairs that began and ended, then [`Tree::commit_boxes`] and
//! [`Tree::maintain`].
//!
//! **No set of pairs is stored.** A pair began if the present boxes overlap and the boxes at the
//! last commit did not. It ended in the opposite case. The join evaluates both overlaps and reports
//! differences.
//!
//! The tree has no shapes and no user data. Its boxes are always `f32`; [`Bounds::enclosing`]
//! rounds outwards. Every result depends only on the calls made, not on the instruction set or the
//! number of threads.

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
mod query;
mod ranked;
mod refit;
mod renewal;
mod schedule;
mod slabs;
mod slot;
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
pub(crate) use two::{TouchQuery, Toward, TreePair, visit_pairs, visit_touching};

/// Number of tasks (pairs of blocks, changed slots or objects) below which a loop over them does
/// not run in parallel: waking a thread costs more than it saves.
pub(crate) const PARALLEL_FROM: usize = 2000;
