//! Convex polygons in 2D: the separating axis test of two outlines, and their nearest points.

pub(super) mod outline;
pub(super) mod polygon_nearest;
pub(crate) mod polygon_polygon;
