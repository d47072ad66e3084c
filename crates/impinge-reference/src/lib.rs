//! Slow and simple reference implementations, with which impinge's tests compare its results.
//!
//! Nothing here shares code with the library. Vectors are plain arrays of `f64`, distances are
//! found by testing every direction that can matter, and the world computes every pair at every
//! update. Results of the library are compared with those of this crate; results of this crate can
//! be verified by hand.
//!
//! - [`geometry`]: poses, convex solids, signed distance, points, rays, boxes
//! - [`mass`]: area or volume, centre and inertia by counting points
//! - [`precise`]: signed distance with about 25 digits
//! - [`world`]: the naive collision world and its event log
//! - [`random`]: the small deterministic generator that all tests share
//! - [`topology`]: tests whether a list of faces is a convex hull
#![forbid(unsafe_code)]

pub mod geometry;
pub mod mass;
pub mod precise;
pub mod random;
pub mod topology;
pub mod world;
