//! Slow and obvious answers that impinge's tests are held against.
//!
//! Nothing here shares code with the library: vectors are plain arrays of `f64`, distances are
//! found by trying every direction that can matter, and the world looks at every pair at every
//! update. Whoever doubts an answer of the library asks here, and whoever doubts an answer of this
//! crate can check it with a pencil.
//!
//! - [`geometry`]: poses, convex solids, signed distance, points, rays, boxes
//! - [`mass`]: area or volume, centre and inertia by counting points
//! - [`precise`]: signed distance with about 25 digits
//! - [`world`]: the naive collision world and its event log
//! - [`random`]: the small deterministic generator that all tests share
//! - [`topology`]: is this list of faces really a convex hull?
#![forbid(unsafe_code)]

pub mod geometry;
pub mod mass;
pub mod precise;
pub mod random;
pub mod topology;
pub mod world;
