//! Checks of the convex algorithms against facts that do not depend on them.

mod corpus;
mod degenerate;
mod exact;
mod generator;
mod random;
mod solids;
mod surface;
mod witness;
