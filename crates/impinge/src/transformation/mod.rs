//! Convex hulls and convex outlines of points.
//!
//! Every visibility decision is exact, so no input, however degenerate, breaks the algorithms. The
//! tolerance is a few epsilon of the largest coordinate. It only removes points whose effect is
//! about as small as the rounding error of the coordinates.

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
