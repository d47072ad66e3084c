//! The nearest point of the surface of an ellipsoid.

use super::SurfacePoint;
use crate::collide::separation::balls::ball_ellipsoid::project;
use crate::math::{Point, Real};
use crate::shape::{Ellipsoid, FeatureId, SupportMap};

/// Returns the nearest surface point, computed as the separation from a ball of radius zero. An
/// ellipsoid with a zero half axis is treated as a set without interior.
pub(super) fn surface_point<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let (feature, projected) = (FeatureId::Face(0), project(ellipsoid, point));
    if ellipsoid.half_axes().iter().any(|&half_axis| half_axis == N::ZERO) {
        return SurfacePoint::on(projected.point, feature).snapped(point, ellipsoid.reach());
    }
    SurfacePoint { point: projected.point, feature, is_inside: projected.distance <= N::ZERO }
}
