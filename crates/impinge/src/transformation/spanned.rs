//! The convex hull of points as a shape of the points' dimension: a solid, a flat shape, a segment
//! or a point.

use super::convex_hull2;
use super::span::{Scaled, first_three, first_two};
use crate::math::{Point, Real, Space};
use crate::shape::{
    ConvexHull, ConvexPolygon, Segment, ShapeError, ShapeHandle, TriMesh, Triangle,
};

/// Returns the convex hull of at least one point: a [`ConvexPolygon`], or a [`Segment`] if all
/// points lie on a line within rounding, as in [`convex_hull2`]. If all points coincide, the
/// segment has no length.
///
/// # Errors
/// If there are no points, or a coordinate is not finite.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::Segment;
/// use impinge::dim2::transformation::convex_shape;
///
/// let line = [[0.0_f32, 0.0], [2.0, 2.0], [1.0, 1.0]].map(Point::from);
/// let shape = convex_shape(&line).expect("finite");
/// assert_eq!(shape.as_shape::<Segment<f32>>().map(|segment| *segment.b()), Some(line[1]));
/// ```
pub fn convex_shape2<N: Real>(points: &[Point<N, 2>]) -> Result<ShapeHandle<N, 2>, ShapeError> {
    match ConvexPolygon::try_from_points(points) {
        Ok(polygon) => Ok(ShapeHandle::new(polygon)),
        Err(error) => {
            without_volume(error)?;
            segment(&Scaled::of(points, 1)?, points)
        }
    }
}

/// Returns the convex hull of at least one point: a [`ConvexHull`]. If all points lie in a plane
/// within rounding, as in [`convex_hull3`](super::convex_hull3), returns a [`Triangle`] or, for
/// more than three corners, a two-sided [`TriMesh`] of the flat polygon. If all points lie on a
/// line, returns a [`Segment`], without length if they coincide.
///
/// # Errors
/// If there are no points, or a coordinate is not finite.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point};
/// use impinge::dim3::query::distance;
/// use impinge::dim3::shape::{Ball, TriMesh};
/// use impinge::dim3::transformation::convex_shape;
///
/// let square = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [1.0, 1.0]];
/// let square = square.map(|[x, y]| Point::new(x, y, 3.0_f64));
/// let shape = convex_shape(&square).expect("finite");
/// assert_eq!(shape.as_shape::<TriMesh<f64>>().map(|mesh| mesh.num_triangles()), Some(2));
/// let (here, ball) = (Isometry::identity(), Ball::new(1.0));
/// assert_eq!(distance(&here, &*shape, &here, &ball), 2.0);
/// ```
pub fn convex_shape3<N: Real>(points: &[Point<N, 3>]) -> Result<ShapeHandle<N, 3>, ShapeError> {
    match ConvexHull::try_from_points(points) {
        Ok(hull) => Ok(ShapeHandle::new(hull)),
        Err(error) => {
            without_volume(error)?;
            let scaled = Scaled::of(points, 1)?;
            flat_polygon(&scaled, points).map_or_else(|| segment(&scaled, points), Ok)
        }
    }
}

/// Returns `Ok` if the error only means that the points span no solid, possibly because there are
/// too few; else returns the error.
fn without_volume(error: ShapeError) -> Result<(), ShapeError> {
    match error {
        ShapeError::Degenerate { .. } | ShapeError::TooFewPoints { given: 1.., .. } => Ok(()),
        ShapeError::TooFewPoints { given, .. } => {
            Err(ShapeError::TooFewPoints { given, needed: 1 })
        }
        other => Err(other),
    }
}

/// Returns the segment between the points that are farthest apart along the axis of the largest
/// spread; a segment without length, at the first point, if all points coincide.
fn segment<N: Real, const D: usize>(
    scaled: &Scaled<D>,
    points: &[Point<N, D>],
) -> Result<ShapeHandle<N, D>, ShapeError> {
    let [low, high] = first_two(scaled).unwrap_or([0, 0]);
    Ok(ShapeHandle::new(Segment::try_new(points[low], points[high])?))
}

/// Returns the convex hull of coplanar points, as a triangle or a mesh; `None` if they lie on a
/// line. Its corners are computed in the coordinate plane that is most nearly parallel to the
/// polygon, so that no coordinate is rounded.
fn flat_polygon<N: Space<3>>(
    scaled: &Scaled<3>,
    points: &[Point<N, 3>],
) -> Option<ShapeHandle<N, 3>> {
    let [a, b, c] = first_three(scaled).ok()?.map(|index| scaled.points[index]);
    let across = (b - a).cross(&(c - a)).iamax();
    let projected =
        points.iter().map(|p| Point::<N, 2>::new(p[(across + 1) % 3], p[(across + 2) % 3]));
    let ring = convex_hull2(&projected.collect::<Vec<_>>()).ok()?;
    let corners: Vec<_> = ring.iter().map(|&index| points[index]).collect();
    if let [a, b, c] = corners[..] {
        return Triangle::try_new(a, b, c).ok().map(ShapeHandle::new);
    }
    let fan = (1_u32..).take(corners.len() - 2).map(|corner| [0, corner, corner + 1]);
    TriMesh::try_new(corners, fan.collect()).ok().map(ShapeHandle::new)
}
