//! Samples of queries on a world.

pub(crate) mod casts;
pub(crate) mod clearance;
pub(crate) mod nearest;
pub(crate) mod rays;
