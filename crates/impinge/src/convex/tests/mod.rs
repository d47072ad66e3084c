//! Checks of the convex algorithms, against what needs no trust in them.

mod corpus;
mod degenerate;
mod exact;
mod generator;
mod random;
mod solids;
mod surface;
mod witness;
