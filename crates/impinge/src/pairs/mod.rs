//! A set of unordered pairs of small indices. Iteration takes linear time; a change or a look-up
//! takes amortised constant time.
//!
//! Memory layout:
//! * the pairs are a dense array of `(smaller, larger)`. A removal moves the last pair into the
//!   gap. A caller with parallel payload arrays calls `swap_remove` at the index in [`Removed`];
//! * each object with pairs has a line of 64 bytes with its first seven links `(partner, pair
//!   index)`; an array has the index of this line for each object. Further links are in a run of
//!   such lines, in a pool that all objects share. A full run moves to a run of twice the size;
//! * a link is found by searching these lines. The links of an object that has had more than 135
//!   partners are also in a hash table, so that ten thousand partners need not be searched.
//!
//! The table stores indices only, neither boxes nor objects. Its arrays are as long as the largest
//! index seen, so indices should be dense. The order of the pairs depends on the sequence of calls
//! alone.

mod adjacency;
mod link_indices;
mod table;

pub(crate) use table::{PairTable, pack, unpack};
