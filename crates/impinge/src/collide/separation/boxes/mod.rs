//! Boxes against boxes and segments, by separating axes.

pub(crate) mod cuboid_axes;
pub(super) mod cuboid_cuboid;
pub(super) mod rectangle_axes;
pub(super) mod segment_cuboid;
