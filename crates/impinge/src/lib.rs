//! Collision detection for the plane and for space.
#![forbid(unsafe_code)]

pub mod bounding_volume;
pub mod broad_phase;
pub mod bvh;
pub(crate) mod convex;
pub mod dim2;
pub mod dim3;
#[cfg(doctest)]
mod guide;
pub mod math;
pub mod narrow_phase;
pub mod pairs;
pub mod partitioning;
pub mod procedural;
pub mod query;
pub mod shape;
#[doc(hidden)]
pub mod tables;
pub mod transformation;
pub mod world;
