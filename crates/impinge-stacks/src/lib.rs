//! A small solver, scenes of solids at rest, and measures of how well contacts support them.
//!
//! [`Solver`] is a minimal rigid-body solver for use with a collision library. [`stacks2`] and
//! [`stacks3`] are scenes as plain numbers, [`pairs2`] and [`pairs3`] are pairs to be shaken.
//! [`play`] and [`shake`] measure whether the solids rest, and whether contacts keep their ids and
//! positions. Contacts come from a [`ContactSource`]: [`Impinge`] implements it with this library,
//! and other libraries can be connected by further implementations.

#![forbid(unsafe_code)]
#![expect(clippy::disallowed_types, reason = "maps are looked up by id here, and never walked")]

mod mass;
mod memory;
mod run;
mod scenes;
mod solver;
mod source;
mod stack;
mod stage;
mod turn;
mod watch;

pub use mass::Weighed;
pub use memory::{Memory, Place};
pub use run::{LAST, Outcome, play, shake};
pub use scenes::{pairs2, pairs3, stacks2, stacks3};
pub use solver::{Body, Contact, Impulse, Solver};
pub use source::{Choices, ContactSource, Impinge, PREDICTION};
pub use stack::{Item, Kind, Mass, Solid, Stack};
pub use stage::{Stage, bodies_of, shape_of};
pub use turn::Turn;
pub use watch::{Counts, JUMP};
