// The conversions for 2D; included by `ncollide.rs`.

use ncollide::na::UnitComplex;
use ncollide::shape::{ConvexPolygon, Polyline};

const DIM: usize = 2;

fn vector(v: &[f64; 2]) -> Vector<f32> {
    Vector::from(v.map(|x| x as f32))
}

fn isometry(placement: &Placement<2>) -> Isometry<f32> {
    let [cosine, sine] = placement.complex().map(|x| x as f32);
    let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
    Isometry::from_parts(Translation::from(vector(&placement.translation)), rotation)
}

fn particular(form: &Form<2>) -> Option<ShapeHandle<f32>> {
    Some(match form {
        Form::Triangle(corners) => ShapeHandle::new(ConvexPolygon::try_from_points(&cloud(corners))?),
        Form::Convex(points) => ShapeHandle::new(ConvexPolygon::try_from_points(&cloud(points))?),
        Form::Polyline(terrain) => ShapeHandle::new(Polyline::new(cloud(&terrain.line()), None)),
        _ => return None,
    })
}
