//! Capsules: the points within a radius of a segment.

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::{finite, or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::{
    Feature, Geometry, Kind, ScaleError, Segment, Shape, ShapeError, ShapeHandle, SupportMap,
};

/// The points within `radius` of a segment.
///
/// Radius and length may be zero: a capsule without length is a ball, a capsule without radius is a
/// segment. The vertices 0 and 1 are the round ends; the round side is `Edge(0)`, also in 2D.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::Capsule;
///
/// let capsule = Capsule::<f32>::new(1.0, 0.5);
/// assert_eq!((capsule.half_height(), capsule.radius()), (1.0, 0.5));
/// assert!(capsule.contains_point(&Isometry::identity(), &Point::new(0.0, 1.5, 0.0)), "its tip");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule<N: Real, const D: usize> {
    segment: Segment<N, D>,
    radius: N,
}

impl<N: Real, const D: usize> Capsule<N, D> {
    /// Returns the capsule along the local y axis; its segment extends from y = −`half_height` to y
    /// = `half_height`.
    ///
    /// # Panics
    /// If a size is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(half_height: N, radius: N) -> Self {
        or_panic(Self::try_new(half_height, radius))
    }

    /// Returns the capsule along the local y axis; its segment extends from y = −`half_height` to y
    /// = `half_height`.
    ///
    /// # Errors
    /// If a size is negative or not finite.
    pub fn try_new(half_height: N, radius: N) -> Result<Self, ShapeError> {
        let mut b = Point::<N, D>::origin();
        b[1] = size("the half height", half_height)?;
        Self::try_from_ends(Point::from(-b.coords), b, radius)
    }

    /// Returns the capsule around the segment between two points.
    ///
    /// # Errors
    /// If the radius is negative, or the radius or a coordinate is not finite.
    pub fn try_from_ends(a: Point<N, D>, b: Point<N, D>, radius: N) -> Result<Self, ShapeError> {
        finite("a coordinate of the first end", &a.coords)?;
        finite("a coordinate of the second end", &b.coords)?;
        let radius = size("the radius", radius)?;
        Ok(Self { segment: Segment::try_new(a, b)?, radius })
    }

    /// Returns half of the length of the core segment.
    #[must_use]
    pub fn half_height(&self) -> N {
        self.segment.half_length()
    }

    /// Returns the core segment.
    #[inline]
    #[must_use]
    pub const fn segment(&self) -> &Segment<N, D> {
        &self.segment
    }

    /// Returns the radius.
    #[inline]
    #[must_use]
    pub const fn radius(&self) -> N {
        self.radius
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Capsule<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        self.segment.core_support(direction)
    }

    fn rounding(&self) -> N {
        self.radius
    }

    fn center(&self) -> Point<N, D> {
        self.segment.center()
    }

    fn reach(&self) -> N {
        self.segment.reach()
    }

    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.segment.core_feature(direction, out);
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Capsule<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Capsule(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.aabb(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        self.segment.aabb(pose).loosened(self.radius)
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let factors = Scale::try_new(scale)?;
        let radius = self.radius * factors.uniform()?;
        let [a, b] = [self.segment.a(), self.segment.b()].map(|end| factors.point(end));
        Ok(ShapeHandle::new(Self::try_from_ends(a, b, radius)?))
    }
}
