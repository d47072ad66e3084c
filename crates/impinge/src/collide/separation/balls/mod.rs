//! Balls against other solids. A ball is a point with a radius, so each file but `ball_ball`
//! projects a point onto one kind of solid.

pub(super) mod ball_ball;
pub(super) mod ball_cone;
pub(super) mod ball_cuboid;
pub(super) mod ball_cylinder;
pub(crate) mod ball_ellipsoid;
pub(super) mod ball_polygon;
pub(super) mod ball_polytope;
pub(super) mod ball_segment;
pub(crate) mod ball_tapered;
pub(super) mod ball_triangle;
pub(super) mod ball_triangle2;
