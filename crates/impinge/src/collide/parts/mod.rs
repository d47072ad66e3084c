//! Composites as their parts: which pairs of parts are near, and how far apart the nearest are.
//!
//! Nested composites are flattened: their parts are numbered consecutively, on one level. The
//! result for a part is that of the convex algorithm. [`between`] makes a pair of two parts,
//! [`bounds`] makes boxes that include rounding errors, [`solid_bounds`] bounds the distance from a
//! convex solid to a part, [`slab_lanes`] from one part to eight, and [`inside`] finds pieces
//! inside closed surfaces that bound bodies. The part that is returned does not depend on the order
//! of a search: the lowest indices win a tie.

pub(crate) mod between;
pub(crate) mod bounds;
mod inside;
mod meeting;
mod nearest;
mod pair_lanes;
mod separation;
mod slab_lanes;
pub(crate) mod slabs;
mod solid_bounds;
mod sweep;
#[cfg(test)]
mod tests;

pub(crate) use between::{Between, PartPair};
pub(crate) use inside::{Exit, InsidePiece, InsidePieces, find_exits, held_pieces};
pub(crate) use meeting::{MeetingVisitor, Meetings, each_meeting};
pub(crate) use nearest::{Wanted, nearest_between};
pub(crate) use pair_lanes::{PairVerdicts, PartPairs, part_pairs2, part_pairs3};
pub(crate) use separation::{PairVisitor, PartSeparation, separation, visit_near_pairs};
pub(crate) use slab_lanes::{part_gaps2, part_gaps3};
pub(crate) use slabs::AxisSlabs;
pub(crate) use sweep::PartSweep;
