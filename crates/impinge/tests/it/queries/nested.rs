//! Tests nesting up to the greatest depth allowed: no query overflows a small stack, and deeper
//! nesting is refused.

use std::thread;

use impinge::math::{Isometry2, Isometry3, Point, Pose, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::{
    ConstantVelocities, ImpactOptions, Moving, PointQuery, Proximity, Ray, RayCast, contact,
    distance, impact, mass_properties, nonlinear_time_of_impact, proximity, witness,
};
use impinge::shape::{
    Ball, Compound, Cuboid, MAX_NESTING, Rounded, ShapeError, ShapeHandle, TriMesh,
};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Returns the shape in `deep` nested compounds, each of which moves its child along the first
/// axis.
fn nest<N: Space<D>, const D: usize>(mut shape: ShapeHandle<N, D>, deep: u32) -> ShapeHandle<N, D> {
    let pose =
        Pose::from_translation(Vector::<N, D>::from_fn(|row, _| N::lit([0.25, 0.0, 0.0][row])));
    let place = N::isometry(&pose);
    for _ in 0..deep {
        shape = ShapeHandle::new(Compound::<N, D>::new(vec![(place, shape)]));
    }
    shape
}

/// Runs `run` in a thread with a stack of 2 MiB, the default of threads.
fn on_small_stack(run: impl FnOnce() + Send + 'static) {
    let thread = thread::Builder::new().stack_size(2 << 20).spawn(run);
    thread.expect("a thread").join().expect("it ends well");
}

fn ask_all(one: &ShapeHandle<f32, 3>, other: &ShapeHandle<f32, 3>) {
    let (here, there) = (Isometry3::identity(), Isometry3::translation(3.0, 0.5, 0.1));
    assert!(distance(&here, &**one, &there, &**other) > 0.0, "apart");
    let own = proximity(&here, &**one, &here, &**one, 0.0);
    assert_eq!(own, Proximity::Intersecting, "with itself");
    assert!(contact(&here, &**one, &here, &**other, 0.1).is_some(), "at one place");
    let nearest = witness(&here, &**one, &there, &**other, f32::INFINITY);
    assert!(nearest.is_some(), "finite");
    let moving = Moving::new(&there, &Vector::<f32, 3>::new(-1.0, 0.0, 0.0), &**other);
    let _ = impact(&Moving::still(&here, &**one), &moving, &ImpactOptions::new());
    let turning = ConstantVelocities::<f32, 3>::new(there, Vector::zeros(), Vector::<f32, 3>::z());
    let still = ConstantVelocities::<f32, 3>::still(here);
    let options = ImpactOptions::new().with_max_time(7.0);
    let _ = nonlinear_time_of_impact(&still, &**one, &turning, &**other, &options);
    let ray = Ray::new(Point::<f32, 3>::new(-50.0, 0.1, 0.1), Vector::<f32, 3>::x());
    let _ = one.toi_with_ray(&here, &ray, true);
    let _ = one.project_point(&here, &Point::<f32, 3>::new(9.0, 4.0, 1.0), true);
    let _ = mass_properties(&**one, 1.0);
    let scaled = one.scaled(&Vector::<f32, 3>::repeat(2.0)).expect("uniform");
    assert!(!format!("{scaled:?}").is_empty(), "it is written");
    let mut world = CollisionWorld::<f32, 3, ()>::new(0.02);
    for (shape, at) in [(one, here), (other, here)] {
        let query = GeometricQueryType::Contacts(0.0, 0.0);
        world.add(at, shape.clone(), CollisionGroups::new(), query, ());
    }
    world.update();
    assert_eq!(world.contact_pairs().count(), 1, "they touch");
}

#[test]
fn shapes_nest_as_deep_as_they_may() {
    on_small_stack(|| {
        let corners =
            [[-1.0, 0.0, -1.0], [1.0, 0.0, -1.0], [1.0, 0.3, 1.0]].map(Point::<f32, 3>::from);
        let mesh = ShapeHandle::new(TriMesh::<f32, 3>::new(corners.to_vec(), vec![[0, 1, 2]]));
        let cuboid = ShapeHandle::new(Cuboid::new(Vector::<f32, 3>::repeat(0.5)));
        let kinds = [cuboid, mesh, ShapeHandle::new(Ball::new(0.5))];
        let kinds = kinds.map(|kind| nest(kind, MAX_NESTING));
        for one in &kinds {
            for other in &kinds {
                ask_all(one, other);
            }
        }
    });
}

#[test]
fn rounded_shapes_nest_as_deep_as_they_may() {
    on_small_stack(|| {
        let mut shape: ShapeHandle<f32, 3> =
            ShapeHandle::new(Cuboid::new(Vector::<f32, 3>::repeat(0.5)));
        for _ in 0..MAX_NESTING - 1 {
            shape = ShapeHandle::new(Rounded::try_from_handle(shape, 0.01).expect("not too deep"));
        }
        let whole = nest(shape, 1);
        ask_all(&whole, &whole);
        let refused = Compound::<f32, 3>::try_new(vec![(Isometry3::identity(), whole)]);
        assert_eq!(refused.expect_err("too deep"), ShapeError::TooDeep { depth: MAX_NESTING + 1 });
    });
}

#[test]
fn deeper_shapes_are_refused() {
    fn check<N: Space<2, Isometry = Isometry2<N>>>() {
        let deep = nest::<N, 2>(ShapeHandle::new(Ball::new(N::ONE)), MAX_NESTING);
        let flat = ShapeHandle::new(Ball::new(N::ONE));
        let children = vec![(Isometry2::identity(), flat), (Isometry2::identity(), deep)];
        let refused = Compound::<N, 2>::try_new(children).expect_err("too deep");
        assert_eq!(refused, ShapeError::TooDeep { depth: MAX_NESTING + 1 });
        assert_eq!(refused.to_string(), "the shape is nested 65 deep, at most 64 are allowed");
        let mut shape: ShapeHandle<N, 2> = ShapeHandle::new(Ball::new(N::ONE));
        for _ in 0..MAX_NESTING {
            shape =
                ShapeHandle::new(Rounded::try_from_handle(shape, N::ONE).expect("not too deep"));
        }
        let refused = Rounded::try_from_handle(shape.clone(), N::ONE).expect_err("too deep");
        assert_eq!(refused, ShapeError::TooDeep { depth: MAX_NESTING + 1 });
        assert!(shape.scaled(&Vector::<N, 2>::repeat(N::TWO)).is_ok(), "as deep as before");
    }
    check::<f32>();
    check::<f64>();
}
