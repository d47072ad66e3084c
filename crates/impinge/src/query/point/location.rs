//! Where on a shape a point lies: which part, which feature, and by which weights of its corners.

use super::nearest_on_segment;
use crate::math::{Point, Real, max_component, unit};
use crate::shape::{FeatureId, Geometry, Kind, Segment, Triangle};

/// Where on a shape a projected point lies.
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
    /// The part of a composite; 0 for a convex solid.
    pub part: u32,
    /// The feature of that part that the nearest point of its boundary lies on.
    pub feature: FeatureId,
    /// The projected point by the corners of the part.
    pub barycentric: Barycentric<N>,
}

/// A point as the mean of corners with these weights: none is negative, and they sum to one up to
/// rounding. On a side or at a corner the others' weights are exactly zero.
///
/// What lies beside a triangle by rounding counts as the nearest point of it. The weights reproduce the
/// point up to rounding of the part's size, however thin the triangle; of one without area they are
/// those of its longest side.
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
    /// The weights of the ends of a segment.
    Segment([N; 2]),
    /// The weights of the corners of a triangle.
    Triangle([N; 3]),
    /// The part is neither a segment nor a triangle.
    Undefined,
}

impl<N: Real> Barycentric<N> {
    /// The weights of a point of a solid. `feature` is that of the boundary that the point lies on;
    /// `None` if it may lie inside.
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

fn of_triangle<N: Real, const D: usize>(
    triangle: &Triangle<N, D>,
    point: &Point<N, D>,
    feature: Option<FeatureId>,
) -> [N; 3] {
    if let Some(FeatureId::Vertex(corner)) = feature {
        return core::array::from_fn(|at| if at == corner as usize { N::ONE } else { N::ZERO });
    }
    let is_side = |side: &u32| feature == Some(FeatureId::flat::<D>(1, *side));
    match (0..3).find(is_side) {
        Some(side) => on_side(triangle, side as usize, point),
        None => on_face(triangle, point),
    }
}

fn on_side<N: Real, const D: usize>(
    triangle: &Triangle<N, D>,
    side: usize,
    point: &Point<N, D>,
) -> [N; 3] {
    let (corners, next) = (triangle.corners(), (side + 1) % 3);
    let (_, fraction) = nearest_on_segment([&corners[side], &corners[next]], point);
    let mut weights = [N::ZERO; 3];
    (weights[side], weights[next]) = (N::ONE - fraction, fraction);
    weights
}

/// First the share of the corner across from the longest side, by the height over that side; then, of
/// what that leaves, the place along the side. So an error of the first, large on a needle, is made
/// good by the second. What comes out beyond a side lies on it.
fn on_face<N: Real, const D: usize>(triangle: &Triangle<N, D>, point: &Point<N, D>) -> [N; 3] {
    let corners = triangle.corners();
    let length = |side: usize| max_component(&(corners[(side + 1) % 3] - corners[side]));
    let longer = |a: usize, b: usize| if length(b) > length(a) { b } else { a };
    let from = longer(longer(0, 1), 2);
    let (to, top) = ((from + 1) % 3, (from + 2) % 3);
    let (arm, rise) = (point - corners[from], corners[top] - corners[from]);
    let Some((along, whole)) = unit(&(corners[to] - corners[from])) else {
        return on_side(triangle, 0, point);
    };
    // Made perpendicular twice: of a needle the first remainder is inexact (Kahan: twice is enough).
    let once = rise - along * rise.dot(&along);
    let Some((up, _)) = unit(&(once - along * once.dot(&along))) else {
        return on_side(triangle, from, point);
    };
    let share = arm.dot(&up) / rise.dot(&up);
    let place = (arm.dot(&along) - rise.dot(&along) * share) / whole;
    let rest = N::ONE - share - place;
    if share >= N::ZERO && place >= N::ZERO && rest >= N::ZERO {
        let mut weights = [N::ZERO; 3];
        (weights[from], weights[to], weights[top]) = (rest, place, share);
        return weights;
    }
    // Also where the numbers end.
    on_side(triangle, nearest_side(triangle, point), point)
}

fn nearest_side<N: Real, const D: usize>(triangle: &Triangle<N, D>, point: &Point<N, D>) -> usize {
    let corners = triangle.corners();
    let apart = |side: usize| {
        let ends = [&corners[side], &corners[(side + 1) % 3]];
        (nearest_on_segment(ends, point).0 - point).norm_squared()
    };
    let nearer = |a: usize, b: usize| if apart(b) < apart(a) { b } else { a };
    nearer(nearer(0, 1), 2)
}
