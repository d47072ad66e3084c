//! The library of the old commit.

use super::contender;
use super::stages::PREDICTION;
use impinge_old as impinge;

#[path = "../../impinge-compare/src/world/ours.rs"]
mod ours;

pub use ours::{plane, space};
