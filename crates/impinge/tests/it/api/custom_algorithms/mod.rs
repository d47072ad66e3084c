//! Algorithms and shapes of the user's own, written against the names of the plane and of space.
//!
//! The same sources are compiled twice, with `dim` being `impinge::dim2` and `impinge::dim3`: what a
//! user writes for one dimension is right for the other but for the numbers.

#![allow(clippy::duplicate_mod, reason = "once for each dimension")]

mod plane;
mod space;
