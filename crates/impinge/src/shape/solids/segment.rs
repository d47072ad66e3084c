//! Segments, and helper functions for lengths and boxes of points.

use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Vector, centroid, max, min, unit};
use crate::shape::error::{finite, or_panic};
use crate::shape::scale::Scale;
use crate::shape::{
    Feature, FeatureId, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle, SupportMap,
};

/// The points between `a` and `b`, which may coincide.
///
/// `Vertex(0)` is `a`, `Vertex(1)` is `b`. The segment itself is `Edge(0)`, also in 2D.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::Segment;
///
/// let segment = Segment::new(Point::new(0.0_f32, 0.0, 0.0), Point::new(4.0, 0.0, 0.0));
/// let distance = segment.distance_to_point(&Isometry::identity(), &Point::new(1.0, 2.0, 0.0), true);
/// assert_eq!(distance, 2.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment<N: Real, const D: usize> {
    a: Point<N, D>,
    b: Point<N, D>,
}

impl<N: Real, const D: usize> Segment<N, D> {
    /// Returns the segment between two points.
    ///
    /// # Panics
    /// If a coordinate is not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(a: Point<N, D>, b: Point<N, D>) -> Self {
        or_panic(Self::try_new(a, b))
    }

    /// Returns the segment between two points.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn try_new(a: Point<N, D>, b: Point<N, D>) -> Result<Self, ShapeError> {
        finite("a coordinate of the first end", &a.coords)?;
        finite("a coordinate of the second end", &b.coords)?;
        Ok(Self { a, b })
    }

    /// Returns the segment between two points that must be finite; they are not checked.
    #[inline]
    pub(crate) const fn of_finite(a: Point<N, D>, b: Point<N, D>) -> Self {
        Self { a, b }
    }

    /// Returns the first end.
    #[inline]
    #[must_use]
    pub const fn a(&self) -> &Point<N, D> {
        &self.a
    }

    /// Returns the second end.
    #[inline]
    #[must_use]
    pub const fn b(&self) -> &Point<N, D> {
        &self.b
    }

    /// Returns half of the length. The coordinates are halved first, as the difference of large
    /// coordinates may overflow.
    pub(in crate::shape) fn half_length(&self) -> N {
        length_of(&(self.b.coords * N::HALF - self.a.coords * N::HALF))
    }
}

/// Returns the length of a vector, also if its square overflows or underflows.
#[inline]
pub(in crate::shape) fn length_of<N: Real, const D: usize>(v: &Vector<N, D>) -> N {
    // Squares in this range keep their relative precision; outside it `unit` scales the vector
    // first.
    let squared = v.norm_squared();
    if squared > N::MIN_POSITIVE.sqrt() && squared < N::MAX.sqrt() {
        return squared.sqrt();
    }
    unit(v).map_or(N::ZERO, |(_, length)| length)
}

/// Returns the larger of the distances of two points from the origin.
pub(in crate::shape) fn farther<N: Real, const D: usize>(a: &Point<N, D>, b: &Point<N, D>) -> N {
    max(length_of(&a.coords), length_of(&b.coords))
}

/// Returns the box around a few points of a solid placed at `pose`. The box is rounded outwards,
/// and unbounded if a coordinate overflows.
pub(in crate::shape) fn box_at<N: Real, const D: usize, const K: usize>(
    pose: &Pose<N, D>,
    points: [&Point<N, D>; K],
) -> Aabb<N, D> {
    let mut size = N::ZERO;
    let mut low = Vector::<N, D>::repeat(N::INFINITY);
    let mut high = -low;
    for point in points {
        let rotated = pose.vector(&point.coords);
        // The sum of magnitudes is an upper bound of the distance from the origin that needs no
        // square root.
        size = max(point.iter().fold(N::ZERO, |sum, x| sum + x.abs()), size);
        for axis in 0..D {
            (low[axis], high[axis]) =
                (min(rotated[axis], low[axis]), max(rotated[axis], high[axis]));
        }
    }
    Aabb::of_rotated(low, high, size, pose)
}

impl<N: Real, const D: usize> SupportMap<N, D> for Segment<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        if direction.dot(&(self.b - self.a)) > N::ZERO { self.b } else { self.a }
    }

    fn center(&self) -> Point<N, D> {
        centroid(&[self.a, self.b])
    }

    fn reach(&self) -> N {
        farther(&self.a, &self.b)
    }

    fn core_feature(&self, _: &Vector<N, D>, out: &mut Feature<N, D>) {
        let ends = [(FeatureId::Vertex(0), self.a), (FeatureId::Vertex(1), self.b)];
        out.set_segment(FeatureId::Edge(0), ends);
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Segment<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Segment(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.aabb(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        box_at(pose, [&self.a, &self.b])
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let scale = Scale::try_new(scale)?;
        Ok(ShapeHandle::new(Self::try_new(scale.point(&self.a), scale.point(&self.b))?))
    }
}
