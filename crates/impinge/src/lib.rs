//! Collision detection for the plane and for space.
#![forbid(unsafe_code)]

pub mod bounding_volume;
pub(crate) mod convex;
pub mod math;
pub mod query;
pub mod shape;
#[doc(hidden)]
pub mod tables;
pub mod transformation;
