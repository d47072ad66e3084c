//! The 3D rivals that have one crate per dimension.
//!
//! The two crates of such a rival have the same interface. So the files below are compiled once
//! here and once in `plane`.

use ncollide3d as ncollide;
use parry3d as parry;
use rapier3d as rapier;

/// The number of dimensions.
const D: usize = 3;

#[path = "ncollide.rs"]
mod ncollide_phase;
#[path = "parry.rs"]
mod parry_tree;
#[path = "rapier.rs"]
mod rapier_phase;

pub use ncollide_phase::Ncollide;
pub use parry_tree::Parry;
pub use rapier_phase::Rapier;
