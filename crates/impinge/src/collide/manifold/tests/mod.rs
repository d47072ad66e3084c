//! What every manifold must be, over random poses and in scenes worked out by hand.

mod clip;
mod faces;
mod half_space;
mod lasting;
mod properties;
mod resting;
mod rods;
pub(crate) mod scene;
mod side_pairs;
