//! The conservative filter. It finds pairs that are apart, or that touch by more than all rounding
//! errors, in `f32` and in SIMD lanes.
//!
//! ```text
//!   group     a ball around up to 8 balls of one node         8 configurations at once, and where it is near
//!     balls     a body, or a row of balls that hold it          its balls at once, in one configuration
//! ```
//!
//! A pair within the error margin is undecided and left to the exact query. A pair with a solid
//! that is represented by its cover or box alone is also undecided, unless it is certainly apart.
//!
//! The margin of a pair is [`ROUNDING_ERRORS`] times the rounding errors of `f32` and of the scalar
//! for all lengths between the world and its solids: the offsets of the joints, the centre and the
//! radius, the position of the obstacle. Each joint adds about ten of these errors, and the pair
//! algorithms a few hundred at most, as in [`crate::collide::far`]. In long chains the factor grows
//! with the number of joints. Lengths are relative to the first joint, so that `f32` loses no
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
pub(super) use self::search::{CandidatePair, CollisionSearch, Other, SearchMode};

use crate::math::Real;

/// The margin in rounding errors; each joint adds 1/14 of this value.
const ROUNDING_ERRORS: f64 = 1024.0;

/// The range in which `f32` can square lengths. Pairs with larger lengths are undecided; margins
/// are at least `MIN_LENGTH`.
const MIN_LENGTH: f64 = 1e-15;
const MAX_LENGTH: f32 = 1e15;

/// Returns the margin for some lengths: `near` is their sum relative to the first joint, `far`
/// relative to the world's origin.
fn margin<N: Real>(joints: usize, near: f64, far: f64) -> f32 {
    let joints = f64::from(u32::try_from(joints).unwrap_or(u32::MAX));
    let errors = ROUNDING_ERRORS * (1.0 + joints / 14.0);
    let of_lengths = f64::from(f32::EPSILON) * near + N::EPSILON.as_f64() * far;
    N::lit(errors * of_lengths + MIN_LENGTH).as_f32_above()
}
