//! The nearest point of the surface of a convex solid known by its support points only.

use super::SurfacePoint;
use crate::convex::{Simplicial, separation};
use crate::math::{Point, Pose};
use crate::shape::{Ball, Feature, FeatureId, SupportMap};

/// The separation of the solid and a point: a ball of no radius.
///
/// As accurate as [`separation`] is; the feature is the one that faces the normal.
pub(super) fn surface_point<N: Simplicial<D>, const D: usize>(
    map: &dyn SupportMap<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let pose = Pose::from_translation(point.coords);
    let Some(found) = separation(map, &Ball::new(N::ZERO), &pose, N::INFINITY) else {
        // The point is not finite.
        return SurfacePoint::on(map.center(), FeatureId::Face(0));
    };
    let mut feature = Feature::default();
    map.core_feature(&found.normal, &mut feature);
    // From the point itself along the normal: on a round surface this is off by the square of the
    // error of the normal, a mix of support points by the error.
    let nearest = point - found.normal * found.distance;
    let is_inside = found.distance <= N::ZERO;
    SurfacePoint { point: nearest, feature: feature.id, is_inside }
}
