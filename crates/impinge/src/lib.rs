//! Collision detection for the plane and for space.
#![forbid(unsafe_code)]

pub mod bounding_volume;
pub mod math;
#[doc(hidden)]
pub mod tables;
