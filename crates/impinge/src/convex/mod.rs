//! Algorithms on convex sets, known by their support points: no shapes, no pairs, no state.

mod separation;

pub(crate) use separation::Separation;
