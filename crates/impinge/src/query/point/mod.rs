//! Point queries: containment, distance, and the nearest point of the surface.
//!
//! Every result is derived from the nearest point of the boundary in the local frame, which has a
//! closed form for most shapes. There is one file per shape, and one table per dimension (`point2`,
//! `point3`).

mod ball;
mod capsule;
mod cone;
mod crossing;
mod cuboid;
mod cylinder;
mod ellipsoid;
mod enclosed;
mod location;
mod plane;
pub(crate) mod point2;
pub(crate) mod point3;
mod polytope;
mod rounded;
mod segment;
mod support_map;
mod surface;
mod tapered_capsule;
mod triangle;
mod triangle2;
mod triangle3;
mod volume;

pub use location::{Barycentric, PointLocation};

pub(super) use segment::{feature_at, nearest as nearest_on_segment};
pub(crate) use surface::SurfacePoint;
pub(super) use surface::length;

use super::composite::{PartPoint, PartQuery};
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, Space, max};
use crate::shape::{CompositeShape, FeatureId, Geometry, Kind, Shape};
use crate::tables::entries;

/// The point of a solid, or of its surface, that is nearest to a given point.
///
/// ```
/// use impinge::dim2::math::{Isometry, Point};
/// use impinge::dim2::query::PointQuery;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, here, inner) = (Ball::new(2.0_f32), Isometry::identity(), Point::new(1.0, 0.0));
/// let onto_solid = ball.project_point(&here, &inner, true);
/// assert_eq!((onto_solid.is_inside, onto_solid.point), (true, inner));
/// assert_eq!(ball.project_point(&here, &inner, false).point, Point::new(2.0, 0.0), "its boundary");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointProjection<N: Real, const D: usize> {
    /// Whether the given point lies in the solid or on its surface.
    pub is_inside: bool,
    /// The nearest point, in the frame in which the query was made.
    pub point: Point<N, D>,
}

/// Queries of a point and a solid; implemented for every [`Shape`].
///
/// With `solid`, a shape is the set with its interior; without `solid` it is the boundary alone. A
/// point on the boundary is inside. Sets without thickness (segments; triangles in 3D) contain the
/// points that lie on them within rounding, which is a few units in the last place of the largest
/// coordinate.
///
/// If several points are equally near, the result is deterministic: the point on the face with the
/// lowest index. Where the direction to the surface is undefined, it is fixed by the shape: the
/// first coordinate axis from the centre of a ball, a direction across the axis from a point on the
/// axis of a capsule, cylinder or cone.
///
/// `contains_point`, `project_point(…, true).is_inside` and `distance_to_point(…, true) == 0`
/// always agree. A point that is not finite is never inside; its projection and distance are
/// meaningless.
///
/// A composite is the union of its parts: a point is inside if it is inside a part. For a point
/// outside, the result is for the nearest part. For a point inside, the result is for the part in
/// which the point is deepest: the nearest point of that part's own boundary, which may lie inside
/// another part. So the depth is at most the depth in the union, and equal to it where parts do not
/// overlap. Of several parts at equal distances, the one with the lowest index is returned.
/// Triangles in 3D and segments are surfaces, which contain the points on them and enclose nothing.
/// But a [solid](crate::shape::TriMesh::solid) mesh or polyline also contains the points that it
/// encloses, and any closed mesh has [`signed_distance`](crate::shape::TriMesh::signed_distance).
/// Distances from triangles and segments are as accurate far from the mesh's origin as near it. A
/// composite without parts is infinitely far from every point.
///
/// For a composite, the cost is a search for the parts near the point.
///
/// ```
/// use impinge::dim3::math::{Isometry, Point, Vector};
/// use impinge::dim3::query::PointQuery;
/// use impinge::dim3::shape::Cuboid;
///
/// let (cube, place) = (Cuboid::new(Vector::repeat(1.0_f32)), Isometry::translation(10.0, 0.0, 0.0));
/// let point = Point::new(10.0, 4.0, 0.0);
/// assert_eq!(cube.project_point(&place, &point, true).point, Point::new(10.0, 1.0, 0.0));
/// assert_eq!(cube.distance_to_point(&place, &point, true), 3.0);
/// assert_eq!(cube.distance_to_point(&place, &Point::new(10.5, 0.0, 0.0), false), -0.5, "inside");
/// ```
pub trait PointQuery<N: Space<D>, const D: usize> {
    /// Returns the nearest point of the boundary, and the feature that contains it, in the local
    /// frame.
    ///
    /// The other methods are derived from this one. [`PointProjection::point`] is on the boundary
    /// even if the given point is inside.
    fn project_local_point(&self, point: &Point<N, D>) -> (PointProjection<N, D>, FeatureId);

    /// Returns the projection of [`Self::project_local_point`], and its location: the part of a
    /// composite, the feature, and the barycentric weights of the part's corners.
    ///
    /// With `solid`, the projection of a point inside is the point itself, with the weights of that
    /// point. The feature is still the feature that contains the nearest point of the boundary.
    ///
    /// ```
    /// use impinge::dim3::math::Point;
    /// use impinge::dim3::shape::Triangle;
    /// use impinge::query::{Barycentric, PointQuery};
    ///
    /// let (a, b, c) = (Point::new(0.0, 0.0, 0.0), Point::new(4.0, 0.0, 0.0), Point::new(0.0, 4.0, 0.0));
    /// let triangle = Triangle::new(a, b, c);
    /// let (nearest, location) = triangle.project_local_point_with_location(&Point::new(1.0, 1.0, 5.0), true);
    /// assert_eq!(nearest.point, Point::new(1.0, 1.0, 0.0));
    /// assert_eq!(location.barycentric, Barycentric::Triangle([0.5, 0.25, 0.25]));
    /// ```
    fn project_local_point_with_location(
        &self,
        point: &Point<N, D>,
        solid: bool,
    ) -> (PointProjection<N, D>, PointLocation<N>);

    /// Returns the signed distance to the boundary in the local frame: negative inside.
    fn signed_distance_to_local_point(&self, point: &Point<N, D>) -> N;

    /// Returns whether the point, given in the local frame, lies in the solid or on its boundary.
    fn contains_local_point(&self, point: &Point<N, D>) -> bool {
        self.project_local_point(point).0.is_inside
    }

    /// Returns the nearest point of the solid placed at `m`, in the world frame; without `solid`,
    /// the nearest point of its boundary.
    ///
    /// With `solid`, a point inside is its own projection, bitwise equal.
    fn project_point<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> PointProjection<N, D> {
        let pose = R::view(m).pose();
        let (local, _) = self.project_local_point(&entries::point_within(&pose, point));
        entries::placed_projection(&local, &pose, point, solid)
    }

    /// Returns the distance from the shape placed at `m` to the point.
    ///
    /// With `solid` the distance is zero inside; without it the distance is negative inside: minus
    /// the distance to the nearest point of the boundary.
    fn distance_to_point<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> N {
        let local = entries::point_within(&R::view(m).pose(), point);
        let distance = self.signed_distance_to_local_point(&local);
        // NaN fails the comparison and is returned.
        if solid && distance < N::ZERO { N::ZERO } else { distance }
    }

    /// Returns whether the point lies in the solid placed at `m`, or on its boundary.
    fn contains_point<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
    ) -> bool {
        self.contains_local_point(&entries::point_within(&R::view(m).pose(), point))
    }

    /// Returns the nearest point of the boundary of the solid placed at `m`, in the world frame,
    /// and the feature that contains it.
    fn project_point_with_feature<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
    ) -> (PointProjection<N, D>, FeatureId) {
        let pose = R::view(m).pose();
        let (local, feature) = self.project_local_point(&entries::point_within(&pose, point));
        (entries::placed_projection(&local, &pose, point, false), feature)
    }

    /// Returns the nearest point of the solid placed at `m`, in the world frame, and its location
    /// on the solid; without `solid`, the nearest point of its boundary. See
    /// [`Self::project_local_point_with_location`].
    fn project_point_with_location<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> (PointProjection<N, D>, PointLocation<N>) {
        located_at(self, &R::view(m).pose(), point, solid)
    }
}

/// Implements [`PointQuery::project_point_with_location`] for a pose.
#[inline]
pub(crate) fn located_at<N: Space<D>, const D: usize>(
    shape: &(impl PointQuery<N, D> + ?Sized),
    pose: &Pose<N, D>,
    point: &Point<N, D>,
    solid: bool,
) -> (PointProjection<N, D>, PointLocation<N>) {
    let local_point = pose.inverse_point(point);
    let (local, location) = shape.project_local_point_with_location(&local_point, solid);
    (placed(&local, pose, point, solid), location)
}

/// Converts a projection from the local frame to the world frame.
pub(crate) fn placed<N: Real, const D: usize>(
    local: &PointProjection<N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
    solid: bool,
) -> PointProjection<N, D> {
    PointProjection { point: pose.point(&local.point), ..*local }.of_solid(point, solid)
}

/// Returns the nearest point of a solid placed at `pose`, in the outer frame; without `solid`, the
/// nearest point of its boundary. Also returns its distance, the magnitude of
/// [`PointQuery::distance_to_point`]. `None` for a composite without parts.
#[inline]
pub(crate) fn project<N: Space<D>, const D: usize>(
    shape: Geometry<'_, N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
    solid: bool,
) -> Option<(PointProjection<N, D>, N)> {
    let local = pose.inverse_point(point);
    let (nearest, distance) = if let Some(parts) = shape.as_composite() {
        let found = entries::nearest_part(parts, &local, false)?;
        (found.projection(), found.distance.abs())
    } else {
        let (nearest, _) = entries::surface_point(shape.0, &local).projection(&local);
        (nearest, length(&(local - nearest.point)))
    };
    let is_own = solid && nearest.is_inside;
    Some((placed(&nearest, pose, point, solid), if is_own { N::ZERO } else { distance }))
}

/// Returns true if the point, in the local frame, is certainly farther than `farthest` from a ball
/// or a box; always false for other shapes.
#[inline(always)]
pub(crate) fn is_surely_beyond<N: Real, const D: usize>(
    shape: Geometry<'_, N, D>,
    point: &Point<N, D>,
    farthest: N,
) -> bool {
    let (squared, reach) = match shape.0 {
        Kind::Ball(ball) => (point.coords.norm_squared(), ball.radius() + farthest),
        Kind::Cuboid(cuboid) => {
            let mut squared = N::ZERO;
            for axis in 0..D {
                let gap = max(point[axis].abs() - cuboid.half_extents()[axis], N::ZERO);
                squared += gap * gap;
            }
            (squared, farthest)
        }
        _ => return false,
    };
    let slack = N::lit(64.0) * N::EPSILON * squared + N::MIN_POSITIVE / N::EPSILON;
    squared > reach * reach + slack && squared < N::INFINITY
}

impl<N: Real, const D: usize> PointProjection<N, D> {
    /// Converts a projection onto the boundary to a projection onto the solid: with `solid`, a
    /// point inside is its own projection.
    fn of_solid(self, point: &Point<N, D>, solid: bool) -> Self {
        if solid && self.is_inside { Self { point: *point, ..self } } else { self }
    }
}

impl<N: Space<D>, const D: usize, S: Shape<N, D> + ?Sized> PointQuery<N, D> for S {
    fn project_local_point(&self, point: &Point<N, D>) -> (PointProjection<N, D>, FeatureId) {
        entries::project_on(self.geometry(), point)
    }

    fn project_local_point_with_location(
        &self,
        point: &Point<N, D>,
        solid: bool,
    ) -> (PointProjection<N, D>, PointLocation<N>) {
        entries::locate_on(self.geometry(), point, solid)
    }

    fn signed_distance_to_local_point(&self, point: &Point<N, D>) -> N {
        entries::signed_distance_on(self.geometry(), point)
    }

    fn contains_local_point(&self, point: &Point<N, D>) -> bool {
        entries::holds(self.geometry(), point)
    }
}

/// Implements [`PointQuery::project_local_point`].
#[inline]
pub(crate) fn project_on<N: Space<D>, const D: usize>(
    shape: Geometry<'_, N, D>,
    point: &Point<N, D>,
) -> (PointProjection<N, D>, FeatureId) {
    match shape.as_composite() {
        None => entries::surface_point(shape.0, point).projection(point),
        Some(parts) => match entries::nearest_part(parts, point, false) {
            None => (nowhere(point), FeatureId::Face(0)),
            Some(found) => (found.projection(), found.feature),
        },
    }
}

/// Implements [`PointQuery::project_local_point_with_location`].
#[inline]
pub(crate) fn locate_on<N: Space<D>, const D: usize>(
    shape: Geometry<'_, N, D>,
    point: &Point<N, D>,
    solid: bool,
) -> (PointProjection<N, D>, PointLocation<N>) {
    let Some(parts) = shape.as_composite() else {
        let (nearest, feature) = project_on(shape, point);
        let projected = nearest.of_solid(point, solid);
        let on_boundary = (projected == nearest).then_some(feature);
        let barycentric = Barycentric::of(shape, &projected.point, on_boundary);
        return (projected, PointLocation { part: 0, feature, barycentric });
    };
    let found = entries::nearest_part(parts, point, false);
    let nothing =
        PointLocation { part: 0, feature: FeatureId::Face(0), barycentric: Barycentric::Undefined };
    found.map_or((nowhere(point), nothing), |found| {
        (found.projection().of_solid(point, solid), found.location(parts, point, solid))
    })
}

/// Implements [`PointQuery::signed_distance_to_local_point`].
#[inline]
pub(crate) fn signed_distance_on<N: Space<D>, const D: usize>(
    shape: Geometry<'_, N, D>,
    point: &Point<N, D>,
) -> N {
    if let Some(parts) = shape.as_composite() {
        let found = entries::nearest_part(parts, point, false);
        return found.map_or(N::INFINITY, |found| found.distance);
    }
    let (nearest, _) = project_on(shape, point);
    let distance = length(&(point - nearest.point));
    // Subtracts from zero, so that the distance on the boundary is not −0.
    if nearest.is_inside { N::ZERO - distance } else { distance }
}

/// Implements [`PointQuery::contains_local_point`].
#[inline]
pub(crate) fn holds<N: Space<D>, const D: usize>(
    shape: Geometry<'_, N, D>,
    point: &Point<N, D>,
) -> bool {
    match shape.as_composite() {
        None => entries::surface_point(shape.0, point).projection(point).0.is_inside,
        Some(parts) => entries::nearest_part(parts, point, true).is_some(),
    }
}

/// Returns the result for a composite without parts, which has no nearest point: the query point
/// itself, not inside.
fn nowhere<N: Real, const D: usize>(point: &Point<N, D>) -> PointProjection<N, D> {
    PointProjection { is_inside: false, point: *point }
}

impl<N: Real, const D: usize> PartPoint<N, D> {
    fn projection(&self) -> PointProjection<N, D> {
        PointProjection { is_inside: self.distance <= N::ZERO, point: self.point }
    }

    /// Returns the location of the projection of `point` on the part `self.part`.
    fn location(
        &self,
        parts: &dyn CompositeShape<N, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> PointLocation<N> {
        let part_query = PartQuery::new(parts.part(self.part), point);
        let is_own = solid && self.distance <= N::ZERO && part_query.query != self.local;
        let (at, feature) =
            if is_own { (&part_query.query, None) } else { (&self.local, Some(self.feature)) };
        let barycentric = Barycentric::of(part_query.solid().geometry(), at, feature);
        PointLocation { part: self.part, feature: self.feature, barycentric }
    }
}
