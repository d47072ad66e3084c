//! Balls (disks in 2D).

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::{or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::{
    Ellipsoid, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle, SupportMap,
};

/// The points within `radius` of the local origin.
///
/// With radius 0 it is a point. Scaling by factors of different magnitudes gives an [`Ellipsoid`].
/// The only feature is `Face(0)`.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::Ball;
///
/// let ball = Ball::new(2.0_f32);
/// let place = Isometry::translation(5.0, 0.0, 0.0);
/// assert_eq!(ball.distance_to_point(&place, &Point::origin(), true), 3.0);
/// assert!(Ball::try_new(-1.0_f32).is_err());
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball<N: Real> {
    radius: N,
}

impl<N: Real> Ball<N> {
    /// Returns the ball with the given radius, zero or more.
    ///
    /// # Panics
    /// If the radius is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(radius: N) -> Self {
        or_panic(Self::try_new(radius))
    }

    /// Returns the ball with the given radius, zero or more.
    ///
    /// # Errors
    /// If the radius is negative or not finite.
    pub fn try_new(radius: N) -> Result<Self, ShapeError> {
        Ok(Self { radius: size("the radius", radius)? })
    }

    /// Returns the ball with a valid radius; the radius is not checked.
    pub(in crate::shape) const fn of_radius(radius: N) -> Self {
        Self { radius }
    }

    /// Returns the radius.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Ball<N> {
    fn core_support(&self, _: &Vector<N, D>) -> Point<N, D> {
        Point::origin()
    }

    fn rounding(&self) -> N {
        self.radius
    }

    fn reach(&self) -> N {
        N::ZERO
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Ball<N> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Ball(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        Aabb::around(Point::origin(), Vector::<N, D>::repeat(self.radius))
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        Aabb::around(Point::from(pose.translation), Vector::<N, D>::repeat(self.radius))
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        BoundingSphere::new(Point::origin(), self.radius)
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let scale = Scale::try_new(scale)?;
        if let Ok(factor) = scale.uniform() {
            return Ok(ShapeHandle::new(Self::try_new(self.radius * factor)?));
        }
        Ok(ShapeHandle::new(Ellipsoid::try_new(scale.magnitudes() * self.radius)?))
    }
}
