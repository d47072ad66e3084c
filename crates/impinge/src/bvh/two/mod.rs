//! Searches of two trees, each in its own frame: near pairs of objects, near ones first
//! ([`near_pairs`]), and pairs that may touch, in no order ([`meeting`]).

mod agenda;
mod meeting;
mod near_pairs;
mod regions;

pub(crate) use meeting::{TreeMeeting, visit_meetings};
pub(crate) use near_pairs::{Toward, TreePair, visit_pairs};
