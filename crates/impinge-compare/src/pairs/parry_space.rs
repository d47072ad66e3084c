// The conversions for 3D; included by `parry.rs`.

const DIM: usize = 3;

fn vector(v: &[f64; 3]) -> Vector {
    Vector::from(v.map(|x| x as f32))
}

fn pose(placement: &Placement<3>) -> Pose {
    let [i, j, k, w] = placement.rotation.map(|x| x as f32);
    Pose::from_parts(vector(&placement.translation), Rotation::from_xyzw(i, j, k, w))
}

fn particular(form: &Form<3>) -> Option<SharedShape> {
    Some(match form {
        Form::Cylinder { half_height, radius } => {
            SharedShape::cylinder(*half_height as f32, *radius as f32)
        }
        Form::Cone { half_height, radius } => {
            SharedShape::cone(*half_height as f32, *radius as f32)
        }
        Form::RoundCuboid { half_extents, radius } => {
            let [x, y, z] = half_extents.map(|x| x as f32);
            SharedShape::round_cuboid(x, y, z, *radius as f32)
        }
        Form::Mesh(terrain) => {
            SharedShape::trimesh(cloud(&terrain.vertices()), terrain.triangles()).ok()?
        }
        Form::HeightField(terrain) => {
            // The heights of parry's height field are in column-major order; z varies within a
            // column.
            let row = terrain.cells + 1;
            let at = |n: u32| terrain.height([n / row, n % row]) as f32;
            let heights = (0..row * row).map(at).collect();
            let heights = parry::utils::Array2::new(row as usize, row as usize, heights);
            let extent = terrain.extent() as f32;
            SharedShape::heightfield(heights, Vector::new(extent, 1.0, extent))
        }
        _ => return None,
    })
}
