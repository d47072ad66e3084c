//! The nearest point of a sphere.

use super::SurfacePoint;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::FeatureId;

/// Returns the point of the sphere on the ray from the centre through `point`; if `point` is the
/// centre, the point of the sphere on the first axis.
pub(super) fn surface_point<N: Real, const D: usize>(
    radius: N,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let mut first = Vector::<N, D>::zeros();
    first[0] = N::ONE;
    let (direction, distance) = unit(&point.coords).unwrap_or((first, N::ZERO));
    SurfacePoint {
        point: Point::from(direction * radius),
        feature: FeatureId::Face(0),
        is_inside: distance <= radius,
    }
}
