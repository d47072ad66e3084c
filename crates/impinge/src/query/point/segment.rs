//! The nearest point of a segment.

use super::SurfacePoint;
use crate::math::{Point, Real, Vector, max, max_component};
use crate::shape::{FeatureId, Segment, SupportMap};

/// The nearest point of the segment between `ends`, and where it is: 0 at the first end, 1 at the
/// second, between them inside. Equal ends are a point.
pub(in crate::query) fn nearest<N: Real, const D: usize>(
    ends: [&Point<N, D>; 2],
    point: &Point<N, D>,
) -> (Point<N, D>, N) {
    let [a, b] = ends;
    let (along, to_point) = (b - a, point - a);
    let (part, whole) = shares(&along, &to_point);
    if part >= whole && whole > N::ZERO {
        return (*b, N::ONE);
    }
    if part > N::ZERO {
        let fraction = part / whole;
        return (a + along * fraction, fraction);
    }
    (*a, N::ZERO)
}

/// How far a vector leads along another, and how far that one leads itself, both in the same unit.
fn shares<N: Real, const D: usize>(along: &Vector<N, D>, to_point: &Vector<N, D>) -> (N, N) {
    let (part, whole) = (to_point.dot(along), along.norm_squared());
    if whole * N::EPSILON > N::MIN_POSITIVE && whole + part.abs() < N::INFINITY {
        return (part, whole);
    }
    // Their squares are no numbers of the type, or lose digits.
    let scale = max(max_component(along), max_component(to_point)).power_of_two_below();
    let (along, to_point) = (along / scale, to_point / scale);
    (to_point.dot(&along), along.norm_squared())
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
