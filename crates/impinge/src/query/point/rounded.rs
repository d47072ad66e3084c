//! The nearest point of the surface of a rounded solid.

use super::SurfacePoint;
use crate::collide::Pair;
use crate::collide::separation::separation;
use crate::math::{Point, Pose, Space};
use crate::shape::{Ball, FeatureId, Geometry, Kind, Rounded, SupportMap};
use crate::tables::ByDimension;

/// Returns the point at the distance `radius` from the nearest point of the inner shape, towards
/// `point`. For a point in the inner shape, the direction is outwards, along the normal of its
/// separation from that shape. A radius of zero gives the result of the inner shape.
pub(super) fn surface_point<N: Space<D>, const D: usize>(
    solid: &Rounded<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let (inner, radius) = (solid.inner(), solid.radius());
    if radius == N::ZERO {
        return <N::Algorithms>::surface_point(inner.0, point);
    }
    // Uses the separation from a ball of radius zero: near the surface and inside, its normal is
    // more accurate than the difference of two points.
    let ball = Ball::new(N::ZERO);
    let pose12 = Pose::from_translation(-point.coords);
    let pair = Pair { first: Kind::Ball(&ball), second: inner.0, pose12 };
    let Some(found) = separation(&pair, N::INFINITY) else {
        // The point is not finite.
        return SurfacePoint::on(solid.center(), FeatureId::Face(0));
    };
    let nearest = point + found.point2.coords - found.normal * radius;
    SurfacePoint {
        point: nearest,
        feature: feature_below(inner, &nearest),
        is_inside: found.distance <= radius,
    }
}

/// Returns the feature of the inner shape nearest to a point of the rounded surface.
fn feature_below<N: Space<D>, const D: usize>(
    inner: Geometry<'_, N, D>,
    point: &Point<N, D>,
) -> FeatureId {
    <N::Algorithms>::surface_point(inner.0, point).feature
}
