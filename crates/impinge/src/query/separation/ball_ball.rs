//! Ball against ball: in closed form, in any dimension.

use super::projection::first_axis;
use super::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, unit};
use crate::query::Pair;
use crate::shape::Kind;

/// The separation of two balls.
///
/// Balls with a common centre are parted along the first axis of the first ball's frame.
pub(super) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Kind::Ball(ball1), Kind::Ball(ball2)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center2 = pair.pose12.translation;
    let (normal, apart) = unit(&center2).unwrap_or((first_axis(), center2.norm()));
    let distance = apart - ball1.radius() - ball2.radius();
    (distance <= limit).then(|| Separation {
        distance,
        normal,
        point1: Point::from(normal * ball1.radius()),
        point2: Point::from(center2 - normal * ball2.radius()),
    })
}
