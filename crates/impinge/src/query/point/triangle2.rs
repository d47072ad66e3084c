//! The nearest point of the outline of a filled triangle in 2D.

use super::SurfacePoint;
use super::triangle::on_side;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::{Point, Real, cross2};
use crate::shape::Triangle;

pub(super) fn surface_point<N: Real>(
    triangle: &Triangle<N, 2>,
    point: &Point<N, 2>,
) -> SurfacePoint<N, 2> {
    let [first, second, third] =
        [0, 1, 2].map(|side| on_side(triangle.corners(), side, point).found);
    let found = first.nearer(second, point).nearer(third, point);
    SurfacePoint { is_inside: contains(triangle, point), ..found }
}

/// Returns whether the point lies on the same side of all three lines, or on them.
///
/// The areas are computed relative to the point. Swapping the ends of a side negates its area
/// exactly, so two triangles that share a side leave no gap. For collinear corners, whose areas are
/// all zero or rounding error, the box decides.
fn contains<N: Real>(triangle: &Triangle<N, 2>, point: &Point<N, 2>) -> bool {
    let [a, b, c] = triangle.corners().map(|corner| corner - point);
    let areas = [cross2(&a, &b), cross2(&b, &c), cross2(&c, &a)];
    let one_side =
        areas.iter().all(|&area| area >= N::ZERO) || areas.iter().all(|&area| area <= N::ZERO);
    one_side && Aabb::from_points(triangle.corners()).is_some_and(|aabb| aabb.contains_point(point))
}
