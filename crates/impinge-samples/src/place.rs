//! Creates positions, vectors and points from three numbers, of which 2D uses the first two.

use impinge::math::na::{self, Rotation};
use impinge::math::{Matrix, Point, Pose, Real, Space, Unit, Vector};
use impinge::narrow_phase::CollisionObjectHandle;
use impinge_record::Recordable;

use crate::{Isometry, World};

/// A full turn in radians.
pub(crate) const TAU: f32 = core::f32::consts::TAU;

/// Returns a vector with the first `D` numbers as components.
pub(crate) fn vector<const D: usize>(xyz: [f32; 3]) -> Vector<f32, D> {
    Vector::<f32, D>::from_fn(|axis, _| xyz[axis])
}

/// Returns a point with the first `D` numbers as coordinates.
pub(crate) fn point<const D: usize>(xyz: [f32; 3]) -> Point<f32, D> {
    Point::from(vector::<D>(xyz))
}

/// Returns a position without a rotation.
pub(crate) fn at<const D: usize>(xyz: [f32; 3]) -> Isometry<D>
where
    f32: Space<D>,
{
    f32::isometry(&Pose::from_translation(vector(xyz)))
}

/// Returns a position with a rotation from the x axis to the y axis by `angle` radians.
pub(crate) fn turned<const D: usize>(xyz: [f32; 3], angle: f32) -> Isometry<D>
where
    f32: Space<D>,
{
    f32::isometry(&Pose { rotation: turn([0, 1], angle), translation: vector(xyz) })
}

/// Returns the rotation from the axis `from` to the axis `to` by `angle` radians. The library
/// computes sine and cosine with the same bits on every machine.
pub(crate) fn turn<const D: usize>([from, to]: [usize; 2], angle: f32) -> Matrix<f32, D> {
    let (sine, cosine) = angle.sine_cosine();
    let mut matrix = Matrix::<f32, D>::identity();
    (matrix[(from, from)], matrix[(to, to)]) = (cosine, cosine);
    (matrix[(from, to)], matrix[(to, from)]) = (-sine, sine);
    matrix
}

/// Returns the pose of an object; the identity if the object was removed.
pub(crate) fn pose_of<const D: usize>(
    world: &World<D>,
    object: CollisionObjectHandle,
) -> Pose<f32, D>
where
    f32: Recordable<D>,
{
    let object = world.collision_object(object);
    object.map_or_else(Pose::identity, |object| f32::pose(object.position()))
}

/// Converts a pose to the isometry type that queries of two shapes accept in either dimension.
pub(crate) fn isometry<const D: usize>(
    pose: &Pose<f32, D>,
) -> na::Isometry<f32, Rotation<f32, D>, D> {
    let rotation = Rotation::from_matrix_unchecked(pose.rotation);
    na::Isometry::from_parts(pose.translation.into(), rotation)
}

/// Returns the number with this index, from 0 to 1, of a quasirandom sequence. The numbers are
/// the fractional parts of multiples of an irrational number, which depends on `stream` (Roberts,
/// "The unreasonable effectiveness of quasirandom sequences", 2018).
#[expect(clippy::cast_possible_truncation, reason = "a fraction rounded to f32")]
pub(crate) fn scattered(index: usize, stream: usize) -> f32 {
    const STEPS: [f64; 4] =
        [0.819_172_513_396, 0.671_043_606_703, 0.549_700_477_901, 0.450_304_206];
    let position = 0.5 + (index + 1) as f64 * STEPS[stream % STEPS.len()];
    (position - position.floor()) as f32
}

/// Returns a triangle wave of period 1, which is 0 at phase 0 and 1 at phase 0.5.
pub(crate) fn to_and_fro(phase: f32) -> f32 {
    1.0 - (2.0 * (phase - phase.floor()) - 1.0).abs()
}

/// Converts a count to `f32`.
#[expect(clippy::cast_precision_loss, reason = "counts of samples are small")]
pub(crate) const fn number(count: usize) -> f32 {
    count as f32
}

/// Returns the upward unit vector, along y.
pub(crate) fn up<const D: usize>() -> Unit<Vector<f32, D>> {
    Unit::new_unchecked(vector([0.0, 1.0, 0.0]))
}
