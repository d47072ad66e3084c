//! Triangles: filled in 2D, flat in 3D.

use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Pose, Real, Vector, centroid, max};
use crate::shape::error::{finite, or_panic};
use crate::shape::scale::Scale;
use crate::shape::solids::segment::{box_at, farther, length_of};
use crate::shape::tilt::Tilt;
use crate::shape::{
    Feature, Geometry, Kind, ScaleError, Shape, ShapeError, ShapeHandle, SupportMap,
};

/// The convex hull of three corners, which may be given in any order and may coincide or lie on a
/// line.
///
/// In 3D the triangle has no thickness and two sides. The vertices 0, 1, 2 are `a`, `b`, `c`. Side
/// `i` leads from vertex `i` to the next vertex; sides are faces in 2D and edges in 3D. In 3D
/// `Face(0)` is the side from which `a`, `b`, `c` appear counter-clockwise, and `Face(1)` the
/// opposite side.
///
/// As features, sides are oriented so that their loop runs counter-clockwise: in 2D with the
/// triangle on the left, in 3D seen from the side to which the direction of the query points. The
/// normal of a side or edge lies in the triangle's plane and points out. A triangle without area
/// has its longest side as its only feature besides the vertices. A triangle whose corners coincide
/// has only its first vertex.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point};
/// use impinge::dim2::query::PointQuery;
/// use impinge::dim2::shape::Triangle;
///
/// let triangle =
///     Triangle::new(Point::new(0.0_f32, 0.0), Point::new(4.0, 0.0), Point::new(0.0, 4.0));
/// assert_eq!(triangle.corners()[1], Point::new(4.0, 0.0));
/// assert!(triangle.contains_point(&Isometry::identity(), &Point::new(1.0, 1.0)));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle<N: Real, const D: usize> {
    corners: [Point<N, D>; 3],
}

impl<N: Real, const D: usize> Triangle<N, D> {
    /// Returns the triangle with three corners.
    ///
    /// # Panics
    /// If a coordinate is not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(a: Point<N, D>, b: Point<N, D>, c: Point<N, D>) -> Self {
        or_panic(Self::try_new(a, b, c))
    }

    /// Returns the triangle with three corners.
    ///
    /// # Errors
    /// If a coordinate is not finite.
    pub fn try_new(a: Point<N, D>, b: Point<N, D>, c: Point<N, D>) -> Result<Self, ShapeError> {
        finite("a coordinate of the first corner", &a.coords)?;
        finite("a coordinate of the second corner", &b.coords)?;
        finite("a coordinate of the third corner", &c.coords)?;
        Ok(Self { corners: [a, b, c] })
    }

    /// Returns the triangle of corners that must be finite; they are not checked.
    #[inline]
    pub(crate) const fn of_finite(corners: [Point<N, D>; 3]) -> Self {
        Self { corners }
    }

    /// Returns the corners, in the order given.
    #[inline]
    #[must_use]
    pub const fn corners(&self) -> &[Point<N, D>; 3] {
        &self.corners
    }
}

impl<N: Real, const D: usize> SupportMap<N, D> for Triangle<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let [a, b, c] = &self.corners;
        let (from_a, from_b) = ((b - a).dot(direction), (c - b).dot(direction));
        if from_a > N::ZERO {
            if from_b > N::ZERO { *c } else { *b }
        } else if (c - a).dot(direction) > N::ZERO {
            *c
        } else {
            *a
        }
    }

    fn center(&self) -> Point<N, D> {
        centroid(&self.corners)
    }

    fn reach(&self) -> N {
        let [a, b, c] = &self.corners;
        let most = max(a.coords.norm_squared(), b.coords.norm_squared());
        let most = max(most, c.coords.norm_squared());
        // The square root of the largest square is the largest length. `length_of` computes lengths
        // whose squares are outside this range.
        if most > N::MIN_POSITIVE.sqrt() && most < N::MAX.sqrt() {
            return most.sqrt();
        }
        max(farther(a, b), length_of(&c.coords))
    }

    fn core_feature(&self, direction: &Vector<N, D>, out: &mut Feature<N, D>) {
        self.fill_toward(direction, Tilt::default_limit(), out);
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Triangle<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Triangle(self))
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.aabb(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        box_at(pose, self.corners.each_ref())
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        let scale = Scale::try_new(scale)?;
        let [a, b, c] = self.corners.mapped(|corner| scale.point(&corner));
        Ok(ShapeHandle::new(Self::try_new(a, b, c)?))
    }
}
