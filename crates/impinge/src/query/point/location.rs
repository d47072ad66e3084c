//! The location of a projected point on a shape: part, feature, and barycentric coordinates.

use super::nearest_on_segment;
use super::triangle::{nearest, on_side};
use crate::math::{Point, Real, filled};
use crate::shape::{FeatureId, Geometry, Kind, Segment, Triangle};

/// The location of a projected point on a shape.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::query::{Barycentric, PointQuery};
/// use impinge::dim2::shape::Polyline;
///
/// let line: Polyline<f64> = Polyline::open([0.0, 4.0, 8.0].map(|x| Point::new(x, 0.0)).to_vec());
/// let (_, location) = line.project_local_point_with_location(&Point::new(5.0, 3.0), true);
/// assert_eq!((location.part, location.barycentric), (1, Barycentric::Segment([0.75, 0.25])));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointLocation<N: Real> {
    /// The index of the part of a composite; 0 for a convex solid.
    pub part: u32,
    /// The feature of that part that contains the nearest point of the part's boundary.
    pub feature: FeatureId,
    /// The barycentric coordinates of the projected point in the part.
    pub barycentric: Barycentric<N>,
}

/// A point as the weighted mean of corners. No weight is negative, and the weights sum to one up to
/// rounding. For a point on a side or at a corner the other weights are exactly zero.
///
/// A point that lies beside a triangle by rounding is replaced by the nearest point of the
/// triangle. The weights reproduce the point up to rounding of the part's size, however thin the
/// triangle is.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::query::{Barycentric, PointQuery};
/// use impinge::dim2::shape::{Ball, Segment};
///
/// let (segment, far) = (Segment::new(Point::origin(), Point::new(4.0_f64, 0.0)), Point::new(9.0, 1.0));
/// let weights = |shape: &dyn impinge::shape::Shape<f64, 2>| {
///     shape.project_local_point_with_location(&far, true).1.barycentric
/// };
/// assert_eq!(weights(&segment), Barycentric::Segment([0.0, 1.0]), "its end");
/// assert_eq!(weights(&Ball::new(1.0)), Barycentric::Undefined);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Barycentric<N: Real> {
    /// The weights of the two ends of a segment.
    Segment([N; 2]),
    /// The weights of the three corners of a triangle.
    Triangle([N; 3]),
    /// The part is neither a segment nor a triangle.
    Undefined,
}

impl<N: Real> Barycentric<N> {
    /// Returns the weights of a point of a solid. `feature` is the boundary feature that contains
    /// the point; `None` if the point may lie inside.
    pub(crate) fn of<const D: usize>(
        solid: Geometry<'_, N, D>,
        point: &Point<N, D>,
        feature: Option<FeatureId>,
    ) -> Self {
        match solid.0 {
            Kind::Segment(segment) => Self::Segment(of_segment(segment, point)),
            Kind::Triangle(triangle) => Self::Triangle(of_triangle(triangle, point, feature)),
            _ => Self::Undefined,
        }
    }
}

fn of_segment<N: Real, const D: usize>(segment: &Segment<N, D>, point: &Point<N, D>) -> [N; 2] {
    let (_, fraction) = nearest_on_segment([segment.a(), segment.b()], point);
    [N::ONE - fraction, fraction]
}

/// Returns the weights of a point of a triangle; exactly zero for corners outside `feature`.
fn of_triangle<N: Real, const D: usize>(
    triangle: &Triangle<N, D>,
    point: &Point<N, D>,
    feature: Option<FeatureId>,
) -> [N; 3] {
    if let Some(FeatureId::Vertex(corner)) = feature {
        return filled(|at| if at == corner as usize { N::ONE } else { N::ZERO });
    }
    let is_side = |side: &u32| feature == Some(FeatureId::flat::<D>(1, *side));
    match (0..3).find(is_side) {
        Some(side) => on_side(triangle.corners(), side, point).weights,
        None => nearest(triangle.corners(), point).weights,
    }
}
