//! Conversions of Bevy's types in 2D.

use bevy_math::{Isometry2d, Ray2d, Rot2, Vec2};
use bevy_transform::components::{GlobalTransform, Transform};
use impinge::dim2::math::{Isometry, Point, Rotation, Translation, Vector};
use impinge::dim2::na::{Complex, Unit};
use impinge::dim2::query::Ray;

use crate::ColliderError;
use crate::glam::{Glam, MAX_SHEAR, Placement, settled};

impl Glam<2> for f32 {
    type Vec = Vec2;
    type Pose = Isometry2d;
    type Ray = Ray2d;

    fn vector(vec: Vec2) -> Vector<f32> {
        Vector::new(vec.x, vec.y)
    }

    fn vec(vector: &Vector<f32>) -> Vec2 {
        Vec2::new(vector.x, vector.y)
    }

    fn isometry_of(pose: &Isometry2d) -> Isometry<Self> {
        isometry(pose.translation, pose.rotation.cos, pose.rotation.sin)
    }

    fn pose_of(isometry: &Isometry<Self>) -> Isometry2d {
        let rotation = Rot2 { cos: isometry.rotation.re, sin: isometry.rotation.im };
        Isometry2d::new(Self::vec(&isometry.translation.vector), rotation)
    }

    fn translate(isometry: &mut Isometry<Self>, by: &Vector<f32>) {
        isometry.translation.vector += by;
    }

    fn ray(ray: &Ray2d) -> Ray<f32> {
        Ray::new(Point::from(Self::vector(ray.origin)), Self::vector(*ray.direction))
    }

    #[inline]
    fn place_root(transform: &Transform) -> Result<Placement<2>, ColliderError> {
        let (rotation, scale) = (transform.rotation, transform.scale);
        if rotation.x != 0.0 || rotation.y != 0.0 {
            return Self::place_child(&GlobalTransform::from(*transform));
        }
        // The quaternion (0, 0, z, w) rotates by twice the angle of the complex number w + z i.
        let (cos, sin) =
            (rotation.w * rotation.w - rotation.z * rotation.z, 2.0 * rotation.w * rotation.z);
        let isometry = isometry(transform.translation.truncate(), cos, sin);
        Ok(Placement { isometry, scale: Vector::new(scale.x, scale.y) })
    }

    fn place_child(transform: &GlobalTransform) -> Result<Placement<2>, ColliderError> {
        let affine = transform.affine();
        let (x_axis, y_axis) = (affine.matrix3.x_axis, affine.matrix3.y_axis);
        let (x, y) = (x_axis.truncate(), y_axis.truncate());
        let (x_length, y_length) = (x.length(), y.length());
        if x_axis.z.abs() > MAX_SHEAR * x_length || y_axis.z.abs() > MAX_SHEAR * y_length {
            return Err(ColliderError::OutOfPlane);
        }
        if x.dot(y).abs() > MAX_SHEAR * x_length * y_length {
            return Err(ColliderError::Sheared);
        }
        // A reflection becomes part of the scale along y: the rotation maps the x axis to its
        // image.
        let (along, mirror) = (x / x_length, x.perp_dot(y).signum());
        let isometry = isometry(affine.translation.truncate(), along.x, along.y);
        Ok(Placement { isometry, scale: settled(Vector::new(x_length, y_length * mirror)) })
    }
}

/// Returns the library's pose; the world checks that the complex number is a rotation.
fn isometry(translation: Vec2, cos: f32, sin: f32) -> Isometry<f32> {
    let rotation: Rotation<f32> = Unit::new_unchecked(Complex::new(cos, sin));
    Isometry::from_parts(Translation::new(translation.x, translation.y), rotation)
}
