//! Polygons of the plane: the separating axis test of two outlines, and the nearest points where none parts them.

pub(super) mod outline;
pub(super) mod polygon_nearest;
pub(crate) mod polygon_polygon;
