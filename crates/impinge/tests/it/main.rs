//! Tests of the public interface, in a single program: it is linked once, and the code that the
//! tests share is compiled once. `cargo test -p impinge --test it NAME` runs the tests whose path
//! contains `NAME`. Only `determinism` is a separate program, because it also runs optimised.

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
