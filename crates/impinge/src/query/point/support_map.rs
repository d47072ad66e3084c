//! TEMP
use super::SurfacePoint;
use crate::math::{Point, Real};
use crate::shape::{FeatureId, SupportMap};
pub(super) fn surface_point2<N: Real>(
    map: &dyn SupportMap<N, 2>,
    _: &Point<N, 2>,
) -> SurfacePoint<N, 2> {
    SurfacePoint::on(map.center(), FeatureId::Face(0))
}
pub(super) fn surface_point3<N: Real>(
    map: &dyn SupportMap<N, 3>,
    _: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    SurfacePoint::on(map.center(), FeatureId::Face(0))
}
