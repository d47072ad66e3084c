//! Searches for the near pairs of parts of two shapes, and for the nearest pair. A composite is a
//! collection of parts; a convex solid counts as a single part.
//!
//! Nested composites are flattened: their parts have consecutive indices on one level. The result
//! for a pair of parts is computed by the convex algorithms. [`between`] makes a pair of two parts.
//! [`bounds`] makes boxes that include rounding errors. [`solid_bounds`] computes lower bounds of
//! the distance from a convex solid to a part, and [`slab_lanes`] lower bounds of the distances
//! from one part to 8 other parts. [`inside`] finds connected pieces that lie inside a body (a
//! solid bounded by a closed surface). For [`Wanted::Deepest`] the result does not depend on the
//! order of the search: of equally near pairs, the pair with the lowest indices is returned.

pub(crate) mod between;
pub(crate) mod bounds;
mod inside;
mod nearest;
mod pair_lanes;
mod separation;
mod slab_lanes;
pub(crate) mod slabs;
mod solid_bounds;
mod sweep;
#[cfg(test)]
mod tests;
mod touching;

pub(crate) use between::{Between, PartPair};
pub(crate) use inside::{Exit, InsidePiece, InsidePieces, find_exits, held_pieces};
pub(crate) use nearest::{Wanted, nearest_between};
pub(crate) use pair_lanes::{PairMasks, PartPairs, part_pairs2, part_pairs3};
pub(crate) use separation::{PairVisitor, PartSeparation, separation, visit_near_pairs};
pub(crate) use slab_lanes::{part_gaps2, part_gaps3};
pub(crate) use slabs::AxisSlabs;
pub(crate) use sweep::PartSweep;
pub(crate) use touching::{Touching, TouchingVisitor, each_touching};
