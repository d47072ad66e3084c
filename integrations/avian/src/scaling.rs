//! Scaled shapes: exactly where the library has them, else the hull of points on their surface.

use bevy_impinge::{ColliderError, Glam};
use impinge::math::{Point, Vector};
use impinge::narrow_phase::ContactPrediction;
use impinge::query::ContactManifold;
use impinge::shape::{ScaleError, Shape, ShapeHandle};

/// The number of subdivisions that is enough for anybody: a hull of some ten thousand points.
const MAX_DETAIL: u32 = 64;

/// What the two dimensions do differently: implemented for `f32` with `D` = 2 and `D` = 3.
pub trait Dimension<const D: usize>: Glam<D> {
    /// Unit vectors all around, the denser the larger `detail` is.
    #[doc(hidden)]
    fn directions(detail: u32) -> Vec<Vector<f32, D>>;

    /// The contacts of two placed shapes, without memory.
    #[doc(hidden)]
    fn contacts(
        poses: &[Self::Isometry; 2],
        shapes: [&dyn Shape<f32, D>; 2],
        prediction: &ContactPrediction<f32>,
    ) -> Vec<ContactManifold<f32, D>>;

    /// The convex hull of points.
    #[doc(hidden)]
    fn hull(points: &[Point<f32, D>]) -> Result<ShapeHandle<f32, D>, ColliderError>;
}

/// The shape scaled along its axes. A convex one that the library does not have scaled so, such as a capsule with
/// oval ends, becomes the hull of its support points in some directions, scaled: it is inside of the true shape.
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
    let directions = <f32 as Dimension<D>>::directions(detail.clamp(1, MAX_DETAIL));
    let points: Vec<_> = directions.iter().map(support).collect();
    f32::hull(&points)
}
