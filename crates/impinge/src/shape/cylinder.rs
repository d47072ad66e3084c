//! Cylinders, in space.

use super::error::{or_panic, size};
use super::{Geometry, Kind, Shape, ShapeError, SupportMap};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector, max, unit};

/// The points within `radius` of the y axis whose y is within `half_height` of zero.
///
/// Sizes may be zero: a disk, a segment, a point. `Face(0)` is the cap on the positive side of y,
/// `Face(1)` the one on the negative side, `Face(2)` the round side; the rims are `Edge(0)` and
/// `Edge(1)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<N: Real> {
    half_height: N,
    radius: N,
}

impl<N: Real> Cylinder<N> {
    /// The cylinder along the local y axis, of given half height and radius, each zero or more.
    ///
    /// # Panics
    /// If a size is negative or not finite; [`Self::try_new`] returns these.
    #[must_use]
    #[track_caller]
    pub fn new(half_height: N, radius: N) -> Self {
        or_panic(Self::try_new(half_height, radius))
    }

    /// The cylinder along the local y axis, of given half height and radius, each zero or more.
    ///
    /// # Errors
    /// If a size is negative or not finite.
    pub fn try_new(half_height: N, radius: N) -> Result<Self, ShapeError> {
        let half_height = size("the half height", half_height)?;
        Ok(Self { half_height, radius: size("the radius", radius)? })
    }

    /// Half the height along the y axis.
    #[inline]
    #[must_use]
    pub const fn half_height(&self) -> N {
        self.half_height
    }

    /// The radius.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }
}

/// The point of the rim of a disk of `radius` around the y axis that lies farthest along `direction`;
/// the middle of the disk for a direction along the axis.
pub(super) fn rim_toward<N: Real>(radius: N, y: N, direction: &Vector<N, 3>) -> Point<N, 3> {
    let radial = unit(&Vector::<N, 2>::new(direction.x, direction.z));
    let (x, z) =
        radial.map_or((N::ZERO, N::ZERO), |(along, _)| (along.x * radius, along.y * radius));
    Point::<N, 3>::new(x, y, z)
}

/// How far a disk of `radius` reaches along each outer axis when its axis points along `axis`.
pub(super) fn disk_reach<N: Real>(radius: N, axis: &Vector<N, 3>) -> Vector<N, 3> {
    axis.map(|a| max(N::ONE - a * a, N::ZERO).sqrt() * radius)
}

impl<N: Real> SupportMap<N, 3> for Cylinder<N> {
    fn core_support(&self, direction: &Vector<N, 3>) -> Point<N, 3> {
        let y = if direction.y < N::ZERO { -self.half_height } else { self.half_height };
        rim_toward(self.radius, y, direction)
    }

    fn reach(&self) -> N {
        (self.half_height * self.half_height + self.radius * self.radius).sqrt()
    }
}

impl<N: Real> Shape<N, 3> for Cylinder<N> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        Geometry(Kind::Cylinder(self, self))
    }

    fn local_aabb(&self) -> Aabb<N, 3> {
        let reach = Vector::<N, 3>::new(self.radius, self.half_height, self.radius);
        Aabb::around(Point::origin(), reach)
    }

    fn aabb(&self, pose: &Pose<N, 3>) -> Aabb<N, 3> {
        let axis = pose.rotation.column(1).into_owned();
        let reach = axis.abs() * self.half_height + disk_reach(self.radius, &axis);
        Aabb::around(Point::from(pose.translation), reach)
    }
}
