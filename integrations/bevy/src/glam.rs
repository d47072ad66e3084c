//! Conversions between the mathematical types of Bevy and of the library, in a trait that both dimensions implement.

use core::fmt::Debug;

use bevy_transform::components::{GlobalTransform, Transform};
use impinge::math::{Space, Vector};
use impinge::query::Ray;

use crate::ColliderError;

/// Bevy's types of dimension `D` and their conversions: implemented for `f32` with `D` = 2 and `D` = 3.
///
/// Numbers are copied one by one, because the library and Bevy may use different versions of glam.
pub trait Glam<const D: usize>: Space<D> {
    /// A vector or a point: `Vec2` or `Vec3`.
    type Vec: Copy + Debug + Default + PartialEq + Send + Sync + 'static;
    /// A rotation and a translation: `Isometry2d` or `Isometry3d`.
    type Pose: Copy + Debug + Default + PartialEq + Send + Sync + 'static;
    /// A half-line: `Ray2d` or `Ray3d`.
    type Ray: Copy + Debug + PartialEq + Send + Sync + 'static;

    /// Converts to the library's vector.
    fn vector(vec: Self::Vec) -> Vector<f32, D>;
    /// Converts to Bevy's vector.
    fn vec(vector: &Vector<f32, D>) -> Self::Vec;
    /// Converts to the library's pose.
    fn isometry_of(pose: &Self::Pose) -> Self::Isometry;
    /// Converts to Bevy's pose.
    fn pose_of(isometry: &Self::Isometry) -> Self::Pose;
    /// Translates a pose by a vector in the world frame.
    #[doc(hidden)]
    fn translate(isometry: &mut Self::Isometry, by: &Vector<f32, D>);

    /// Converts to the library's ray, with a direction of length 1.
    fn ray(ray: &Self::Ray) -> Ray<f32, D>;

    /// Returns pose and scale of an entity without a parent: exact copies of the transform's
    /// values.
    #[doc(hidden)]
    fn place_root(transform: &Transform) -> Result<Placement<D>, ColliderError>
    where
        Self: Sized,
        f32: Glam<D>;

    /// Returns pose and scale of an entity with a parent, decomposed from the affine map.
    #[doc(hidden)]
    fn place_child(transform: &GlobalTransform) -> Result<Placement<D>, ColliderError>
    where
        Self: Sized,
        f32: Glam<D>;
}

/// `Vec2` or `Vec3`.
pub(crate) type Vec_<const D: usize> = <f32 as Glam<D>>::Vec;
/// `Isometry2d` or `Isometry3d`.
pub(crate) type Pose<const D: usize> = <f32 as Glam<D>>::Pose;
/// The library's isometry.
pub(crate) type Isometry<const D: usize> = <f32 as Space<D>>::Isometry;

/// The pose of an entity, and the scale factors along the axes of its local frame.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placement<const D: usize>
where
    f32: Glam<D>,
{
    pub(crate) isometry: Isometry<D>,
    pub(crate) scale: Vector<f32, D>,
}

/// The largest cosine between two scaled axes that count as perpendicular: 0.06° from a right
/// angle. The error of a chain of rotations in `f32` is about 1e-6.
pub(crate) const MAX_SHEAR: f32 = 1e-3;
/// The largest relative difference of two scales that is attributed to rounding in a chain of transforms.
const SCALE_ROUNDING: f32 = 1e-5;

/// Removes the rounding error of a scale that was computed from a product of matrices. A factor whose magnitude
/// agrees within [`SCALE_ROUNDING`] with 1, or else with the magnitude of the first factor, gets that magnitude and
/// keeps its sign. So a capsule below a rotated parent remains a capsule.
pub(crate) fn settled<const D: usize>(mut scale: Vector<f32, D>) -> Vector<f32, D> {
    let first = scale[0].abs();
    let is_near = |a: f32, b: f32| (a - b).abs() <= SCALE_ROUNDING * b;
    for factor in scale.iter_mut() {
        if is_near(factor.abs(), 1.0) {
            *factor = factor.signum();
        } else if is_near(factor.abs(), first) {
            *factor = first.copysign(*factor);
        }
    }
    scale
}

/// Returns `old` if `new` differs from it only by rounding, otherwise `new`. Without this a
/// rotating parent would give its children a new shape in each step.
pub(crate) fn kept_scale<const D: usize>(
    old: Vector<f32, D>,
    new: Vector<f32, D>,
) -> Vector<f32, D> {
    let is_near = |(a, b): (&f32, &f32)| (a - b).abs() <= SCALE_ROUNDING * a.abs();
    if old.iter().zip(new.iter()).all(is_near) { old } else { new }
}
