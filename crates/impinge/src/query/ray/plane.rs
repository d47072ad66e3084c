//! Ray casts against a half-space: the span of time during which the ray's line is inside.

use super::clip::{HalfSpace, clipped};
use super::span::Span;
use crate::bounding_volume::Ray;
use crate::math::Real;
use crate::shape::{FeatureId, Plane};

pub(super) fn span<N: Real, const D: usize>(
    plane: &Plane<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let normal = plane.normal().into_inner();
    let below = -normal.dot(&ray.origin.coords);
    let rise = normal.dot(&ray.dir);
    let half_space = HalfSpace { normal, below, rise, feature: FeatureId::Face(0) };
    clipped(Span::everything(), [half_space])
}
