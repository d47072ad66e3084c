//! Ray queries of bounding volumes, which need no pose.

use super::{RayIntersection, ball, cast, cuboid};
use crate::bounding_volume::{Aabb, BoundingSphere, Ray};
use crate::math::Real;
use crate::shape::FeatureId;

impl<N: Real, const D: usize> Aabb<N, D> {
    /// Returns the first hit of the ray on the box, by the rules of [`RayCast`](super::RayCast);
    /// `None` if the ray misses the box.
    ///
    /// The faces have the indices of a cuboid's faces.
    pub fn toi_and_normal_with_ray(
        &self,
        ray: &Ray<N, D>,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        let project = |point: &_| Some(self.project_point_with_feature(point));
        cast(ray, solid, project, |ray| cuboid::span([self.mins(), self.maxs()], ray))
    }

    /// Returns the time of the first hit of the ray on the box, in units of the ray's direction;
    /// `None` if the ray misses the box.
    pub fn toi_with_ray(&self, ray: &Ray<N, D>, solid: bool) -> Option<N> {
        self.toi_and_normal_with_ray(ray, solid).map(|hit| hit.toi)
    }
}

impl<N: Real, const D: usize> BoundingSphere<N, D> {
    /// Returns the first hit of the ray on the sphere, by the rules of [`RayCast`](super::RayCast);
    /// `None` if the ray misses the sphere.
    ///
    /// The only feature is `Face(0)`. An infinite sphere has no boundary to hit.
    pub fn toi_and_normal_with_ray(
        &self,
        ray: &Ray<N, D>,
        solid: bool,
    ) -> Option<RayIntersection<N, D>> {
        let (center, radius) = (self.center(), self.radius());
        let project = |point: &_| Some(self.project_point_with_feature(point));
        cast(ray, solid, project, |ray| ball::around(center, radius, FeatureId::Face(0), ray))
    }

    /// Returns the time of the first hit of the ray on the sphere, in units of the ray's direction;
    /// `None` if the ray misses the sphere.
    pub fn toi_with_ray(&self, ray: &Ray<N, D>, solid: bool) -> Option<N> {
        self.toi_and_normal_with_ray(ray, solid).map(|hit| hit.toi)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Point, Vector};

    type P = Point<f64, 2>;
    type V = Vector<f64, 2>;

    #[test]
    fn boxes_and_spheres_answer_like_shapes() {
        let aabb = Aabb::new(P::new(1.0, -1.0), P::new(3.0, 1.0));
        let sphere = BoundingSphere::new(P::new(2.0, 0.0), 1.0);
        let ray = Ray::new(P::origin(), V::new(0.5, 0.0));
        let expected =
            RayIntersection { toi: 2.0, normal: -V::x(), feature: FeatureId::Face(1), part: 0 };
        assert_eq!(aabb.toi_and_normal_with_ray(&ray, true), Some(expected), "the left face");
        let expected = RayIntersection { feature: FeatureId::Face(0), ..expected };
        assert_eq!(sphere.toi_and_normal_with_ray(&ray, true), Some(expected), "the left pole");
        let inside = Ray::new(P::new(2.0, 0.0), V::new(0.0, 2.0));
        assert_eq!(aabb.toi_with_ray(&inside, true), Some(0.0), "it starts inside");
        assert_eq!(aabb.toi_with_ray(&inside, false), Some(0.5), "and leaves through the top");
        assert_eq!(sphere.toi_with_ray(&inside, false), Some(0.5), "of the sphere as well");
    }

    #[test]
    fn unbounded_volumes_are_never_left() {
        let ray = Ray::new(P::new(1.0, 2.0), V::new(0.0, -3.0));
        let aabb = Aabb::<f64, 2>::unbounded();
        assert_eq!(aabb.toi_with_ray(&ray, true), Some(0.0), "everything is inside");
        assert_eq!(aabb.toi_with_ray(&ray, false), None, "there is no boundary");
        let sphere = BoundingSphere::<f64, 2>::unbounded();
        assert_eq!(sphere.toi_with_ray(&ray, true), Some(0.0), "everything is inside");
        assert_eq!(sphere.toi_with_ray(&ray, false), None, "there is no boundary");
    }
}
