//! Convex hulls and convex outlines of points.
//!
//! Every visibility decision is exact, so that no input, however degenerate, can break the
//! algorithms. A tolerance only removes points that change nothing: the rounding error of computed
//! coordinates, a few rounding units of the largest one.

mod given;
mod hull2;
mod hull3;
mod hull_faces;
mod lattice;
mod outline;
mod quickhull;
mod span;
mod spanned;

pub use hull2::convex_hull2;
pub use hull3::{IndexedHull, convex_hull3};
pub use spanned::{convex_shape2, convex_shape3};
