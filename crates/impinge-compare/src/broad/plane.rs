//! The 2D rivals that have one crate per dimension.
//!
//! The two crates of such a rival have the same interface. So the files below are compiled once
//! here and once in `space`.

use ncollide2d as ncollide;
use parry2d as parry;
use rapier2d as rapier;

/// The number of dimensions.
const D: usize = 2;

#[path = "ncollide.rs"]
mod ncollide_phase;
#[path = "parry.rs"]
mod parry_tree;
#[path = "rapier.rs"]
mod rapier_phase;

pub use ncollide_phase::Ncollide;
pub use parry_tree::Parry;
pub use rapier_phase::Rapier;
