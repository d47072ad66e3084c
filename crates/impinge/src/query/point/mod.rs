//! Where a point lies to one solid: inside or not, how far, and the nearest point of the surface.
//!
//! Every answer derives from one local fact, the nearest point of the boundary, found by closed
//! forms: one file per shape, and one table per dimension (`point2`, `point3`).

mod ball;
mod capsule;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
mod plane;
pub(crate) mod point2;
pub(crate) mod point3;
mod polytope;
mod rounded;
mod segment;
mod support_map;
mod surface;
mod tapered_capsule;
mod triangle2;
mod triangle3;
mod volume;

pub(super) use segment::{feature_at, nearest as nearest_on_segment};
pub(crate) use surface::SurfacePoint;
pub(super) use surface::length;

use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, Space};
use crate::shape::{FeatureId, Shape};

/// The point of a solid, or of its surface, that is nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointProjection<N: Real, const D: usize> {
    /// The given point lies in the solid or on its surface.
    pub is_inside: bool,
    /// The nearest point, in the frame that the question was asked in.
    pub point: Point<N, D>,
}

/// Questions about a point and a solid; implemented for every [`Shape`].
///
/// A `solid` is the set with its interior; without `solid` only its boundary counts. A point on the
/// boundary is inside. Sets without thickness (segments; triangles in space) hold the points that
/// lie on them within rounding, which is a few units in the last place of the largest coordinate.
///
/// Where several points are equally near, the answer is fixed: the feature of lowest number wins
/// among faces, and a direction that is not defined (from the centre of a ball, from the axis of a
/// capsule, cylinder or cone) is the first coordinate axis that will do.
///
/// `contains_point`, `project_point(…, true).is_inside` and `distance_to_point(…, true) == 0` always
/// agree. A point that is not finite lies in nothing; its projection and distance mean nothing.
pub trait PointQuery<N: Real, const D: usize> {
    /// The nearest point of the boundary, and the feature that it lies on, in the local frame.
    ///
    /// The other methods derive from it. [`PointProjection::point`] is on the boundary even if the
    /// given point is inside.
    fn project_local_point(&self, point: &Point<N, D>) -> (PointProjection<N, D>, FeatureId);

    /// The nearest point of the solid (or of its boundary) placed at `m`, in the world frame.
    ///
    /// For a solid, a point inside is its own projection, to the bit.
    fn project_point<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> PointProjection<N, D> {
        let pose = Pose::from_isometry(m);
        let (local, _) = self.project_local_point(&pose.inverse_point(point));
        placed(&local, &pose, point, solid)
    }

    /// The distance from the solid placed at `m` to the point.
    ///
    /// For a solid it is zero inside; for a boundary it is negative inside: minus the distance to
    /// the nearest point of the boundary.
    fn distance_to_point<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
        solid: bool,
    ) -> N {
        let local = Pose::from_isometry(m).inverse_point(point);
        let (nearest, _) = self.project_local_point(&local);
        let distance = length(&(local - nearest.point));
        match (nearest.is_inside, solid) {
            (false, _) => distance,
            (true, true) => N::ZERO,
            // Subtracting from zero, so that the boundary is at plain zero.
            (true, false) => N::ZERO - distance,
        }
    }

    /// The point lies in the solid placed at `m`, or on its boundary.
    fn contains_point<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
    ) -> bool {
        let local = Pose::from_isometry(m).inverse_point(point);
        self.project_local_point(&local).0.is_inside
    }

    /// The nearest point of the boundary of the solid placed at `m`, in the world frame, and the
    /// feature that it lies on.
    fn project_point_with_feature<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        point: &Point<N, D>,
    ) -> (PointProjection<N, D>, FeatureId) {
        let pose = Pose::from_isometry(m);
        let (local, feature) = self.project_local_point(&pose.inverse_point(point));
        (placed(&local, &pose, point, false), feature)
    }
}

/// The projection in the world frame.
fn placed<N: Real, const D: usize>(
    local: &PointProjection<N, D>,
    pose: &Pose<N, D>,
    point: &Point<N, D>,
    solid: bool,
) -> PointProjection<N, D> {
    PointProjection { point: pose.point(&local.point), ..*local }.of_solid(point, solid)
}

impl<N: Real, const D: usize> PointProjection<N, D> {
    /// The projection on the boundary, made that on the solid: a point inside is its own.
    fn of_solid(self, point: &Point<N, D>, solid: bool) -> Self {
        if solid && self.is_inside { Self { point: *point, ..self } } else { self }
    }
}

impl<N: Space<D>, const D: usize, S: Shape<N, D> + ?Sized> PointQuery<N, D> for S {
    fn project_local_point(&self, point: &Point<N, D>) -> (PointProjection<N, D>, FeatureId) {
        (N::tables().surface_point)(self.geometry().0, point).projection(point)
    }
}
