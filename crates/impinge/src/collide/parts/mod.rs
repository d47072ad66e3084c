//! Composites as their parts: which pairs of parts are near, and how far apart the nearest are.
//!
//! The parts of nested composites are numbered in a row, so a composite has one level. An answer about
//! a part is that of the convex algorithm for it: [`between`] places two parts for it, [`bounds`] makes
//! boxes that rounding cannot make too small. Which part answers never depends on the order in which
//! a search proposes them: of equal answers the one with the lowest numbers counts.

pub(crate) mod between;
pub(crate) mod bounds;
mod separation;
pub(crate) mod slabs;
mod sweep;

pub(crate) use between::{Between, PartPair};
pub(crate) use separation::{
    PairVisitor, PartSeparation, Wanted, nearest_between, separation, visit_near_pairs,
};
pub(crate) use sweep::PartSweep;
