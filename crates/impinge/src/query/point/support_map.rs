//! The nearest point of the surface of a convex solid given by support points alone.

use super::SurfacePoint;
use crate::convex::{Simplicial, separation};
use crate::math::{Point, Pose};
use crate::shape::{Ball, Feature, FeatureId, SupportMap};

/// Returns the nearest point from the separation of the solid and a ball of radius zero.
///
/// The result is as accurate as [`separation`]; the feature is the supporting feature for the
/// normal.
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
    // The point is computed from `point` along the normal. On a round surface its error is the
    // square of the normal's error; a combination of support points would have the error itself.
    let nearest = point - found.normal * found.distance;
    let is_inside = found.distance <= N::ZERO;
    SurfacePoint { point: nearest, feature: feature.id, is_inside }
}
