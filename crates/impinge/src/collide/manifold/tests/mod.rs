//! Properties of every manifold, at random poses and in scenes computed by hand.

mod clip;
mod faces;
mod half_space;
mod lasting;
mod properties;
mod resting;
mod rods;
pub(crate) mod scene;
mod side_pairs;
