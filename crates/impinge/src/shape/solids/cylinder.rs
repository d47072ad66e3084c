//! Cylinders, in 3D.

use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::{or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::solids::round::{Disk, RoundPart, axial_on, radial_of};
use crate::shape::solids::segment::length_of;
use crate::shape::tilt::Tilt;
use crate::shape::{
    CurvedSupport, Feature, FeatureId, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle,
    SupportMap,
};

/// The points with a distance of at most `radius` from the y axis and with |y| ≤ `half_height`.
///
/// Sizes may be zero; the cylinder is then a disk, a segment or a point. `Face(0)` is the cap at
/// positive y, `Face(1)` the cap at negative y, `Face(2)` the round side. `Edge(0)` and `Edge(1)`
/// are the rims of these caps.
///
/// As features the caps are inscribed octagons whose vertices and sides all have the id of the rim.
/// The round side is its generating segment nearest to the direction; the ends of the segment have
/// the ids of the rims.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::{Ray, RayCast};
/// use impinge::dim3::shape::Cylinder;
///
/// let cylinder = Cylinder::new(1.0_f64, 0.5);
/// let down = Ray::new(Point::new(0.25, 5.0, 0.0), -Vector::y());
/// assert_eq!(cylinder.toi_with_ray(&Isometry::identity(), &down, true), Some(4.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder<N: Real> {
    half_height: N,
    radius: N,
}

impl<N: Real> Cylinder<N> {
    /// Returns the cylinder along the local y axis with the given half height and radius, each zero
    /// or more.
    ///
    /// # Panics
    /// If a size is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(half_height: N, radius: N) -> Self {
        or_panic(Self::try_new(half_height, radius))
    }

    /// Returns the cylinder along the local y axis with the given half height and radius, each zero
    /// or more.
    ///
    /// # Errors
    /// If a size is negative or not finite.
    pub fn try_new(half_height: N, radius: N) -> Result<Self, ShapeError> {
        let half_height = size("the half height", half_height)?;
        Ok(Self { half_height, radius: size("the radius", radius)? })
    }

    /// Returns half of the height along the y axis.
    #[inline]
    #[must_use]
    pub const fn half_height(&self) -> N {
        self.half_height
    }

    /// Returns the radius.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }
}

impl<N: Real> Cylinder<N> {
    fn disk(&self, y: N) -> Disk<N> {
        Disk { radius: self.radius, y }
    }
}

impl<N: Real> Cylinder<N> {
    /// Returns the id of the cap, rim or round side on which a surface point lies, up to
    /// `tolerance`. `None` for a cylinder with a half height or radius of at most `4 tolerance`.
    pub(crate) fn part_at<const D: usize>(
        &self,
        point: &Point<N, D>,
        tolerance: N,
    ) -> Option<FeatureId> {
        let (y, aside) = axial_on(point, [self.half_height, self.radius], tolerance)?;
        let side = u32::from(y < N::ZERO);
        let is_at_end = y.abs() >= self.half_height - tolerance;
        Some(if is_at_end && aside >= self.radius - tolerance {
            FeatureId::Edge(side)
        } else {
            FeatureId::Face(if is_at_end { side } else { 2 })
        })
    }
}

impl<N: Real> Cylinder<N> {
    /// Returns the index and the y coordinate of the cap on the side of a direction.
    fn end_toward(&self, direction: &Vector<N, 3>) -> (u32, N) {
        if direction.y < N::ZERO { (1, -self.half_height) } else { (0, self.half_height) }
    }

    /// Returns the supporting feature for a unit vector; `None` if it is a cap.
    pub(crate) fn supporting_part(&self, direction: &Vector<N, 3>) -> Option<RoundPart<N>> {
        if Tilt::default_limit().admits(radial_of(direction).norm_squared()) {
            return None;
        }
        let (side, y) = self.end_toward(direction);
        let (rim, near) = (FeatureId::Edge(side), self.disk(y).rim_toward(direction));
        let is_line =
            Tilt::default_limit().admits(direction.y * direction.y) && self.half_height > N::ZERO;
        Some(if is_line {
            let far = Point::<N, 3>::new(near.x, -y, near.z);
            RoundPart::Line(FeatureId::Face(2), [(FeatureId::Edge(1 - side), far), (rim, near)])
        } else {
            RoundPart::Point(rim, near)
        })
    }
}

impl<N: Real> SupportMap<N, 3> for Cylinder<N> {
    fn core_support(&self, direction: &Vector<N, 3>) -> Point<N, 3> {
        let y = if direction.y < N::ZERO { -self.half_height } else { self.half_height };
        self.disk(y).rim_toward(direction)
    }

    fn curved_support(
        &self,
        point: &Point<N, 3>,
        direction: &Vector<N, 3>,
    ) -> Option<CurvedSupport<N, 3>> {
        let y = if point.y < N::ZERO { -self.half_height } else { self.half_height };
        self.disk(y).curved_rim(direction)
    }

    fn round_face(&self, direction: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        let up = Vector::<N, 3>::y();
        Some(if direction.y < N::ZERO { -up } else { up })
    }

    fn round_side(&self) -> Option<(Vector<N, 3>, N)> {
        Some((Vector::<N, 3>::y(), N::ZERO))
    }

    fn reach(&self) -> N {
        length_of(&Vector::<N, 2>::new(self.half_height, self.radius))
    }

    fn core_feature(&self, direction: &Vector<N, 3>, out: &mut Feature<N, 3>) {
        match self.supporting_part(direction) {
            Some(part) => part.fill(out),
            None => {
                let (side, y) = self.end_toward(direction);
                let ids = [FeatureId::Face(side), FeatureId::Edge(side)];
                self.disk(y).fill_polygon(ids[0], ids[1], direction, out);
            }
        }
    }
}

impl<N: Real> Shape<N, 3> for Cylinder<N> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        Geometry(Kind::Cylinder(self, self))
    }

    fn local_aabb(&self) -> Aabb<N, 3> {
        let extents = Vector::<N, 3>::new(self.radius, self.half_height, self.radius);
        Aabb::around(Point::origin(), extents)
    }

    fn aabb(&self, pose: &Pose<N, 3>) -> Aabb<N, 3> {
        let axis = pose.rotation.column(1).into_owned();
        let disk = self.disk(N::ZERO).extents(&pose.rotation);
        Aabb::around_rotated(pose, axis.abs() * self.half_height + disk)
    }

    fn scaled(&self, scale: &Vector<N, 3>) -> Result<ShapeHandle<N, 3>, ScaleError> {
        let (along, across) = Scale::try_new(scale)?.axial()?;
        let scaled = Self::try_new(self.half_height * along, self.radius * across)?;
        Ok(ShapeHandle::new(scaled))
    }
}
