//! Checks of the convex algorithms, against what needs no trust in them.

mod corpus;
mod solids;
