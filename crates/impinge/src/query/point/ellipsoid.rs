//! The nearest point of the surface of an ellipsoid.

use super::SurfacePoint;
use crate::collide::separation::balls::ball_ellipsoid::project;
use crate::math::{Point, Real};
use crate::shape::{Ellipsoid, FeatureId, SupportMap};

/// The point from the separation of a ball of radius zero. An ellipsoid without thickness is a flat
/// set.
pub(super) fn surface_point<N: Real, const D: usize>(
    ellipsoid: &Ellipsoid<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let (feature, seen) = (FeatureId::Face(0), project(ellipsoid, point));
    if ellipsoid.half_axes().iter().any(|&half_axis| half_axis == N::ZERO) {
        return SurfacePoint::on(seen.point, feature).snapped(point, ellipsoid.reach());
    }
    SurfacePoint { point: seen.point, feature, is_inside: seen.distance <= N::ZERO }
}
