//! The configuration checker, which computes which of many configurations of a robot are free of
//! collisions.
//!
//! ```text
//!   FrameTree ── frames on joints, driven by the columns of a configuration ──┐
//!   Body      ── a shape at a pose on a frame ────────────────────────────────┤ Checker
//!   pairs     ── bodies that must not touch ──────────────────────────────────┤
//!   Obstacle  ── a shape at a pose in the world, and bodies that may touch it ┘
//!
//!   configuration      0        1        2      …        rows of numbers, radians and lengths
//!   free            [ yes ]  [ no  ]  [ yes ]   …        Checker::are_free
//!   pair            [  -  ]  [ 2 7 ]  [  -  ]   …        Checker::first_pairs
//!   distance        [ 0.3 ]  [ 0.0 ]  [ 0.1 ]   …        Checker::nearest
//! ```
//!
//! Eight configurations are placed and tested at a time in SIMD lanes, in `f32` with a margin for
//! all rounding errors. Pairs that this filter cannot decide are computed by
//! [`proximity`](crate::query::proximity()) and [`distance`](crate::query::distance()) at the poses
//! of [`Checker::place_bodies`]. So all results are bitwise equal to the results of these queries,
//! for any number of threads.
//!
//! Balls are tested in SIMD lanes against balls, boxes, capsules, segments, cylinders and
//! half-spaces. Other bodies are covered by balls, and other obstacles by their boxes; each pair
//! whose covers are not apart takes one exact query. Bodies of triangles or segments also have
//! convex hulls, and their parts are searched only if the hulls are within the clearance.
//! [`Checker::are_free`] defers a pair whose earlier searches mostly found no contact until all
//! other pairs are tested.
//!
//! The use of lanes for configurations follows W. Thomason, Z. Kingston and L. E. Kavraki, "Motions
//! in Microseconds via Vectorized Sampling-Based Planning" (2024).

mod answers;
mod body;
mod chain;
mod checks;
mod columns;
mod entries;
mod error;
mod exact;
mod filter;
mod frames;
mod hulls;
mod joint;
mod odds;
mod rows;
#[cfg(test)]
mod tests;

pub use body::{Body, Obstacle};
pub use checks::{Checker, NO_PAIR};
pub use columns::NearestColumns;
pub(crate) use entries::CheckerEntries;
pub use error::CheckerError;
pub use frames::FrameTree;
pub use joint::{Frame, Joint};
