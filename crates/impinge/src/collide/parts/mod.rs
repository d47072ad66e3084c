//! Composites as their parts: which pairs of parts are near, and how far apart the nearest are.
//!
//! The parts of nested composites are numbered in a row, so a composite has one level. An answer about
//! a part is that of the convex algorithm for it: [`between`] places two parts for it, [`bounds`] makes
//! boxes that rounding cannot make too small. [`solid_bounds`] tells how near parts can be to a convex solid,
//! [`inside`] asks what lies inside closed surfaces that bound bodies, [`slab_lanes`] how near eight are to one part. Which part answers never depends on the order in which
//! a search proposes them: of equal answers the one with the lowest numbers counts.

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
