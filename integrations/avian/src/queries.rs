//! Ray and point queries about one collider.

use bevy_impinge::Glam;
use impinge::math::{Point, Space};
use impinge::query::{PointQuery, Ray, RayCast};

use crate::Collider;
use crate::collider::{Isometry, Vec_};
use crate::scaling::Dimension;

impl<const D: usize> Collider<D>
where
    f32: Dimension<D>,
{
    /// Returns the time at which a ray hits the shape at a pose, and the normal there; `None`
    /// without a hit by `max_time`, or for a collider with an error.
    pub(crate) fn ray_hit(
        &self,
        pose: &Isometry<D>,
        [origin, direction]: [Vec_<D>; 2],
        max_time: f32,
        solid: bool,
    ) -> Option<(f32, Vec_<D>)> {
        let (shape, pose) = (self.shape_scaled().ok()?, f32::pose(pose));
        let origin = pose.inverse_point(&Point::from(f32::vector(origin)));
        let ray = Ray::new(origin, pose.inverse_vector(&f32::vector(direction)));
        let hit = shape.cast_local_ray_until(&ray, max_time, solid)?;
        Some((hit.toi, f32::vec(&pose.vector(&hit.normal))))
    }

    /// Returns the nearest point of the shape at a pose, and whether the given point is inside. If
    /// `solid`, a point inside is its own nearest point, otherwise the nearest point lies on the
    /// surface. `None` for a collider with an error.
    pub(crate) fn nearest(
        &self,
        pose: &Isometry<D>,
        point: Vec_<D>,
        solid: bool,
    ) -> Option<(Vec_<D>, bool)> {
        let (shape, pose) = (self.shape_scaled().ok()?, f32::pose(pose));
        let local = pose.inverse_point(&Point::from(f32::vector(point)));
        let (found, _) = shape.project_local_point_with_location(&local, solid);
        let kept = solid && found.is_inside;
        let nearest = if kept { point } else { f32::vec(&pose.point(&found.point).coords) };
        Some((nearest, found.is_inside))
    }

    /// Whether the point lies in the shape at a pose, or on its surface; `false` for a collider
    /// with an error.
    pub(crate) fn holds(&self, pose: &Isometry<D>, point: Vec_<D>) -> bool {
        let Ok(shape) = self.shape_scaled() else { return false };
        let local = f32::pose(pose).inverse_point(&Point::from(f32::vector(point)));
        shape.contains_local_point(&local)
    }
}
