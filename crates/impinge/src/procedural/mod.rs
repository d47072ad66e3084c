//! Surfaces of the built-in shapes as points and triangles, for drawing and for tests.
//!
//! [`plane`] computes outlines of 2D shapes, [`space`] closed surfaces of 3D shapes, made of
//! triangles. The results are plain data in the frame of the shape, independent of any drawing.
//! Half-spaces, which are unbounded, and segments, which have no surface, are left out.
//!
//! Common properties:
//! * every vertex is a point of the true surface, up to a few rounding units, so the result lies
//!   inside the solid. Each function states a bound of the gap: the greatest distance of a point of
//!   the true surface from the result;
//! * a size of zero changes no vertex count and no triangle: some triangles then have no area.
//!   Tapered capsules are an exception: their number of vertices depends on their sizes;
//! * scaling a shape by a power of two scales every vertex exactly, and the results are bitwise
//!   equal on every machine;
//! * the number of subdivisions is for a full turn. It is clamped to the range from
//!   [`MIN_SUBDIVISIONS`] to [`MAX_SUBDIVISIONS`].

mod circle;
pub mod plane;
mod revolution;
pub mod space;
mod surface;

pub use circle::{MAX_SUBDIVISIONS, MIN_SUBDIVISIONS};
pub use surface::{Outline, TriangleSurface};
