//! The nearest point of the surface of a tapered capsule.

use super::SurfacePoint;
use super::segment::surface_point as segment_point;
use crate::collide::separation::balls::ball_tapered::project;
use crate::math::{Point, Real};
use crate::shape::TaperedCapsule;

/// The point from the separation of a ball of radius zero. Without any radius it is a segment.
pub(super) fn surface_point<N: Real, const D: usize>(
    capsule: &TaperedCapsule<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    if capsule.radii() == [N::ZERO; 2] {
        return segment_point(capsule.segment(), point);
    }
    let (seen, feature) = project(capsule, point);
    SurfacePoint { point: seen.point, feature, is_inside: seen.distance <= N::ZERO }
}
