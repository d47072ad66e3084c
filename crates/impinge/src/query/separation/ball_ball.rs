//! Ball against ball: in closed form, in any dimension.

use super::projection::first_axis;
use super::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, unit};
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
    of_balls([ball1.radius(), ball2.radius()], &pair.pose12.translation, limit, |axis| axis)
}

/// The separation of two balls in any axes put through the centre of the first, in which `turned` has those
/// of its frame.
#[inline]
pub(in crate::query) fn of_balls<N: Real, const D: usize>(
    [radius1, radius2]: [N; 2],
    center2: &Vector<N, D>,
    limit: N,
    turned: impl FnOnce(Vector<N, D>) -> Vector<N, D>,
) -> Option<Separation<N, D>> {
    let (normal, apart) = unit(center2).unwrap_or_else(|| (turned(first_axis()), center2.norm()));
    let distance = apart - radius1 - radius2;
    (distance <= limit).then(|| Separation {
        distance,
        normal,
        point1: Point::from(normal * radius1),
        point2: Point::from(center2 - normal * radius2),
    })
}
