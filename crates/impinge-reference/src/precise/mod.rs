//! Signed distances with about 25 digits, with which the errors of `f64` results are measured.
//!
//! [`crate::geometry`] computes the same quantities in `f64`. Here the numbers are [`Quad`]s, and
//! the solids include ellipsoids and tapered capsules. All input is exact: the rotation of a pose
//! is that of the stored complex number or quaternion after normalization. A library that assumes
//! stored rotations to have unit length is therefore charged with the error of this assumption.

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
