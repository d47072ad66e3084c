//! The tests of the public interface, in one program: it is linked once, and what the tests share is compiled
//! once. `cargo test -p impinge --test it NAME` runs those whose path has a name. Only `determinism` is a program of
//! its own, which is also run optimised.

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
