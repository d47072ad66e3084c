//! Writes the recordings that the tests of the page read: `cargo run -p impinge-page --example
//! falling_ball`.
//!
//! A ball of radius 0.5 falls onto a floor whose top is at 0. A second ball of this radius rests on
//! the floor, two units beside the first. While the first ball is at height `h` above its rest
//! position, the distance between the balls is `sqrt(4 + h²) - 1`. On its way the ball passes a
//! sensor with half extents of 0.5.

use std::error::Error;
use std::fs;
use std::path::Path;

use impinge::bounding_volume::Ray;
use impinge::math::{Point, Pose, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::shape::{Ball, Cuboid, ShapeHandle};
use impinge::world::CollisionGroups;
use impinge_record::{Query, Question, RayQuestion, Recordable, Recorder, Registry, Scalar};

/// The number of updates; in the last updates the ball rests.
const STEPS: u32 = 40;
/// The initial height above the rest position. The ball falls by 0.1 in each step.
const HEIGHT: f64 = 3.0;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("web/tests");
    fs::write(folder.join("falling2.rec"), recording::<f32, 2>()?)?;
    fs::write(folder.join("falling3.rec"), recording::<f64, 3>()?)?;
    Ok(())
}

fn recording<N: Scalar + Recordable<D>, const D: usize>() -> Result<Vec<u8>, Box<dyn Error>> {
    let registry = Registry::<N, D, String>::new();
    let mut recorder = Recorder::new(N::lit(0.02), registry)?;
    let floor = Vector::<N, D>::from_fn(|axis, _| N::lit([4.0, 0.5, 4.0][axis]));
    let ball = || ShapeHandle::new(Ball::new(N::HALF));
    let contacts = GeometricQueryType::Contacts(N::lit(0.05), N::ZERO);
    let mut add = |[x, y]: [f64; 2], shape, query, label: &str| {
        let groups = CollisionGroups::new();
        recorder.add(at::<N, D>(x, y), shape, groups, query, label.to_owned())
    };
    add([0.0, -0.5], ShapeHandle::new(Cuboid::new(floor)), contacts, "floor")?;
    let falling = add([0.0, HEIGHT + 0.5], ball(), contacts, "falling ball")?;
    add([2.0, 0.5], ball(), contacts, "resting ball")?;
    let zone = Vector::<N, D>::repeat(N::HALF);
    add(
        [0.0, 2.0],
        ShapeHandle::new(Cuboid::new(zone)),
        GeometricQueryType::Proximity(N::ZERO),
        "sensor",
    )?;
    for step in 0..STEPS {
        advance(&mut recorder, falling, step)?;
    }
    Ok(recorder.finish().bytes)
}

/// Moves the falling ball to its position at a step and updates. Every tenth step, casts a ray
/// before the update.
fn advance<N: Scalar + Recordable<D>, const D: usize>(
    recorder: &mut Recorder<N, D, String>,
    falling: CollisionObjectHandle,
    step: u32,
) -> Result<(), Box<dyn Error>> {
    let height = (HEIGHT - 0.1 * f64::from(step)).max(0.0);
    recorder.set_position(falling, at::<N, D>(0.0, height + 0.5))?;
    if step % 10 == 5 {
        let from = Vector::<N, D>::from_fn(|axis, _| N::lit([-3.0, 0.5, 0.0][axis]));
        let mut along = Vector::<N, D>::zeros();
        along[0] = N::ONE;
        let ray = RayQuestion {
            ray: Ray::new(Point::from(from), along),
            max_time: N::lit(8.0),
            solid: true,
        };
        recorder.ask(&Query::new(Question::RayHits(ray)))?;
    }
    recorder.update();
    Ok(())
}

/// Returns a position without rotation, whose first two coordinates are `x` and `y`.
fn at<N: Recordable<D>, const D: usize>(x: f64, y: f64) -> N::Isometry {
    let translation = Vector::<N, D>::from_fn(|axis, _| N::lit([x, y, 0.0][axis]));
    N::isometry(&Pose::from_translation(translation))
}
