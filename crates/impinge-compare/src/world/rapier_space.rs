// The conversions for 3D; included by `rapier.rs`.

/// The number of dimensions.
pub const DIM: usize = 3;

/// Converts a shape of a scene.
pub fn builder(shape: &SceneShape<3>) -> ColliderBuilder {
    match shape {
        SceneShape::Ball { radius } => ColliderBuilder::ball(*radius as f32),
        SceneShape::Cuboid { half_extents: [x, y, z] } => {
            ColliderBuilder::cuboid(*x as f32, *y as f32, *z as f32)
        }
        SceneShape::Capsule { half_height, radius } => {
            ColliderBuilder::capsule_y(*half_height as f32, *radius as f32)
        }
        SceneShape::Plane { normal } => {
            ColliderBuilder::new(SharedShape::halfspace(vector(normal)))
        }
        SceneShape::Segment { ends: [a, b] } => ColliderBuilder::segment(vector(a), vector(b)),
        SceneShape::Triangle { corners: [a, b, c] } => {
            ColliderBuilder::triangle(vector(a), vector(b), vector(c))
        }
        SceneShape::Convex { points } => {
            let points: Vec<_> = points.iter().map(vector).collect();
            ColliderBuilder::convex_hull(&points).expect("the points span all dimensions")
        }
        SceneShape::Cylinder { half_height, radius } => {
            ColliderBuilder::cylinder(*half_height as f32, *radius as f32)
        }
        SceneShape::Cone { half_height, radius } => {
            ColliderBuilder::cone(*half_height as f32, *radius as f32)
        }
        SceneShape::TriMesh { vertices, triangles } => {
            let vertices = vertices.iter().map(vector).collect();
            ColliderBuilder::trimesh(vertices, triangles.clone()).expect("the mesh is sound")
        }
        SceneShape::HeightField { counts, heights, extents } => {
            ColliderBuilder::new(SharedShape::new(field(*counts, heights, extents)))
        }
        SceneShape::Polyline { .. } => unreachable!("not of space"),
    }
}

/// Converts a height field. The status of its cells selects the diagonals that the field of the
/// scene has.
fn field([rows, columns]: [usize; 2], heights: &[f64], extents: &[f64; 3]) -> HeightField {
    let by_column = (0..columns)
        .flat_map(|column| (0..rows).map(move |row| heights[row * columns + column] as f32));
    let mut field =
        HeightField::new(Array2::new(rows, columns, by_column.collect()), vector(extents));
    for (row, column) in (1..rows).flat_map(|row| (1..columns).map(move |column| (row, column))) {
        field.set_cell_status(row - 1, column - 1, HeightFieldCellStatus::ZIGZAG_SUBDIVISION);
    }
    field
}

fn vector(v: &[f64; 3]) -> Vector {
    Vector::from(v.map(|x| x as f32))
}

/// Converts a placement of a scene.
pub fn pose(placement: &Placement<3>) -> Pose {
    let [x, y, z] = placement.translation.map(|x| x as f32);
    let [i, j, k, w] = placement.quaternion().map(|x| x as f32);
    Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(i, j, k, w))
}
