//! Segments and capsules: the nearest points of two lines with ends.

pub(crate) mod nearest;
pub(crate) mod segment_lanes;
pub(crate) mod segment_segment;
