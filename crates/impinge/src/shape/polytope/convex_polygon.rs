//! Convex polygons, in 2D.

use core::ops::Deref;

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::error::or_panic;
use crate::shape::scale::Scale;
use crate::shape::{Geometry, Kind, Polytope, ScaleError, Shape, ShapeHandle};

/// A convex polygon with at least three corners and an area.
///
/// Vertices are counter-clockwise; `Face(i)` is the side from `Vertex(i)` to the next vertex. All
/// methods of [`Polytope`] are available.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::ConvexPolygon;
///
/// let outline = [[0.0, 0.0], [2.0, 0.0], [3.0, 1.0], [0.0, 1.0]].map(Point::<f32>::from);
/// let polygon = ConvexPolygon::new(&outline);
/// assert_eq!(polygon.vertices(), outline);
/// assert_eq!(polygon.faces()[0].normal.y, -1.0, "the side below");
/// ```
#[derive(Clone, PartialEq)]
pub struct ConvexPolygon<N: Real> {
    polytope: Polytope<N, 2>,
}

impl<N: Real> ConvexPolygon<N> {
    /// Returns the polygon with a given convex outline, counter-clockwise or clockwise; see
    /// [`Self::try_new`].
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(points: &[Point<N, 2>]) -> Self {
        or_panic(Self::try_new(points))
    }

    /// Returns the convex hull of points in any order; see [`Self::try_from_points`].
    ///
    /// # Panics
    /// If [`Self::try_from_points`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn from_points(points: &[Point<N, 2>]) -> Self {
        or_panic(Self::try_from_points(points))
    }

    /// Returns the polygon with the given corners: at least three, in counter-clockwise order along
    /// a convex outline.
    pub(crate) fn from_corners(corners: Vec<Point<N, 2>>) -> Self {
        Self { polytope: Polytope::<N, 2>::from_corners(corners) }
    }

    /// Returns the vertices and sides of the polygon and their adjacency.
    #[must_use]
    pub const fn polytope(&self) -> &Polytope<N, 2> {
        &self.polytope
    }
}

impl<N: Real> Deref for ConvexPolygon<N> {
    type Target = Polytope<N, 2>;

    fn deref(&self) -> &Self::Target {
        &self.polytope
    }
}

impl<N: Real> Shape<N, 2> for ConvexPolygon<N> {
    fn geometry(&self) -> Geometry<'_, N, 2> {
        Geometry(Kind::Polytope(&self.polytope))
    }

    fn local_aabb(&self) -> Aabb<N, 2> {
        self.polytope.aabb_at(&Pose::identity())
    }

    fn aabb(&self, pose: &Pose<N, 2>) -> Aabb<N, 2> {
        self.polytope.aabb_at(pose)
    }

    fn local_bounding_sphere(&self) -> BoundingSphere<N, 2> {
        self.polytope.bounding_sphere()
    }

    fn scaled(&self, scale: &Vector<N, 2>) -> Result<ShapeHandle<N, 2>, ScaleError> {
        let scale = Scale::try_new(scale)?;
        let mut corners = scale.corners(self.polytope.vertices())?;
        if scale.is_mirror() {
            corners.reverse();
        }
        Ok(ShapeHandle::new(Self::from_corners(corners)))
    }
}
