//! The nearest points of two shapes, with the parts and features that contain them.

use crate::collide::pair::Ordered;
use crate::collide::parts::{Between, Wanted, nearest_between};
use crate::collide::separation::{placed, separation};
use crate::collide::{AtIsometry, Pair, Placed, Placing};
use crate::convex::Separation;
use crate::math::{AbstractRotation, Isometry, IsometryRef, Point, Real, Space, Unit, Vector};
use crate::shape::{FeatureId, Shape};
use crate::tables::ByDimension;
use crate::tables::entries;

/// Placeholders for features that were not requested.
const NO_FEATURES: [FeatureId; 2] = [FeatureId::Face(u32::MAX); 2];

/// The points of two shapes that are nearest to each other, or deepest in each other, with their
/// parts and features.
///
/// `point2 = point1 + distance · normal` up to rounding.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::query::witness;
/// use impinge::dim2::shape::{Ball, Cuboid, FeatureId};
///
/// let (square, ball) = (Cuboid::new(Vector::new(1.0_f64, 1.0)), Ball::new(1.0));
/// let there = Isometry::translation(4.0, 0.0);
/// let found = witness(&Isometry::identity(), &square, &there, &ball, 5.0).expect("near enough");
/// assert_eq!((found.distance, found.point1.x, found.point2.x), (2.0, 1.0, 3.0));
/// assert!(matches!(found.feature1, FeatureId::Face(_)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Witness<N: Real, const D: usize> {
    /// The point on the surface of the first shape, in the world frame.
    pub point1: Point<N, D>,
    /// The point on the surface of the second shape, in the world frame.
    pub point2: Point<N, D>,
    /// The unit vector from the first shape to the second.
    pub normal: Unit<Vector<N, D>>,
    /// The distance. If the shapes overlap, it is negative: minus the length of the shortest
    /// translation that separates the two parts.
    pub distance: N,
    /// The index of the first shape's part that contains `point1`; 0 for a convex solid.
    pub part1: u32,
    /// The index of the second shape's part that contains `point2`; 0 for a convex solid.
    pub part2: u32,
    /// The feature of the first shape's part that contains `point1`.
    pub feature1: FeatureId,
    /// The feature of the second shape's part that contains `point2`.
    pub feature2: FeatureId,
}

impl<N: Real, const D: usize> Witness<N, D> {
    /// Returns the witness with the shapes swapped.
    #[must_use]
    pub fn flipped(&self) -> Self {
        Self {
            point1: self.point2,
            point2: self.point1,
            normal: -self.normal,
            distance: self.distance,
            part1: self.part2,
            part2: self.part1,
            feature1: self.feature2,
            feature2: self.feature1,
        }
    }
}

/// Returns the nearest points of two shapes that are at most `max_distance` apart, with the parts
/// of composites and the features that contain the points.
///
/// [`distance`](super::distance()), [`closest_points`](super::closest_points()) and
/// [`proximity`](super::proximity()) are derived from the same result. If several pairs of points
/// are equally near, one pair is chosen; both orders of the arguments choose the same pair, and
/// among the parts of composites the lowest indices win. For composites that overlap, the result is
/// the pair of parts that are deepest in each other: a translation by `distance` along the normal
/// separates these two parts, not always the shapes.
///
/// A rounded solid has the features of its core. A distance equal to `max_distance` is within it; a
/// negative `max_distance` restricts the result to overlaps at least that deep. Returns `None` if
/// the shapes are farther apart, if `max_distance` is NaN or a pose is not finite, for a composite
/// without parts, and for two half-spaces with an unbounded overlap.
///
/// The cost for two convex solids is the cost of their distance; a composite is searched for the
/// parts near the other shape. Of two composites with n and m parts, n ≤ m, the larger one is
/// searched for each part of the smaller one that is not too far away: at most n searches of O(log
/// m). A half-space not aligned with an axis is tested against every part.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point, Vector};
/// use impinge::dim2::shape::{Ball, Cuboid, FeatureId};
/// use impinge::query::witness;
///
/// let (cuboid, ball) = (Cuboid::new(Vector::new(1.0_f64, 1.0)), Ball::new(1.0));
/// let place = Isometry::translation(4.0, 5.0);
/// let found = witness(&Isometry::identity(), &cuboid, &place, &ball, 10.0).expect("within ten");
/// assert_eq!((found.distance, found.point1), (4.0, Point::new(1.0, 1.0)));
/// assert!(matches!(found.feature1, FeatureId::Vertex(_)), "a corner of the square");
/// assert_eq!((found.part1, found.part2), (0, 0), "convex solids");
/// ```
#[must_use]
pub fn witness<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    g2: &dyn Shape<N, D>,
    max_distance: N,
) -> Option<Witness<N, D>> {
    entries::witness(R::view(m1), g1, R::view(m2), g2, max_distance)
}

/// Implements [`witness`] with poses by reference.
#[inline]
pub(crate) fn witness_at<N: Space<D>, const D: usize>(
    isometry1: IsometryRef<'_, N, D>,
    shape1: &dyn Shape<N, D>,
    isometry2: IsometryRef<'_, N, D>,
    shape2: &dyn Shape<N, D>,
    max_distance: N,
) -> Option<Witness<N, D>> {
    witness_between(
        &AtIsometry::new(isometry1, shape1),
        &AtIsometry::new(isometry2, shape2),
        max_distance,
        true,
    )
}

/// Implements [`witness`] for shapes placed by any [`Placing`]. Features are slow to compute;
/// without `with_features` they are `Face(u32::MAX)`.
#[inline]
pub(crate) fn witness_between<'a, N: Space<D>, const D: usize>(
    one: &impl Placing<'a, N, D>,
    other: &impl Placing<'a, N, D>,
    max_distance: N,
    with_features: bool,
) -> Option<Witness<N, D>> {
    let [placed1, placed2] = Placed::within(one, other, max_distance)?;
    entries::witness_in_world(&placed1, &placed2, max_distance, with_features)
}

/// Implements [`witness`] for placed shapes.
pub(crate) fn in_world<N: Space<D>, const D: usize>(
    placed1: &Placed<'_, N, D>,
    placed2: &Placed<'_, N, D>,
    limit: N,
    with_features: bool,
) -> Option<Witness<N, D>> {
    let ordered = Ordered::new(placed1, placed2);
    let found = if ordered.has_composite() {
        of_composites(&Between::of_ordered(&ordered), limit, with_features)
    } else {
        of_convex(&ordered.pair(), limit, with_features)
    };
    let (separation, mut parts, mut features) = found?;
    if !separation.distance.is_finite_number() {
        return None;
    }
    if ordered.swapped {
        parts.reverse();
        features.reverse();
    }
    let separation = placed(&separation, ordered.first, ordered.swapped);
    Some(Witness::new(&separation, parts, features))
}

/// A separation in the frame of the first shape, with its parts and their features.
type Found<N, const D: usize> = (Separation<N, D>, [u32; 2], [FeatureId; 2]);

/// Returns the separation of two convex solids and, if requested, the features; `None` if the
/// solids are farther apart than `limit` or the pose is not finite.
#[inline]
fn of_convex<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
    with_features: bool,
) -> Option<Found<N, D>> {
    if !pair.pose12.is_finite() {
        return None;
    }
    let found = separation(pair, limit)?;
    let features = features(with_features, pair, &found);
    Some((found, [0; 2], features))
}

/// Returns the separation of the nearest or deepest parts of two shapes, at least one of which is a
/// composite. `None` if the shapes are farther apart than `limit`, a composite has no parts, or the
/// pose is not finite.
fn of_composites<N: Space<D>, const D: usize>(
    between: &Between<'_, N, D>,
    limit: N,
    with_features: bool,
) -> Option<Found<N, D>> {
    if !between.pair.pose12.is_finite() {
        return None;
    }
    let found = nearest_between(between, limit, Wanted::Deepest, None)?;
    let features = features(with_features, &between.parts(found.parts).pair(), &found.local);
    Some((found.separation, found.parts, features))
}

/// Returns the features of a pair of convex solids from their separation; placeholders if
/// `is_wanted` is false.
#[inline]
fn features<N: Space<D>, const D: usize>(
    is_wanted: bool,
    pair: &Pair<'_, N, D>,
    found: &Separation<N, D>,
) -> [FeatureId; 2] {
    if is_wanted { <N::Algorithms>::witness_features(pair, found) } else { NO_FEATURES }
}

impl<N: Real, const D: usize> Witness<N, D> {
    /// Converts a separation of two convex solids in the world frame, without features; `None` for
    /// two half-spaces with an unbounded overlap.
    #[inline]
    pub(crate) fn of_separation(found: &Separation<N, D>) -> Option<Self> {
        found.distance.is_finite_number().then(|| Self::new(found, [0; 2], NO_FEATURES))
    }

    /// Builds a witness from a separation in the world frame.
    #[inline]
    fn new(
        in_world: &Separation<N, D>,
        [part1, part2]: [u32; 2],
        [feature1, feature2]: [FeatureId; 2],
    ) -> Self {
        let &Separation { distance, normal, point1, point2 } = in_world;
        let normal = Unit::new_unchecked(normal);
        Self { point1, point2, normal, distance, part1, part2, feature1, feature2 }
    }
}
