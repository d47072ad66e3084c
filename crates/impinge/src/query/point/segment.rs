//! The nearest point of a segment.

use super::SurfacePoint;
use crate::math::{Point, Real};
use crate::shape::{FeatureId, Segment, SupportMap};

/// The nearest point of the segment between `ends`, and where it is: 0 at the first end, 1 at the
/// second, between them inside. Equal ends are a point.
pub(in crate::query) fn nearest<N: Real, const D: usize>(
    ends: [&Point<N, D>; 2],
    point: &Point<N, D>,
) -> (Point<N, D>, N) {
    let [a, b] = ends;
    let (along, to_point) = (b - a, point - a);
    let (part, whole) = (to_point.dot(&along), along.norm_squared());
    if part >= whole && whole > N::ZERO {
        return (*b, N::ONE);
    }
    if part > N::ZERO {
        let fraction = part / whole;
        return (a + along * fraction, fraction);
    }
    (*a, N::ZERO)
}

/// The name of a place on a segment: an end, or what lies between.
pub(in crate::query) fn feature_at<N: Real>(
    fraction: N,
    ends: [u32; 2],
    between: FeatureId,
) -> FeatureId {
    if fraction <= N::ZERO {
        FeatureId::Vertex(ends[0])
    } else if fraction >= N::ONE {
        FeatureId::Vertex(ends[1])
    } else {
        between
    }
}

pub(super) fn surface_point<N: Real, const D: usize>(
    segment: &Segment<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let (nearest, fraction) = nearest([segment.a(), segment.b()], point);
    let feature = feature_at(fraction, [0, 1], FeatureId::Edge(0));
    SurfacePoint::on(nearest, feature).snapped(point, segment.reach())
}
