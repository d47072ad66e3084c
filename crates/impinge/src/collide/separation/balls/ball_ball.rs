//! Ball against ball, in closed form, in any dimension.

use crate::collide::Pair;
use crate::collide::separation::projection::first_axis;
use crate::collide::separation::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::Kind;

/// Returns the separation of two balls; `None` above `limit`.
///
/// If the centres coincide, the normal is the first axis of the world: the rotation of the first
/// ball is ignored, so its frame has the axes of the world.
pub(in crate::collide::separation) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Kind::Ball(ball1), Kind::Ball(ball2)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let center2 = pair.pose12.translation;
    let (normal, apart) = apart(&center2);
    let distance = apart - ball1.radius() - ball2.radius();
    (distance <= limit).then(|| Separation {
        distance,
        normal,
        point1: Point::from(normal * ball1.radius()),
        point2: Point::from(center2 - normal * ball2.radius()),
    })
}

/// Returns the distance of [`separation`], without a limit; the centre of the first ball is the
/// origin.
#[inline]
pub(in crate::collide::separation) fn distance<N: Real, const D: usize>(
    center2: &Vector<N, D>,
    radii: [N; 2],
) -> N {
    apart(center2).1 - radii[0] - radii[1]
}

/// Returns the unit direction from the origin to `center2`, and the length of `center2`. If both
/// centres coincide, the direction is the first axis.
#[inline]
fn apart<N: Real, const D: usize>(center2: &Vector<N, D>) -> (Vector<N, D>, N) {
    unit(center2).unwrap_or((first_axis(), center2.norm()))
}
