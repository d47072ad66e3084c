//! The nearest point of a segment.

use super::SurfacePoint;
use crate::math::{Mapped, Point, Real, Vector, max, max_component};
use crate::shape::{FeatureId, Segment, SupportMap};

/// Returns the nearest point of the segment between `ends`, and its parameter: 0 at the first end,
/// 1 at the second. If the ends coincide, the segment is a point.
///
/// The position is measured from the nearer end, so that it is accurate near both ends of a long
/// segment.
pub(crate) fn nearest<N: Real, const D: usize>(
    ends: [&Point<N, D>; 2],
    point: &Point<N, D>,
) -> (Point<N, D>, N) {
    let [a, b] = ends;
    let along = b - a;
    let (from_a, to_b) = shares(&along, [&(point - a), &(b - point)]);
    // The comparison is false for NaN, for which an end is returned.
    if from_a > N::ZERO && to_b > N::ZERO {
        let whole = from_a + to_b;
        return if from_a < to_b {
            let fraction = from_a / whole;
            (a + along * fraction, fraction)
        } else {
            let rest = to_b / whole;
            (b - along * rest, N::ONE - rest)
        };
    }
    if from_a > N::ZERO { (*b, N::ONE) } else { (*a, N::ZERO) }
}

/// Returns the components along `along` of two vectors whose sum is `along`, both multiplied by one
/// positive factor: only their signs and their ratio are meaningful.
fn shares<N: Real, const D: usize>(along: &Vector<N, D>, parts: [&Vector<N, D>; 2]) -> (N, N) {
    let [from_a, to_b] = parts.mapped(|part| part.dot(along));
    let whole = from_a + to_b;
    if whole * N::EPSILON > N::MIN_POSITIVE && from_a.abs() + to_b.abs() < N::INFINITY {
        return (from_a, to_b);
    }
    // The squares would overflow, underflow or lose precision.
    let largest = parts.mapped(max_component);
    let scale = max(largest[0], largest[1]).power_of_two_below();
    let along = along / scale;
    let [from_a, to_b] = parts.mapped(|part| (part / scale).dot(&along));
    (from_a, to_b)
}

/// Returns the feature at a parameter of a segment: a vertex at or beyond an end, else `between`.
pub(crate) fn feature_at<N: Real>(fraction: N, ends: [u32; 2], between: FeatureId) -> FeatureId {
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
