//! Segments and capsules: nearest points of two segments.

pub(crate) mod nearest;
pub(crate) mod segment_lanes;
pub(crate) mod segment_segment;
