//! From points to solids: convex hulls and convex outlines.
//!
//! Every decision about who is in front of what is exact, so that no input, however degenerate, can
//! confuse the algorithms. Points are thinned by a tolerance only where a point that changes nothing
//! would be kept: the noise of computed coordinates, a few rounding units of the largest one.

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
