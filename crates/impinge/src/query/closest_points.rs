//! The nearest points of two solids.

use crate::collide::{AtIsometry, Placed};
use crate::math::{AbstractRotation, Isometry, IsometryRef, Point, Real, Space, max};
use crate::shape::Shape;
use crate::tables::entries;

/// The nearest points of two solids.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point};
/// use impinge::dim2::query::{ClosestPoints, closest_points};
/// use impinge::dim2::shape::Ball;
///
/// let (ball, here) = (Ball::new(1.0_f32), Isometry::identity());
/// let nearest = |x| closest_points(&here, &ball, &Isometry::translation(x, 0.0), &ball, 2.0);
/// assert_eq!(nearest(1.0), ClosestPoints::Intersecting);
/// assert_eq!(nearest(3.0), ClosestPoints::WithinMargin(Point::new(1.0, 0.0), Point::new(2.0, 0.0)));
/// assert_eq!(nearest(9.0), ClosestPoints::Disjoint);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ClosestPoints<N: Real, const D: usize> {
    /// The solids touch or overlap.
    Intersecting,
    /// A point on the first solid and a point on the second, in the world frame. Their distance is
    /// the distance of the solids.
    WithinMargin(Point<N, D>, Point<N, D>),
    /// The solids are farther apart than `max_distance`, a pose is not finite, or a composite has
    /// no parts.
    Disjoint,
}

impl<N: Real, const D: usize> ClosestPoints<N, D> {
    /// Returns the result with the solids swapped.
    #[must_use]
    pub fn flipped(&self) -> Self {
        match self {
            Self::WithinMargin(point1, point2) => Self::WithinMargin(*point2, *point1),
            other => *other,
        }
    }
}

/// Returns the nearest points of two solids if these are apart by at most `max_distance`.
///
/// If several pairs of points are equally near, one pair is chosen; both orders of the arguments
/// choose the same pair. A distance equal to `max_distance` is within the limit; a negative or NaN
/// `max_distance` is treated as zero. Returns [`ClosestPoints::Disjoint`] if a pose is not finite
/// or a composite has no parts. For composites the points lie on the nearest parts;
/// [`witness`](super::witness()) returns the indices of these parts.
pub fn closest_points<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
    max_distance: N,
) -> ClosestPoints<N, D> {
    entries::closest_points(R::view(m1), g1, R::view(m2), g2, max_distance)
}

/// Implements [`closest_points`] for poses passed by reference.
#[inline]
pub(crate) fn closest_points_at<N: Space<D>, const D: usize>(
    isometry1: IsometryRef<'_, N, D>,
    shape1: &dyn Shape<N, D>,
    isometry2: IsometryRef<'_, N, D>,
    shape2: &dyn Shape<N, D>,
    max_distance: N,
) -> ClosestPoints<N, D> {
    let limit = max(max_distance, N::ZERO);
    let (one, other) = (AtIsometry::new(isometry1, shape1), AtIsometry::new(isometry2, shape2));
    let found = Placed::within(&one, &other, limit)
        .and_then(|[placed1, placed2]| entries::touching_in_world(&placed1, &placed2, limit));
    match found {
        None => ClosestPoints::Disjoint,
        Some(found) if found.distance <= N::ZERO => ClosestPoints::Intersecting,
        Some(found) => ClosestPoints::WithinMargin(found.point1, found.point2),
    }
}
