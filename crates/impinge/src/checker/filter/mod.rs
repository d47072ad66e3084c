//! The conservative filter, in `f32` and in SIMD lanes. It finds the pairs that are certainly
//! farther apart than the limit or certainly within it, despite all rounding errors.
//!
//! ```text
//!   group     a ball around up to 8 balls of one node     lanes: 8 configurations
//!     balls   a body, or a row of balls that cover it     lanes: balls, where the group is near
//! ```
//!
//! A pair whose distance differs from the limit by less than the error margin is undecided and left
//! to the exact query. A pair with a solid that is represented only by its covering balls or its
//! box is also undecided, unless it is certainly farther apart than the limit.
//!
//! The margin of a pair is [`ROUNDING_ERRORS`] times the rounding errors of `f32` and of the scalar
//! for all lengths from the world to its solids: the offsets of the joints, the centre and the
//! radius of the ball, and the position of the obstacle. Each joint adds about ten of these errors,
//! and the pair algorithms a few hundred at most, as in [`crate::collide::far`]. In long chains the
//! factor grows with the number of joints. Positions are relative to the first joint, so that the
//! rounding errors of `f32` are small even for a robot far from the origin.

mod core;
mod cover;
mod obstacles;
mod robot;
mod scan;
mod search;

pub(super) use self::obstacles::Surroundings;
pub(super) use self::robot::RobotFilter;
pub(super) use self::scan::{ScanScratch, scan_at};
pub(super) use self::search::{CandidatePair, CollisionSearch, Other, SearchMode};

use crate::math::Real;

/// The margin of a pair without joints, in units of ε times the lengths; each joint adds 1/14 of
/// this value.
const ROUNDING_ERRORS: f64 = 1024.0;

/// The range of lengths whose squares neither overflow nor underflow in `f32`. Pairs with larger
/// lengths are undecided; margins are at least `MIN_LENGTH`.
const MIN_LENGTH: f64 = 1e-15;
const MAX_LENGTH: f32 = 1e15;

/// Returns an error margin for a chain of `joints` joints. `near` is the sum of the lengths
/// relative to the first joint, `far` the sum relative to the world's origin.
fn margin<N: Real>(joints: usize, near: f64, far: f64) -> f32 {
    let joints = f64::from(u32::try_from(joints).unwrap_or(u32::MAX));
    let errors = ROUNDING_ERRORS * (1.0 + joints / 14.0);
    let of_lengths = f64::from(f32::EPSILON) * near + N::EPSILON.as_f64() * far;
    N::lit(errors * of_lengths + MIN_LENGTH).as_f32_above()
}
