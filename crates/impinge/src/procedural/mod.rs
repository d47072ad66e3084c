//! The surfaces of the built-in shapes as points and triangles: for drawing and for tests.
//!
//! [`plane`] gives outlines, [`space`] closed surfaces of triangles; both are plain data in the frame
//! of the shape, and what turns them into lines on a screen is nobody's business here. Half-spaces
//! have no end and segments no surface, so they are missing.
//!
//! What holds of all of them:
//! * every vertex is a point of the true surface, up to a few rounding units, so that the result lies
//!   inside the solid, by no more than the gap that each function states;
//! * a size of zero changes no vertex count and no triangle: some triangles then have no area;
//! * scaling a shape by a power of two scales every vertex exactly, and the bits are the same on every
//!   machine;
//! * the number of subdivisions is that of a full turn. It counts as [`MIN_SUBDIVISIONS`] below that
//!   and as [`MAX_SUBDIVISIONS`] above that.

mod circle;
pub mod plane;
mod revolution;
pub mod space;
mod surface;

pub use circle::{MAX_SUBDIVISIONS, MIN_SUBDIVISIONS};
pub use surface::{Outline, TriangleSurface};
