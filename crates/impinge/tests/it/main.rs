//! Tests of the public interface in a single program, so that it is linked once and shared code is compiled once.
//! `cargo test -p impinge --test it NAME` runs those whose path contains a name. Only `determinism` is a separate
//! program, because it also runs optimised.

#[macro_use]
mod support;

mod api;
mod batch;
mod broad_phase;
mod cases;
mod checker;
mod composites;
mod contacts;
mod queries;
mod stacks;
mod worlds;
