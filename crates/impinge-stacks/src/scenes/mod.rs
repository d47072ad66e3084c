//! The scenes: what stands, what falls, what slides, and pairs to shake.

mod build;
mod pairs;
mod plane;
mod space;
mod space_terrain;

pub use pairs::{pairs2, pairs3};
pub use plane::stacks2;

use crate::Stack;

/// All scenes in 3D.
#[must_use]
pub fn stacks3() -> Vec<Stack<3>> {
    let mut all = space::stacks();
    all.extend(space_terrain::stacks());
    all
}
