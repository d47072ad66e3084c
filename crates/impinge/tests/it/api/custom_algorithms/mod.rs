//! Custom algorithms and shapes, written against `impinge::dim2` and `impinge::dim3`.
//!
//! Each source is compiled twice, with `dim` as an alias for one of the two modules. So code
//! written for one dimension also works in the other, once its numbers are adapted.

#![allow(clippy::duplicate_mod, reason = "once for each dimension")]

mod plane;
mod space;
