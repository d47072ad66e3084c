//! The nearest point of the outline of a filled triangle in the plane.

use super::SurfacePoint;
use super::segment::{feature_at, nearest};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::{Point, Real, cross2};
use crate::shape::{FeatureId, Triangle};

pub(super) fn surface_point<N: Real>(
    triangle: &Triangle<N, 2>,
    point: &Point<N, 2>,
) -> SurfacePoint<N, 2> {
    let [first, second, third] = [0, 1, 2].map(|side| on_side(triangle, side, point));
    let found = first.nearer(second, point).nearer(third, point);
    SurfacePoint { is_inside: contains(triangle, point), ..found }
}

fn on_side<N: Real>(
    triangle: &Triangle<N, 2>,
    side: u32,
    point: &Point<N, 2>,
) -> SurfacePoint<N, 2> {
    let next = (side + 1) % 3;
    let corners = triangle.corners();
    let (found, fraction) = nearest([&corners[side as usize], &corners[next as usize]], point);
    SurfacePoint::on(found, feature_at(fraction, [side, next], FeatureId::Face(side)))
}

/// The point lies on the same side of all three lines, or on them.
///
/// The areas are taken from the point: swapping the ends of a side negates its area to the bit, so
/// two triangles that share a side leave no gap. The box settles corners in one line, whose areas
/// are all zero or noise.
fn contains<N: Real>(triangle: &Triangle<N, 2>, point: &Point<N, 2>) -> bool {
    let [a, b, c] = triangle.corners().map(|corner| corner - point);
    let areas = [cross2(&a, &b), cross2(&b, &c), cross2(&c, &a)];
    let one_side =
        areas.iter().all(|&area| area >= N::ZERO) || areas.iter().all(|&area| area <= N::ZERO);
    one_side && Aabb::from_points(triangle.corners()).is_some_and(|aabb| aabb.contains_point(point))
}
