//! TEMP
use super::Span;
use crate::bounding_volume::Ray;
use crate::math::Real;
use crate::shape::SupportMap;
pub(super) fn span2<N: Real>(_: &dyn SupportMap<N, 2>, _: &Ray<N, 2>) -> Option<Span<N, 2>> {
    None
}
pub(super) fn span3<N: Real>(_: &dyn SupportMap<N, 3>, _: &Ray<N, 3>) -> Option<Span<N, 3>> {
    None
}
