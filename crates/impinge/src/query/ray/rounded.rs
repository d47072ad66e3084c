//! Ray casts against a rounded solid: the span of time during which the ray's line is inside.

use super::Span;
use super::support_map::RaySolid;
use crate::bounding_volume::Ray;
use crate::collide::Pair;
use crate::collide::separation::separation;
use crate::math::{Point, Pose, Real, Space, Vector, max};
use crate::shape::{Ball, Geometry, Kind, Rounded, ShapeKind, SupportMap};
use crate::tables::ByDimension;

/// Returns the span by a search with the distances of points from the rounded solid; see
/// [`RaySolid::span`] for `None`. If the radius is zero, returns the span of the inner shape.
pub(super) fn span<N: Space<D>, const D: usize>(
    solid: &Rounded<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let inner = solid.inner();
    if solid.radius() == N::ZERO {
        return <N::Algorithms>::ray_span(inner.0, ray);
    }
    let ball = Ball::new(N::ZERO);
    let distance = |point: &Vector<N, D>| {
        let pose12 = Pose::from_translation(-point);
        let pair = Pair { first: Kind::Ball(&ball), second: Kind::Rounded(solid), pose12 };
        let found = separation(&pair, N::INFINITY)?;
        Some((found.distance, -found.normal))
    };
    let feature = |point: &Vector<N, D>, _: &Vector<N, D>| {
        <N::Algorithms>::surface_point(inner.0, &Point::from(*point)).feature
    };
    let radius = solid.reach() + solid.rounding();
    RaySolid { distance: &distance, feature: &feature, radius, precision: precision(inner) }
        .span(ray)
}

/// Returns the accuracy of point distances, as a fraction of the rounded solid's bounding radius.
/// Closed forms are exact up to rounding.
fn precision<N: Real, const D: usize>(inner: Geometry<'_, N, D>) -> N {
    let rounding = N::lit(16.0) * N::EPSILON;
    match inner.0 {
        Kind::Rounded(solid) => precision(solid.inner()),
        _ if inner.kind() == ShapeKind::SupportMap => {
            max(rounding, N::lit(1.0 / 549_755_813_888.0))
        }
        _ => rounding,
    }
}
