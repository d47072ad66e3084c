//! Recordings: the same bits in a replay, in every direction, and errors for all other bytes.

mod damage;
mod engine;
mod golden;
mod growing;
mod packing;
mod refusals;
mod roundtrip;
mod scene;
mod solids;
