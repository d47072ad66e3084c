// The conversions for 3D; included by `parry.rs`.

const DIM: usize = 3;

fn vector(v: &[f64; 3]) -> Vector {
    Vector::from(v.map(|x| x as Real))
}

fn components(v: Vector) -> [f64; 3] {
    [v.x, v.y, v.z].map(|x| f64::from(x))
}

fn pose(placement: &Placement<3>) -> Pose {
    let [i, j, k, w] = placement.rotation.map(|x| x as Real);
    Pose::from_parts(vector(&placement.translation), Rotation::from_xyzw(i, j, k, w))
}

fn particular(form: &Form<3>) -> Option<SharedShape> {
    match form {
        Form::Convex(points) => {
            let points: Vec<Vector> = points.iter().map(vector).collect();
            SharedShape::convex_hull(&points)
        }
        Form::Cylinder { half_height, radius } => {
            Some(SharedShape::cylinder(*half_height as Real, *radius as Real))
        }
        Form::Cone { half_height, radius } => {
            Some(SharedShape::cone(*half_height as Real, *radius as Real))
        }
        Form::RoundCuboid { half_extents, radius } => {
            let [x, y, z] = half_extents.map(|x| x as Real);
            Some(SharedShape::round_cuboid(x, y, z, *radius as Real))
        }
        _ => None,
    }
}
