//! The conservative filter: pairs that are apart or touch by more than all rounding errors, in
//! `f32` and in lanes.
//!
//! ```text
//!   group     a ball around up to eight balls of one node     eight configurations at once, and where it is near
//!     balls     a body, or a row of balls that hold it          its balls at once, in one configuration
//! ```
//!
//! A pair within the error margin is undecided and left to the exact query. So is a pair of a solid
//! represented by its cover or box alone, unless it is known to be apart.
//!
//! The margin of a pair is [`ROUNDING_ERRORS`] times the rounding errors of `f32` and of the scalar
//! for all lengths that lead from the world to its solids: the offsets of the joints, the center
//! and the radius, the position of the obstacle. Each joint adds some ten of these errors and the
//! pair algorithms some hundred at most, as in [`crate::collide::far`]; in long chains the factor
//! grows with the number of joints. Lengths are relative to the first joint, so that `f32` loses no
//! digits for a robot far from the origin.

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

/// The margin in rounding errors; grows with the number of joints by 1/14 each.
const ROUNDING_ERRORS: f64 = 1024.0;

/// The range in which `f32` can square lengths. Larger ones are undecided; margins are at least
/// `MIN_LENGTH`.
const MIN_LENGTH: f64 = 1e-15;
const MAX_LENGTH: f32 = 1e15;

/// The margin for some lengths: `near` is their sum relative to the first joint, `far` relative to
/// the origin.
fn margin<N: Real>(joints: usize, near: f64, far: f64) -> f32 {
    let joints = f64::from(u32::try_from(joints).unwrap_or(u32::MAX));
    let errors = ROUNDING_ERRORS * (1.0 + joints / 14.0);
    let of_lengths = f64::from(f32::EPSILON) * near + N::EPSILON.as_f64() * far;
    N::lit(errors * of_lengths + MIN_LENGTH).as_f32_above()
}
