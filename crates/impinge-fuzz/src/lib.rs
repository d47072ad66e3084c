//! Shapes, poses and queries made from the bytes of the fuzzer. No call may panic or hang for any
//! bytes, and results must be consistent.
#![forbid(unsafe_code)]
#![allow(
    clippy::missing_assert_message,
    clippy::missing_panics_doc,
    reason = "all of this is assertions; what is printed of them is the input"
)]
#![allow(clippy::cast_possible_truncation, reason = "counts and indices are below 256")]

mod bytes;
mod construct;
mod impact;
mod manifolds;
mod mass;
mod pair;
mod place;
mod recording;
mod shapes;
mod single;
mod world;
mod world_queries;

use bytes::Bytes;
pub use construct::construct;
pub use impact::{nonlinear_time_of_impact, time_of_impact};
pub use manifolds::manifolds;
pub use mass::mass;
pub use pair::{closest_points, contact, distance, proximity, witness};
pub use recording::recording;
pub use single::{point, ray};
pub use world::world;

use impinge::math::Space;
use place::{Dimension, Plane, Room};

/// A fuzz target: runs on the bytes of an input, and panics if it finds a fault.
pub type Target = fn(&[u8]);

/// The targets with their names.
pub const TARGETS: [(&str, Target); 14] = [
    ("distance", distance),
    ("closest_points", closest_points),
    ("proximity", proximity),
    ("contact", contact),
    ("witness", witness),
    ("manifolds", manifolds),
    ("time_of_impact", time_of_impact),
    ("nonlinear_time_of_impact", nonlinear_time_of_impact),
    ("ray", ray),
    ("point", point),
    ("mass", mass),
    ("construct", construct),
    ("world", world),
    ("recording", recording),
];

/// A fuzz target that is generic over the dimension and the scalar.
trait Task {
    /// Runs the task.
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>);
}

/// Runs a task in the dimension, scalar and range of numbers that the first byte selects.
fn dispatch(task: impl Task, data: &[u8]) {
    let bytes = &mut Bytes::new(data);
    let choice = bytes.choice(8);
    if choice >= 4 {
        bytes.go_wild();
    }
    match choice % 4 {
        0 => task.run::<f32, Plane, 2>(bytes),
        1 => task.run::<f64, Plane, 2>(bytes),
        2 => task.run::<f32, Room, 3>(bytes),
        _ => task.run::<f64, Room, 3>(bytes),
    }
}
