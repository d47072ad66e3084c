//! Conversions of Bevy's types in 3D.

use bevy_math::{Isometry3d, Mat3A, Quat, Ray3d, Vec3};
use bevy_transform::components::{GlobalTransform, Transform};
use impinge::dim3::math::{Isometry, Point, Translation, Vector};
use impinge::dim3::na::{Quaternion, UnitQuaternion};
use impinge::dim3::query::Ray;

use crate::ColliderError;
use crate::glam::{Glam, MAX_SHEAR, Placement, settled};

impl Glam<3> for f32 {
    type Vec = Vec3;
    type Pose = Isometry3d;
    type Ray = Ray3d;

    fn vector(vec: Vec3) -> Vector<f32> {
        Vector::new(vec.x, vec.y, vec.z)
    }

    fn vec(vector: &Vector<f32>) -> Vec3 {
        Vec3::new(vector.x, vector.y, vector.z)
    }

    fn isometry_of(pose: &Isometry3d) -> Isometry<Self> {
        isometry(pose.translation.into(), pose.rotation)
    }

    fn pose_of(isometry: &Isometry<Self>) -> Isometry3d {
        let q = isometry.rotation.coords;
        let rotation = Quat::from_xyzw(q.x, q.y, q.z, q.w);
        Isometry3d::new(Self::vec(&isometry.translation.vector), rotation)
    }

    fn translate(isometry: &mut Isometry<Self>, by: &Vector<f32>) {
        isometry.translation.vector += by;
    }

    fn ray(ray: &Ray3d) -> Ray<f32> {
        Ray::new(Point::from(Self::vector(ray.origin)), Self::vector(*ray.direction))
    }

    #[inline]
    fn place_root(transform: &Transform) -> Result<Placement<3>, ColliderError> {
        let isometry = isometry(transform.translation, transform.rotation);
        Ok(Placement { isometry, scale: Self::vector(transform.scale) })
    }

    fn place_child(transform: &GlobalTransform) -> Result<Placement<3>, ColliderError> {
        let affine = transform.affine();
        let axes = [affine.matrix3.x_axis, affine.matrix3.y_axis, affine.matrix3.z_axis];
        let lengths = axes.map(|axis| axis.length());
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            if axes[i].dot(axes[j]).abs() > MAX_SHEAR * lengths[i] * lengths[j] {
                return Err(ColliderError::Sheared);
            }
        }
        // A reflection becomes part of the scale along x, as in
        // `Affine3A::to_scale_rotation_translation`.
        let mirror = affine.matrix3.determinant().signum();
        let [x, y, z] = lengths;
        let scale = Vector::new(x * mirror, y, z);
        let turned = Mat3A::from_cols(axes[0] / scale.x, axes[1] / scale.y, axes[2] / scale.z);
        let isometry = isometry(affine.translation.into(), Quat::from_mat3a(&turned));
        Ok(Placement { isometry, scale: settled(scale) })
    }
}

/// Returns the library's pose; the world checks that the quaternion is a rotation.
fn isometry(translation: Vec3, rotation: Quat) -> Isometry<f32> {
    let quaternion = Quaternion::new(rotation.w, rotation.x, rotation.y, rotation.z);
    let translation = Translation::new(translation.x, translation.y, translation.z);
    Isometry::from_parts(translation, UnitQuaternion::new_unchecked(quaternion))
}
