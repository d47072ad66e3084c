//! Tests of convex hulls and convex polygons against slow checks that share no code with the
//! library.

mod checks;
mod corpus;
mod given;
mod large;
mod plane;
mod points;
mod solids;
mod space;
