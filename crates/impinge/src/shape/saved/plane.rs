//! Records of the shapes whose types exist in 2D only, and of height fields in 2D.

use super::{ShapeRecord, made};
use crate::math::numbers::{Damage, Numbers, ensure};
use crate::math::{Point, Real};
use crate::shape::composite::polyline::Front;
use crate::shape::composite::polyline_parts::right_of;
use crate::shape::{ConvexPolygon, HeightField, Shape, ShapeHandle};

/// Returns the function that maps the direction of a segment to the normal on its front.
pub(crate) fn front2<N: Real>() -> Option<Front<N, 2>> {
    Some(right_of)
}

/// Returns the record of a convex polygon or a height field; `None` for any other shape.
pub(crate) fn record2<N: Real>(shape: &dyn Shape<N, 2>) -> Option<ShapeRecord<N>> {
    if let Some(polygon) = shape.as_shape::<ConvexPolygon<N>>() {
        return Some(ShapeRecord::ConvexPolygon(Numbers::of_points(polygon.vertices())));
    }
    let field = shape.as_shape::<HeightField<N, 2>>()?;
    Some(ShapeRecord::HeightField(field.record()))
}

/// Restores a shape from a record that [`record2`] returned; an error for a damaged record or
/// another kind.
pub(crate) fn make2<N: Real>(record: &ShapeRecord<N>) -> Result<ShapeHandle<N, 2>, Damage> {
    match record {
        ShapeRecord::ConvexPolygon(vertices) => Ok(ShapeHandle::new(polygon(vertices.points()?)?)),
        ShapeRecord::HeightField(field) => {
            let field =
                field.make(|heights, scale| HeightField::<N, 2>::try_new(heights, scale))?;
            made(Ok::<_, core::convert::Infallible>(field.with_all_rebuilt()))
        }
        _ => Err(Damage("2D has no such shape".into())),
    }
}

/// Restores a polygon from its vertices, which must be counter-clockwise. Public constructors would
/// drop vertices on the line between their neighbours. An error if there are fewer than 3 vertices,
/// one is not finite, or the polygon is not roughly convex.
fn polygon<N: Real>(vertices: Vec<Point<N, 2>>) -> Result<ConvexPolygon<N>, Damage> {
    let is_finite = vertices.iter().flat_map(|point| point.iter()).all(|x| x.is_finite_number());
    ensure(is_finite && vertices.len() >= 3, "a polygon has too few vertices, or infinite ones")?;
    let polygon = ConvexPolygon::from_corners(vertices);
    ensure(polygon.is_roughly_convex(), "a polygon is not convex")?;
    Ok(polygon)
}
