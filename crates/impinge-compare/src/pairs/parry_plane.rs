// The conversions for 2D; included by `parry.rs`.

const DIM: usize = 2;

fn vector(v: &[f64; 2]) -> Vector {
    Vector::from(v.map(|x| x as f32))
}

fn pose(placement: &Placement<2>) -> Pose {
    let [cosine, sine] = placement.complex().map(|x| x as f32);
    let rotation = Rotation::from_cos_sin_unchecked(cosine, sine);
    Pose::from_parts(vector(&placement.translation), rotation)
}

fn particular(form: &Form<2>) -> Option<SharedShape> {
    match form {
        Form::Polyline(terrain) => Some(SharedShape::polyline(cloud(&terrain.line()), None)),
        Form::RoundCuboid { half_extents, radius } => {
            let [x, y] = half_extents.map(|x| x as f32);
            Some(SharedShape::round_cuboid(x, y, *radius as f32))
        }
        _ => None,
    }
}
