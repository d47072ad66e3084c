//! Tests of queries of whole worlds: compared with queries of every object, by hand, and at the
//! limits.

mod against_all;
mod by_hand;
mod stage;
