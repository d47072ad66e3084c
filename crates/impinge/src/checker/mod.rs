//! The configuration checker: a robot on moving frames, and which of many configurations are free.
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
//! Eight configurations are moved and looked at side by side, in `f32` with a margin for all rounding errors. What that
//! leaves open is asked of [`proximity`](crate::query::proximity()) and [`distance`](crate::query::distance()) on the
//! poses of [`Checker::place_bodies`]; so all answers are theirs, to the bit, on any number of threads.
//!
//! Balls are decided in lanes against balls, boxes, capsules, segments, cylinders and half-spaces; other bodies are held
//! by balls and other obstacles by their boxes, and what these do not tell apart takes a single call for each pair. Bodies
//! of triangles or segments are held by their convex hulls besides: parts are searched only where hulls touch, and where
//! any pair will do, those pairs last of which most searches found nothing.
//!
//! The idea of lanes across configurations is that of W. Thomason, Z. Kingston and L. E. Kavraki, "Motions in
//! Microseconds via Vectorized Sampling-Based Planning" (2024).

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
