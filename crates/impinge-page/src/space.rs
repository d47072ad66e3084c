//! Converts between the dimension of the world and the three coordinates that the page uses in
//! both dimensions.

use impinge::math::na::{Quaternion, Translation2, Translation3, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Pose, Real, Vector, na};
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_record::{Recordable, Registry, Scalar};

use crate::answer::Picked;
use crate::ask;
use crate::request::PickRequest;

/// The operations of the page that depend on the dimension. Every [`Scalar`] implements them for
/// `D` = 2 and `D` = 3.
pub trait Viewed<const D: usize>: Recordable<D> {
    /// Returns the rotation of an isometry as a unit quaternion x, y, z, w. In 2D the rotation is
    /// about the third axis.
    fn quaternion(isometry: &Self::Isometry) -> [f64; 4];

    /// Returns the isometry with a translation and a unit quaternion x, y, z, w. In 2D, x and y of
    /// the quaternion are ignored.
    fn placed(translation: &Vector<Self, D>, quaternion: [f64; 4]) -> Self::Isometry;

    /// Adds a pair filter that accepts all pairs to a registry. Each dimension has an
    /// implementation: a closure is a filter in one dimension only, and a type that is a filter in
    /// both would conflict with closures.
    fn with_open_filter<T>(registry: Registry<Self, D, T>, name: &str) -> Registry<Self, D, T>;

    /// Returns the object at a point on the screen, with the hit point, and in 3D with the normal
    /// and the time.
    fn pick<T>(world: &CollisionWorld<Self, D, T>, at: &PickRequest) -> Picked;
}

impl<N: Scalar> Viewed<2> for N {
    /// Computes sine and cosine of the half angle. The one with the larger magnitude is computed
    /// first and the other by a division, which avoids cancellation.
    fn quaternion(isometry: &Isometry2<N>) -> [f64; 4] {
        let [cosine, sine] = [isometry.rotation.re, isometry.rotation.im].map(N::as_f64);
        if cosine >= 0.0 {
            let w = f64::midpoint(1.0, cosine).sqrt();
            [0.0, 0.0, sine / (2.0 * w), w]
        } else {
            let z = f64::midpoint(1.0, -cosine).sqrt().copysign(sine);
            [0.0, 0.0, z, sine / (2.0 * z)]
        }
    }

    fn placed(translation: &Vector<N, 2>, [_, _, z, w]: [f64; 4]) -> Isometry2<N> {
        let squared = z * z + w * w;
        // If z and w are zero, the rotation is about an axis in the plane. In 2D this becomes the
        // identity.
        let [cosine, sine] = if squared > 0.0 {
            [(w * w - z * z) / squared, 2.0 * z * w / squared]
        } else {
            [1.0, 0.0]
        };
        let turn = UnitComplex::from_cos_sin_unchecked(N::lit(cosine), N::lit(sine));
        Isometry2::from_parts(Translation2::from(*translation), turn)
    }

    fn with_open_filter<T>(registry: Registry<N, 2, T>, name: &str) -> Registry<N, 2, T> {
        type Object<N, T> = CollisionObject<N, 2, T>;
        registry.with_filter(name, |_: &Object<N, T>, _: &Object<N, T>| true)
    }

    fn pick<T>(world: &CollisionWorld<N, 2, T>, at: &PickRequest) -> Picked {
        ask::pick_by_point(world, at)
    }
}

impl<N: Scalar> Viewed<3> for N {
    fn quaternion(isometry: &Isometry3<N>) -> [f64; 4] {
        let turn = &isometry.rotation.coords;
        [turn.x, turn.y, turn.z, turn.w].map(N::as_f64)
    }

    fn placed(translation: &Vector<N, 3>, quaternion: [f64; 4]) -> Isometry3<N> {
        let [x, y, z, w] = quaternion.map(N::lit);
        let turn = UnitQuaternion::new_unchecked(Quaternion::new(w, x, y, z));
        Isometry3::from_parts(Translation3::from(*translation), turn)
    }

    fn with_open_filter<T>(registry: Registry<N, 3, T>, name: &str) -> Registry<N, 3, T> {
        type Object<N, T> = CollisionObject<N, 3, T>;
        registry.with_filter(name, |_: &Object<N, T>, _: &Object<N, T>| true)
    }

    fn pick<T>(world: &CollisionWorld<N, 3, T>, at: &PickRequest) -> Picked {
        ask::pick_by_ray(world, at)
    }
}

/// Converts a vector to three coordinates; coordinates beyond the dimension are zero.
pub(crate) fn coordinates<N: Real, const D: usize>(vector: &Vector<N, D>) -> [f64; 3] {
    let mut three = [0.0; 3];
    for (coordinate, own) in three.iter_mut().zip(vector.iter()) {
        *coordinate = own.as_f64();
    }
    three
}

/// Converts three coordinates to a vector of the dimension, rounded to its scalar.
pub(crate) fn vector<N: Real, const D: usize>(three: [f64; 3]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(three[axis]))
}

/// Converts three coordinates to a point of the dimension, rounded to its scalar.
pub(crate) fn point<N: Real, const D: usize>(three: [f64; 3]) -> Point<N, D> {
    Point::from(vector(three))
}

/// Converts a pose to the isometry type that queries of two shapes accept in either dimension. The
/// rotation matrix is copied without rounding.
pub(crate) fn isometry<N: Real, const D: usize>(
    pose: &Pose<N, D>,
) -> na::Isometry<N, na::Rotation<N, D>, D> {
    let rotation = na::Rotation::from_matrix_unchecked(pose.rotation);
    na::Isometry::from_parts(na::Translation::from(pose.translation), rotation)
}

/// Normalizes a quaternion; `None` if all its components are zero or one of them is not finite.
pub(crate) fn unit_quaternion(quaternion: [f64; 4]) -> Option<[f64; 4]> {
    let largest = quaternion.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    let is_usable = largest > 0.0 && quaternion.iter().all(|x| x.is_finite());
    // The components are divided by the largest magnitude first, so that their squares neither
    // overflow nor all underflow.
    let scaled = quaternion.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    is_usable.then(|| scaled.map(|x| x / length))
}
