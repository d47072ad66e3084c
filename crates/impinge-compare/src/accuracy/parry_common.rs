// Source shared by the modules for parry's four crates; included by `parry.rs`.

use super::{Form, Outcome, Placement, Sample};
use parry::math::{Pose, Rotation, Vector};
use parry::query::{contact, distance};
use parry::shape::SharedShape;

/// Runs a sample. Shapes that parry lacks, and pairs that it does not support, give `Unsupported`.
pub fn ask(sample: &Sample<DIM>, prediction: f64) -> Outcome<DIM> {
    let [shape1, shape2] = [0, 1].map(|i: usize| shape(&sample.forms[i]));
    let (Some(shape1), Some(shape2)) = (shape1, shape2) else { return Outcome::Unsupported };
    let [at1, at2] = [0, 1].map(|i: usize| pose(&sample.placements[i]));
    let Ok(distance) = distance(&at1, &*shape1, &at2, &*shape2) else {
        return Outcome::Unsupported;
    };
    let distance = f64::from(distance.distance);
    match contact(&at1, &*shape1, &at2, &*shape2, prediction as Real) {
        Err(_) => Outcome::Unsupported,
        Ok(None) => Outcome::Nothing { distance },
        Ok(Some(found)) => Outcome::Found {
            distance,
            signed: f64::from(found.dist),
            normal: components(found.normal1),
        },
    }
}

fn shape(form: &Form<DIM>) -> Option<SharedShape> {
    Some(match form {
        Form::Ball { radius } => SharedShape::ball(*radius as Real),
        Form::Cuboid { half_extents } => {
            SharedShape::new(parry::shape::Cuboid::new(vector(half_extents)))
        }
        Form::Capsule { half_height, radius } => {
            SharedShape::capsule_y(*half_height as Real, *radius as Real)
        }
        Form::Segment([a, b]) => SharedShape::segment(vector(a), vector(b)),
        Form::Triangle([a, b, c]) => SharedShape::triangle(vector(a), vector(b), vector(c)),
        Form::HalfSpace { normal } => SharedShape::halfspace(vector(normal)),
        other => return particular(other),
    })
}
