//! Builds the shapes whose types differ between 2D and 3D.

use impinge::dim2::shape::ConvexPolygon;
use impinge::dim3::shape::ConvexHull;
use impinge::math::Point;
use impinge::shape::{ShapeError, ShapeHandle};
use impinge_record::{Recordable, Scalar};

/// A scalar and a dimension that scenes support: `f32` and `f64` with `D` = 2 and `D` = 3.
pub trait SceneSpace<const D: usize>: Recordable<D> {
    /// Returns the convex hull of points, as a shape.
    ///
    /// # Errors
    /// If a coordinate is not finite, or the points span no area (2D) or volume (3D).
    fn convex_hull(points: &[Point<Self, D>]) -> Result<ShapeHandle<Self, D>, ShapeError>;
}

impl<N: Scalar> SceneSpace<2> for N {
    fn convex_hull(points: &[Point<N, 2>]) -> Result<ShapeHandle<N, 2>, ShapeError> {
        Ok(ShapeHandle::new(ConvexPolygon::try_from_points(points)?))
    }
}

impl<N: Scalar> SceneSpace<3> for N {
    fn convex_hull(points: &[Point<N, 3>]) -> Result<ShapeHandle<N, 3>, ShapeError> {
        Ok(ShapeHandle::new(ConvexHull::try_from_points(points)?))
    }
}
