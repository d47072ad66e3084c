//! Tests of recordings: a replay has the same bits in every direction, and all other bytes give
//! errors.

mod damage;
mod engine;
mod ghosts;
mod golden;
mod growing;
mod packing;
mod refusals;
mod retired;
mod roundtrip;
mod scene;
mod solids;
