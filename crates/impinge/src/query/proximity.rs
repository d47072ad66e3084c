//! The proximity of two solids: intersecting, within a margin, or disjoint.

use super::distance::distance_within;
use crate::collide::AtIsometry;
use crate::math::{AbstractRotation, Isometry, IsometryRef, Real, Space, max};
use crate::shape::Shape;
use crate::tables::entries;

/// The relation of two solids: they touch, are within a margin, or are farther apart.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::query::{Proximity, proximity};
/// use impinge::dim2::shape::Ball;
///
/// let (ball, here) = (Ball::new(1.0_f32), Isometry::identity());
/// let near = |x| proximity(&here, &ball, &Isometry::translation(x, 0.0), &ball, 1.0);
/// assert_eq!(near(2.0), Proximity::Intersecting, "touching counts");
/// assert_eq!(near(3.0), Proximity::WithinMargin, "and so does the margin itself");
/// assert_eq!(near(3.5), Proximity::Disjoint);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Proximity {
    /// The solids touch or overlap: their distance is zero.
    Intersecting,
    /// The solids are apart, by at most the margin.
    WithinMargin,
    /// The solids are farther apart than the margin, a pose is not finite, or a composite has no
    /// parts.
    Disjoint,
}

impl Proximity {
    /// Returns the proximity of solids whose distance is known to be within the margin.
    #[inline]
    pub(crate) fn within<N: Real>(distance: N) -> Self {
        if distance <= N::ZERO { Self::Intersecting } else { Self::WithinMargin }
    }
}

/// Returns whether two solids touch or overlap, are at most `margin` apart, or are farther apart.
///
/// Touching solids intersect, and a distance equal to `margin` is within it. A negative or NaN
/// `margin` is treated as zero. Two half-spaces with an unbounded overlap intersect. The result is
/// [`Proximity::Disjoint`] if a pose is not finite, and for a composite without parts. The
/// proximity of composites is the proximity of their nearest parts; the search ends at the first
/// two parts that touch.
pub fn proximity<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
    margin: N,
) -> Proximity {
    entries::proximity_at(R::view(m1), g1, R::view(m2), g2, margin)
}

/// Implements [`proximity`] with poses by reference.
#[inline]
pub(crate) fn proximity_at<N: Space<D>, const D: usize>(
    isometry1: IsometryRef<'_, N, D>,
    shape1: &dyn Shape<N, D>,
    isometry2: IsometryRef<'_, N, D>,
    shape2: &dyn Shape<N, D>,
    margin: N,
) -> Proximity {
    let (one, other) = (AtIsometry::new(isometry1, shape1), AtIsometry::new(isometry2, shape2));
    match distance_within(&one, &other, max(margin, N::ZERO)) {
        None => Proximity::Disjoint,
        Some(distance) => Proximity::within(distance),
    }
}
