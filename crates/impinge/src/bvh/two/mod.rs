//! Searches of two trees, each in its own frame: near pairs of objects, near ones first
//! ([`near_pairs`]), and pairs that may touch, in no order ([`touching`]).

mod agenda;
mod near_pairs;
mod regions;
mod touching;

pub(crate) use near_pairs::{Toward, TreePair, visit_pairs};
pub(crate) use touching::{TouchQuery, visit_touching};
