//! Tests of manifolds: properties at random poses, and scenes with results computed by hand.

mod clip;
mod faces;
mod half_space;
mod lasting;
mod properties;
mod resting;
pub(crate) mod scene;
mod segments;
mod side_pairs;
