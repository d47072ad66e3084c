//! The library of the working tree.

use super::contender;
use super::stages::PREDICTION;
use impinge_new as impinge;

#[path = "../../impinge-compare/src/world/ours.rs"]
mod ours;

pub use ours::{plane, space};
