//! Custom algorithms and shapes, written against `impinge::dim2` and `impinge::dim3`.
//!
//! Each source is compiled twice, with `dim` standing for one of the two modules. The tests thereby
//! show that code for one dimension is right for the other once the numbers are adapted.

#![allow(clippy::duplicate_mod, reason = "once for each dimension")]

mod plane;
mod space;
