//! Questions about composites: each is one about the parts, which are found by their boxes.
//!
//! Which part answers never depends on the order in which a search proposes them: of equal answers the one with the
//! lowest numbers counts.

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
