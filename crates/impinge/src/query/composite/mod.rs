//! Composites: every question about one is a question about its parts, found by their boxes.
//!
//! The parts of nested composites are numbered in a row, so a composite has one level. An answer about
//! a part is that of the convex algorithm for it: [`between`] places two parts for it, [`bounds`] makes
//! boxes that rounding cannot make too small. Which part answers never depends on the order in which
//! a search proposes them: of equal answers the one with the lowest numbers counts.

mod between;
mod bounds;
mod contacts;
mod impact;
mod mover;
mod point;
mod ray;
mod separation;
mod slabs;
mod sweep;

pub(crate) use between::{Between, PartPair};
pub(crate) use contacts::{
    CompositeContacts, contact_in_world, over2, over3, own_distance, update_chain,
    update_on_surface,
};
pub(crate) use impact::{PartArrival, first_arrival};
pub(in crate::query) use point::surface_point;
pub(crate) use point::{Near, PartPoint, nearest_part};
pub(crate) use ray::{RayQuestion, each_hit};
pub(in crate::query) use separation::separation;
pub(crate) use separation::{
    PairVisitor, PartSeparation, Wanted, nearest_between, visit_near_pairs,
};
pub(crate) use sweep::Sweep;
