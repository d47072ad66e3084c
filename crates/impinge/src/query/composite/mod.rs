//! Queries of composites: each is a query of the parts, which are found by their boxes.
//!
//! The result never depends on the order in which a search proposes the parts: of equal answers the
//! one with the lowest part numbers wins.

mod impact;
mod mover;
mod point;
mod ray;
mod view;

pub(crate) use impact::{PartArrival, first_arrival};
pub(crate) use point::{Near, PartPoint, nearest_part, surface_point};
pub(crate) use ray::{RayQuestion, each_hit, is_crossed};
pub(super) use view::tracked;
pub(crate) use view::{Touched, touched};
