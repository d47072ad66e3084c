//! What is certain at a glance: pairs that are apart or touch by more than all rounding errors, in `f32` and in lanes.
//!
//! ```text
//!   group     a ball around up to eight balls of one node     eight configurations at once, and where it is near
//!     balls     a body, or a row of balls that hold it          its balls at once, in one configuration
//! ```
//!
//! What stays within the margin for errors is undecided, and is asked of the single call.
//! So is what is held by its balls or box alone and not known to be apart.
//!
//! The margin of a pair is [`ROUNDING_ERRORS`] times those of `f32` and of the scalar, of all lengths that lead from the
//! world to its solids: the offsets of the joints, the center and the radius, the place of the obstacle. Each joint
//! adds some ten of these errors and the algorithms for pairs some hundred at most, as in [`crate::collide::far`]; of
//! chains with more joints than a few the number grows with the joints. Lengths are counted from the first
//! joint, so that `f32` loses nothing by a robot far from the origin.

mod core;
mod cover;
mod obstacles;
mod robot;
mod scan;
mod search;

pub(super) use self::obstacles::Surroundings;
pub(super) use self::robot::RobotFilter;
pub(super) use self::scan::{ScanScratch, scan_at};
pub(super) use self::search::{CollisionSearch, NearPair, Other, SearchMode};

use crate::math::Real;

/// The margin in rounding errors, of chains of up to fourteen joints.
const ROUNDING_ERRORS: f64 = 1024.0;

/// Numbers of which `f32` has the squares. What is larger is undecided; margins are never smaller than the least.
const MIN_LENGTH: f64 = 1e-15;
const MAX_LENGTH: f32 = 1e15;

/// The margin that lengths make: `near` are those from the first joint, `far` those from the origin.
fn margin<N: Real>(joints: usize, near: f64, far: f64) -> f32 {
    let joints = f64::from(u32::try_from(joints).unwrap_or(u32::MAX));
    let errors = ROUNDING_ERRORS * (1.0 + joints / 14.0);
    let of_lengths = f64::from(f32::EPSILON) * near + N::EPSILON.as_f64() * far;
    N::lit(errors * of_lengths + MIN_LENGTH).as_f32_above()
}
