//! The nearest point of the surface of a tapered capsule.

use super::SurfacePoint;
use super::segment::surface_point as segment_point;
use crate::collide::separation::balls::ball_tapered::project;
use crate::math::{Point, Real};
use crate::shape::TaperedCapsule;

/// Returns the nearest surface point, computed as the separation from a ball of radius zero. If
/// both radii are zero, the shape is a segment.
pub(super) fn surface_point<N: Real, const D: usize>(
    capsule: &TaperedCapsule<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    if capsule.radii() == [N::ZERO; 2] {
        return segment_point(capsule.segment(), point);
    }
    let (projected, feature) = project(capsule, point);
    SurfacePoint { point: projected.point, feature, is_inside: projected.distance <= N::ZERO }
}
