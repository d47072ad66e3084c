// The conversions for 3D; included by `ncollide.rs`.

use ncollide::na::{DMatrix, Point3, Quaternion, UnitQuaternion};
use ncollide::shape::{ConvexHull, HeightField, TriMesh, Triangle};

const DIM: usize = 3;

fn vector(v: &[f64; 3]) -> Vector<f32> {
    Vector::from(v.map(|x| x as f32))
}

fn isometry(placement: &Placement<3>) -> Isometry<f32> {
    let [i, j, k, w] = placement.rotation.map(|x| x as f32);
    let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
    Isometry::from_parts(Translation::from(vector(&placement.translation)), rotation)
}

/// Converts the shapes that have no form in 2D or have another type of ncollide there. Cylinders
/// and cones give `None`: in ncollide they do not implement `Shape`, which the query functions used
/// here require.
fn particular(form: &Form<3>) -> Option<ShapeHandle<f32>> {
    Some(match form {
        Form::Triangle([a, b, c]) => ShapeHandle::new(Triangle::new(point(a), point(b), point(c))),
        Form::Convex(points) => ShapeHandle::new(ConvexHull::try_from_points(&cloud(points))?),
        Form::Mesh(terrain) => {
            let triangle = |corners: &[u32; 3]| Point3::from(corners.map(|n| n as usize));
            let triangles = terrain.triangles().iter().map(triangle).collect();
            ShapeHandle::new(TriMesh::new(cloud(&terrain.vertices()), triangles, None))
        }
        Form::HeightField(terrain) => {
            let row = terrain.cells as usize + 1;
            let heights: Vec<f32> = terrain.heights().iter().map(|&y| y as f32).collect();
            let extent = terrain.extent() as f32;
            let heights = DMatrix::from_row_slice(row, row, &heights);
            ShapeHandle::new(HeightField::new(heights, Vector::new(extent, 1.0, extent)))
        }
        _ => return None,
    })
}
