//! Queries of composites: each queries the parts, which are found by their boxes.
//!
//! The result never depends on the order in which a search reports the parts: of equal results the
//! one with the lowest part indices wins.

mod impact;
mod mover;
mod point;
mod ray;
mod view;

pub(crate) use impact::{PartArrival, first_arrival};
pub(crate) use point::{PartPoint, PartQuery, nearest_part, surface_point};
pub(crate) use ray::{RayQuestion, each_hit, is_crossed};
pub(super) use view::tracked;
pub(crate) use view::{Touched, touched};
