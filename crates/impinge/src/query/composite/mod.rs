//! Queries on composites: a search finds candidate parts by their boxes, and the query runs on each
//! of these parts.
//!
//! The result of a public query never depends on the order in which a search reports the parts: of
//! equal results, the one with the lowest part indices is returned.

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
