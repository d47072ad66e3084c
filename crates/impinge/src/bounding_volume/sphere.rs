//! Bounding spheres (disks in 2D).

use core::fmt;

use super::{Aabb, BoundingVolume, Ray};
use crate::math::outward::{slack_of, sum_above};
use crate::math::{Point, Pose, Real, Vector, max, unit};

/// A bounding sphere: the points within `radius` of `center`.
///
/// The radius may be zero (a point) or infinite (the whole space).
///
/// ```
/// use impinge::dim3::bounding_volume::{BoundingSphere, BoundingVolume};
/// use impinge::dim3::math::Point;
///
/// let sphere = BoundingSphere::new(Point::origin(), 2.0_f32);
/// assert!(sphere.contains_point(&Point::new(0.0, 2.0, 0.0)));
/// assert!(sphere.intersects(&BoundingSphere::new(Point::new(3.0, 0.0, 0.0), 1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere<N: Real, const D: usize> {
    center: Point<N, D>,
    radius: N,
}

/// The reason why a centre and a radius were rejected as a sphere.
///
/// ```
/// use impinge::dim2::bounding_volume::{BoundingSphere, BoundingSphereError};
/// use impinge::dim2::math::Point;
///
/// let refused = BoundingSphere::try_new(Point::origin(), -1.0_f32);
/// assert_eq!(refused, Err(BoundingSphereError::Radius(-1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BoundingSphereError<N: Real> {
    /// The radius is negative or NaN.
    Radius(N),
    /// The coordinate of the centre on this axis is not finite.
    Center(usize),
}

impl<N: Real> fmt::Display for BoundingSphereError<N> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Radius(radius) => write!(f, "{radius} is no radius of a sphere"),
            Self::Center(axis) => write!(f, "the sphere's centre is not finite on axis {axis}"),
        }
    }
}

impl<N: Real> std::error::Error for BoundingSphereError<N> {}

impl<N: Real, const D: usize> BoundingSphere<N, D> {
    /// Creates the sphere with the given centre and radius.
    ///
    /// # Panics
    /// If the radius is negative or NaN or the centre is not finite; [`Self::try_new`] returns an
    /// error instead.
    #[must_use]
    #[track_caller]
    pub fn new(center: Point<N, D>, radius: N) -> Self {
        match Self::try_new(center, radius) {
            Ok(sphere) => sphere,
            Err(error) => panic!("{error}"),
        }
    }

    /// Creates the sphere with the given centre and radius.
    ///
    /// # Errors
    /// If the radius is negative or NaN or the centre is not finite.
    pub fn try_new(center: Point<N, D>, radius: N) -> Result<Self, BoundingSphereError<N>> {
        if let Some(axis) = center.iter().position(|x| !x.is_finite_number()) {
            return Err(BoundingSphereError::Center(axis));
        }
        let usable = radius >= N::ZERO;
        if usable { Ok(Self { center, radius }) } else { Err(BoundingSphereError::Radius(radius)) }
    }

    /// Returns a sphere with an infinite radius, which contains the whole space.
    #[must_use]
    pub fn unbounded() -> Self {
        Self { center: Point::origin(), radius: N::INFINITY }
    }

    /// Returns the centre.
    pub const fn center(&self) -> &Point<N, D> {
        &self.center
    }

    /// Returns the radius.
    pub const fn radius(&self) -> N {
        self.radius
    }

    /// Returns a sphere that contains a box; the whole space if the box is unbounded.
    pub(crate) fn around_box(aabb: &Aabb<N, D>) -> Self {
        let center = aabb.center();
        let farthest = Vector::<N, D>::from_fn(|axis, _| {
            max(aabb.maxs()[axis] - center[axis], center[axis] - aabb.mins()[axis])
        });
        Self::try_new(center, length_above(&farthest)).unwrap_or_else(|_| Self::unbounded())
    }

    /// Returns an upper bound of the distance from `center` to a point of this sphere.
    pub(crate) fn farthest_from(&self, center: &Point<N, D>) -> N {
        sum_above(length_above(&(self.center - center)), self.radius)
    }

    /// Returns this sphere placed at `pose`, rounded outwards. The result is exact if the sphere is
    /// centred at the origin and the pose maps axes to axes.
    #[must_use]
    pub fn transformed_by(&self, pose: &Pose<N, D>) -> Self {
        let (center, mut radius) = (pose.point(&self.center), self.radius);
        if self.center != Point::origin() {
            let size = length_above(&self.center.coords) + length_above(&pose.translation);
            radius = sum_above(radius, slack_of(size));
        }
        if !pose.is_aligned() {
            // A rounded rotation matrix may lengthen vectors.
            radius = sum_above(radius, slack_of(radius));
        }
        Self { center, radius }
    }
}

/// Returns an upper bound of the length of a vector whose components have a relative error of at
/// most ε/2. The bound is infinite for a vector that is not finite, and zero for the zero vector.
fn length_above<N: Real, const D: usize>(v: &Vector<N, D>) -> N {
    match unit(v) {
        Some((_, length)) => length + slack_of(length),
        None if *v == Vector::<N, D>::zeros() => N::ZERO,
        None => N::INFINITY,
    }
}

impl<N: Real, const D: usize> BoundingVolume<N> for BoundingSphere<N, D> {
    type Point = Point<N, D>;
    type Ray = Ray<N, D>;
    type Vector = Vector<N, D>;

    fn intersects(&self, other: &Self) -> bool {
        (other.center - self.center).norm() <= self.radius + other.radius
    }

    fn contains(&self, other: &Self) -> bool {
        other.farthest_from(&self.center) <= self.radius
    }

    fn merged(&self, other: &Self) -> Self {
        if self.contains(other) {
            return *self;
        }
        if other.contains(self) {
            return *other;
        }
        let Some((direction, distance)) = unit(&(other.center - self.center)) else {
            // The distance between the centres overflows.
            return Self::unbounded();
        };
        let share = (other.radius - self.radius + distance) * N::HALF;
        let center = self.center + direction * share;
        let radius = max(self.farthest_from(&center), other.farthest_from(&center));
        Self::try_new(center, radius).unwrap_or_else(|_| Self::unbounded())
    }

    fn loosened(&self, margin: N) -> Self {
        Self { radius: sum_above(self.radius, margin), ..*self }
    }

    fn swept(&self, velocity: &Vector<N, D>, max_time: N) -> Self {
        let Some((_, speed)) = unit(velocity) else { return *self };
        let travel = speed * max_time;
        let rounding = slack_of(length_above(&self.center.coords) + travel);
        let radius = sum_above(self.radius, rounding);
        let moved = Self::try_new(self.center + velocity * max_time, radius);
        // If the path is not finite, the result is the whole space.
        moved.map_or_else(|_| Self::unbounded(), |moved| self.merged(&moved))
    }

    fn contains_point(&self, point: &Point<N, D>) -> bool {
        (point - self.center).norm() <= self.radius
    }

    fn intersects_ray(&self, ray: &Ray<N, D>) -> bool {
        let to_center = self.center - ray.origin;
        let nearest = unit(&ray.dir).map_or(ray.origin, |(direction, _)| {
            ray.origin + direction * max(direction.dot(&to_center), N::ZERO)
        });
        self.contains_point(&nearest)
    }
}

#[cfg(test)]
mod tests {
    use super::super::BoundingVolume;
    use super::*;

    type P = Point<f64, 3>;

    #[test]
    fn merging_encloses_both_tightly() {
        let left = BoundingSphere::new(P::new(-2.0, 0.0, 0.0), 1.0);
        let right = BoundingSphere::new(P::new(3.0, 0.0, 0.0), 2.0);
        let both = left.merged(&right);
        assert!((both.center().x - 1.0).abs() < 1e-14, "{both:?}");
        assert!((4.0..4.0 + 2e-14).contains(&both.radius()), "from -3 to 5: {both:?}");
        assert_eq!(both.merged(&left), both, "nothing to add");
    }

    #[test]
    fn spheres_around_a_path() {
        let sphere = BoundingSphere::new(P::new(1.0, 0.0, 0.0), 1.0);
        let swept = sphere.swept(&Vector::<f64, 3>::new(0.0, 2.0, 0.0), 3.0);
        assert!((swept.center().y - 3.0).abs() < 1e-14, "{swept:?}");
        assert!((4.0..4.0 + 4e-14).contains(&swept.radius()), "from -1 to 7: {swept:?}");
        assert_eq!(sphere.swept(&Vector::<f64, 3>::zeros(), f64::INFINITY), sphere, "it rests");
        let endless = sphere.swept(&Vector::<f64, 3>::x(), f64::INFINITY);
        assert!(endless.radius().is_infinite(), "everything");
    }

    #[test]
    fn rays_start_at_their_origin() {
        let sphere = BoundingSphere::new(P::new(0.0, 0.0, 5.0), 1.0);
        let towards = Ray::new(P::new(0.0, 1.0, 0.0), Vector::<f64, 3>::new(0.0, 0.0, 3.0));
        assert!(sphere.intersects_ray(&towards), "it grazes the top");
        let away = Ray::new(P::new(0.0, 1.0, 0.0), Vector::<f64, 3>::new(0.0, 0.0, -3.0));
        assert!(!sphere.intersects_ray(&away), "the sphere lies behind");
    }

    #[test]
    fn bad_radii_are_refused() {
        let negative = BoundingSphere::try_new(P::origin(), -1.0);
        assert_eq!(negative, Err(BoundingSphereError::Radius(-1.0)), "negative");
        assert!(BoundingSphere::try_new(P::origin(), f64::NAN).is_err(), "NaN");
    }
}
