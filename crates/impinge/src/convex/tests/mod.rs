//! Tests of the convex algorithms: against reference data, closed forms, results computed by hand,
//! and properties that every correct result has.

mod corpus;
mod degenerate;
mod exact;
mod generator;
mod random;
mod solids;
mod surface;
mod witness;
