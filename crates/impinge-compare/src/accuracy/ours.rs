//! The contender impinge: converts samples and runs its queries.

use impinge::math::na::{Quaternion, Translation, Unit, UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::query::{contact, distance};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, Plane, Rounded,
    Segment, ShapeHandle, TaperedCapsule, Triangle,
};

use super::form::{Form, Outcome, Placement, Sample};

/// Runs a 2D sample.
pub fn plane<N: Space<2>>(sample: &Sample<2>, prediction: f64) -> Outcome<2> {
    let particular = |form: &Form<2>| match form {
        Form::Convex(points) => ShapeHandle::new(ConvexPolygon::from_points(&hull::<N, 2>(points))),
        other => unreachable!("{other:?} is not of the plane"),
    };
    let isometry = |placement: &Placement<2>| {
        let [cosine, sine, ..] = placement.rotation.map(N::lit);
        let rotation = UnitComplex::from_cos_sin_unchecked(cosine, sine);
        Isometry2::from_parts(Translation::from(placement.translation.map(N::lit)), rotation)
    };
    ask(sample, prediction, particular, isometry)
}

/// Runs a 3D sample.
pub fn space<N: Space<3>>(sample: &Sample<3>, prediction: f64) -> Outcome<3> {
    let particular = |form: &Form<3>| match form {
        Form::Convex(points) => ShapeHandle::new(ConvexHull::from_points(&hull::<N, 3>(points))),
        Form::Cylinder { half_height, radius } => {
            ShapeHandle::new(Cylinder::new(N::lit(*half_height), N::lit(*radius)))
        }
        Form::Cone { half_height, radius } => {
            ShapeHandle::new(Cone::new(N::lit(*half_height), N::lit(*radius)))
        }
        other => unreachable!("{other:?} is of every dimension"),
    };
    let isometry = |placement: &Placement<3>| {
        let [i, j, k, w] = placement.rotation.map(N::lit);
        let rotation = UnitQuaternion::new_unchecked(Quaternion::new(w, i, j, k));
        Isometry3::from_parts(Translation::from(placement.translation.map(N::lit)), rotation)
    };
    ask(sample, prediction, particular, isometry)
}

fn ask<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    sample: &Sample<D>,
    prediction: f64,
    particular: impl Fn(&Form<D>) -> ShapeHandle<N, D>,
    isometry: impl Fn(&Placement<D>) -> Isometry<N, R, D>,
) -> Outcome<D> {
    let shape = |form: &Form<D>| common(form).unwrap_or_else(|| particular(form));
    let [shape1, shape2] = [0, 1].map(|i: usize| shape(&sample.forms[i]));
    let [at1, at2] = [0, 1].map(|i: usize| isometry(&sample.placements[i]));
    let distance = distance(&at1, &*shape1, &at2, &*shape2).as_f64();
    match contact(&at1, &*shape1, &at2, &*shape2, N::lit(prediction)) {
        None => Outcome::Nothing { distance },
        Some(found) => {
            let normal = std::array::from_fn(|i| found.normal[i].as_f64());
            Outcome::Found { distance, signed: -found.depth.as_f64(), normal }
        }
    }
}

fn point<N: Space<D>, const D: usize>(point: &[f64; D]) -> Point<N, D> {
    Point::from(point.map(N::lit))
}

fn hull<N: Space<D>, const D: usize>(points: &[[f64; D]]) -> Vec<Point<N, D>> {
    points.iter().map(point).collect()
}

/// Converts the solids whose type in impinge is the same in 2D and 3D; returns `None` for all other
/// solids.
fn common<N: Space<D>, const D: usize>(form: &Form<D>) -> Option<ShapeHandle<N, D>> {
    let vector = |v: &[f64; D]| Vector::<N, D>::from(v.map(N::lit));
    Some(match form {
        Form::Ball { radius } => ShapeHandle::new(Ball::new(N::lit(*radius))),
        Form::Cuboid { half_extents } => ShapeHandle::new(Cuboid::new(vector(half_extents))),
        Form::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(N::lit(*half_height), N::lit(*radius)))
        }
        Form::Segment([a, b]) => ShapeHandle::new(Segment::new(point(a), point(b))),
        Form::Triangle([a, b, c]) => ShapeHandle::new(Triangle::new(point(a), point(b), point(c))),
        Form::Ellipsoid { half_axes } => ShapeHandle::new(Ellipsoid::new(vector(half_axes))),
        Form::Tapered { half_height, radii: [low, high] } => {
            let [half_height, low, high] = [*half_height, *low, *high].map(N::lit);
            ShapeHandle::new(TaperedCapsule::new(half_height, low, high))
        }
        Form::RoundCuboid { half_extents, radius } => {
            let cuboid = Cuboid::new(vector(half_extents));
            ShapeHandle::new(Rounded::new(cuboid, N::lit(*radius)))
        }
        Form::HalfSpace { normal } => {
            ShapeHandle::new(Plane::new(Unit::new_unchecked(vector(normal))))
        }
        Form::Convex(_) | Form::Cylinder { .. } | Form::Cone { .. } => return None,
    })
}
