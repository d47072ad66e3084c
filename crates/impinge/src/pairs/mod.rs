//! A set of unordered pairs of small numbers, with linear iteration and constant-time changes.
//!
//! Memory layout:
//! * the pairs are one dense array of `(smaller, larger)`; a removal moves the last pair into the
//!   gap. A caller with parallel payload arrays calls `swap_remove` at the index in [`Removed`];
//! * each object with pairs has one line of 64 bytes with its first seven links `(partner, pair
//!   index)`, and each object number the index of that line. Further links are in a run of such
//!   lines, in a pool that all objects share. A full run moves to one of twice the size;
//! * a link is found by searching these lines. The links of objects with more than about a hundred
//!   partners are also in a hash table, so that ten thousand partners are not searched.
//!
//! The table has no boxes and no objects, only numbers. It grows to the largest number it has seen,
//! so numbers should be dense. Its order depends only on the calls made.

mod lines;
mod places;
mod table;

pub(crate) use table::{PairTable, pack, unpack};
