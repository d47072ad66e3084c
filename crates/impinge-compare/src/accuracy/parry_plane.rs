// The conversions for 2D; included by `parry.rs`.

const DIM: usize = 2;

fn vector(v: &[f64; 2]) -> Vector {
    Vector::from(v.map(|x| x as Real))
}

fn components(v: Vector) -> [f64; 2] {
    [v.x, v.y].map(|x| f64::from(x))
}

fn pose(placement: &Placement<2>) -> Pose {
    let [cosine, sine, ..] = placement.rotation.map(|x| x as Real);
    let rotation = Rotation::from_cos_sin_unchecked(cosine, sine);
    Pose::from_parts(vector(&placement.translation), rotation)
}

fn particular(form: &Form<2>) -> Option<SharedShape> {
    match form {
        Form::Convex(points) => {
            let points: Vec<Vector> = points.iter().map(vector).collect();
            SharedShape::convex_hull(&points)
        }
        Form::RoundCuboid { half_extents, radius } => {
            let [x, y] = half_extents.map(|x| x as Real);
            Some(SharedShape::round_cuboid(x, y, *radius as Real))
        }
        _ => None,
    }
}
