//! Where a ray meets one solid.
//!
//! The solids are convex, so the line of a ray is inside during one span of time. Each shape's file
//! finds that span in closed form; [`span`] turns it into the answer for a solid or a hollow shape.
//! One table per dimension (`ray2`, `ray3`) says which file answers for which shape.

mod ball;
mod capsule;
mod clip;
mod cone;
mod cuboid;
mod cylinder;
mod ellipsoid;
mod plane;
mod polytope;
pub(crate) mod ray2;
pub(crate) mod ray3;
mod rounded;
mod segment;
mod span;
mod support_map;
mod tapered_capsule;
mod triangle2;
mod triangle3;
mod volume;

pub(crate) use span::Span;

use super::composite::first_hit;
use super::point::length;
use super::{PointProjection, PointQuery};
use crate::bounding_volume::Ray;
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, Space, Vector, max_component};
use crate::shape::{FeatureId, Shape};

/// Where and when a ray first meets a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayIntersection<N: Real, const D: usize> {
    /// The time of impact, zero or more, in units of the length of the ray's direction: the point
    /// hit is `ray.point_at(toi)`.
    pub toi: N,
    /// The unit vector out of the solid at the point hit, in the frame that the question was asked
    /// in. It points out also where a ray leaves a hollow shape. On a set without thickness it
    /// points against the ray.
    ///
    /// It is the zero vector where there is no surface to speak of: the ray of a solid query starts
    /// inside, or on the boundary and leads out; or the ray has no direction.
    pub normal: Vector<N, D>,
    /// The feature that was hit. A hit on a vertex or an edge may answer with one of the faces there;
    /// a ray that starts inside a solid, with the nearer of the two features ahead and behind.
    pub feature: FeatureId,
    /// The part of a composite that was hit, which the feature is of; 0 for a convex solid.
    pub part: u32,
}

/// Questions about a ray and a solid; implemented for every [`Shape`].
///
/// A `solid` is the set with its interior: a ray that starts inside or on the boundary hits at time
/// zero. Without `solid` only the boundary counts, and a ray that starts inside hits where it leaves.
/// A ray that only touches the boundary hits. A ray whose direction is zero is a point: it hits at
/// time zero if that point is in the set. A ray that is not finite hits nothing.
///
/// Sets without thickness (segments; triangles in space) are hit where the ray meets them within
/// rounding: a few units in the last place of the distances involved.
pub trait RayCast<N: Real, const D: usize> {
    /// The first hit in the local frame.
    ///
    /// The other methods derive from it.
    fn cast_local_ray(&self, ray: &Ray<N, D>, solid: bool) -> Option<RayIntersection<N, D>>;

    /// The first hit on the solid placed at `m`, with its normal in the world frame.
    fn toi_and_normal_with_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        let pose = Pose::from_isometry(m);
        let local = self.cast_local_ray(&ray.inverse_transformed_by(&pose), solid)?;
        Some(RayIntersection { normal: pose.vector(&local.normal), ..local })
    }

    /// The time of the first hit on the solid placed at `m`, in units of the ray's direction.
    fn toi_with_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
        solid: bool,
    ) -> Option<N> {
        let local = ray.inverse_transformed_by(&Pose::from_isometry(m));
        self.cast_local_ray(&local, solid).map(|hit| hit.toi)
    }

    /// The ray meets the solid placed at `m`.
    fn intersects_ray<R: AbstractRotation<N, D>>(
        &self,
        m: &Isometry<N, R, D>,
        ray: &Ray<N, D>,
    ) -> bool {
        self.toi_with_ray(m, ray, true).is_some()
    }
}

impl<N: Space<D>, const D: usize, S: Shape<N, D> + ?Sized> RayCast<N, D> for S {
    fn cast_local_ray(&self, ray: &Ray<N, D>, solid: bool) -> Option<RayIntersection<N, D>> {
        if let Some(parts) = self.geometry().as_composite() {
            return first_hit(parts, ray, solid);
        }
        let project = |point: &_| self.project_local_point(point);
        cast(ray, solid, project, |ray| (N::tables().ray_span)(self.geometry().0, ray))
    }
}

/// The hit of a ray that starts in the set.
fn at_start<N: Real, const D: usize>(feature: FeatureId) -> RayIntersection<N, D> {
    RayIntersection { toi: N::ZERO, normal: Vector::<N, D>::zeros(), feature, part: 0 }
}

/// What all shapes have in common: rays that are no rays, and the length of the direction.
///
/// `span` is asked for finite rays whose largest component of the direction is between 1 and 2: the
/// direction is divided by a power of two, which loses nothing, so that its powers stay in range.
fn cast<N: Real, const D: usize>(
    ray: &Ray<N, D>,
    solid: bool,
    project: impl FnOnce(&Point<N, D>) -> (PointProjection<N, D>, FeatureId),
    span: impl FnOnce(&Ray<N, D>) -> Option<Span<N, D>>,
) -> Option<RayIntersection<N, D>> {
    if !ray.origin.iter().chain(ray.dir.iter()).all(|x| x.is_finite_number()) {
        return None;
    }
    let speed = max_component(&ray.dir);
    if speed == N::ZERO {
        let (nearest, feature) = project(&ray.origin);
        let on_boundary = length(&(ray.origin - nearest.point)) == N::ZERO;
        let hits = if solid { nearest.is_inside } else { on_boundary };
        return hits.then(|| at_start(feature));
    }
    let unit = speed.power_of_two_below();
    let hit = span(&Ray::new(ray.origin, ray.dir / unit)).and_then(|span| span.first_hit(solid));
    let Some(hit) = hit else {
        // By rounding, a crossing at the start may seem to lie before it.
        let start = if solid { Some(project(&ray.origin)) } else { None };
        return start
            .filter(|(nearest, _)| nearest.is_inside)
            .map(|(_, feature)| at_start(feature));
    };
    let toi = hit.toi / unit;
    toi.is_finite_number().then_some(RayIntersection { toi, ..hit })
}
