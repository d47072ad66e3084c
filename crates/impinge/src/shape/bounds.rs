//! Boxes and spheres around shapes placed somewhere.

use super::segment::length_of;
use super::{Polytope, Shape};
use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, max};

/// The box around a shape placed at `pose`, in the frame that the pose leads to; as small as is
/// cheap. Unbounded for a half-space, but for the axis that its normal lies along exactly.
pub fn aabb<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
) -> Aabb<N, D> {
    shape.aabb(&Pose::from_isometry(pose))
}

/// The sphere around a shape placed at `pose`, in the frame that the pose leads to; infinite for a
/// half-space.
pub fn bounding_sphere<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
) -> BoundingSphere<N, D> {
    shape.local_bounding_sphere().transformed_by(&Pose::from_isometry(pose))
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// The smallest box around the solid placed at `pose`.
    pub(super) fn aabb_at(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        let placed = self.vertices.iter().map(|vertex| pose.point(vertex));
        // A pose that is not finite gives no box; then everything is in it.
        Aabb::around_all(placed).unwrap_or_else(Aabb::unbounded)
    }

    /// The sphere around the middle of the box; a little larger than the farthest vertex asks for,
    /// by the rounding of its distance.
    pub(super) fn bounding_sphere(&self) -> BoundingSphere<N, D> {
        let center = self.aabb_at(&Pose::identity()).center();
        let distance = |vertex: &Point<N, D>| length_of(&(vertex - center));
        let radius = self.vertices.iter().map(distance).fold(N::ZERO, max);
        let radius = radius * (N::ONE + N::lit(4.0) * N::EPSILON);
        BoundingSphere::try_new(center, radius).unwrap_or(BoundingSphere::unbounded())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Ball, Plane};
    use super::*;
    use crate::math::{Isometry2, Isometry3, Unit, Vector};

    #[test]
    fn balls_and_half_spaces_by_isometries() {
        let pose = Isometry3::translation(1.0_f32, 2.0, 3.0);
        let ball = aabb(&Ball::new(0.5), &pose);
        assert_eq!(ball.maxs(), &Point::<f32, 3>::new(1.5, 2.5, 3.5), "moved");
        assert_eq!(bounding_sphere(&Ball::new(0.5), &pose).radius(), 0.5, "itself");
        let plane = Plane::new(Unit::new_unchecked(Vector::<f64, 2>::y()));
        let below = aabb(&plane, &Isometry2::translation(0.0, 4.0));
        assert_eq!(below.maxs(), &Point::<f64, 2>::new(f64::INFINITY, 4.0), "bounded above");
        let sphere = bounding_sphere(&plane, &Isometry2::identity());
        assert!(sphere.radius().is_infinite(), "{sphere:?}");
    }
}
