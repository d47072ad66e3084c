//! The nearest point of a triangle in space.

use super::SurfacePoint;
use super::segment::{feature_at, nearest};
use crate::math::{Point, Real, cross, max, max_component};
use crate::shape::{FeatureId, SupportMap, Triangle};

/// The nearest of four candidates: one on each side and the foot of the perpendicular.
///
/// Each candidate is a point of the triangle whatever rounding did to it, so that needles and
/// corners in one line cost no accuracy: the worst foot only loses to a point on a side.
pub(super) fn surface_point<N: Real>(
    triangle: &Triangle<N, 3>,
    point: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    let [first, second, third] = [0, 1, 2].map(|side| on_side(triangle, side, point));
    let on_sides = first.nearer(second, point).nearer(third, point);
    let found = match foot(triangle, point) {
        Some(foot) => foot.nearer(on_sides, point),
        None => on_sides,
    };
    found.snapped(point, triangle.reach())
}

fn on_side<N: Real>(
    triangle: &Triangle<N, 3>,
    side: u32,
    point: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    let next = (side + 1) % 3;
    let corners = triangle.corners();
    let (found, fraction) = nearest([&corners[side as usize], &corners[next as usize]], point);
    SurfacePoint::on(found, feature_at(fraction, [side, next], FeatureId::Edge(side)))
}

/// The foot of the perpendicular, by barycentric coordinates; `None` where it falls outside.
fn foot<N: Real>(triangle: &Triangle<N, 3>, point: &Point<N, 3>) -> Option<SurfacePoint<N, 3>> {
    let [a, b, c] = triangle.corners();
    let (to_b, to_c, to_point) = (b - a, c - a, point - a);
    // In units of a power of two near the size: fourth powers of lengths stay in range.
    let scale = max(max_component(&to_b), max_component(&to_c)).power_of_two_below();
    let (u, v, p) = (to_b / scale, to_c / scale, to_point / scale);
    let normal = cross(&u, &v);
    let squared = normal.norm_squared();
    let at_b = cross(&p, &v).dot(&normal);
    let at_c = cross(&u, &p).dot(&normal);
    let within = at_b >= N::ZERO && at_c >= N::ZERO && at_b + at_c <= squared;
    if !within || squared == N::ZERO {
        return None;
    }
    let face = if normal.dot(&to_point) < N::ZERO { 1 } else { 0 };
    let foot = a + to_b * (at_b / squared) + to_c * (at_c / squared);
    Some(SurfacePoint::on(foot, FeatureId::Face(face)))
}
