//! Queries about everything in a world: against every object one by one, by hand, and at the edges.

mod against_all;
mod by_hand;
mod stage;
