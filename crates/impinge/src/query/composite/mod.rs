//! Composites: every question about one is a question about its parts, found by their boxes.

mod contacts;
mod point;
mod ray;
mod separation;

pub(crate) use contacts::{CompositeContacts, contact_in_world, distance_within};
pub(super) use point::surface_point;
pub(super) use ray::first_hit;
pub(super) use separation::separation;
#[allow(unused_imports, reason = "for the floors above")]
pub(crate) use separation::{PartSeparation, nearest};
