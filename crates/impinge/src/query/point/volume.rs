//! Point queries of bounding volumes, which need no pose.

use super::{PointProjection, SurfacePoint, ball, cuboid};
use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{Point, Real};
use crate::shape::FeatureId;

impl<N: Real, const D: usize> Aabb<N, D> {
    /// Returns the nearest point of the box's boundary, and the feature that contains it, with the
    /// ids of a cuboid's features. For a point inside a box without finite faces, the result is at
    /// infinity.
    pub fn project_point_with_feature(
        &self,
        point: &Point<N, D>,
    ) -> (PointProjection<N, D>, FeatureId) {
        cuboid::surface_point([self.mins(), self.maxs()], point).projection(point)
    }

    /// Returns the nearest point of the box; without `solid`, the nearest point of its boundary.
    pub fn project_point(&self, point: &Point<N, D>, solid: bool) -> PointProjection<N, D> {
        self.project_point_with_feature(point).0.of_solid(point, solid)
    }
}

impl<N: Real, const D: usize> BoundingSphere<N, D> {
    /// Returns the nearest point of the sphere's boundary, and `Face(0)`. The point is not finite
    /// if the radius is infinite.
    pub fn project_point_with_feature(
        &self,
        point: &Point<N, D>,
    ) -> (PointProjection<N, D>, FeatureId) {
        let around_center = Point::from(point - self.center());
        let found = ball::surface_point(self.radius(), &around_center);
        SurfacePoint { point: found.point + self.center().coords, ..found }.projection(point)
    }

    /// Returns the nearest point of the sphere; without `solid`, the nearest point of its boundary.
    pub fn project_point(&self, point: &Point<N, D>, solid: bool) -> PointProjection<N, D> {
        self.project_point_with_feature(point).0.of_solid(point, solid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type P = Point<f64, 3>;

    #[test]
    fn boxes_and_spheres_answer_like_shapes() {
        let aabb = Aabb::new(P::new(0.0, 0.0, 0.0), P::new(4.0, 2.0, 4.0));
        let beyond = aabb.project_point_with_feature(&P::new(5.0, 3.0, 1.0));
        let edge = PointProjection { is_inside: false, point: P::new(4.0, 2.0, 1.0) };
        assert_eq!(beyond, (edge, FeatureId::Edge(8 + 3)), "the edge along z at +x +y");
        let within = P::new(2.0, 1.5, 2.0);
        assert_eq!(aabb.project_point(&within, true).point, within, "inside stays");
        assert_eq!(aabb.project_point(&within, false).point, P::new(2.0, 2.0, 2.0), "the top");
        let sphere = BoundingSphere::new(P::new(1.0, 0.0, 0.0), 2.0);
        let found = sphere.project_point(&P::new(1.0, 5.0, 0.0), true);
        assert_eq!(found.point, P::new(1.0, 2.0, 0.0), "towards the point");
    }
}
