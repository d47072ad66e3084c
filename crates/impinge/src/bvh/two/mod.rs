//! Searches of two trees, each in its own frame: for near pairs of objects, roughly by ascending
//! distance ([`near_pairs`]), and for pairs that may touch, in any order ([`touching`]).

mod agenda;
mod near_pairs;
mod regions;
mod touching;

pub(crate) use near_pairs::{Toward, TreePair, visit_pairs};
pub(crate) use touching::{TouchQuery, visit_touching};
