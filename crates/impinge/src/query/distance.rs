//! The distance between two solids.

use crate::collide::{AtIsometry, Placed, Placing};
use crate::math::{AbstractRotation, Isometry, IsometryRef, Space, max};
use crate::shape::Shape;
use crate::tables::entries;

/// Returns the distance between two solids: zero if they touch or overlap.
///
/// The distance is the length of the shortest translation that makes the solids touch. Swapping the
/// solids gives a bitwise equal result. The distance is infinite if a pose is not finite, and for a
/// composite without parts.
///
/// The distance of composites is the distance of their nearest parts; [`witness`](super::witness())
/// returns these parts and documents the cost.
///
/// ```
/// use impinge::math::{Isometry2, Vector};
/// use impinge::query::distance;
/// use impinge::shape::{Ball, Cuboid};
///
/// let ball = Ball::new(1.0_f32);
/// let cuboid = Cuboid::new(Vector::<f32, 2>::new(2.0, 2.0));
/// let place = Isometry2::translation(5.0, 0.0);
/// assert_eq!(distance(&Isometry2::identity(), &ball, &place, &cuboid), 2.0);
/// ```
pub fn distance<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
) -> N {
    entries::distance(R::view(m1), g1, R::view(m2), g2)
}

/// Implements [`distance`] with poses by reference.
#[inline]
pub(crate) fn distance_at<N: Space<D>, const D: usize>(
    isometry1: IsometryRef<'_, N, D>,
    shape1: &dyn Shape<N, D>,
    isometry2: IsometryRef<'_, N, D>,
    shape2: &dyn Shape<N, D>,
) -> N {
    distance_between(&AtIsometry::new(isometry1, shape1), &AtIsometry::new(isometry2, shape2))
}

/// Implements [`distance`] for shapes placed by any [`Placing`].
#[inline]
pub(crate) fn distance_between<'a, N: Space<D>, const D: usize>(
    one: &impl Placing<'a, N, D>,
    other: &impl Placing<'a, N, D>,
) -> N {
    let found = entries::distance_in_world(&one.placed(), &other.placed(), N::INFINITY);
    found.map_or(N::INFINITY, |distance| max(distance, N::ZERO))
}

/// Returns the distance of two shapes, zero or more; `None` if it exceeds `limit` or a pose is not
/// finite.
#[inline]
pub(crate) fn distance_within<'a, N: Space<D>, const D: usize>(
    one: &impl Placing<'a, N, D>,
    other: &impl Placing<'a, N, D>,
    limit: N,
) -> Option<N> {
    let [placed1, placed2] = Placed::within(one, other, limit)?;
    let found = entries::distance_in_world(&placed1, &placed2, limit)?;
    Some(max(found, N::ZERO))
}
