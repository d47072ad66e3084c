//! Collision detection for the plane and for space.
#![forbid(unsafe_code)]

pub mod bounding_volume;
pub mod broad_phase;
pub mod bvh;
pub mod math;
pub mod pairs;
#[doc(hidden)]
pub mod tables;
