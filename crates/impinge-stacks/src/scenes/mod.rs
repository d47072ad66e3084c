//! The scenes: solids that stand, fall or slide, and pairs to be shaken.

mod build;
mod dim2;
mod dim3;
mod pairs;
mod slides;
mod terrain;

pub use dim2::stacks2;
pub use pairs::{pairs2, pairs3};

use crate::Stack;

/// Returns all scenes in 3D.
#[must_use]
pub fn stacks3() -> Vec<Stack<3>> {
    let mut all = dim3::stacks();
    all.extend(terrain::stacks());
    all.extend(slides::stacks());
    all
}
