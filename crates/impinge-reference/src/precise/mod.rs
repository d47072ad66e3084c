//! Signed distances with about 25 digits, for the judging of answers in `f64`.
//!
//! [`crate::geometry`] answers the same questions in `f64`; here the numbers are [`Quad`]s, the
//! solids include ellipsoids and tapered capsules, and all input is taken to the last digit: a
//! rotation is the one that the stored complex number or quaternion describes once it is brought to
//! length one, so a library that takes it for unit is charged for what it is not.

mod distance;
mod linear;
mod newton;
mod number;
mod polytope;
mod search;
mod solid;
#[cfg(test)]
mod tests;
mod topology;
pub mod vector;

pub use distance::{Precise, separation_along, signed_distance};
pub use number::Quad;
pub use solid::{Pose, Solid};
