//! Segments and capsules against each other: nearest points and separations.

pub(crate) mod nearest;
pub(crate) mod segment_lanes;
pub(crate) mod segment_segment;
