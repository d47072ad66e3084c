//! Scales shapes: exactly if the library supports it, otherwise by the convex hull of scaled
//! surface points.

use bevy_impinge::{ColliderError, Glam};
use impinge::math::{Point, Vector};
use impinge::narrow_phase::ContactPrediction;
use impinge::query::ManifoldView;
use impinge::shape::{ScaleError, Shape, ShapeHandle};

/// The largest number of subdivisions: about 6000 points in 3D.
const MAX_DETAIL: u32 = 64;

/// The operations that differ by dimension; implemented for `f32` with `D` = 2 and `D` = 3.
pub trait Dimension<const D: usize>: Glam<D> {
    /// Computes the contacts of two placed shapes, without state, and passes each manifold to `each`.
    #[doc(hidden)]
    fn each_manifold(
        poses: &[Self::Isometry; 2],
        shapes: [&dyn Shape<f32, D>; 2],
        prediction: &ContactPrediction<f32>,
        each: impl FnMut(ManifoldView<'_, f32, D>),
    );

    /// Creates the convex hull of points.
    #[doc(hidden)]
    fn hull(points: &[Point<f32, D>]) -> Result<ShapeHandle<f32, D>, ColliderError>;
}

/// Scales a shape along its axes. A convex shape that the library cannot scale exactly, such as a
/// capsule whose ends would be elliptic, becomes the convex hull of scaled support points, which
/// lies inside the exact shape.
pub(crate) fn scaled<const D: usize>(
    shape: &ShapeHandle<f32, D>,
    scale: &Vector<f32, D>,
    detail: u32,
) -> Result<ShapeHandle<f32, D>, ColliderError>
where
    f32: Dimension<D>,
{
    if scale.iter().all(|&factor| factor == 1.0) {
        return Ok(shape.clone());
    }
    let refused = match shape.scaled(scale) {
        Ok(scaled) => return Ok(scaled),
        Err(error) => error,
    };
    let map = match refused {
        ScaleError::NotSuch { .. } => shape.geometry().as_support_map(),
        _ => None,
    };
    let Some(map) = map else { return Err(refused.into()) };
    let support = |direction: &Vector<f32, D>| {
        let point = map.core_support(direction) + direction * map.rounding();
        Point::from(point.coords.component_mul(scale))
    };
    let points: Vec<_> = directions::<D>(detail).map(|direction| support(&direction)).collect();
    f32::hull(&points)
}

/// Returns unit vectors through the points of a grid on the surface of a square or cube, including
/// the axes: 40 in 2D and 218 in 3D for `detail` 10. Trigonometry is not used, so the bits are the
/// same on every machine.
fn directions<const D: usize>(detail: u32) -> impl Iterator<Item = Vector<f32, D>> {
    let half = detail.clamp(1, MAX_DETAIL).div_ceil(2 * (D as u32 - 1));
    let width = 2 * half + 1;
    let corner = move |index: u32| {
        let digit = |axis: usize| index / width.pow(axis as u32) % width;
        Vector::<f32, D>::from_fn(|axis, _| digit(axis) as f32 - half as f32)
    };
    let is_outside = move |corner: &Vector<f32, D>| corner.amax() == half as f32;
    (0..width.pow(D as u32)).map(corner).filter(is_outside).map(|corner| corner.normalize())
}
