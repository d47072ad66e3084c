//! Ball against segment or capsule: in closed form, in any dimension.

use super::projection::{
    Projection, center_in_second, first_axis, made_perpendicular, perpendicular_to,
};
use super::segments::{core, nearest_on_segment};
use crate::convex::Separation;
use crate::math::{Point, Real, unit};
use crate::query::Pair;
use crate::shape::Kind;

/// The separation of a ball from a segment or capsule.
///
/// A centre on the segment leaves it along a fixed perpendicular; one at the place of a segment of
/// no length along the first axis of the segment's frame.
pub(super) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let Kind::Ball(ball) = &pair.first else { super::wrong_kinds(pair) };
    let (ends, rounding) = core(pair, &pair.second);
    let center = center_in_second(&pair.pose12);
    let mut seen = project(&ends, &center);
    seen.distance -= rounding;
    seen.point += seen.outward * rounding;
    seen.of_ball(ball.radius(), &pair.pose12, limit)
}

/// A point seen from a segment.
pub(super) fn project<N: Real, const D: usize>(
    ends: &[Point<N, D>; 2],
    center: &Point<N, D>,
) -> Projection<N, D> {
    let (point, inside) = nearest_on_segment(ends, center);
    let offset = center - point;
    let axis = unit(&(ends[1] - ends[0])).map(|(axis, _)| axis);
    let sideways = axis.filter(|_| inside).and_then(|axis| made_perpendicular(&offset, &axis));
    let found = sideways.or_else(|| unit(&offset).filter(|_| !inside).map(|(along, _)| along));
    let outward =
        found.unwrap_or_else(|| axis.map_or_else(first_axis, |axis| perpendicular_to(&axis)));
    Projection { distance: offset.norm(), outward, point }
}
