//! A set of unordered pairs of small numbers, kept so that it can be walked linearly and changed
//! anywhere in constant time.
//!
//! Who owns what, in which order it lies in memory:
//! * the pairs themselves are one dense array of `(smaller, larger)`; a removal moves the last pair
//!   into the gap. A caller that keeps payload arrays in step with it does the same with
//!   `swap_remove` at the index that [`Removed`] names;
//! * each object that has pairs has one line of 64 bytes with its first seven links `(partner, pair
//!   index)`, and each object that could have them the number of that line; what is beyond that stands
//!   in a run of such lines, in a pool that all objects share. A run that is full moves to one of twice
//!   the size;
//! * a link is found by looking through these lines. Of objects with more than about a hundred
//!   partners the links stand in a hash table too, so that ten thousand partners are not searched.
//!
//! The table knows no boxes and no objects, only numbers. It grows to the largest number it has
//! seen, so numbers should be dense. Its order is a function of the calls made and of nothing else.

mod lines;
mod places;
mod table;

pub(crate) use table::{PairTable, pack, unpack};
