//! Cones, in 3D.

use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector, max, min, unit};
use crate::shape::error::{or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::solids::round::{Disk, RoundPart, axial_on, radial_of};
use crate::shape::solids::segment::length_of;
use crate::shape::tilt::Tilt;
use crate::shape::{
    CurvedSupport, Feature, FeatureId, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle,
    SupportMap,
};

/// The convex hull of the apex at `(0, half_height, 0)` and the horizontal disk of `radius` around
/// `(0, -half_height, 0)`.
///
/// Sizes may be zero; the cone is then a disk, a segment or a point. `Vertex(0)` is the apex,
/// `Face(0)` the base, `Face(1)` the round side, `Edge(0)` the rim.
///
/// As a feature the base is an inscribed octagon whose vertices and sides all have the id of the
/// rim. The round side is its generating segment nearest to the direction, from the rim to the
/// apex. A cone without height is a disk: its upper side is the same octagon in reverse order, with
/// the id `Face(1)`.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::Cone;
///
/// let cone = Cone::new(1.0_f64, 0.5);
/// assert!(cone.contains_point(&Isometry::identity(), &Point::new(0.0, 1.0, 0.0)), "the apex");
/// assert!(!cone.contains_point(&Isometry::identity(), &Point::new(0.5, 1.0, 0.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cone<N: Real> {
    half_height: N,
    radius: N,
}

impl<N: Real> Cone<N> {
    /// Returns the cone along the local y axis with the given half height and radius, each zero or
    /// more.
    ///
    /// # Panics
    /// If a size is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(half_height: N, radius: N) -> Self {
        or_panic(Self::try_new(half_height, radius))
    }

    /// Returns the cone along the local y axis with the given half height and radius, each zero or
    /// more.
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

    /// Returns the radius of the base.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }
}

impl<N: Real> Cone<N> {
    fn base(&self) -> Disk<N> {
        Disk { radius: self.radius, y: -self.half_height }
    }

    fn apex(&self) -> Point<N, 3> {
        Point::<N, 3>::new(N::ZERO, self.half_height, N::ZERO)
    }

    /// Returns the component along `direction` of a unit vector from the rim to the apex, on the
    /// generating line nearest to `direction`. `None` for a cone that is a point.
    fn sine(&self, direction: &Vector<N, 3>) -> Option<N> {
        let line = Vector::<N, 2>::new(-self.radius, N::TWO * self.half_height);
        let (line, _) = unit(&line)?;
        Some(line.x * radial_of(direction).norm() + line.y * direction.y)
    }
}

impl<N: Real> Cone<N> {
    /// Returns the id of the apex, base, rim or round side on which a surface point lies, up to
    /// `tolerance`. `None` for a cone with a half height or radius of at most `4 tolerance`.
    pub(crate) fn part_at<const D: usize>(
        &self,
        point: &Point<N, D>,
        tolerance: N,
    ) -> Option<FeatureId> {
        let (y, aside) = axial_on(point, [self.half_height, self.radius], tolerance)?;
        Some(if y <= tolerance - self.half_height {
            if aside >= self.radius - tolerance { FeatureId::Edge(0) } else { FeatureId::Face(0) }
        } else if y >= self.half_height - N::TWO * tolerance && aside <= N::TWO * tolerance {
            FeatureId::Vertex(0)
        } else {
            FeatureId::Face(1)
        })
    }
}

impl<N: Real> Cone<N> {
    /// Returns the supporting feature for a unit vector. `None` if it is the base, or either side
    /// of a cone without height: both are polygons.
    pub(crate) fn supporting_part(&self, direction: &Vector<N, 3>) -> Option<RoundPart<N>> {
        let is_axial = Tilt::default_limit().admits(radial_of(direction).norm_squared());
        if is_axial && (direction.y < N::ZERO || self.half_height == N::ZERO) {
            return None;
        }
        let (apex, rim) = (FeatureId::Vertex(0), FeatureId::Edge(0));
        let sine = self.sine(direction).unwrap_or(N::ZERO);
        Some(if Tilt::default_limit().admits(sine * sine) && self.half_height > N::ZERO {
            let ends = [(rim, self.base().rim_toward(direction)), (apex, self.apex())];
            RoundPart::Line(FeatureId::Face(1), ends)
        } else if sine > N::ZERO {
            RoundPart::Point(apex, self.apex())
        } else {
            RoundPart::Point(rim, self.base().rim_toward(direction))
        })
    }
}

impl<N: Real> SupportMap<N, 3> for Cone<N> {
    fn core_support(&self, direction: &Vector<N, 3>) -> Point<N, 3> {
        let rim = self.base().rim_toward(direction);
        if (self.apex() - rim).dot(direction) > N::ZERO { self.apex() } else { rim }
    }

    fn curved_support(
        &self,
        point: &Point<N, 3>,
        direction: &Vector<N, 3>,
    ) -> Option<CurvedSupport<N, 3>> {
        let is_apex = point.y > N::ZERO;
        if is_apex { None } else { self.base().curved_rim(direction) }
    }

    fn round_face(&self, direction: &Vector<N, 3>) -> Option<Vector<N, 3>> {
        (direction.y < N::ZERO).then(|| -Vector::<N, 3>::y())
    }

    fn round_side(&self) -> Option<(Vector<N, 3>, N)> {
        let (normal, _) = unit(&Vector::<N, 2>::new(N::TWO * self.half_height, self.radius))?;
        Some((Vector::<N, 3>::y(), normal.y))
    }

    fn reach(&self) -> N {
        length_of(&Vector::<N, 2>::new(self.half_height, self.radius))
    }

    fn core_feature(&self, direction: &Vector<N, 3>, out: &mut Feature<N, 3>) {
        match self.supporting_part(direction) {
            Some(part) => part.fill(out),
            None => {
                let is_below = direction.y < N::ZERO;
                let face = FeatureId::Face(u32::from(!is_below));
                self.base().fill_polygon(face, FeatureId::Edge(0), direction, out);
            }
        }
    }
}

impl<N: Real> Shape<N, 3> for Cone<N> {
    fn geometry(&self) -> Geometry<'_, N, 3> {
        Geometry(Kind::Cone(self, self))
    }

    fn local_aabb(&self) -> Aabb<N, 3> {
        let extents = Vector::<N, 3>::new(self.radius, self.half_height, self.radius);
        Aabb::around(Point::origin(), extents)
    }

    fn aabb(&self, pose: &Pose<N, 3>) -> Aabb<N, 3> {
        let axis = pose.rotation.column(1).into_owned();
        let (apex, disk) = (axis * self.half_height, self.base().extents(&pose.rotation));
        let (low, high) = (apex.zip_map(&(-apex - disk), min), apex.zip_map(&(-apex + disk), max));
        Aabb::of_rotated(low, high, self.reach(), pose)
    }

    fn scaled(&self, scale: &Vector<N, 3>) -> Result<ShapeHandle<N, 3>, ScaleError> {
        let (along, across) = Scale::try_new(scale)?.axial()?;
        if scale.y < N::ZERO {
            return Err(ScaleError::NotSuch { needs: "a factor above zero along its axis" });
        }
        let scaled = Self::try_new(self.half_height * along, self.radius * across)?;
        Ok(ShapeHandle::new(scaled))
    }
}
