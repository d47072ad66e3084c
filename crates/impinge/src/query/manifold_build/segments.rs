//! Segments and capsules that cross: they touch at one place only, the witness.

use super::frame::rounding;
use super::{ManifoldRequest, Pair};
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, cross, max};
use crate::shape::{FeatureId, Kind, Segment};

/// The parts that the witness of two segments or capsules lies on, if it is all there is to their
/// manifold; `None` for other solids, for segments that are nearly parallel when seen along the normal,
/// and for those without length.
///
/// These are the names that facets would give, but for a segment seen along its own direction: it
/// shows its end.
pub(super) fn crossing_parts<N: Real>(
    pair: &Pair<'_, N, 3>,
    found: &Separation<N, 3>,
    request: &ManifoldRequest<N>,
) -> Option<[FeatureId; 2]> {
    let ((segment1, rounding1), (segment2, rounding2)) = (core(pair.first)?, core(pair.second)?);
    let ends2 = [segment2.a(), segment2.b()].map(|end| pair.pose12.point(end));
    let (along1, along2) = (segment1.b() - segment1.a(), ends2[1] - ends2[0]);
    let across = |along: &Vector<N, 3>| along.norm_squared() - found.normal.dot(along).powi(2);
    // Twice the limit of the facets: which side of it rounding puts a pair on is left to them.
    let least = N::TWO * max(request.sine, N::lit(16.0) * N::EPSILON);
    let turn = found.normal.dot(&cross(&along1, &along2));
    if turn * turn <= least * least * across(&along1) * across(&along2) {
        return None;
    }
    let noise = N::TWO * rounding(pair);
    let core1 = found.point1 - found.normal * rounding1;
    let core2 = found.point2 + found.normal * rounding2;
    let part1 = part_at(&core1, segment1.a(), &along1, noise)?;
    Some([part1, part_at(&core2, &ends2[0], &along2, noise)?])
}

/// The segment in the middle of a segment or capsule, and the radius around it.
pub(super) fn core<'a, N: Real>(kind: Kind<'a, N, 3>) -> Option<(&'a Segment<N, 3>, N)> {
    match kind {
        Kind::Segment(segment) => Some((segment, N::ZERO)),
        Kind::Capsule(capsule) => Some((capsule.segment(), capsule.radius())),
        _ => None,
    }
}

/// The end that a point of a segment lies at, or the segment; `None` if both ends are that near.
pub(super) fn part_of<N: Real, const D: usize>(
    segment: &Segment<N, D>,
    point: &Point<N, D>,
    noise: N,
) -> Option<FeatureId> {
    part_at(point, segment.a(), &(segment.b() - segment.a()), noise)
}

/// [`part_of`], of a segment given by an end and the way to the other.
pub(super) fn part_at<N: Real, const D: usize>(
    point: &Point<N, D>,
    from: &Point<N, D>,
    along: &Vector<N, D>,
    noise: N,
) -> Option<FeatureId> {
    let (squared, reached) = (along.norm_squared(), (point - from).dot(along));
    let is_near = |reach: N| reach <= noise * squared.sqrt();
    match (is_near(reached), is_near(squared - reached)) {
        (true, true) => None,
        (true, false) => Some(FeatureId::Vertex(0)),
        (false, true) => Some(FeatureId::Vertex(1)),
        (false, false) => Some(FeatureId::Edge(0)),
    }
}
