//! Records of the shapes whose types exist in 3D only, and of height fields in 3D.

use super::{ShapeRecord, made};
use crate::math::numbers::{Damage, NumberSource, Numbers, ensure};
use crate::math::{Point, Real, Vector, is_unit};
use crate::shape::composite::polyline::Front;
use crate::shape::{Cone, ConvexHull, Cylinder, HeightField, Shape, ShapeHandle, Tetrahedron};

/// Returns `None`: a segment in 3D has no front.
pub(crate) const fn front3<N: Real>() -> Option<Front<N, 3>> {
    None
}

/// Returns the record of a shape whose type exists in 3D only, or of a height field; `None` for any
/// other shape.
pub(crate) fn record3<N: Real>(shape: &dyn Shape<N, 3>) -> Option<ShapeRecord<N>> {
    if let Some(hull) = shape.as_shape::<ConvexHull<N>>() {
        let (vertices, faces) = (Numbers::of_points(hull.vertices()), hull.faces());
        let normals = Numbers::of(faces.iter().flat_map(|face| face.normal.iter().copied()));
        let faces = faces.iter().map(|face| hull.face_vertices(face).to_vec()).collect();
        return Some(ShapeRecord::ConvexHull { vertices, normals, faces });
    }
    if let Some(cylinder) = shape.as_shape::<Cylinder<N>>() {
        let sizes = [cylinder.half_height(), cylinder.radius()];
        return Some(ShapeRecord::Cylinder(Numbers::of(sizes)));
    }
    if let Some(cone) = shape.as_shape::<Cone<N>>() {
        return Some(ShapeRecord::Cone(Numbers::of([cone.half_height(), cone.radius()])));
    }
    if let Some(tetrahedron) = shape.as_shape::<Tetrahedron<N>>() {
        return Some(ShapeRecord::Tetrahedron(Numbers::of_points(tetrahedron.corners())));
    }
    let field = shape.as_shape::<HeightField<N, 3>>()?;
    Some(ShapeRecord::HeightField(field.record()))
}

/// Restores a shape from a record that [`record3`] returned; an error for a damaged record or
/// another kind.
pub(crate) fn make3<N: Real>(record: &ShapeRecord<N>) -> Result<ShapeHandle<N, 3>, Damage> {
    match record {
        ShapeRecord::ConvexHull { vertices, normals, faces } => {
            Ok(ShapeHandle::new(hull(vertices.points()?, &normals.points()?, faces)?))
        }
        ShapeRecord::Cylinder(sizes) => {
            let [half_height, radius] = sizes.array()?;
            made(Cylinder::try_new(half_height, radius))
        }
        ShapeRecord::Cone(sizes) => {
            let [half_height, radius] = sizes.array()?;
            made(Cone::try_new(half_height, radius))
        }
        ShapeRecord::Tetrahedron(corners) => {
            made(Tetrahedron::try_new(corners.all(NumberSource::points)?))
        }
        ShapeRecord::HeightField(field) => {
            let columns = field.columns as usize;
            let field = field.make(|heights, scale| {
                let rows = heights.len() / columns.max(1);
                HeightField::<N, 3>::try_new(rows, columns, heights, scale)
            })?;
            Ok(ShapeHandle::new(field.with_all_rebuilt()))
        }
        _ => Err(Damage("3D has no such shape".into())),
    }
}

/// Restores a hull from its vertices, face normals and faces. Public constructors would renumber
/// them. An error if they do not form a closed and roughly convex solid.
fn hull<N: Real>(
    vertices: Vec<Point<N, 3>>,
    normals: &[Point<N, 3>],
    faces: &[Vec<u32>],
) -> Result<ConvexHull<N>, Damage> {
    let is_finite = vertices.iter().flat_map(|point| point.iter()).all(|x| x.is_finite_number());
    ensure(is_finite, "a vertex of a hull is not finite")?;
    let are_units = normals.iter().all(|normal| is_unit(normal.coords.norm_squared()));
    ensure(are_units && normals.len() == faces.len(), "a face of a hull has no normal")?;
    let exists = |corner: &u32| (*corner as usize) < vertices.len();
    let are_whole = faces.iter().all(|face| face.len() >= 3 && face.iter().all(exists));
    ensure(are_whole && faces.len() >= 4, "a face of a hull is not whole")?;
    let normals = normals.iter().map(|normal| -> Vector<N, 3> { normal.coords });
    let hull = ConvexHull::from_closed_faces(vertices, normals.zip(faces));
    let hull = hull.ok_or(Damage("a hull is not closed".into()))?;
    ensure(hull.has_all_fans() && hull.is_roughly_convex(), "a hull is not convex")?;
    Ok(hull)
}
