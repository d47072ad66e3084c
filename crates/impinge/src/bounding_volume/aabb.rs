//! Axis-aligned boxes.

use core::fmt;

use super::{BoundingVolume, Ray};
use crate::math::outward::{product_within, sum_above, sum_below};
use crate::math::{Point, Real, Vector, max, max_component, min};

/// An axis-aligned box: the points between two corners, including the faces.
///
/// `mins ≤ maxs` on every axis and no coordinate is NaN. Faces may be infinite: such a box is
/// unbounded. Zero extents are allowed.
///
/// ```
/// use impinge::dim2::bounding_volume::{Aabb, BoundingVolume};
/// use impinge::dim2::math::{Point, Vector};
///
/// let left = Aabb::new(Point::new(0.0_f32, 0.0), Point::new(2.0, 1.0));
/// let right = Aabb::from_half_extents(Point::new(3.0, 0.5), Vector::new(1.0, 0.5));
/// assert!(left.intersects(&right), "touching counts");
/// assert_eq!(left.merged(&right).maxs(), &Point::new(4.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<N: Real, const D: usize> {
    pub(super) mins: Point<N, D>,
    pub(super) maxs: Point<N, D>,
}

/// The reason why two corners were rejected as a box. Coordinates are converted to `f64`, exactly.
///
/// ```
/// use impinge::dim2::bounding_volume::{Aabb, AabbError};
/// use impinge::dim2::math::Point;
///
/// let refused = Aabb::try_new(Point::new(2.0_f32, 0.0), Point::new(1.0, 1.0)).expect_err("inverted");
/// assert_eq!(refused, AabbError::Inverted { axis: 0, min: 2.0, max: 1.0 });
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum AabbError {
    /// A coordinate is NaN.
    NotANumber {
        /// The axis of the error: 0 for x.
        axis: usize,
        /// The coordinate of the first corner on this axis.
        min: f64,
        /// The coordinate of the second corner on this axis.
        max: f64,
    },
    /// The first corner exceeds the second on an axis.
    Inverted {
        /// The axis of the error: 0 for x.
        axis: usize,
        /// The coordinate of the first corner on this axis.
        min: f64,
        /// The coordinate of the second corner on this axis.
        max: f64,
    },
}

impl fmt::Display for AabbError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber { axis, min, max } => {
                write!(f, "the box is not a number on axis {axis}: from {min} to {max}")
            }
            Self::Inverted { axis, min, max } => {
                write!(f, "the box is inverted on axis {axis}: from {min} to {max}")
            }
        }
    }
}

impl std::error::Error for AabbError {}

impl<N: Real, const D: usize> Aabb<N, D> {
    /// Creates the box between two corners.
    ///
    /// # Panics
    /// If a coordinate is NaN or `mins` exceeds `maxs` on an axis; [`Aabb::try_new`] returns an
    /// error instead.
    #[must_use]
    #[track_caller]
    pub fn new(mins: Point<N, D>, maxs: Point<N, D>) -> Self {
        match Self::try_new(mins, maxs) {
            Ok(aabb) => aabb,
            Err(error) => panic!("{error}"),
        }
    }

    /// Creates the box between two corners.
    ///
    /// # Errors
    /// If a coordinate is NaN or `mins` exceeds `maxs` on an axis.
    pub fn try_new(mins: Point<N, D>, maxs: Point<N, D>) -> Result<Self, AabbError> {
        for axis in 0..D {
            let (low, high) = (mins[axis], maxs[axis]);
            let (min, max) = (low.as_f64(), high.as_f64());
            if low > high {
                return Err(AabbError::Inverted { axis, min, max });
            }
            let ordered = low <= high;
            if !ordered {
                return Err(AabbError::NotANumber { axis, min, max });
            }
        }
        Ok(Self { mins, maxs })
    }

    /// Creates the box with the given centre and half extents, rounded outwards.
    ///
    /// # Panics
    /// If a coordinate is NaN, or a half extent is so negative that the rounded corners are
    /// inverted; [`Aabb::try_from_half_extents`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn from_half_extents(center: Point<N, D>, half_extents: Vector<N, D>) -> Self {
        match Self::try_from_half_extents(center, half_extents) {
            Ok(aabb) => aabb,
            Err(error) => panic!("{error}"),
        }
    }

    /// Creates the box with the given centre and half extents, rounded outwards.
    ///
    /// # Errors
    /// If a coordinate is NaN, or a half extent is so negative that the rounded corners are
    /// inverted.
    pub fn try_from_half_extents(
        center: Point<N, D>,
        half_extents: Vector<N, D>,
    ) -> Result<Self, AabbError> {
        let aabb = Self::around(center, half_extents);
        Self::try_new(aabb.mins, aabb.maxs)
    }

    /// Returns the box that contains only the given point. The coordinates are not checked for NaN.
    pub(crate) const fn at(point: Point<N, D>) -> Self {
        Self { mins: point, maxs: point }
    }

    /// Returns the smallest box around some points; `None` if there are no points or a coordinate
    /// is NaN.
    #[must_use]
    pub fn from_points(points: &[Point<N, D>]) -> Option<Self> {
        Self::around_all(points.iter().copied())
    }

    /// Implements [`Self::from_points`] for an iterator.
    pub(crate) fn around_all(mut points: impl Iterator<Item = Point<N, D>>) -> Option<Self> {
        let first = points.next()?;
        let is_usable = |point: &Point<N, D>| point.iter().all(|x| x.partial_cmp(x).is_some());
        let mut aabb = Self::at(first);
        let mut are_usable = is_usable(&first);
        for point in points {
            aabb.mins = Point::from(aabb.mins.coords.zip_map(&point.coords, min));
            aabb.maxs = Point::from(aabb.maxs.coords.zip_map(&point.coords, max));
            are_usable &= is_usable(&point);
        }
        are_usable.then_some(aabb)
    }

    /// Returns the box of the whole space.
    #[must_use]
    pub fn unbounded() -> Self {
        let infinity = Vector::<N, D>::repeat(N::INFINITY);
        Self { mins: Point::from(-infinity), maxs: Point::from(infinity) }
    }

    /// Returns the corner with the least coordinates.
    #[inline]
    pub const fn mins(&self) -> &Point<N, D> {
        &self.mins
    }

    /// Returns the corner with the greatest coordinates.
    #[inline]
    pub const fn maxs(&self) -> &Point<N, D> {
        &self.maxs
    }

    /// Returns the centre; not finite if the box is unbounded or its size overflows.
    pub fn center(&self) -> Point<N, D> {
        self.mins + self.half_extents()
    }

    /// Returns half the size along each axis; infinite where the box is unbounded or its size
    /// overflows.
    pub fn half_extents(&self) -> Vector<N, D> {
        (self.maxs - self.mins) * N::HALF
    }

    /// Returns `true` if every face is finite.
    pub fn is_bounded(&self) -> bool {
        self.mins.iter().chain(self.maxs.iter()).all(|x| x.is_finite_number())
    }

    /// Returns the times at which the ray enters and leaves the box, clamped to `t ≥ 0`; `None` if
    /// the ray misses the box.
    ///
    /// This is the slab test (Kay and Kajiya 1986). A ray that lies in a face hits the box.
    pub fn ray_interval(&self, ray: &Ray<N, D>) -> Option<(N, N)> {
        let (mut enter, mut leave) = (N::ZERO, N::INFINITY);
        for axis in 0..D {
            let (origin, speed) = (ray.origin[axis], ray.dir[axis]);
            if speed == N::ZERO {
                if origin < self.mins[axis] || origin > self.maxs[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.mins[axis] - origin) / speed, (self.maxs[axis] - origin) / speed);
            enter = max(enter, min(a, b));
            leave = min(leave, max(a, b));
        }
        (enter <= leave).then_some((enter, leave))
    }

    /// Returns the times at which the box `moving`, with `velocity`, begins and ceases to touch
    /// this box, clamped to `t ≥ 0`; `None` if the boxes do not touch at any `t ≥ 0`.
    ///
    /// This is the slab test with the extents of both boxes added. If `moving` is a single point,
    /// the result equals [`Self::ray_interval`] for the ray from that point along `velocity`. With
    /// a zero velocity the interval is from zero to infinity, or the result is `None`. The velocity
    /// must be finite.
    pub fn sweep_interval(&self, moving: &Self, velocity: &Vector<N, D>) -> Option<(N, N)> {
        let (mut enter, mut leave) = (N::ZERO, N::INFINITY);
        for axis in 0..D {
            let (low, high) = (moving.mins[axis], moving.maxs[axis]);
            let speed = velocity[axis];
            if speed == N::ZERO {
                if high < self.mins[axis] || low > self.maxs[axis] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.mins[axis] - high) / speed, (self.maxs[axis] - low) / speed);
            enter = max(enter, min(a, b));
            leave = min(leave, max(a, b));
        }
        (enter <= leave).then_some((enter, leave))
    }

    /// Returns the distance from the box to a point, zero inside.
    pub fn distance_to_point(&self, point: &Point<N, D>) -> N {
        self.distance_to_aabb(&Self::at(*point))
    }

    /// Returns the distance between two boxes, zero if they overlap. A distance whose square
    /// underflows becomes zero.
    pub fn distance_to_aabb(&self, other: &Self) -> N {
        let below = (self.mins - other.maxs).map(|x| max(x, N::ZERO));
        let above = (other.mins - self.maxs).map(|x| max(x, N::ZERO));
        let gaps = below + above;
        let distance = gaps.norm();
        if distance.is_finite_number() { distance } else { long_distance(&gaps) }
    }

    /// Returns `true` if the box contains a finite point: it is neither inverted nor NaN nor
    /// entirely at infinity.
    pub(crate) fn holds_finite_point(&self) -> bool {
        let holds = |low: N, high: N| low <= high && low < N::INFINITY && high > -N::INFINITY;
        (0..D).all(|axis| holds(self.mins[axis], self.maxs[axis]))
    }
}

/// Returns the length of a vector whose squared length overflows. The result is never less than the
/// largest length whose square is finite. So distances are monotonic: a box that encloses another
/// box is not farther away.
#[cold]
fn long_distance<N: Real, const D: usize>(gaps: &Vector<N, D>) -> N {
    let largest = max_component(gaps);
    if !largest.is_finite_number() {
        return N::INFINITY;
    }
    let scale = largest.power_of_two_below();
    max((gaps / scale).norm() * scale, N::MAX.sqrt())
}

impl<N: Real, const D: usize> BoundingVolume<N> for Aabb<N, D> {
    type Point = Point<N, D>;
    type Ray = Ray<N, D>;
    type Vector = Vector<N, D>;

    #[inline]
    fn intersects(&self, other: &Self) -> bool {
        (0..D)
            .all(|axis| self.mins[axis] <= other.maxs[axis] && other.mins[axis] <= self.maxs[axis])
    }

    #[inline]
    fn contains(&self, other: &Self) -> bool {
        (0..D)
            .all(|axis| self.mins[axis] <= other.mins[axis] && other.maxs[axis] <= self.maxs[axis])
    }

    fn merged(&self, other: &Self) -> Self {
        Self {
            mins: Point::from(self.mins.coords.zip_map(&other.mins.coords, min)),
            maxs: Point::from(self.maxs.coords.zip_map(&other.maxs.coords, max)),
        }
    }

    fn loosened(&self, margin: N) -> Self {
        let mut grown = *self;
        for axis in 0..D {
            grown.mins[axis] = sum_below(self.mins[axis], -margin);
            grown.maxs[axis] = sum_above(self.maxs[axis], margin);
        }
        grown
    }

    fn swept(&self, velocity: &Vector<N, D>, max_time: N) -> Self {
        let mut swept = *self;
        for axis in 0..D {
            // A velocity component of zero causes no motion, even in infinite time.
            if velocity[axis] != N::ZERO {
                let [back, forth] = product_within(velocity[axis], max_time);
                swept.mins[axis] = sum_below(self.mins[axis], min(back, N::ZERO));
                swept.maxs[axis] = sum_above(self.maxs[axis], max(forth, N::ZERO));
            }
        }
        swept
    }

    fn contains_point(&self, point: &Point<N, D>) -> bool {
        (0..D).all(|axis| self.mins[axis] <= point[axis] && point[axis] <= self.maxs[axis])
    }

    fn intersects_ray(&self, ray: &Ray<N, D>) -> bool {
        self.ray_interval(ray).is_some()
    }
}

#[cfg(test)]
mod tests {
    use super::super::BoundingVolume;
    use super::*;
    use crate::math::{Isometry2, Pose};

    type P = Point<f64, 2>;

    fn unit_box() -> Aabb<f64, 2> {
        Aabb::new(P::new(0.0, 0.0), P::new(1.0, 1.0))
    }

    #[test]
    fn bad_corners_are_refused() {
        let nan = Aabb::try_new(P::new(0.0, f64::NAN), P::new(1.0, 1.0));
        assert!(matches!(nan, Err(AabbError::NotANumber { axis: 1, .. })), "NaN on y");
        let inverted = Aabb::try_new(P::new(2.0, 0.0), P::new(1.0, 1.0));
        let error = inverted.expect_err("inverted on x");
        assert_eq!(error, AabbError::Inverted { axis: 0, min: 2.0, max: 1.0 }, "inverted on x");
        assert_eq!(error.to_string(), "the box is inverted on axis 0: from 2 to 1", "in words");
    }

    #[test]
    fn touching_boxes_intersect() {
        let right = Aabb::new(P::new(1.0, 1.0), P::new(2.0, 2.0));
        assert!(unit_box().intersects(&right), "they share a corner");
        let beyond = Aabb::new(P::new(1.0 + 1e-9, 0.0), P::new(2.0, 2.0));
        assert!(!unit_box().intersects(&beyond), "a gap is a gap");
    }

    #[test]
    fn rays_through_corners_and_along_faces_hit() {
        let cases = [
            ([-1.0, -1.0], [1.0, 1.0], Some((1.0, 2.0))),
            ([-1.0, 1.0], [1.0, 0.0], Some((1.0, 2.0))),
            ([-1.0, 1.1], [1.0, 0.0], None),
            ([0.5, 0.5], [0.0, 0.0], Some((0.0, f64::INFINITY))),
            ([2.0, 0.5], [1.0, 0.0], None),
        ];
        for (origin, dir, expected) in cases {
            let ray = Ray::new(P::from(origin), Vector::<f64, 2>::from(dir));
            assert_eq!(unit_box().ray_interval(&ray), expected, "from {origin:?} along {dir:?}");
        }
    }

    #[test]
    fn moving_boxes_touch_for_a_while() {
        let half = Vector::<f64, 2>::new(0.5, 0.5);
        let cases = [
            ([-2.5, 0.5], [2.0, 0.0], Some((1.0, 2.0))),
            ([-1.5, 1.5], [1.0, 0.0], Some((1.0, 3.0))),
            ([-1.5, 1.6], [1.0, 0.0], None),
            ([3.5, 3.5], [-1.0, -2.0], Some((2.0, 2.0))),
            ([1.25, 0.0], [0.0, 0.0], Some((0.0, f64::INFINITY))),
            ([1.75, 0.0], [0.0, 0.0], None),
            ([1.25, 0.0], [1.0, 0.0], Some((0.0, 0.25))),
        ];
        for (center, velocity, expected) in cases {
            let moving = Aabb::around(P::from(center), half);
            let found = unit_box().sweep_interval(&moving, &Vector::<f64, 2>::from(velocity));
            assert_eq!(found, expected, "from {center:?} along {velocity:?}");
        }
        let halves = Aabb::new(P::new(f64::NEG_INFINITY, 0.0), P::new(-1.0, f64::INFINITY));
        let found = unit_box().sweep_interval(&halves, &Vector::<f64, 2>::new(0.5, -1.0));
        assert_eq!(found, Some((2.0, f64::INFINITY)), "a box without an end never leaves");
    }

    #[test]
    fn boxes_around_a_path() {
        let swept = unit_box().swept(&Vector::<f64, 2>::new(-2.0, 0.0), 1.5);
        assert_eq!(swept, Aabb::new(P::new(-3.0, 0.0), P::new(1.0, 1.0)), "three to the left");
        let swept = unit_box().swept(&Vector::<f64, 2>::new(0.0, 1.0), f64::INFINITY);
        assert_eq!(swept.maxs(), &P::new(1.0, f64::INFINITY), "up for ever");
        assert_eq!(swept.mins(), unit_box().mins(), "and nowhere else");
    }

    #[test]
    fn distances_between_boxes() {
        let at = |x: f64, y: f64| Aabb::new(P::new(x, y), P::new(x + 1.0, y + 2.0));
        assert_eq!(unit_box().distance_to_aabb(&at(4.0, 5.0)), 5.0, "corner to corner");
        assert_eq!(unit_box().distance_to_aabb(&at(-4.0, -1.0)), 3.0, "side to side");
        assert_eq!(unit_box().distance_to_aabb(&at(1.0, -2.0)), 0.0, "they touch");
        assert_eq!(unit_box().distance_to_aabb(&Aabb::unbounded()), 0.0, "in everything");
        assert_eq!(Aabb::unbounded().distance_to_aabb(&Aabb::<f64, 2>::unbounded()), 0.0, "both");
        let far = Aabb::at(P::new(3e200, 4e200));
        assert!(
            (far.distance_to_aabb(&unit_box()) / 5e200 - 1.0).abs() < 1e-15,
            "squares overflow"
        );
        let edge = Aabb::at(P::new(f64::MAX, -f64::MAX));
        assert_eq!(edge.distance_to_aabb(&unit_box()), f64::INFINITY, "beyond the scalar");
    }

    #[test]
    fn a_rotated_unbounded_box_stays_unbounded_without_nan() {
        let strip = Aabb::new(P::new(f64::NEG_INFINITY, 0.0), P::new(f64::INFINITY, 1.0));
        let still = strip.transformed_by(&Pose::identity());
        assert_eq!(still, strip, "an identity pose changes nothing");
        let rotated = strip.transformed_by(&Pose::from_isometry(&Isometry2::rotation(0.3)));
        assert_eq!(rotated, Aabb::unbounded(), "both axes have a component of the infinite one");
    }

    #[test]
    fn a_rotated_square_fits_its_box() {
        let rotated = unit_box().transformed_by(&Pose::from_isometry(&Isometry2::rotation(
            std::f64::consts::FRAC_PI_4,
        )));
        let half = std::f64::consts::FRAC_1_SQRT_2;
        assert!((rotated.maxs() - P::new(half, 2.0 * half)).norm() < 8e-15, "{rotated:?}");
    }
}
