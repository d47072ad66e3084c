//! The nearest point of the boundary of a half-space.

use super::SurfacePoint;
use crate::math::{Point, Real};
use crate::shape::{FeatureId, Plane};

pub(super) fn surface_point<N: Real, const D: usize>(
    plane: &Plane<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let normal = plane.normal().into_inner();
    let height = normal.dot(&point.coords);
    let nearest = point - normal * height;
    SurfacePoint { point: nearest, feature: FeatureId::Face(0), is_inside: height <= N::ZERO }
}
