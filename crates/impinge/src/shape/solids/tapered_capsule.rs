//! Tapered capsules: the convex hulls of two balls.

use crate::bounding_volume::{Aabb, BoundingSphere, BoundingVolume};
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, max, min, perpendicular_to, unit};
use crate::shape::error::{or_panic, size};
use crate::shape::scale::Scale;
use crate::shape::solids::segment::{box_at, length_of};
use crate::shape::tilt::Tilt;
use crate::shape::{
    CurvedSupport, Feature, FeatureId, Geometry, Kind, ScaleError, Segment, Shape, ShapeError,
    ShapeHandle, SupportMap,
};

/// The convex hull of two balls around the ends of a segment.
///
/// Radii and length may be zero, and one ball may contain the other; the solid is then the larger
/// ball. With equal radii it is a capsule. If one radius is zero it is a cone with a round base, if
/// both are zero a segment. The vertices 0 and 1 are the round ends; the conical side is `Edge(0)`,
/// also in 2D.
///
/// The rounding radius is the smaller radius. The core is the hull of a point and of a ball whose
/// radius is the difference of the radii. As a feature the side is its generating segment nearest
/// to the direction.
///
/// ```
/// use impinge::dim3::math::Isometry;
/// use impinge::dim3::bounding_volume::aabb;
/// use impinge::dim3::shape::TaperedCapsule;
///
/// let club = TaperedCapsule::new(2.0_f32, 0.25, 1.0);
/// let around = aabb(&club, &Isometry::identity());
/// assert_eq!((around.mins().y, around.maxs().y, around.maxs().x), (-2.25, 3.0, 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TaperedCapsule<N: Real, const D: usize> {
    segment: Segment<N, D>,
    radii: [N; 2],
}

impl<N: Real, const D: usize> TaperedCapsule<N, D> {
    /// Returns the tapered capsule along the local y axis: a ball of `radius1` at y =
    /// −`half_height` and a ball of `radius2` at y = `half_height`.
    ///
    /// # Panics
    /// If a size is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(half_height: N, radius1: N, radius2: N) -> Self {
        or_panic(Self::try_new(half_height, radius1, radius2))
    }

    /// Returns the tapered capsule along the local y axis: a ball of `radius1` at y =
    /// −`half_height` and a ball of `radius2` at y = `half_height`.
    ///
    /// # Errors
    /// If a size is negative or not finite.
    pub fn try_new(half_height: N, radius1: N, radius2: N) -> Result<Self, ShapeError> {
        let mut end2 = Point::<N, D>::origin();
        end2[1] = size("the half height", half_height)?;
        Self::try_from_ends(Point::from(-end2.coords), end2, [radius1, radius2])
    }

    /// Returns the convex hull of the balls of given radii around two points.
    ///
    /// # Errors
    /// If a radius is negative, or a radius or a coordinate is not finite.
    pub fn try_from_ends(
        a: Point<N, D>,
        b: Point<N, D>,
        radii: [N; 2],
    ) -> Result<Self, ShapeError> {
        let segment = Segment::try_new(a, b)?;
        let [radius1, radius2] = radii;
        let radii = [size("the first radius", radius1)?, size("the second radius", radius2)?];
        Ok(Self { segment, radii })
    }

    /// Returns half of the distance between the centres of the balls.
    #[must_use]
    pub fn half_height(&self) -> N {
        self.segment.half_length()
    }

    /// Returns the segment between the centres of the balls.
    #[inline]
    #[must_use]
    pub const fn segment(&self) -> &Segment<N, D> {
        &self.segment
    }

    /// Returns the radii of the balls around the first and the second end.
    #[inline]
    #[must_use]
    pub const fn radii(&self) -> [N; 2] {
        self.radii
    }

    /// Returns the direction and slope of the side; `None` if one ball contains the other.
    pub(crate) fn taper(&self) -> Option<Taper<N, D>> {
        let [radius1, radius2] = self.radii;
        let (along, length) = unit(&(self.segment.b() - self.segment.a()))?;
        let sine = (radius1 - radius2) / length;
        let cosine = max((N::ONE - sine) * (N::ONE + sine), N::ZERO).sqrt();
        let has_side = cosine > N::ZERO && (radius1 - radius2).abs() < length;
        has_side.then_some(Taper { along, length, sine, cosine })
    }

    /// Returns the index of the end with the larger ball; 0 if the radii are equal.
    pub(crate) fn larger_end(&self) -> usize {
        usize::from(self.radii[1] > self.radii[0])
    }

    /// Returns the end of the segment with index 0 or 1.
    pub(crate) fn end(&self, index: usize) -> &Point<N, D> {
        if index == 0 { self.segment.a() } else { self.segment.b() }
    }

    /// Returns the radii of the core's balls; at least one of them is zero.
    fn core_radii(&self) -> [N; 2] {
        self.radii.mapped(|radius| radius - self.rounding())
    }
}

/// The side of a tapered capsule. In every half-plane that the axis bounds, it is a line that
/// touches both balls. Its unit normal has the component `cosine` away from the axis and `sine`
/// along it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Taper<N: Real, const D: usize> {
    /// The unit vector from the first end to the second.
    pub(crate) along: Vector<N, D>,
    /// The distance between the ends.
    pub(crate) length: N,
    pub(crate) sine: N,
    pub(crate) cosine: N,
}

impl<N: Real, const D: usize> Taper<N, D> {
    /// Returns the unit vector perpendicular to the axis that is nearest to `direction`, and the
    /// component of `direction` along it. If `direction` is along the axis, up to rounding, returns
    /// an arbitrary perpendicular of the axis and zero.
    fn away(&self, direction: &Vector<N, D>) -> (Vector<N, D>, N) {
        let radial = direction - self.along * direction.dot(&self.along);
        let known = unit(&radial).filter(|&(_, length)| length > N::lit(16.0) * N::EPSILON);
        known.unwrap_or_else(|| (perpendicular_to(&self.along), N::ZERO))
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for TaperedCapsule<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let (a, b) = (self.segment.a(), self.segment.b());
        let Some((toward, _)) = unit(direction) else { return *a };
        let [radius1, radius2] = self.core_radii();
        let beyond = (b - a).dot(&toward) + (radius2 - radius1);
        if beyond > N::ZERO { b + toward * radius2 } else { a + toward * radius1 }
    }

    fn rounding(&self) -> N {
        min(self.radii[0], self.radii[1])
    }

    fn curved_support(
        &self,
        point: &Point<N, D>,
        direction: &Vector<N, D>,
    ) -> Option<CurvedSupport<N, D>> {
        let large = self.larger_end();
        let (center, radius) = (self.end(large), self.core_radii()[large]);
        // The smaller ball of the core is a point, a vertex without curvature.
        let to_corner = (point - self.end(1 - large)).norm();
        if to_corner < ((point - center).norm() - radius).abs() {
            return None;
        }
        let across = Matrix::<N, D>::identity() - direction * direction.transpose();
        Some(CurvedSupport { point: center + direction * radius, bend: across * radius })
    }

    fn round_side(&self) -> Option<(Vector<N, D>, N)> {
        self.taper().map(|taper| (taper.along, taper.sine))
    }

    fn center(&self) -> Point<N, D> {
        self.segment.center()
    }

    fn reach(&self) -> N {
        let [radius1, radius2] = self.core_radii();
        let distance = |end: &Point<N, D>, radius| length_of(&end.coords) + radius;
        max(distance(self.segment.a(), radius1), distance(self.segment.b(), radius2))
    }

    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        let large = self.larger_end();
        let ids = [FeatureId::Vertex(0), FeatureId::Vertex(1)];
        let Some(taper) = self.taper() else {
            return out.set_point(ids[large], self.core_support(direction));
        };
        let (away, across) = taper.away(direction);
        let climb = direction.dot(&taper.along);
        // The sine is positive if the support point is on the ball around the second end.
        let sine = taper.cosine * climb - taper.sine * across;
        let faces = taper.cosine * across + taper.sine * climb > N::ZERO;
        if !(faces && Tilt::default_limit().admits(sine * sine)) {
            let end = usize::from(sine > N::ZERO);
            return out.set_point(ids[end], self.core_support(direction));
        }
        // On the larger ball the feature ends at the support point; or, if the support point is on
        // the smaller ball, at the point where the side touches the larger ball.
        let is_on_large = (sine > N::ZERO) == (large == 1);
        let side = away * taper.cosine + taper.along * taper.sine;
        let toward = if is_on_large { *direction } else { side };
        let ends = [0, 1].mapped(|end| self.end(end) + toward * self.core_radii()[end]);
        out.set_segment(FeatureId::Edge(0), [(ids[0], ends[0]), (ids[1], ends[1])]);
    }
}

impl<N: Real, const D: usize> Shape<N, D> for TaperedCapsule<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::TaperedCapsule(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.aabb(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        let [around1, around2] =
            [0, 1].mapped(|end| box_at(pose, [self.end(end)]).loosened(self.radii[end]));
        around1.merged(&around2)
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        let [ball1, ball2] =
            [0, 1].mapped(|end| BoundingSphere::try_new(*self.end(end), self.radii[end]));
        match (ball1, ball2) {
            (Ok(ball1), Ok(ball2)) => ball1.merged(&ball2),
            _ => BoundingSphere::unbounded(),
        }
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let factors = Scale::try_new(scale)?;
        let factor = factors.uniform()?;
        let [a, b] = [0, 1].mapped(|end| factors.point(self.end(end)));
        Ok(ShapeHandle::new(Self::try_from_ends(
            a,
            b,
            self.radii.mapped(|radius| radius * factor),
        )?))
    }
}
