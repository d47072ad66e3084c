//! The nearest point of a triangle in 3D.

use super::{SurfacePoint, triangle};
use crate::math::{Point, Real, cross, max, max_component};
use crate::shape::{FeatureId, SupportMap, Triangle};

pub(super) fn surface_point<N: Real>(
    triangle: &Triangle<N, 3>,
    point: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    let found = triangle::nearest(triangle.corners(), point).found;
    let feature = match found.feature {
        FeatureId::Face(_) => facing(triangle, point),
        side => side,
    };
    SurfacePoint { feature, ..found }.snapped(point, triangle.reach())
}

/// Returns the face of the triangle on the side of the point: `Face(0)` for a point in front of the
/// triangle or in its plane, else `Face(1)`.
fn facing<N: Real>(triangle: &Triangle<N, 3>, point: &Point<N, 3>) -> FeatureId {
    let [a, b, c] = triangle.corners();
    let (to_b, to_c, to_point) = (b - a, c - a, point - a);
    // Scaled by a power of two near the size, so that products of lengths stay in range.
    let scale = max(max_component(&to_b), max_component(&to_c)).power_of_two_below();
    let normal = cross(&(to_b / scale), &(to_c / scale));
    let height = normal.dot(&(to_point / max_component(&to_point).power_of_two_below()));
    FeatureId::Face(u32::from(height < N::ZERO))
}
