//! Cones, in space.

use super::cylinder::{disk_reach, rim_toward};
use super::error::{or_panic, size};
use super::{Geometry, Kind, Shape, ShapeError, SupportMap};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector, max, min};

/// The points between the apex at `(0, half_height, 0)` and the disk of `radius` around
/// `(0, -half_height, 0)`.
///
/// Sizes may be zero: a disk, a segment, a point. `Vertex(0)` is the apex, `Face(0)` the base,
/// `Face(1)` the round side, `Edge(0)` the rim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<N: Real> {
    half_height: N,
    radius: N,
}

impl<N: Real> Cone<N> {
    /// The cone along the local y axis, of given half height and radius, each zero or more.
    ///
    /// # Panics
    /// If a size is negative or not finite; [`Self::try_new`] returns these.
    #[must_use]
    #[track_caller]
    pub fn new(half_height: N, radius: N) -> Self {
        or_panic(Self::try_new(half_height, radius))
    }

    /// The cone along the local y axis, of given half height and radius, each zero or more.
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

    /// The radius of the base.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }
}

impl<N: Real> SupportMap<N, 3> for Cone<N> {
    fn core_support(&self, direction: &Vector<N, 3>) -> Point<N, 3> {
        let rim = rim_toward(self.radius, -self.half_height, direction);
        let apex = Point::<N, 3>::new(N::ZERO, self.half_height, N::ZERO);
        if (apex - rim).dot(direction) > N::ZERO { apex } else { rim }
    }

    fn reach(&self) -> N {
        (self.half_height * self.half_height + self.radius * self.radius).sqrt()
    }
}

impl<N: Real> Shape<N, 3> for Cone<N> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        Geometry(Kind::Cone(self, self))
    }

    fn local_aabb(&self) -> Aabb<N, 3> {
        let reach = Vector::<N, 3>::new(self.radius, self.half_height, self.radius);
        Aabb::around(Point::origin(), reach)
    }

    fn aabb(&self, pose: &Pose<N, 3>) -> Aabb<N, 3> {
        let axis = pose.rotation.column(1).into_owned();
        let (apex, disk) = (axis * self.half_height, disk_reach(self.radius, &axis));
        let mins = pose.translation + apex.zip_map(&(-apex - disk), min);
        let maxs = pose.translation + apex.zip_map(&(-apex + disk), max);
        Aabb::new(Point::from(mins), Point::from(maxs))
    }
}
