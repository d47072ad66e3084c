//! Composites: every question about one is a question about its parts, found by their boxes.

mod point;
mod ray;
mod separation;

pub(super) use point::surface_point;
pub(super) use ray::first_hit;
pub(super) use separation::separation;
#[allow(unused_imports, reason = "for the floors above")]
pub(crate) use separation::{PartSeparation, nearest};
